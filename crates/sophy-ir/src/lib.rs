//! The representations between text and callable equations, with their text forms and verifiers.
//!
//! - [`Graph`]: hash-consed expressions; [`Graph::derivative`], [`Graph::affine`],
//!   [`Graph::dependencies`], [`evaluate`]; for large systems [`Importer`], [`Reach`], [`Linearity`].
//! - [`Model`]: what was written: classes of components with their variables, locations and transitions, and
//!   composites that say how many copies of which there are and how they are connected.
//! - [`System`]: what is run: one flat hybrid system whose names are typed indices.
//! - [`arithmetic`]: the one meaning of every operation, used by folding, interpreter and tests.
//!
//! None of these types is serialisable; files have versioned types of their own.

mod affine;
pub mod arithmetic;
mod class;
mod column;
mod dependencies;
mod derivative;
mod display;
mod evaluate;
mod graph;
mod import;
mod linearity;
mod model;
mod model_text;
mod names;
mod packed;
mod pieces;
mod renumbered;
mod repeated;
mod system;
mod system_text;
mod written;

pub use affine::Affine;
pub use arithmetic::{Binary, Comparison, Unary};
pub use class::{
    Actions, Allowed, Assignment, Body, Class, ClassIndex, Clock, Composite, Constraint, Discrete, Emission,
    Equation, EventEnd, EventPort, EventSection, EventWire, HybridAutomaton, Location, Member, Port, Rule,
    Sources, Special, Transition, Trigger, Variable, VariableId, VariableKind, Wire,
};
pub use column::Column;
pub use dependencies::Reach;
pub use evaluate::{Evaluator, Value, evaluate};
pub use graph::{Graph, Leaf, Node, NodeId};
pub use import::Importer;
pub use linearity::Linearity;
pub use model::{Interpolation, Model, Quantity, Table};
pub use names::{ComponentIndex, Components, Members};
pub use pieces::Pieces;
pub use repeated::{Repeated, Shared};
pub use system::{
    Algebraic, Automaton, AutomatonKind, Awaited, Declared, Event, EventInput, Feature, FlatEmission,
    FlatLocation, FlatReset, FlatTransition, FlatTrigger, Input, Origin, Output, Parameter, Range, Ranged,
    Receiver, Role, Row, Stair, State, System, Truth, VerifyError, Watch,
};
