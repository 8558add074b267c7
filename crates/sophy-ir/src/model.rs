use crate::graph::{Graph, NodeId};
use sophy_diagnostics::Span;

/// A variable of a [`Model`], by its place in [`Model::variables`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct VariableId(pub u32);

/// A component of a [`Model`], by its place in [`Model::components`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct ComponentIndex(pub u32);

/// What was written, names resolved and checked: hybrid automata side by side and how they are connected.
///
/// A model that exists is correct: it can be flattened and run once its inputs are given. Each component is
/// the tuple of thesis definitions 8.1–8.5.
#[derive(Clone, Debug, Default)]
pub struct Model {
    /// Name of the whole.
    pub name: String,
    /// What it is, in the author's words.
    pub documentation: String,
    /// All expressions; their leaves are [`crate::Leaf::Variable`] and [`crate::Leaf::Time`].
    pub graph: Graph,
    /// All variables, component by component, in written order.
    pub variables: Vec<Variable>,
    /// All components, in written order.
    pub components: Vec<Component>,
    /// Signal connections.
    pub connections: Vec<Connection>,
    /// Event connections.
    pub event_connections: Vec<EventConnection>,
}

/// A named quantity.
#[derive(Clone, Debug)]
pub struct Variable {
    /// Name within its component.
    pub name: String,
    /// The component it belongs to.
    pub component: ComponentIndex,
    /// What it is.
    pub kind: VariableKind,
    /// Unit as written, for labels.
    pub unit: Option<String>,
    /// What it means, in the author's words.
    pub documentation: String,
    /// Where it is declared.
    pub span: Option<Span>,
}

/// The kinds of variables.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum VariableKind {
    /// A constant an experiment may set (a knob); the node refers to parameters only.
    Parameter(NodeId),
    /// A continuous state; the node is its initial value, over parameters (and inputs).
    State(Option<NodeId>),
    /// Given from outside or by a connection.
    Input,
    /// Defined by every location's `outputs`.
    Output,
}

/// One hybrid automaton. A purely continuous component has a single location.
#[derive(Clone, Debug, Default)]
pub struct Component {
    /// Name; empty for a model that is a single component.
    pub name: String,
    /// What it is, in the author's words.
    pub documentation: String,
    /// At least one, in written order.
    pub locations: Vec<Location>,
    /// Position of the location a run starts in.
    pub initial_location: usize,
    /// Event labels it receives, sorted.
    pub input_events: Vec<String>,
    /// Event labels it emits, sorted.
    pub output_events: Vec<String>,
}

/// A location q with its f_q, g_q and outgoing transitions.
#[derive(Clone, Debug, Default)]
pub struct Location {
    /// Name.
    pub name: String,
    /// What it is, in the author's words.
    pub documentation: String,
    /// Where its name stands.
    pub span: Option<Span>,
    /// `der(state) = right`, one for every state that does not rest here.
    pub dynamics: Vec<Equation>,
    /// `output = right`, one for every output of the component.
    pub outputs: Vec<Equation>,
    /// In written order.
    pub transitions: Vec<Transition>,
}

/// A variable and what it (or its derivative) equals.
#[derive(Clone, Debug)]
pub struct Equation {
    /// The state or output.
    pub variable: VariableId,
    /// Right-hand side.
    pub right: NodeId,
    /// Where the right-hand side stands.
    pub span: Option<Span>,
}

/// When a transition is taken.
#[derive(Clone, Debug)]
pub enum Trigger {
    /// While the condition holds, also on entry.
    When(NodeId),
    /// When one of the events arrives and the condition, if any, holds.
    On {
        /// Labels.
        events: Vec<String>,
        /// Condition.
        guard: Option<NodeId>,
    },
}

/// A transition τ = (q₁, q₂, j, r, e_in, e_out) of thesis definition 8.5.
#[derive(Clone, Debug)]
pub struct Transition {
    /// Name as written.
    pub name: String,
    /// What it is, in the author's words.
    pub documentation: String,
    /// Where it stands.
    pub span: Option<Span>,
    /// When it is taken.
    pub trigger: Trigger,
    /// Position of the destination in its component.
    pub destination: usize,
    /// New values of states, all read before the transition.
    pub resets: Vec<Reset>,
    /// Labels emitted.
    pub emits: Vec<String>,
    /// Smaller goes first.
    pub priority: i32,
}

/// `state := right` when a transition is taken.
#[derive(Clone, Debug)]
pub struct Reset {
    /// The state.
    pub state: VariableId,
    /// Its new value, from the values before.
    pub right: NodeId,
    /// Where the right-hand side stands.
    pub span: Option<Span>,
}

/// An output feeds an input.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Connection {
    /// An output.
    pub from: VariableId,
    /// An input.
    pub to: VariableId,
}

/// An event label of a component.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Port {
    /// The component.
    pub component: ComponentIndex,
    /// The label there.
    pub label: String,
}

/// An emitted label is received.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct EventConnection {
    /// Emitting side.
    pub from: Port,
    /// Receiving side.
    pub to: Port,
}

impl Model {
    /// A variable.
    pub fn variable(&self, id: VariableId) -> &Variable {
        &self.variables[id.0 as usize]
    }

    /// `component.name`, or `name` alone in a model of one nameless component.
    pub fn full_name(&self, id: VariableId) -> String {
        let variable = self.variable(id);
        match self.components.get(variable.component.0 as usize) {
            Some(component) if !component.name.is_empty() => {
                format!("{}.{}", component.name, variable.name)
            }
            _ => variable.name.clone(),
        }
    }

    /// Ids of all variables of a component that satisfy `kind`, in written order.
    pub fn variables_of(
        &self,
        component: ComponentIndex,
        kind: impl Fn(VariableKind) -> bool,
    ) -> impl Iterator<Item = VariableId> {
        self.variables
            .iter()
            .enumerate()
            .filter(move |(_, v)| v.component == component && kind(v.kind))
            .map(|(position, _)| VariableId(position as u32))
    }
}
