//! Experiment → configured run: the one place that sees all engines.
//!
//! - [`Experiment`] is everything a run needs besides the model.
//! - [`Run`] is one run: [`Run::advance`] goes on to a time, pausing leaves no trace.
//! - [`simulate`] runs an experiment to its end and feeds recorders.

mod backend;
mod columns;
mod configure;
mod experiment;
mod failure;
mod grid;
mod initial;
mod inputs;
mod ranges;
mod recorder;
mod recording;
mod run;
mod simulate;
mod tables;

pub use backend::Backend;
pub use experiment::{AtEnd, Experiment, ExperimentError, Interpolation, Method, QuantumRule, Signal};
pub use failure::Failure;
pub use recorder::Recorder;
pub use run::{Pause, Run, RunStatistics, Snapshot, StartError};
pub use simulate::{Observer, Outcome, Progress, Report, SimulateError, simulate};
pub use sophy_solvers::Quantum;
