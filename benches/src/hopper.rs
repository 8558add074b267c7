//! `hopper-1000s`: Raibert's hopper for 1000 s by QSS2 with quanta of 1e-3; 3460 transitions.

use crate::floor::hopper::run as floor;
use crate::measure::{Measured, alternate};
use sophy_field::StateIndex;
use sophy_passes::lower;
use sophy_run::{Backend, Experiment, Pause, Quantum, QuantumRule, Run};
use sophy_testkit::{Reference, problems::Hopper};
use std::sync::Arc;

const STOP: f64 = 1000.0;
const QUANTUM: f64 = 1e-3;
const TRANSITIONS: usize = 3460;
const REPETITIONS: usize = 15;

/// Ours (nothing recorded, start included, native code made there) beside the floor; both must give the same bits.
pub fn bench() -> Vec<Measured> {
    let model = Hopper::TAU40.model();
    let system = Arc::new(lower(&model).expect("the hopper is sound"));
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
    let (times, hops, run) =
        alternate(REPETITIONS, || floor(Hopper::TAU40, STOP, QUANTUM), || ours(Backend::Interpreter));
    let (native, _, run_native) =
        alternate(REPETITIONS, || floor(Hopper::TAU40, STOP, QUANTUM), || ours(Backend::Native));
    assert!(run_native.is_native());

    let engine = run.statistics().engine;
    assert_eq!((engine.steps, engine.refreshes), (hops.steps, hops.refreshes), "steps and refreshes");
    let taken: Vec<u64> = run.taken.iter().map(|taken| taken.time.to_bits()).collect();
    assert_eq!(taken, hops.transitions.iter().map(|t| t.to_bits()).collect::<Vec<_>>(), "transitions");
    assert_eq!(taken.len(), TRANSITIONS);
    let end = [0, 1].map(|state| run.state(StateIndex::new(state)).to_bits());
    assert_eq!(end, hops.end.map(f64::to_bits), "the state at the end");

    let reference = Reference::read("hopper/tau40_events.csv").numbers("t");
    let last = reference.len() - 1;
    let error = (hops.transitions[last] - reference[last]).abs();
    let row = |by, time, ratio| Measured {
        bench: "hopper-1000s",
        by,
        time,
        simulated: STOP,
        steps: hops.steps,
        transitions: Some(taken.len()),
        error_of: "time of the 68th transition, s",
        error,
        ratio: Some(ratio),
    };
    vec![
        row("floor", times.first, 1.0),
        row("interpreter", times.second, times.ratio),
        row("native", native.second, native.ratio),
    ]
}
