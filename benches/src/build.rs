//! `build`: from a flat system to a started run, for copies of one component and for equations that all differ.

use crate::memory;
use sophy_ir::System;
use sophy_passes::lift_kinks;
use sophy_run::{Experiment, Quantum, QuantumRule, Run};
use sophy_testkit::cells::{distinct, ring};
use std::sync::Arc;
use std::time::Instant;

/// One row of the table.
#[derive(Clone, Debug)]
pub struct Built {
    /// Which system.
    pub system: &'static str,
    /// Its states.
    pub states: usize,
    /// Different programs.
    pub programs: usize,
    /// Lifting of kinks, ms.
    pub lift_ms: f64,
    /// Configuration, compilation and start of the run, ms.
    pub start_ms: f64,
    /// What the run needs beside the system, bytes.
    pub bytes: usize,
    /// The most it needed meanwhile, bytes.
    pub peak: usize,
}

impl Built {
    /// ns per state.
    pub fn per_state(&self, ms: f64) -> f64 {
        1e6 * ms / self.states as f64
    }
}

/// All systems; each the fastest of three.
pub fn bench() -> Vec<Built> {
    let mut rows = Vec::new();
    for cells in [1000, 10_000, 100_000] {
        rows.push(fastest("copies", || ring(cells, false)));
    }
    for cells in [1000, 10_000, 100_000] {
        rows.push(fastest("copies with events", || ring(cells, true)));
    }
    rows.push(fastest("distinct", || distinct(100_000)));
    rows
}

fn fastest(name: &'static str, system: impl Fn() -> System) -> Built {
    let built = (0..3).map(|_| build(name, system()));
    built.min_by(|a, b| (a.lift_ms + a.start_ms).total_cmp(&(b.lift_ms + b.start_ms))).expect("three")
}

fn build(name: &'static str, mut system: System) -> Built {
    let begin = Instant::now();
    lift_kinks(&mut system);
    let lift_ms = 1e3 * begin.elapsed().as_secs_f64();
    let system = Arc::new(system);
    let experiment = Experiment {
        quanta: vec![QuantumRule { pattern: "*".to_owned(), quantum: Quantum::absolute(1e-3) }],
        ..Experiment::default()
    };
    let begin = Instant::now();
    let run = Run::new(Arc::clone(&system), &experiment).expect("it starts");
    let start_ms = 1e3 * begin.elapsed().as_secs_f64();
    drop(run);
    let (run, peak) = memory::peak_of(|| Run::new(Arc::clone(&system), &experiment).expect("it starts"));
    Built {
        system: name,
        states: system.states.len(),
        programs: run.compiled().equations.programs.len() - 1,
        lift_ms,
        start_ms,
        bytes: memory::held(),
        peak,
    }
}
