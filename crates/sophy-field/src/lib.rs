//! What equations, engines and hybrid logic say to one another.
mod index;
pub use index::{
    AlgebraicIndex, AutomatonIndex, EventIndex, InputIndex, LocationIndex, OutputIndex, ParameterIndex,
    StairIndex, StateIndex, TransitionIndex, TruthIndex, WatchIndex,
};
