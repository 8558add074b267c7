//! `scale`: what a step costs in large systems, and what a large system costs that is mostly at rest. The systems of
//! several sizes are arrays of components (`models`).

use crate::language;
use crate::measure::{medians, timed};
use crate::memory;
use sophy_ir::Model;
use sophy_passes::lower;
use sophy_run::{Backend, Experiment, Method, Pause, Quantum, QuantumRule, Run};
use std::sync::Arc;

/// One system.
#[derive(Clone, Debug)]
pub struct Scaled {
    /// Which.
    pub system: &'static str,
    /// Its states.
    pub states: usize,
    /// Fronts that travel through it.
    pub fronts: Option<usize>,
    /// By which engine.
    pub method: Method,
    /// Changes of quantised states.
    pub steps: u64,
    /// CPU time of the run, ms.
    pub cpu_ms: f64,
    /// System and run that is ready, bytes.
    pub bytes: usize,
}

pub const LINE: &str = "LC line, a wave at its beginning";
pub const BUSY_LINE: &str = "LC line, every state moves";
pub const FRONT: &str = "front";
pub const NEURONS: &str = "spiking neurons, spikes at their beginning";
/// Cells of the systems with several fronts.
pub const CELLS: usize = 100_000;

const SIZES: [usize; 4] = [1_000, 10_000, 100_000, 1_000_000];
const REPETITIONS: usize = 5;

impl Scaled {
    pub fn ns_per_step(&self) -> f64 {
        1e6 * self.cpu_ms / self.steps as f64
    }

    pub fn bytes_per_state(&self) -> f64 {
        self.bytes as f64 / self.states as f64
    }
}

/// The same dynamics in ever larger systems.
pub fn sizes() -> Vec<Scaled> {
    let mut rows = Vec::new();
    for states in SIZES {
        let line = cells(include_str!("../models/line.hsml"), states / 2);
        let quiet = Experiment { stop: 100.0, ..experiment(Method::Qss2, 1e-4) };
        rows.push(measure(LINE, &line, &quiet, u64::MAX));
        let busy = Experiment { initial: scattered(states / 2), ..quiet };
        // As many steps for each state, and enough of them to be measured.
        rows.push(measure(BUSY_LINE, &line, &busy, 1_000_000.max(4 * states as u64)));
        let front = cells(include_str!("../models/reaction.hsml"), states);
        rows.push(measure(FRONT, &front, &travelling(), u64::MAX));
        let neurons = cells(include_str!("../models/neurons.hsml"), states / 2);
        let spiking = Experiment { stop: 0.2, ..experiment(Method::Liqss2, 1e-3) };
        rows.push(measure(NEURONS, &neurons, &spiking, u64::MAX));
    }
    rows
}

/// A model of 500 cells with another number of them.
fn cells(text: &str, count: usize) -> Model {
    let text = text.replace("500", &count.to_string()).replace("1..499", &format!("1..{}", count - 1));
    language::model(&text, &mut Vec::new())
}

/// The same number of states, more and more of them active.
pub fn activity() -> Vec<Scaled> {
    let mut rows = Vec::new();
    let model = cells(include_str!("../models/reaction.hsml"), CELLS);
    for fronts in [1, 2, 4, 8, 16] {
        let experiment = Experiment { initial: stripes(fronts), ..travelling() };
        let row = measure(FRONT, &model, &experiment, u64::MAX);
        rows.push(Scaled { fronts: Some(fronts), ..row });
    }
    rows
}

fn experiment(method: Method, quantum: f64) -> Experiment {
    let quantum = Quantum::absolute(quantum);
    Experiment {
        method,
        backend: Backend::Native,
        quanta: vec![QuantumRule { pattern: "*".to_owned(), quantum }],
        ..Experiment::default()
    }
}

/// In half a second a front travels through 500 cells.
fn travelling() -> Experiment {
    Experiment { stop: 0.5, ..experiment(Method::Liqss2, 1e-3) }
}

/// Cells of 1 and cells of 0, with so many edges between them; the first stands behind three tenths of its share of the
/// cells. One front is as fast and as steep as another: with u, 1 − u is a solution, too.
fn stripes(fronts: usize) -> Vec<(String, f64)> {
    let passed = |cell: usize| (10 * cell * fronts + 7 * CELLS) / (10 * CELLS);
    let ones = (0..CELLS).filter(|&cell| passed(cell).is_multiple_of(2));
    ones.map(|cell| (format!("cell[{}].u", cell + 1), 1.0)).collect()
}

/// Initial values that differ from state to state.
fn scattered(sections: usize) -> Vec<(String, f64)> {
    let of = |k: usize, state: &str, phase: f64| {
        (format!("section[{}].{state}", k + 1), libm::sin(2.0 * k as f64 + phase))
    };
    (0..sections).flat_map(|k| [of(k, "i", 0.0), of(k, "u", 1.0)]).collect()
}

fn measure(system: &'static str, model: &Model, experiment: &Experiment, budget: u64) -> Scaled {
    let begin = |lowered| {
        let mut run = Run::new(lowered, experiment).expect("it starts");
        run.journal.stop();
        run
    };
    let mut run = memory::peak_of(|| begin(Arc::new(lower(model).expect("it is sound")))).0;
    let bytes = memory::held();
    let lowered = Arc::clone(run.system());
    let mut times = Vec::new();
    for repetition in 0..REPETITIONS {
        if repetition > 0 {
            run = begin(Arc::clone(&lowered));
        }
        let mut go =
            || assert!(matches!(run.advance(experiment.stop, budget), Ok(Pause::Reached | Pause::Budget)));
        times.push(timed(&mut go).1);
    }
    let steps = run.statistics().engine.steps;
    let (states, method) = (lowered.states.len(), experiment.method);
    Scaled { system, states, fronts: None, method, steps, cpu_ms: medians(&times).cpu_ms, bytes }
}
