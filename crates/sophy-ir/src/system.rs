use crate::arithmetic::Comparison;
use crate::graph::{Graph, Leaf, Node, NodeId};
use sophy_diagnostics::Span;
use sophy_field::{
    AutomatonIndex, EventIndex, InputIndex, LocationIndex, ParameterIndex, StateIndex, TransitionIndex,
    WatchIndex,
};
use std::fmt;

/// One flat hybrid system, ready to be made callable. Automata stay side by side; locations are never
/// multiplied into a product.
///
/// Every expression is smooth where it is read by a rate or a guard: comparisons over continuous quantities
/// are [`Leaf::Truth`], `floor` is [`Leaf::Stair`], both decided by watches (architecture: *kinks are
/// events*). Outputs and resets are read at instants only and keep the switches as written.
#[derive(Clone, Debug, Default)]
pub struct System {
    /// Name of the model.
    pub name: String,
    /// All expressions.
    pub graph: Graph,
    /// Constants and knobs.
    pub parameters: Vec<Parameter>,
    /// Inputs from outside.
    pub inputs: Vec<Input>,
    /// Continuous states, the union over locations.
    pub states: Vec<State>,
    /// Outputs of one automaton read by another, in an order in which they can be evaluated.
    pub algebraics: Vec<Algebraic>,
    /// Outputs.
    pub outputs: Vec<Output>,
    /// Automata, in the order of components.
    pub automata: Vec<Automaton>,
    /// Transitions, in written order.
    pub transitions: Vec<FlatTransition>,
    /// Input events.
    pub events: Vec<Event>,
    /// Scalars whose sign changes are located; one that reads a truth or stair comes after its watches.
    pub watches: Vec<Watch>,
    /// Decided comparisons.
    pub truths: Vec<Truth>,
    /// Staircases.
    pub stairs: Vec<Stair>,
}

/// A constant or knob.
#[derive(Clone, Debug)]
pub struct Parameter {
    /// Full name.
    pub name: String,
    /// Over earlier parameters.
    pub value: NodeId,
    /// Unit as written.
    pub unit: Option<String>,
    /// Where it is declared.
    pub span: Option<Span>,
}

/// An input from outside.
#[derive(Clone, Debug)]
pub struct Input {
    /// Full name.
    pub name: String,
    /// Unit as written.
    pub unit: Option<String>,
    /// Where it is declared.
    pub span: Option<Span>,
}

/// A continuous state.
#[derive(Clone, Debug)]
pub struct State {
    /// Full name.
    pub name: String,
    /// Unit as written.
    pub unit: Option<String>,
    /// Initial value over parameters; `None` when the experiment must give it.
    pub initial: Option<NodeId>,
    /// Its time derivative.
    pub rate: Row,
    /// Where it is declared.
    pub span: Option<Span>,
}

/// A right-hand side: the same everywhere, or chosen by the location of one automaton.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// The automaton whose location selects the row.
    pub owner: AutomatonIndex,
    /// One expression per location of `owner`.
    pub by_location: Vec<NodeId>,
    /// Where each stands.
    pub spans: Vec<Option<Span>>,
}

/// A quantity defined by other quantities at the same instant.
#[derive(Clone, Debug)]
pub struct Algebraic {
    /// Full name.
    pub name: String,
    /// Its value, smooth: read by rates and guards.
    pub value: Row,
    /// Its value with switches as written: read by outputs and resets.
    pub plain: Row,
}

/// An output.
#[derive(Clone, Debug)]
pub struct Output {
    /// Full name.
    pub name: String,
    /// Unit as written.
    pub unit: Option<String>,
    /// Its value.
    pub value: Row,
}

/// A hybrid automaton.
#[derive(Clone, Debug)]
pub struct Automaton {
    /// Name of the component; empty in a model of one nameless component.
    pub name: String,
    /// Its locations.
    pub locations: Vec<FlatLocation>,
    /// Where a run starts.
    pub initial: LocationIndex,
}

/// A location.
#[derive(Clone, Debug)]
pub struct FlatLocation {
    /// Name.
    pub name: String,
    /// Outgoing transitions, by priority, then in written order.
    pub transitions: Vec<TransitionIndex>,
}

/// When a transition is taken.
#[derive(Clone, Debug)]
pub enum FlatTrigger {
    /// While the condition holds.
    When(NodeId),
    /// When one of the events arrives and the condition holds.
    On {
        /// Any of them.
        events: Vec<EventIndex>,
        /// Condition, if any.
        guard: Option<NodeId>,
    },
}

impl FlatTrigger {
    /// The condition, if there is one.
    pub fn guard(&self) -> Option<NodeId> {
        match self {
            FlatTrigger::When(guard) => Some(*guard),
            FlatTrigger::On { guard, .. } => *guard,
        }
    }
}

/// A transition.
#[derive(Clone, Debug)]
pub struct FlatTransition {
    /// Name as written.
    pub name: String,
    /// The automaton.
    pub automaton: AutomatonIndex,
    /// Location left.
    pub source: LocationIndex,
    /// Location entered.
    pub destination: LocationIndex,
    /// When it is taken.
    pub trigger: FlatTrigger,
    /// New values of states.
    pub resets: Vec<FlatReset>,
    /// Labels emitted, with who receives each.
    pub emits: Vec<(String, Vec<EventIndex>)>,
    /// Smaller goes first.
    pub priority: i32,
    /// Where it stands.
    pub span: Option<Span>,
}

/// `state := value`, read before the micro-step.
#[derive(Clone, Debug)]
pub struct FlatReset {
    /// The state.
    pub state: StateIndex,
    /// The new value; switches inside it are plain.
    pub value: NodeId,
    /// Where it stands.
    pub span: Option<Span>,
}

/// An input event of one automaton.
#[derive(Clone, Debug)]
pub struct Event {
    /// `component.label`, or the label alone.
    pub name: String,
    /// Label.
    pub label: String,
    /// Who receives it.
    pub receiver: Receiver,
}

/// Who receives an event.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Receiver {
    /// The automaton.
    pub automaton: AutomatonIndex,
}

/// A scalar `left − right` whose first sign change is to be located.
#[derive(Clone, Debug)]
pub struct Watch {
    /// One side.
    pub left: NodeId,
    /// The other side.
    pub right: NodeId,
    /// What is watched: `left − right`.
    pub difference: NodeId,
    /// Whether the difference is affine in states, inputs and time: its crossings have a closed form.
    pub affine: bool,
}

/// What the sign of a watch says to a guard or a switch.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Truth {
    /// The watch.
    pub watch: WatchIndex,
    /// `left comparison right`.
    pub comparison: Comparison,
}

/// The integer n with n ≤ argument < n + 1 along the motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Stair {
    /// What is rounded down.
    pub argument: NodeId,
    /// Watches argument − n.
    pub lower: WatchIndex,
    /// Watches argument − (n + 1).
    pub upper: WatchIndex,
}

/// A [`System`] breaks one of its own rules: a mistake in Sophy, not in a model.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct VerifyError(pub String);

impl fmt::Display for VerifyError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "the flat system is inconsistent: {}", self.0)
    }
}

impl std::error::Error for VerifyError {}

impl Row {
    /// The expression in a location of the owner.
    pub fn at(&self, location: LocationIndex) -> NodeId {
        self.by_location[location.position()]
    }

    /// Whether the location does not matter.
    pub fn is_constant(&self) -> bool {
        self.by_location.windows(2).all(|pair| pair[0] == pair[1])
    }
}

impl System {
    /// What a leaf is called in text forms and messages.
    pub fn leaf_name(&self, leaf: Leaf) -> String {
        let named = |name: Option<&String>| name.cloned().unwrap_or_else(|| "?".to_owned());
        match leaf {
            Leaf::Variable(id) => format!("v{}", id.0),
            Leaf::Parameter(i) => named(self.parameters.get(i.position()).map(|p| &p.name)),
            Leaf::State(i) => named(self.states.get(i.position()).map(|s| &s.name)),
            Leaf::Input(i) => named(self.inputs.get(i.position()).map(|u| &u.name)),
            Leaf::Algebraic(i) => named(self.algebraics.get(i.position()).map(|z| &z.name)),
            Leaf::Time => "time".to_owned(),
            Leaf::Truth(i) => match self.truths.get(i.position()) {
                Some(truth) => {
                    let watch = &self.watches[truth.watch.position()];
                    let (left, right) = (self.text(watch.left), self.text(watch.right));
                    format!("({left} {} {right})", truth.comparison.symbol())
                }
                None => "?".to_owned(),
            },
            Leaf::Stair(i) => match self.stairs.get(i.position()) {
                Some(stair) => format!("floor({})", self.text(stair.argument)),
                None => "?".to_owned(),
            },
        }
    }

    /// An expression in the notation of the language.
    pub fn text(&self, node: NodeId) -> String {
        self.graph.display(node, &|leaf| self.leaf_name(leaf))
    }

    /// Every rate row depends on which states and inputs: the thesis's coupling matrix D (§3.2.2), rows in
    /// the order of states, `true` where a location exists in which the entry is not zero.
    pub fn coupling(&self) -> Vec<Vec<Leaf>> {
        self.states.iter().map(|state| self.row_sources(&state.rate)).collect()
    }

    /// States, inputs and time that a row reads, through algebraic variables and switches.
    pub fn row_sources(&self, row: &Row) -> Vec<Leaf> {
        let mut found = std::collections::BTreeSet::new();
        let mut visited = std::collections::BTreeSet::new();
        let mut pending: Vec<Leaf> =
            self.graph.dependencies(row.by_location.iter().copied()).into_iter().collect();
        while let Some(leaf) = pending.pop() {
            if !visited.insert(leaf) {
                continue;
            }
            match leaf {
                Leaf::State(_) | Leaf::Input(_) | Leaf::Time => {
                    found.insert(leaf);
                }
                Leaf::Algebraic(z) => {
                    let row = &self.algebraics[z.position()].value;
                    pending.extend(self.graph.dependencies(row.by_location.iter().copied()));
                }
                _ => {}
            }
        }
        found.into_iter().collect()
    }

    /// Checks the rules that later stages rely on.
    ///
    /// # Errors
    /// [`VerifyError`] says which rule is broken and where.
    pub fn verify(&self) -> Result<(), VerifyError> {
        let fail = |what: String| Err(VerifyError(what));
        let rows = self
            .states
            .iter()
            .map(|s| (&s.name, &s.rate))
            .chain(self.algebraics.iter().map(|z| (&z.name, &z.value)))
            .chain(self.outputs.iter().map(|y| (&y.name, &y.value)));
        for (name, row) in rows {
            let Some(owner) = self.automata.get(row.owner.position()) else {
                return fail(format!("row of `{name}` has no owner"));
            };
            if row.by_location.len() != owner.locations.len() || row.spans.len() != owner.locations.len() {
                return fail(format!("row of `{name}` does not have one expression per location"));
            }
        }
        let smooth = self
            .states
            .iter()
            .flat_map(|s| &s.rate.by_location)
            .chain(self.algebraics.iter().flat_map(|z| &z.value.by_location))
            .chain(self.watches.iter().map(|w| &w.difference));
        for id in self.graph.reachable(smooth.copied()) {
            match self.graph.node(id) {
                Node::Compare(..) if !self.is_parametric(id) => {
                    return fail(format!("`{}` was not lifted", self.text(id)));
                }
                Node::Unary(crate::Unary::Abs | crate::Unary::Sign | crate::Unary::Floor, _)
                | Node::Binary(crate::Binary::Min | crate::Binary::Max, ..)
                    if !self.is_parametric(id) =>
                {
                    return fail(format!("`{}` was not lifted", self.text(id)));
                }
                Node::Leaf(leaf) => self.verify_leaf(leaf)?,
                _ => {}
            }
        }
        for (index, transition) in self.transitions.iter().enumerate() {
            let Some(automaton) = self.automata.get(transition.automaton.position()) else {
                return fail(format!("transition {index} has no automaton"));
            };
            for end in [transition.source, transition.destination] {
                if end.position() >= automaton.locations.len() {
                    return fail(format!("transition `{}` has no such location", transition.name));
                }
            }
        }
        Ok(())
    }

    fn verify_leaf(&self, leaf: Leaf) -> Result<(), VerifyError> {
        let inside = match leaf {
            Leaf::Variable(_) => false,
            Leaf::Parameter(i) => i.position() < self.parameters.len(),
            Leaf::State(i) => i.position() < self.states.len(),
            Leaf::Input(i) => i.position() < self.inputs.len(),
            Leaf::Algebraic(i) => i.position() < self.algebraics.len(),
            Leaf::Time => true,
            Leaf::Truth(i) => i.position() < self.truths.len(),
            Leaf::Stair(i) => i.position() < self.stairs.len(),
        };
        if inside { Ok(()) } else { Err(VerifyError(format!("{leaf:?} does not exist"))) }
    }

    /// Whether an expression depends on parameters and numbers only.
    pub fn is_parametric(&self, node: NodeId) -> bool {
        self.graph.dependencies([node]).iter().all(|leaf| matches!(leaf, Leaf::Parameter(_)))
    }

    /// The index of a name, for experiments.
    pub fn state_named(&self, name: &str) -> Option<StateIndex> {
        self.states.iter().position(|s| s.name == name).map(StateIndex::new)
    }

    /// The index of a name, for experiments.
    pub fn parameter_named(&self, name: &str) -> Option<ParameterIndex> {
        self.parameters.iter().position(|p| p.name == name).map(ParameterIndex::new)
    }

    /// The index of a name, for experiments.
    pub fn input_named(&self, name: &str) -> Option<InputIndex> {
        self.inputs.iter().position(|u| u.name == name).map(InputIndex::new)
    }
}

/// The text form: everything with names, in the order of the tables (`--emit system`).
impl fmt::Display for System {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let unit = |unit: &Option<String>| unit.as_ref().map(|u| format!(" \"{u}\"")).unwrap_or_default();
        writeln!(f, "system {}", self.name)?;
        for p in &self.parameters {
            writeln!(f, "  parameter {} = {}{}", p.name, self.text(p.value), unit(&p.unit))?;
        }
        for u in &self.inputs {
            writeln!(f, "  input {}{}", u.name, unit(&u.unit))?;
        }
        for (index, s) in self.states.iter().enumerate() {
            let initial = s.initial.map(|i| format!(" := {}", self.text(i))).unwrap_or_default();
            writeln!(f, "  state x{index} {}{initial}{}", s.name, unit(&s.unit))?;
            self.write_row(f, &format!("der({})", s.name), &s.rate)?;
        }
        for z in &self.algebraics {
            writeln!(f, "  algebraic {}", z.name)?;
            self.write_row(f, &z.name, &z.value)?;
        }
        for y in &self.outputs {
            writeln!(f, "  output {}{}", y.name, unit(&y.unit))?;
            self.write_row(f, &y.name, &y.value)?;
        }
        for (index, w) in self.watches.iter().enumerate() {
            let kind = if w.affine { "affine" } else { "enclosed" };
            writeln!(f, "  watch w{index} {} ({kind})", self.text(w.difference))?;
        }
        for (index, a) in self.automata.iter().enumerate() {
            writeln!(f, "  automaton a{index} {}", a.name)?;
            for (position, location) in a.locations.iter().enumerate() {
                let initial = if a.initial.position() == position { " (initial)" } else { "" };
                writeln!(f, "    location {}{initial}", location.name)?;
                for &t in &location.transitions {
                    let t = &self.transitions[t.position()];
                    let to = &a.locations[t.destination.position()].name;
                    writeln!(f, "      {} {} -> {to}", t.name, self.trigger_text(&t.trigger))?;
                    for reset in &t.resets {
                        let state = &self.states[reset.state.position()].name;
                        writeln!(f, "        {state} := {}", self.text(reset.value))?;
                    }
                    for (label, _) in &t.emits {
                        writeln!(f, "        emit {label}")?;
                    }
                }
            }
        }
        Ok(())
    }
}

impl System {
    fn write_row(&self, f: &mut fmt::Formatter<'_>, left: &str, row: &Row) -> fmt::Result {
        if row.is_constant() {
            return match row.by_location.first() {
                Some(&node) => writeln!(f, "    {left} = {}", self.text(node)),
                None => Ok(()),
            };
        }
        let owner = &self.automata[row.owner.position()];
        for (location, &node) in owner.locations.iter().zip(&row.by_location) {
            writeln!(f, "    {}: {left} = {}", location.name, self.text(node))?;
        }
        Ok(())
    }

    /// `when GUARD` or `on EVENT when GUARD`.
    pub fn trigger_text(&self, trigger: &FlatTrigger) -> String {
        match trigger {
            FlatTrigger::When(guard) => format!("when {}", self.text(*guard)),
            FlatTrigger::On { events, guard } => {
                let names: Vec<_> = events.iter().map(|e| self.events[e.position()].name.clone()).collect();
                let guard = guard.map(|g| format!(" when {}", self.text(g))).unwrap_or_default();
                format!("on {}{guard}", names.join(", "))
            }
        }
    }
}
