//! Systems of the literature on quantised states: a stiff pair, a front that travels through cells at rest, and a line
//! of coils and capacitors. Native code, made before; nothing recorded.

use crate::measure::{Measured, repeat};
use sophy_field::StateIndex;
use sophy_ir::{Model, System};
use sophy_passes::lower;
use sophy_run::{Backend, Experiment, Method, Pause, Quantum, QuantumRule, Run};
use sophy_testkit::stiff::{AdvectionReaction, LcLine, Smooth, stiff_pair, stiff_pair_at};
use std::sync::Arc;

const REPETITIONS: usize = 7;

/// All of them.
pub fn bench() -> Vec<Measured> {
    let pair = stiff_pair_at(500.0).to_vec();
    let (front, line) = (AdvectionReaction(1000), LcLine(500));
    let (front_end, line_end) = (front.runge_kutta(1.0, 2e-4), line.runge_kutta(100.0, 0.01));
    vec![
        measure("stiff pair", &stiff_pair(), Method::Qss2, 1e-3, 500.0, &pair),
        measure("stiff pair", &stiff_pair(), Method::Liqss2, 1e-3, 500.0, &pair),
        measure("advection–reaction-1000", &front.model(), Method::Qss2, 1e-3, 1.0, &front_end),
        measure("advection–reaction-1000", &front.model(), Method::Liqss2, 1e-3, 1.0, &front_end),
        measure("LC line-1000", &line.model(), Method::Qss2, 1e-4, 100.0, &line_end),
        measure("LC line-1000", &line.model(), Method::Liqss2, 1e-4, 100.0, &line_end),
    ]
}

fn measure(
    bench: &'static str,
    model: &Model,
    method: Method,
    quantum: f64,
    stop: f64,
    expected: &[f64],
) -> Measured {
    let system: Arc<System> = Arc::new(lower(model).expect("it is sound"));
    let experiment = Experiment {
        stop,
        method,
        backend: Backend::Native,
        quanta: vec![QuantumRule { pattern: "*".to_owned(), quantum: Quantum::absolute(quantum) }],
        ..Experiment::default()
    };
    let begin = || {
        let mut run = Run::new(Arc::clone(&system), &experiment).expect("it starts");
        run.journal.wanted = false;
        run
    };
    let (time, run) = repeat(REPETITIONS, begin, |run| {
        assert_eq!(run.advance(stop, u64::MAX).expect("it goes on"), Pause::Reached);
    });
    let error = |(i, x): (usize, &f64)| (run.state(StateIndex::new(i)) - x).abs();
    Measured {
        bench,
        by: match method {
            Method::Qss2 => "qss2",
            _ => "liqss2",
        },
        time,
        simulated: stop,
        steps: run.statistics().engine.steps,
        transitions: None,
        error_of: "any state at the end",
        error: expected.iter().enumerate().map(error).fold(0.0, f64::max),
        ratio: None,
    }
}
