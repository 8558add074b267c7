//! `Model` → flat `System`, one file per pass.
//!
//! [`lower`] flattens, runs the [`PIPELINE`] (lift the kinks, give back memory) and verifies what came out.

mod flatten;
mod lift;
mod pipeline;

pub use flatten::{FlattenError, LoopEquation, flatten};
pub use lift::lift_kinks;
pub use pipeline::{PIPELINE, Pass, PassError, lower};
