use crate::graph::{Graph, NodeId};
use crate::model::Quantity;
use crate::repeated::Repeated;
use sophy_diagnostics::Span;
use std::sync::Arc;

/// A class of a [`crate::Model`], by its place in [`crate::Model::classes`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct ClassIndex(pub u32);

/// A variable of a [`Class`], by its place in [`Class::variables`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct VariableId(pub u32);

/// One component as written, with what decides its structure fixed; all its copies share it.
///
/// Vectors and matrices are written out: `omega : real[3]` is `omega[1]`, `omega[2]`, `omega[3]`, in a row.
#[derive(Clone, Debug, Default)]
pub struct Class {
    /// Name of the component.
    pub name: String,
    /// What it is, in the author's words.
    pub documentation: String,
    /// All expressions; their leaves are [`crate::Leaf::Variable`], [`crate::Leaf::Special`] and
    /// [`crate::Leaf::Time`].
    pub graph: Graph,
    /// All variables, in written order.
    pub variables: Vec<Variable>,
    /// What an expression can read besides variables and time, by [`crate::Leaf::Special`].
    pub specials: Vec<Special>,
    /// Event labels it receives, in written order.
    pub input_events: Vec<EventPort>,
    /// Event labels it emits, in written order.
    pub output_events: Vec<EventPort>,
    /// Labels of transitions it takes together with others.
    pub synchronised: Vec<EventPort>,
    /// What it does.
    pub body: Body,
    /// Where its name stands.
    pub span: Option<Span>,
}

/// An event label of a component.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct EventPort {
    /// The label.
    pub name: Arc<str>,
    /// What it means.
    pub documentation: String,
    /// Where it is declared.
    pub span: Option<Span>,
}

/// A named quantity.
#[derive(Clone, Debug)]
pub struct Variable {
    /// Name within its component; elements of vectors and matrices are `omega[2]`, `J[1,3]`.
    pub name: String,
    /// What it is.
    pub kind: VariableKind,
    /// Kind of its values.
    pub quantity: Quantity,
    /// Numbers it can have, where they were declared.
    pub range: Option<Allowed>,
    /// Texts it can have, where they were declared; empty if any.
    pub choices: Vec<usize>,
    /// Whether it is to be recorded and displayed although it is no output.
    pub viewed: bool,
    /// Whether its value decided something of the structure of the class (an extent, an index, the bounds of a
    /// loop), so that an experiment cannot change it.
    pub structural: bool,
    /// Unit as written, for labels.
    pub unit: Option<String>,
    /// What it means, in the author's words.
    pub documentation: String,
    /// Where it is declared.
    pub span: Option<Span>,
}

/// Numbers that a quantity can have.
#[derive(Clone, Debug, PartialEq)]
pub enum Allowed {
    /// From the first to the second; both belong to it. Over parameters.
    Between([NodeId; 2]),
    /// These, and none between them.
    OneOf(Vec<f64>),
}

/// The kinds of variables.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum VariableKind {
    /// A constant; `knob` if an experiment is meant to set it. The node refers to parameters only.
    Parameter {
        /// Its value unless something else is said.
        value: NodeId,
        /// Whether it is part of the interface.
        knob: bool,
    },
    /// A state: continuous, or that of a discrete-time component. The node is its initial value.
    State(Option<NodeId>),
    /// Changes at instants only. The node is its initial value.
    Mode(Option<NodeId>),
    /// Given from outside or by a connection.
    Input {
        /// Whether it is a signal; else it changes at instants only.
        continuous: bool,
    },
    /// Defined by an equation in every location, and part of the interface.
    Output,
    /// Defined by an equation in every location.
    Local,
    /// A local whose sign changes are events.
    Flag,
}

/// What a component does.
#[derive(Clone, Debug)]
pub enum Body {
    /// A hybrid automaton: CTC and LBC. A purely continuous component has a single location.
    Automaton(HybridAutomaton),
    /// A discrete-time component: DTC.
    Discrete(Discrete),
    /// Members and connections: CC and SYSTEM.
    Composite(Composite),
}

impl Default for Body {
    fn default() -> Self {
        Body::Composite(Composite::default())
    }
}

/// A hybrid automaton: the tuple of thesis definitions 8.1–8.5, with Taylor's event sections and rules.
#[derive(Clone, Debug, Default)]
pub struct HybridAutomaton {
    /// At least one, in written order.
    pub locations: Vec<Location>,
    /// Position of the location a run starts in.
    pub initial_location: usize,
    /// Assignments of the `initial` section, in an order in which each follows what it reads.
    pub initial: Vec<Assignment>,
    /// Event sections, in written order.
    pub events: Vec<EventSection>,
    /// Rules, in written order.
    pub rules: Vec<Rule>,
    /// Whether it is an LBC.
    pub logic: bool,
    /// Seconds between a trigger and what it does (`tdelay` of an LBC).
    pub delay: Option<NodeId>,
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
    /// `variable = right` for outputs, locals and flags, each after those it reads.
    pub values: Vec<Equation>,
    /// Equations that hold besides, as `left = right`.
    pub constraints: Vec<Constraint>,
    /// What holds as long as the location may be kept.
    pub invariant: Option<NodeId>,
    /// In written order.
    pub transitions: Vec<Transition>,
}

/// A variable and what it (or its derivative) equals.
#[derive(Clone, Debug)]
pub struct Equation {
    /// The state, output, local or flag.
    pub variable: VariableId,
    /// Right-hand side.
    pub right: NodeId,
    /// Where the right-hand side stands.
    pub span: Option<Span>,
}

/// `left = right`, solved for whatever is not defined otherwise.
#[derive(Clone, Debug)]
pub struct Constraint {
    /// Left-hand side.
    pub left: NodeId,
    /// Right-hand side.
    pub right: NodeId,
    /// Where it stands.
    pub span: Option<Span>,
}

/// `variable := right` at an instant.
#[derive(Clone, Debug)]
pub struct Assignment {
    /// A state or mode, or an output that is assigned.
    pub variable: VariableId,
    /// Its new value, from the values before.
    pub right: NodeId,
    /// Where the right-hand side stands.
    pub span: Option<Span>,
}

/// `emit label` at an instant.
#[derive(Clone, Debug)]
pub struct Emission {
    /// The label.
    pub label: Arc<str>,
    /// Only if this holds.
    pub when: Option<NodeId>,
}

/// What is done at an instant. All right-hand sides read the values before.
#[derive(Clone, Debug, Default)]
pub struct Actions {
    /// New values, one for a variable at most.
    pub assignments: Vec<Assignment>,
    /// Events, in the order of emission.
    pub emissions: Vec<Emission>,
    /// Flags on whose surface the motion is to stay.
    pub holds: Vec<VariableId>,
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
    /// At random, with a rate in 1/s.
    Rate {
        /// The rate.
        rate: NodeId,
        /// Condition.
        guard: Option<NodeId>,
    },
    /// When the location's invariant becomes false.
    Invariant {
        /// Condition.
        guard: Option<NodeId>,
    },
    /// Together with transitions of connected components.
    Synchronised {
        /// The common label.
        label: String,
        /// Condition.
        guard: Option<NodeId>,
    },
}

/// A transition τ = (q₁, q₂, j, r, e_in, e_out) of thesis definition 8.5.
#[derive(Clone, Debug)]
pub struct Transition {
    /// Name as written.
    pub name: Arc<str>,
    /// What it is, in the author's words.
    pub documentation: String,
    /// Where it stands.
    pub span: Option<Span>,
    /// When it is taken.
    pub trigger: Trigger,
    /// Position of the destination in its component.
    pub destination: usize,
    /// r and e_out.
    pub actions: Actions,
    /// Smaller goes first.
    pub priority: i32,
}

/// What happens when a flag changes its sign (seed: state-event sections).
#[derive(Clone, Debug)]
pub struct EventSection {
    /// The flag.
    pub flag: VariableId,
    /// Smaller goes first.
    pub priority: i32,
    /// From negative to positive.
    pub rising: Option<Actions>,
    /// From positive to negative.
    pub falling: Option<Actions>,
    /// Where it stands.
    pub span: Option<Span>,
}

/// What happens when a condition becomes true.
#[derive(Clone, Debug)]
pub struct Rule {
    /// The condition.
    pub condition: NodeId,
    /// What is done.
    pub actions: Actions,
    /// Seconds from the trigger to the execution.
    pub delay: Option<NodeId>,
    /// Whether right-hand sides are read at the trigger.
    pub latched: bool,
    /// Whether what is pending is dropped when the condition becomes false.
    pub cancellable: bool,
    /// Whether truth at the start counts.
    pub initially: bool,
    /// Smaller goes first.
    pub priority: i32,
    /// Where it stands.
    pub span: Option<Span>,
}

/// A discrete-time component (seed `HSML`, equation 3): executed at instants it announces itself.
#[derive(Clone, Debug, Default)]
pub struct Discrete {
    /// When it executes.
    pub clock: Clock,
    /// Seconds from the execution to the change of its outputs.
    pub delay: Option<NodeId>,
    /// Smaller executes first.
    pub priority: i32,
    /// Assignments at the start.
    pub initial: Vec<Assignment>,
    /// Assignments at every execution, locals written out.
    pub update: Vec<Assignment>,
    /// Events emitted at an execution.
    pub emissions: Vec<Emission>,
    /// Outputs and locals after an execution, each after those it reads.
    pub values: Vec<Equation>,
    /// Equations that are solved at every execution, for what has no other.
    pub constraints: Vec<Constraint>,
}

/// When a discrete-time component executes.
#[derive(Clone, Debug, Default)]
pub enum Clock {
    /// Nothing was said; only in models under construction.
    #[default]
    None,
    /// At offset + k·period, s.
    Periodic {
        /// Distance of executions.
        period: NodeId,
        /// The first execution; the start of the run if nothing is said.
        offset: Option<NodeId>,
    },
    /// When the variable says, s; updates move it.
    Announced {
        /// The variable of `tsample`.
        next: VariableId,
    },
}

/// Members and how they are connected.
#[derive(Clone, Debug, Default)]
pub struct Composite {
    /// In written order.
    pub members: Vec<Member>,
    /// What feeds inputs of members and outputs of the composite.
    pub wires: Repeated<Wire>,
    /// Emitted labels and who receives them.
    pub event_wires: Repeated<EventWire>,
}

/// A member, or all copies of an array of members.
#[derive(Clone, Debug)]
pub struct Member {
    /// Name within the composite.
    pub name: String,
    /// What it is.
    pub class: ClassIndex,
    /// Extents of an array, row by row; empty for a single member.
    pub extents: Vec<u32>,
    /// For one element of an array whose elements differ: its indices, from 1.
    pub element: Vec<u32>,
    /// Parameters that get a value here, over the parameters of the composite.
    pub parameters: Vec<(VariableId, NodeId)>,
    /// What it is, in the author's words.
    pub documentation: String,
    /// Where it stands.
    pub span: Option<Span>,
}

/// A port of a member, or of the composite itself.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Port {
    /// Position of the member; `None` for the composite itself.
    pub member: Option<u32>,
    /// Which copy, from 0, row by row.
    pub copy: u32,
    /// The variable, in the class of the member (or of the composite).
    pub variable: VariableId,
}

/// `to` equals a source, or a weighted sum of sources (a row of a composition matrix, thesis A.3).
#[derive(Clone, Debug, PartialEq)]
pub struct Wire {
    /// An input of a member, or an output of the composite.
    pub to: Port,
    /// Outputs of members or inputs of the composite, with their weights.
    pub from: Sources,
    /// Where it is written.
    pub span: Option<Span>,
}

/// What feeds a port.
#[derive(Clone, Debug, PartialEq)]
pub enum Sources {
    /// One port, as it is.
    One(Port),
    /// Σ weight · port.
    Sum(Arc<[(f64, Port)]>),
}

/// An event port of a member, or of the composite itself.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct EventEnd {
    /// Position of the member; `None` for the composite itself.
    pub member: Option<u32>,
    /// Which copy, from 0, row by row.
    pub copy: u32,
    /// The label.
    pub label: Arc<str>,
}

/// An emitted label is received; labels of synchronised transitions are joined.
#[derive(Clone, Debug, PartialEq)]
pub struct EventWire {
    /// Emitting side.
    pub from: EventEnd,
    /// Receiving side.
    pub to: EventEnd,
    /// Whether it joins synchronised transitions.
    pub synchronised: bool,
    /// Where it is written.
    pub span: Option<Span>,
}

/// What an expression reads besides variables and time.
#[derive(Clone, Debug, PartialEq)]
pub enum Special {
    /// `delayed(u, T, u0)`: the value T seconds ago.
    Delayed {
        /// u.
        value: NodeId,
        /// T, s.
        delay: NodeId,
        /// What holds before there was a value.
        before: Option<NodeId>,
    },
    /// `noise("name", sigma, period)`.
    Noise {
        /// Name of the stream.
        name: String,
        /// Standard deviation.
        deviation: NodeId,
        /// Seconds between draws.
        period: NodeId,
    },
    /// `chance(p)`: true with probability p.
    Chance(NodeId),
    /// True in the micro-step in which the event is received.
    Event(String),
    /// `rises(b)`.
    Rises(NodeId),
    /// `falls(b)`.
    Falls(NodeId),
    /// `changes(x)`.
    Changes(NodeId),
    /// The position of the present location, from 1.
    Location,
    /// `never`: an instant that does not come.
    Never,
    /// A table at a point.
    Table {
        /// In [`crate::Model::tables`].
        table: usize,
        /// Where.
        at: NodeId,
    },
    /// `smooth(value)`: switches inside are no events.
    Smooth(NodeId),
}
