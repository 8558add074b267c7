//! Runs of whole systems against reference data and properties.

mod convergence;
mod crossings;
mod failures;
mod hopper;
mod promises;
mod simultaneous;
mod support;
