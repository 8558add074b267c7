//! Those who solve the same problems, Sophy among them.
//!
//! Each does what its own documents advise; whoever has no location of events leaves the hopper to the others. What is
//! measured is the run alone: native code and imports come before it.

mod diffsol;
mod ode_solvers;
mod ours;
mod python;
mod wheels;

use crate::measure::Time;
use crate::problem::Problem;
use cpu_time::ProcessTime;
use std::time::Instant;

pub use ours::{Ours, Work};

/// Somebody who solves problems.
pub trait Solver {
    /// Whose it is.
    fn by(&self) -> String;
    /// Its method.
    fn method(&self) -> &str;
    /// Whether it can do this problem at all.
    fn can(&self, problem: Problem) -> bool;
    /// Solves it until `stop` (s) with `setting`, a quantum or a tolerance; else why not.
    fn solve(&mut self, problem: Problem, stop: f64, setting: f64) -> Result<Outcome, String>;
}

/// What somebody found, and what it took.
#[derive(Clone, Debug, Default)]
pub struct Outcome {
    /// The states at the instants asked for.
    pub states: Vec<Vec<f64>>,
    /// Times of transitions, s.
    pub transitions: Vec<f64>,
    /// Steps accepted; of ours, changes of quantised states.
    pub steps: u64,
    /// What it took.
    pub time: Time,
}

/// No solve may take longer, s.
pub const PATIENCE: f64 = 60.0;

/// Everybody that can be had here.
pub fn everybody() -> Vec<Box<dyn Solver>> {
    let mut all = Ours::engines();
    all.extend(ode_solvers::all());
    all.extend(diffsol::all());
    all.extend(python::all());
    all
}

/// Does `work`; with the time it took.
fn clocked<R>(work: impl FnOnce() -> R) -> (R, Time) {
    let (wall, cpu) = (Instant::now(), ProcessTime::now());
    let result = work();
    let (wall, cpu) = (wall.elapsed(), cpu.elapsed());
    (result, Time { wall_ms: 1e3 * wall.as_secs_f64(), cpu_ms: 1e3 * cpu.as_secs_f64() })
}
