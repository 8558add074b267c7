//! `Model` → flat `System`, one file per pass.
//!
//! [`lower`] runs the [`PIPELINE`]: flatten, then lift the kinks. The verifier runs after each pass in debug
//! builds and tests.

mod flatten;
mod lift;
mod pipeline;

pub use flatten::{FlattenError, flatten};
pub use lift::lift_kinks;
pub use pipeline::{PIPELINE, Pass, PassError, lower};
