//! What there is to know of a class, found once for all its copies.

use sophy_diagnostics::Span;
use sophy_ir::{Body, Class, Graph, HybridAutomaton, Leaf, NodeId, Special, VariableId, VariableKind};

/// What a variable of a class becomes in a system.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Becomes {
    /// A parameter; the node is its value unless a member says something else.
    Parameter(NodeId),
    /// A state, continuous or discrete, by its place among the states of the class.
    State(u32),
    /// What feeds it, or an input of the system.
    Input,
    /// An output of a composite: what feeds it.
    Port,
    /// Its definition, by its place among the values of the class.
    Value(u32),
    /// Nothing: it is written out where it is read.
    Nothing,
}

/// An expression and where it stands.
pub(super) type Definition = Option<(NodeId, Option<Span>)>;

/// Where something of an instance stands among all that instances have: variables first, then, for a class of
/// several locations, its values location by location.
pub(super) type Slot = u32;

#[derive(Debug, Default)]
pub(super) struct Facts {
    /// Per variable.
    pub(super) becomes: Vec<Becomes>,
    pub(super) states: Vec<VariableId>,
    pub(super) values: Vec<VariableId>,
    pub(super) locations: usize,
    /// Per location, per value: `y = …`.
    pub(super) definitions: Vec<Definition>,
    /// Per location, per value: inputs and values that the definition reads.
    pub(super) reads: Vec<Vec<VariableId>>,
    /// Per location, per state: `der(x) = …`.
    pub(super) rates: Vec<Definition>,
    /// Inputs that anything else reads.
    pub(super) inputs_read: Vec<VariableId>,
    /// Values that are read whatever the location: by event sections and at the start.
    pub(super) values_read: Vec<VariableId>,
    /// Per member of a composite: its first copy among all copies of all members; the number of all at the end.
    pub(super) first_copies: Vec<u32>,
}

impl Facts {
    pub(super) fn new(class: &Class) -> Self {
        let mut facts = Facts::default();
        match &class.body {
            Body::Automaton(automaton) => {
                facts.locations = automaton.locations.len();
                let held = |id| is_assigned(automaton, id) && !is_defined(automaton, id);
                facts.variables(class, |id, kind| match kind {
                    VariableKind::State(_) | VariableKind::Mode(_) => Kind::State,
                    VariableKind::Output if held(id) => Kind::State,
                    _ => Kind::Value,
                });
                facts.equations(automaton);
                Reader::new(class, &mut facts).automaton(automaton);
            }
            Body::Discrete(discrete) => {
                facts.locations = 1;
                facts.variables(class, |id, kind| match kind {
                    VariableKind::Local if !class.variable(id).viewed => Kind::Nothing,
                    _ => Kind::State,
                });
                facts.rates = vec![None; facts.states.len()];
                let initial = discrete.initial.iter().map(|a| a.right).collect();
                Reader::new(class, &mut facts).outside(Vec::new(), initial, Vec::new());
            }
            Body::Composite(composite) => {
                facts.variables(class, |_, kind| match kind {
                    VariableKind::Output => Kind::Port,
                    _ => Kind::Nothing,
                });
                let mut first = 0;
                for member in &composite.members {
                    facts.first_copies.push(first);
                    first += member.copies();
                }
                facts.first_copies.push(first);
            }
        }
        facts
    }

    fn variables(&mut self, class: &Class, kind: impl Fn(VariableId, VariableKind) -> Kind) {
        for (position, variable) in class.variables.iter().enumerate() {
            let id = VariableId(position as u32);
            self.becomes.push(match variable.kind {
                VariableKind::Parameter { value, .. } => Becomes::Parameter(value),
                VariableKind::Input { .. } => Becomes::Input,
                other => match kind(id, other) {
                    Kind::State => {
                        self.states.push(id);
                        Becomes::State(self.states.len() as u32 - 1)
                    }
                    Kind::Value => {
                        self.values.push(id);
                        Becomes::Value(self.values.len() as u32 - 1)
                    }
                    Kind::Port => Becomes::Port,
                    Kind::Nothing => Becomes::Nothing,
                },
            });
        }
    }

    fn equations(&mut self, automaton: &HybridAutomaton) {
        let (states, values) = (self.states.len(), self.values.len());
        self.rates = vec![None; states * self.locations];
        self.definitions = vec![None; values * self.locations];
        for (q, location) in automaton.locations.iter().enumerate() {
            for equation in &location.dynamics {
                if let Becomes::State(k) = self.of(equation.variable) {
                    self.rates[q * states + k as usize] = Some((equation.right, equation.span));
                }
            }
            for equation in &location.values {
                if let Becomes::Value(k) = self.of(equation.variable) {
                    self.definitions[q * values + k as usize] = Some((equation.right, equation.span));
                }
            }
        }
    }

    /// What a variable becomes.
    pub(super) fn of(&self, id: VariableId) -> Becomes {
        self.becomes.get(id.0 as usize).copied().unwrap_or(Becomes::Nothing)
    }

    /// Number of slots of an instance.
    pub(super) fn slots(&self) -> u32 {
        let inside = if self.locations > 1 { self.values.len() * self.locations } else { 0 };
        (self.becomes.len() + inside) as u32
    }

    /// The slot of a value as its own automaton sees it in a location.
    pub(super) fn inside(&self, value: u32, location: u32) -> Slot {
        if self.locations > 1 {
            self.becomes.len() as u32 + location * self.values.len() as u32 + value
        } else {
            self.values[value as usize].0
        }
    }

    /// The value and location of a slot that is a definition; `None` for the slot of a variable with several.
    pub(super) fn definition_of(&self, slot: Slot) -> Option<usize> {
        match slot.checked_sub(self.becomes.len() as u32) {
            Some(inside) => Some(inside as usize),
            None => match self.of(VariableId(slot)) {
                Becomes::Value(value) if self.locations <= 1 => Some(value as usize),
                _ => None,
            },
        }
    }
}

enum Kind {
    State,
    Value,
    Port,
    Nothing,
}

fn is_defined(automaton: &HybridAutomaton, id: VariableId) -> bool {
    automaton.locations.iter().any(|l| l.values.iter().any(|equation| equation.variable == id))
}

fn is_assigned(automaton: &HybridAutomaton, id: VariableId) -> bool {
    let transitions = automaton.locations.iter().flat_map(|l| &l.transitions).map(|t| &t.actions);
    let sections = automaton.events.iter().flat_map(|e| e.rising.iter().chain(&e.falling));
    let actions = transitions.chain(sections).chain(automaton.rules.iter().map(|rule| &rule.actions));
    let assignments = actions.flat_map(|actions| &actions.assignments).chain(&automaton.initial);
    assignments.into_iter().any(|assignment| assignment.variable == id)
}

/// Calls `visit` on what a node of a class reads at the same instant: its operands, also those of a special.
pub(super) fn operands(class: &Class, graph: &Graph, id: NodeId, mut visit: impl FnMut(NodeId)) {
    if let sophy_ir::Node::Leaf(Leaf::Special(special)) = graph.node(id) {
        if let Some(
            Special::Smooth(e)
            | Special::Table { at: e, .. }
            | Special::Rises(e)
            | Special::Falls(e)
            | Special::Changes(e)
            | Special::Chance(e),
        ) = class.specials.get(special as usize)
        {
            visit(*e);
        }
        return;
    }
    graph.operands(id, visit);
}

/// Finds what expressions of a class read.
struct Reader<'a> {
    class: &'a Class,
    facts: &'a mut Facts,
    /// Per node: the last search that came by.
    seen: Vec<u32>,
    search: u32,
    pending: Vec<NodeId>,
}

impl<'a> Reader<'a> {
    fn new(class: &'a Class, facts: &'a mut Facts) -> Self {
        Reader { seen: vec![0; class.graph.len()], search: 0, pending: Vec::new(), class, facts }
    }

    fn automaton(&mut self, automaton: &HybridAutomaton) {
        let definitions = self.facts.definitions.clone();
        for definition in &definitions {
            let reads = self.variables(definition.iter().map(|(right, _)| *right));
            self.facts.reads.push(reads);
        }
        let transitions = || automaton.locations.iter().flat_map(|l| &l.transitions);
        let rates = self.facts.rates.iter().flatten().map(|(right, _)| *right);
        let mut inside: Vec<NodeId> = rates.collect();
        for transition in transitions() {
            inside.extend(trigger_nodes(&transition.trigger));
            inside.extend(action_nodes(&transition.actions));
        }
        let mut outside: Vec<NodeId> = automaton.initial.iter().map(|a| a.right).collect();
        for section in &automaton.events {
            outside.extend(section.rising.iter().chain(&section.falling).flat_map(action_nodes));
        }
        let flags = automaton.events.iter().map(|section| section.flag).collect();
        self.outside(inside, outside, flags);
    }

    /// `inside`: what is read in a location; `outside`: whatever the location; `flags` are read there, too.
    fn outside(&mut self, inside: Vec<NodeId>, mut outside: Vec<NodeId>, flags: Vec<VariableId>) {
        for &state in &self.facts.states {
            if let VariableKind::State(Some(node)) | VariableKind::Mode(Some(node)) =
                self.class.variable(state).kind
            {
                outside.push(node);
            }
        }
        let inside = self.variables(inside);
        let outside = self.variables(outside);
        let (mut inputs, mut values) = (Vec::new(), Vec::new());
        for id in inside {
            if self.facts.of(id) == Becomes::Input {
                inputs.push(id);
            }
        }
        for id in outside.into_iter().chain(flags) {
            match self.facts.of(id) {
                Becomes::Input if !inputs.contains(&id) => inputs.push(id),
                Becomes::Value(_) if !values.contains(&id) => values.push(id),
                _ => {}
            }
        }
        self.facts.inputs_read = inputs;
        self.facts.values_read = values;
    }

    /// Inputs and values below `roots`, in the order in which they are met.
    fn variables(&mut self, roots: impl IntoIterator<Item = NodeId>) -> Vec<VariableId> {
        self.search += 1;
        let mut found = Vec::new();
        for root in roots {
            self.pending.push(root);
            while let Some(id) = self.pending.pop() {
                if self.seen[id.position()] == self.search {
                    continue;
                }
                self.seen[id.position()] = self.search;
                if let sophy_ir::Node::Leaf(Leaf::Variable(variable)) = self.class.graph.node(id) {
                    if matches!(self.facts.of(variable), Becomes::Input | Becomes::Value(_)) {
                        found.push(variable);
                    }
                    continue;
                }
                let pending = &mut self.pending;
                operands(self.class, &self.class.graph, id, |operand| pending.push(operand));
            }
        }
        found
    }
}

fn trigger_nodes(trigger: &sophy_ir::Trigger) -> Vec<NodeId> {
    use sophy_ir::Trigger;
    match trigger {
        Trigger::When(guard) => vec![*guard],
        Trigger::On { guard, .. } | Trigger::Invariant { guard } | Trigger::Synchronised { guard, .. } => {
            guard.iter().copied().collect()
        }
        Trigger::Rate { rate, guard } => guard.iter().copied().chain([*rate]).collect(),
    }
}

fn action_nodes(actions: &sophy_ir::Actions) -> impl Iterator<Item = NodeId> {
    let assigned = actions.assignments.iter().map(|assignment| assignment.right);
    assigned.chain(actions.emissions.iter().filter_map(|emission| emission.when))
}
