//! `oscillator`: x₁′ = x₂, x₂′ = −0.95 x₁ − 0.1 x₂ for 200 s by QSS2 with quanta of 1e-5.

use crate::floor::oscillator::run as floor;
use crate::measure::{Measured, alternate};
use sophy_field::StateIndex;
use sophy_passes::lower;
use sophy_run::{Backend, Experiment, Pause, Quantum, QuantumRule, Run};
use sophy_testkit::{Reference, problems::oscillator};
use std::sync::Arc;

const STOP: f64 = 200.0;
const QUANTUM: f64 = 1e-5;
const REPETITIONS: usize = 51;

/// Ours (nothing recorded, start included, native code made there) beside the floor; both must give the same bits.
pub fn bench() -> Vec<Measured> {
    let system = Arc::new(lower(&oscillator()).expect("the oscillator is sound"));
    let experiment = Experiment {
        stop: STOP,
        quanta: vec![QuantumRule { pattern: "*".to_owned(), quantum: Quantum::absolute(QUANTUM) }],
        ..Experiment::default()
    };
    let ours = |backend| {
        let mut run =
            Run::new(Arc::clone(&system), &Experiment { backend, ..experiment.clone() }).expect("it starts");
        run.journal.wanted = false;
        assert_eq!(run.advance(STOP, u64::MAX).expect("it goes on"), Pause::Reached);
        run
    };
    let (times, motion, run) = alternate(REPETITIONS, || floor(STOP, QUANTUM), || ours(Backend::Interpreter));
    let (native, _, run_native) = alternate(REPETITIONS, || floor(STOP, QUANTUM), || ours(Backend::Native));
    assert!(run_native.is_native());

    assert_eq!(run.statistics().engine.steps, motion.steps, "steps");
    let end = [0, 1].map(|state| run.state(StateIndex::new(state)).to_bits());
    assert_eq!(end, motion.end.map(f64::to_bits), "the state at the end");

    let reference = Reference::read("oscillator/reference.csv");
    let (times_of, x1) = (reference.numbers("t"), reference.numbers("x1"));
    assert_eq!(times_of.last(), Some(&STOP));
    let error = (motion.end[0] - x1[x1.len() - 1]).abs();
    let row = |by, time, ratio| Measured {
        bench: "oscillator",
        by,
        time,
        simulated: STOP,
        steps: motion.steps,
        transitions: None,
        error_of: "x1 at the end",
        error,
        ratio: Some(ratio),
    };
    vec![
        row("floor", times.first, 1.0),
        row("interpreter", times.second, times.ratio),
        row("native", native.second, native.ratio),
    ]
}
