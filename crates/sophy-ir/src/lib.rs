//! The representations between text and callable equations, with their text forms and verifiers.
//!
//! - [`Graph`]: hash-consed expressions; [`Graph::derivative`], [`Graph::affine`],
//!   [`Graph::dependencies`], [`evaluate`]; for large systems [`Importer`], [`Reach`], [`Linearity`].
//! - [`Model`]: what was written: components with their variables, locations and transitions, and how they
//!   are connected.
//! - [`System`]: what is run: one flat hybrid system whose names are typed indices.
//! - [`arithmetic`]: the one meaning of every operation, used by folding, interpreter and tests.
//!
//! None of these types is serialisable; files have versioned types of their own.

mod affine;
pub mod arithmetic;
mod dependencies;
mod derivative;
mod display;
mod evaluate;
mod graph;
mod import;
mod linearity;
mod model;
mod model_text;
mod system;

pub use affine::Affine;
pub use arithmetic::{Binary, Comparison, Unary};
pub use dependencies::Reach;
pub use evaluate::{Evaluator, Value, evaluate};
pub use graph::{Graph, Leaf, Node, NodeId};
pub use import::Importer;
pub use linearity::Linearity;
pub use model::{
    Component, ComponentIndex, Connection, Equation, EventConnection, Location, Model, Port, Reset,
    Transition, Trigger, Variable, VariableId, VariableKind,
};
pub use system::{
    Algebraic, Automaton, Event, FlatLocation, FlatReset, FlatTransition, FlatTrigger, Input, Output,
    Parameter, Receiver, Row, Stair, State, System, Truth, VerifyError, Watch,
};
