//! Runs of whole systems against reference data and properties.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)] // a test may panic

mod convergence;
mod crossings;
mod failures;
mod hopper;
mod promises;
mod simultaneous;
mod support;
