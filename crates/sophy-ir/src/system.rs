use crate::arithmetic::Comparison;
use crate::class::{Allowed, ClassIndex, VariableId};
use crate::graph::{Graph, Leaf, Node, NodeId};
use crate::model::Quantity;
use crate::names::{ComponentIndex, Components};
use crate::repeated::{Repeated, Shared};
use sophy_diagnostics::Span;
use sophy_field::{
    AutomatonIndex, ColumnIndex, EventIndex, InputIndex, LocationIndex, ParameterIndex, StairIndex,
    StateIndex, TransitionIndex, WatchIndex,
};
use std::fmt;
use std::sync::Arc;

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
    /// What it consists of, for names.
    pub components: Components,
    /// All expressions.
    pub graph: Graph,
    /// The expressions of all rows, those of one in a row.
    pub rows: Vec<NodeId>,
    /// Where they stand; copies share what was written.
    pub spans: Vec<Option<Span>>,
    /// Constants and knobs.
    pub parameters: Vec<Parameter>,
    /// Inputs from outside.
    pub inputs: Vec<Input>,
    /// Continuous states, the union over locations.
    pub states: Repeated<State>,
    /// Outputs of one automaton read by another, in an order in which they can be evaluated.
    pub algebraics: Repeated<Algebraic>,
    /// Outputs.
    pub outputs: Repeated<Output>,
    /// Automata, in the order of components.
    pub automata: Repeated<Automaton>,
    /// Transitions, in written order.
    pub transitions: Repeated<FlatTransition>,
    /// Input events.
    pub events: Repeated<Event>,
    /// Scalars whose sign changes are located; one that reads a truth or stair comes after its watches.
    pub watches: Repeated<Watch>,
    /// Decided comparisons.
    pub truths: Repeated<Truth>,
    /// Staircases.
    pub stairs: Vec<Stair>,
    /// What is watched though no rate or guard reads it: rows that read the stairs of tables which outputs read.
    pub guarded: Vec<Row>,
    /// Declared ranges, those of parameters first; those of states are in the order of states.
    pub ranges: Vec<Range>,
    /// Assignments at the start, after declared values, in an order in which each follows what it reads.
    pub initial: Vec<FlatReset>,
    /// Input events of the whole that members receive under other names.
    pub event_inputs: Vec<EventInput>,
    /// Texts that strings can be, by number.
    pub texts: Vec<String>,
    /// What was checked but cannot be run yet; a run of a system that awaits something is refused.
    pub awaits: Vec<Awaited>,
}

/// The numbers that a quantity can have.
#[derive(Clone, Debug, PartialEq)]
pub struct Range {
    /// The quantity.
    pub of: Ranged,
    /// Its numbers.
    pub allowed: Allowed,
    /// Of what moves between events: the stairs that watch it, one for all locations or one for each. A run puts the
    /// bounds into their columns, a margin further out, as quantised trajectories leave them by about a quantum.
    pub stairs: Vec<StairIndex>,
    /// Where the quantity is declared.
    pub span: Option<Span>,
}

/// What has a range.
#[derive(Clone, Debug, PartialEq)]
pub enum Ranged {
    /// A parameter.
    Parameter(ParameterIndex),
    /// A state.
    State(StateIndex),
    /// An input, an output or a local.
    Value {
        /// Its component.
        component: ComponentIndex,
        /// What was declared.
        declared: Shared<Declared>,
        /// Its value, switches as written.
        value: Row,
    },
}

/// A part of a model that this version checks but cannot run.
#[derive(Clone, Debug, PartialEq)]
pub struct Awaited {
    /// What kind of thing it is.
    pub what: Feature,
    /// The component, without the numbers of copies; empty for a model of one nameless component.
    pub component: String,
    /// As it is written: an expression, a transition, a rule …
    pub text: String,
    /// Where it stands.
    pub span: Option<Span>,
}

/// What this version checks but cannot run.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Feature {
    /// A component that executes at instants it announces.
    DiscreteTime,
    /// A component whose reactions are delayed as a whole.
    LogicDelay,
    /// A rule.
    Rule,
    /// A transition at random.
    Rate,
    /// A transition taken together with others.
    Synchronised,
    /// A transition that answers an invariant, or the invariant itself.
    Invariant,
    /// An action that keeps the motion on a surface.
    Hold,
    /// An equation that is solved for what is not defined otherwise.
    Constraint,
    /// `delayed(…)`.
    Delayed,
    /// `noise(…)`.
    Noise,
    /// `chance(…)`.
    Chance,
    /// An event, `rises(…)`, `falls(…)` or `changes(…)` in an expression.
    Edge,
    /// `never`.
    Never,
}

impl Feature {
    /// What it is, as the predicate of a sentence.
    pub fn text(self) -> &'static str {
        match self {
            Feature::DiscreteTime => "a discrete-time component",
            Feature::LogicDelay => "a logic component with a delay",
            Feature::Rule => "a rule",
            Feature::Rate => "a transition at random",
            Feature::Synchronised => "a synchronised transition",
            Feature::Invariant => "an invariant",
            Feature::Hold => "a motion held on a surface",
            Feature::Constraint => "a constraint",
            Feature::Delayed => "a transport delay",
            Feature::Noise => "noise",
            Feature::Chance => "a random choice",
            Feature::Edge => "an edge in an expression",
            Feature::Never => "an instant that does not come",
        }
    }
}

/// One sentence: what of which component it is.
impl fmt::Display for Awaited {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (what, component, text) = (self.what.text(), &self.component, &self.text);
        match (self.what, component.is_empty()) {
            (Feature::DiscreteTime, false) => write!(f, "`{component}` is {what}"),
            (_, false) => write!(f, "`{text}` of `{component}` is {what}"),
            (_, true) => write!(f, "`{text}` is {what}"),
        }
    }
}

/// An input event of the whole, passed on to members.
#[derive(Clone, Debug)]
pub struct EventInput {
    /// The label.
    pub name: String,
    /// Who receives it.
    pub receivers: Vec<EventIndex>,
}

/// Where something was declared, for what else is said there.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Origin {
    /// The class.
    pub class: ClassIndex,
    /// The variable there.
    pub variable: VariableId,
}

/// What was declared of a quantity, once for all its copies.
#[derive(Clone, Debug, PartialEq)]
pub struct Declared {
    /// Name within its component.
    pub name: String,
    /// Unit as written.
    pub unit: Option<String>,
    /// Kind of its values.
    pub quantity: Quantity,
    /// Texts it can have, where they were declared; empty if any.
    pub choices: Vec<usize>,
    /// Its declaration.
    pub origin: Origin,
    /// Where it is declared.
    pub span: Option<Span>,
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
    /// Whether it is part of the interface.
    pub knob: bool,
    /// Whether the structure was built from its value, which therefore is fixed.
    pub structural: bool,
    /// Its declaration.
    pub origin: Origin,
    /// Where it is declared.
    pub span: Option<Span>,
}

/// An input from outside.
#[derive(Clone, Debug)]
pub struct Input {
    /// Its component.
    pub component: ComponentIndex,
    /// What was declared.
    pub declared: Shared<Declared>,
}

/// A state: continuous, or one that changes at instants only (its rate is 0 everywhere).
#[derive(Clone, Debug, PartialEq)]
pub struct State {
    /// Its component.
    pub component: ComponentIndex,
    /// What was declared.
    pub declared: Shared<Declared>,
    /// Whether it changes at instants only: a mode, or what a discrete-time component keeps.
    pub discrete: bool,
    /// Initial value over parameters; `None` when the experiment must give it.
    pub initial: Option<NodeId>,
    /// For a mode that nothing initialises: the flag whose sign (−1 or +1) it starts with.
    pub sign_of: Option<NodeId>,
    /// Its time derivative.
    pub rate: Row,
}

/// A right-hand side: the same everywhere, or chosen by the location of one automaton. Its expressions, one per location
/// of `owner`, are [`System::nodes`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Row {
    /// The automaton whose location selects the row.
    pub owner: AutomatonIndex,
    /// In [`System::rows`]: its first expression.
    pub first: u32,
    /// How many there are.
    pub locations: u32,
    /// In [`System::spans`]: where the first expression stands; [`Row::NOWHERE`] if it was not written.
    pub spans: u32,
}

/// A quantity defined by other quantities at the same instant.
#[derive(Clone, Debug, PartialEq)]
pub struct Algebraic {
    /// Its component.
    pub component: ComponentIndex,
    /// What was declared.
    pub declared: Shared<Declared>,
    /// Its value, smooth: read by rates and guards.
    pub value: Row,
    /// Its value with switches as written: read by outputs and resets.
    pub plain: Row,
}

/// An output.
#[derive(Clone, Debug, PartialEq)]
pub struct Output {
    /// Its component.
    pub component: ComponentIndex,
    /// What was declared.
    pub declared: Shared<Declared>,
    /// Whether it is only to be looked at: no output of the interface.
    pub view: bool,
    /// Its value.
    pub value: Row,
}

/// What an automaton stands for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Role {
    /// A component, with the locations that were written.
    Component,
    /// An event section: two locations, the sides of its flag. It is set to the side of the flag at the start,
    /// and after a reset of its own that put the flag back; none of this is an event.
    Flag,
    /// Nothing of its own: it owns the rows of what has no locations.
    Owner,
}

/// A hybrid automaton.
#[derive(Clone, Debug, PartialEq)]
pub struct Automaton {
    /// Its component.
    pub component: ComponentIndex,
    /// What it has in common with its copies.
    pub kind: Shared<AutomatonKind>,
    /// Its first transition; its others follow.
    pub first: TransitionIndex,
}

/// An automaton, whatever the copy.
#[derive(Clone, Debug)]
pub struct AutomatonKind {
    /// What it stands for; only components show their location.
    pub role: Role,
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
    /// Outgoing transitions, by priority, then in written order, counted from the first of the automaton.
    pub transitions: Vec<u32>,
}

impl Automaton {
    /// The transitions out of a location, by priority, then in written order.
    pub fn outgoing(&self, location: LocationIndex) -> impl Iterator<Item = TransitionIndex> {
        let location = self.kind.locations.get(location.position());
        let transitions = location.into_iter().flat_map(|location| &location.transitions);
        transitions.map(|&transition| TransitionIndex(self.first.0 + transition))
    }
}

/// When a transition is taken.
#[derive(Clone, Debug, PartialEq)]
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
#[derive(Clone, Debug, PartialEq)]
pub struct FlatTransition {
    /// Name as written.
    pub name: Arc<str>,
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
    /// What is emitted, in order.
    pub emits: Vec<FlatEmission>,
    /// Smaller goes first.
    pub priority: i32,
    /// Whether it only keeps the side of a flag: no event, no micro-step.
    pub silent: bool,
    /// Where it stands.
    pub span: Option<Span>,
}

/// `emit label`.
#[derive(Clone, Debug, PartialEq)]
pub struct FlatEmission {
    /// The label.
    pub label: Arc<str>,
    /// Who receives it.
    pub receivers: Vec<EventIndex>,
    /// Only if this holds before the micro-step; switches inside it are plain.
    pub when: Option<NodeId>,
}

/// `state := value`, read before the micro-step.
#[derive(Clone, Debug, PartialEq)]
pub struct FlatReset {
    /// The state.
    pub state: StateIndex,
    /// The new value; switches inside it are plain.
    pub value: NodeId,
    /// Where it stands.
    pub span: Option<Span>,
}

/// An input event of one automaton.
#[derive(Clone, Debug, PartialEq)]
pub struct Event {
    /// Its component.
    pub component: ComponentIndex,
    /// Label.
    pub label: Arc<str>,
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
#[derive(Clone, Debug, PartialEq)]
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

/// The integer n with n ≤ argument < n + 1 along the motion; for a table the n with knot n ≤ argument < knot n + 1,
/// −1 before the first knot.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Stair {
    /// What is rounded down.
    pub argument: NodeId,
    /// The knots of a table; `None` for whole numbers.
    pub knots: Option<ColumnIndex>,
    /// Watches argument − n, or − knot n.
    pub lower: WatchIndex,
    /// Watches argument − (n + 1), or − knot n + 1.
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
    /// Among [`System::spans`].
    pub const NOWHERE: u32 = u32::MAX;

    /// Its expressions, in [`System::rows`].
    pub fn range(self) -> std::ops::Range<usize> {
        self.first as usize..(self.first + self.locations) as usize
    }
}

impl System {
    /// A row of these expressions.
    pub fn row(&mut self, owner: AutomatonIndex, nodes: &[NodeId], spans: u32) -> Row {
        let (first, locations) = (self.rows.len() as u32, nodes.len() as u32);
        self.rows.extend_from_slice(nodes);
        Row { owner, first, locations, spans }
    }

    /// The expressions of a row, one per location of its owner.
    pub fn nodes(&self, row: Row) -> &[NodeId] {
        self.rows.get(row.range()).unwrap_or_default()
    }

    /// The expression of a row in a location of its owner.
    pub fn at(&self, row: Row, location: LocationIndex) -> NodeId {
        self.nodes(row)[location.position()]
    }

    /// Where that stands.
    pub fn span(&self, row: Row, location: LocationIndex) -> Option<Span> {
        *self.spans.get(row.spans as usize + location.position())?
    }

    /// Whether the location does not matter to a row.
    pub fn is_constant(&self, row: Row) -> bool {
        self.nodes(row).windows(2).all(|pair| pair[0] == pair[1])
    }

    /// Gives back what only building takes.
    pub fn shrink_to_fit(&mut self) {
        self.graph.shrink_to_fit();
        self.rows.shrink_to_fit();
        self.spans.shrink_to_fit();
        self.states.shrink_to_fit();
        self.algebraics.shrink_to_fit();
        self.outputs.shrink_to_fit();
        self.automata.shrink_to_fit();
        self.transitions.shrink_to_fit();
        self.events.shrink_to_fit();
        self.watches.shrink_to_fit();
        self.truths.shrink_to_fit();
        self.stairs.shrink_to_fit();
        self.guarded.shrink_to_fit();
        self.ranges.shrink_to_fit();
        self.initial.shrink_to_fit();
    }

    /// What a leaf is called in text forms and messages.
    pub fn leaf_name(&self, leaf: Leaf) -> String {
        let named = |name: Option<String>| name.unwrap_or_else(|| "?".to_owned());
        match leaf {
            Leaf::Variable(id) => format!("v{}", id.0),
            Leaf::Special(i) => named(self.awaits.get(i as usize).map(|awaited| awaited.text.clone())),
            Leaf::Parameter(i) => named(self.parameters.get(i.position()).map(|p| p.name.clone())),
            Leaf::State(i) => named(self.states.get(i.position()).map(|s| s.name(self))),
            Leaf::Input(i) => named(self.inputs.get(i.position()).map(|u| u.name(self))),
            Leaf::Algebraic(i) => named(self.algebraics.get(i.position()).map(|z| z.name(self))),
            Leaf::Time => "time".to_owned(),
            Leaf::Truth(i) => match self.truths.get(i.position()) {
                Some(truth) => {
                    let watch = self.watches.at(truth.watch.position());
                    let (left, right) = (self.text(watch.left), self.text(watch.right));
                    format!("({left} {} {right})", truth.comparison.symbol())
                }
                None => "?".to_owned(),
            },
            Leaf::Stair(i) => match self.stairs.get(i.position()) {
                Some(Stair { argument, knots: Some(knots), .. }) => {
                    format!("locate({:?}, {})", self.graph.column_name(*knots), self.text(*argument))
                }
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
        self.states.iter().map(|state| self.row_sources(state.rate)).collect()
    }

    /// States, inputs and time that a row reads, through algebraic variables and switches.
    pub fn row_sources(&self, row: Row) -> Vec<Leaf> {
        let mut found = std::collections::BTreeSet::new();
        let mut visited = std::collections::BTreeSet::new();
        let mut pending: Vec<Leaf> =
            self.graph.dependencies(self.nodes(row).iter().copied()).into_iter().collect();
        while let Some(leaf) = pending.pop() {
            if !visited.insert(leaf) {
                continue;
            }
            match leaf {
                Leaf::State(_) | Leaf::Input(_) | Leaf::Time => {
                    found.insert(leaf);
                }
                Leaf::Algebraic(z) => {
                    let row = self.algebraics.at(z.position()).value;
                    pending.extend(self.graph.dependencies(self.nodes(row).iter().copied()));
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
            .map(|s| (Some(s.declared), s.rate))
            .chain(self.algebraics.iter().map(|z| (Some(z.declared), z.value)))
            .chain(self.outputs.iter().map(|y| (Some(y.declared), y.value)))
            .chain(self.guarded.iter().map(|row| (None, *row)));
        for (declared, row) in rows {
            let name = declared.as_ref().map_or(&self.name, |declared| &declared.name);
            let Some(owner) = self.automata.get(row.owner.position()) else {
                return fail(format!("row of `{name}` has no owner"));
            };
            let locations = owner.kind.locations.len();
            if row.locations as usize != locations || self.nodes(row).len() != locations {
                return fail(format!("row of `{name}` does not have one expression per location"));
            }
        }
        let smooth = self
            .states
            .iter()
            .flat_map(|s| self.nodes(s.rate))
            .chain(self.algebraics.iter().flat_map(|z| self.nodes(z.value)))
            .chain(self.guarded.iter().flat_map(|row| self.nodes(*row)))
            .copied()
            .chain(self.watches.iter().map(|w| w.difference));
        for id in self.graph.reachable_switches(smooth) {
            match self.graph.node(id) {
                Node::Compare(..) if !self.is_parametric(id) => {
                    return fail(format!("`{}` was not lifted", self.text(id)));
                }
                Node::Unary(crate::Unary::Abs | crate::Unary::Sign | crate::Unary::Floor, _)
                | Node::Binary(crate::Binary::Min | crate::Binary::Max, ..)
                | Node::Locate(..)
                    if !self.is_parametric(id) =>
                {
                    return fail(format!("`{}` was not lifted", self.text(id)));
                }
                Node::Lookup(column, _) if self.graph.numbers(column).is_empty() => {
                    return fail(format!("`{}` has no numbers", self.text(id)));
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
                if end.position() >= automaton.kind.locations.len() {
                    return fail(format!("transition `{}` has no such location", transition.name));
                }
            }
            if transition.silent && !(transition.resets.is_empty() && transition.emits.is_empty()) {
                return fail(format!("transition `{}` is silent and does something", transition.name));
            }
            let receivers = transition.emits.iter().flat_map(|emission| &emission.receivers);
            if let Some(event) = receivers.into_iter().find(|e| e.position() >= self.events.len()) {
                return fail(format!("transition `{}` emits {event}, which does not exist", transition.name));
            }
        }
        let resets = self.transitions.iter().flat_map(|t| t.resets).chain(self.initial.iter().cloned());
        if let Some(reset) = resets.into_iter().find(|r| r.state.position() >= self.states.len()) {
            return fail(format!("{} is assigned and does not exist", reset.state));
        }
        for automaton in self.automata.iter().filter(|automaton| automaton.kind.role == Role::Flag) {
            let locations = &automaton.kind.locations;
            if locations.len() != 2 || locations.iter().any(|l| l.transitions.len() != 1) {
                return fail(format!("a flag of `{}` does not have two sides", automaton.name(self)));
            }
        }
        for state in self.states.iter().filter(|state| state.discrete) {
            let rests = |&node: &NodeId| self.graph.as_number(node) == Some(0.0);
            if !self.nodes(state.rate).iter().all(rests) {
                return fail(format!("`{}` changes at instants only and has a rate", state.name(self)));
            }
        }
        Ok(())
    }

    fn verify_leaf(&self, leaf: Leaf) -> Result<(), VerifyError> {
        let inside = match leaf {
            Leaf::Variable(_) => false,
            Leaf::Special(i) => (i as usize) < self.awaits.len(),
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
        self.states.iter().position(|s| s.name(self) == name).map(StateIndex::new)
    }

    /// The index of a name, for experiments.
    pub fn parameter_named(&self, name: &str) -> Option<ParameterIndex> {
        self.parameters.iter().position(|p| p.name == name).map(ParameterIndex::new)
    }

    /// The index of a name, for experiments.
    pub fn input_named(&self, name: &str) -> Option<InputIndex> {
        self.inputs.iter().position(|u| u.name(self) == name).map(InputIndex::new)
    }
}
