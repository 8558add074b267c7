//! For tests only: models built by hand (no front end involved) and reference data.

mod build;
pub mod cells;
pub mod problems;
mod reference;
pub mod stiff;

pub use build::{Build, Place};
pub use reference::{Reference, repository};
