//! Runs of whole systems against reference data and properties.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)] // a test may panic

mod allocation;
mod automata;
mod convergence;
mod crossings;
mod equations;
mod failures;
mod flags;
mod guards;
mod hopper;
mod inputs;
mod jacobian;
mod limits;
mod promises;
mod recording;
mod shapes;
mod simultaneous;
mod stiff;
mod support;
mod switches;
mod tables;
