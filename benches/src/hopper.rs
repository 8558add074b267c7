//! `hopper-1000s`: Raibert's hopper for 1000 s with quanta of 1e-3; 3460 transitions.

use crate::case::{Case, bits, bits_of};
use crate::floor::hopper::run as floor;
use crate::measure::Measured;
use sophy_run::Method;
use sophy_testkit::{Reference, problems::Hopper};

const STOP: f64 = 1000.0;
const QUANTUM: f64 = 1e-3;
const TRANSITIONS: usize = 3460;
const REPETITIONS: usize = 15;

/// QSS2 beside the floor, to the bit; QSS3 alone.
pub fn bench() -> Vec<Measured> {
    let reference = Reference::read("hopper/tau40_events.csv").numbers("t");
    let last = reference.len() - 1;
    let error = |time: f64| ("time of the 68th transition, s", (time - reference[last]).abs());
    let case = Case::new("hopper-1000s", &Hopper::TAU40.model(), Method::Qss2, QUANTUM, STOP);
    let floor = || floor(Hopper::TAU40, STOP, QUANTUM);
    let (mut rows, hops, run) = case.against(REPETITIONS, floor, |hops| error(hops.transitions[last]));

    let engine = run.statistics().engine;
    assert_eq!((engine.steps, engine.refreshes), (hops.steps, hops.refreshes), "steps and refreshes");
    let taken: Vec<u64> = run.taken.iter().map(|taken| taken.time.to_bits()).collect();
    assert_eq!(taken, bits_of(&hops.transitions), "transitions");
    assert_eq!(taken.len(), TRANSITIONS);
    assert_eq!(bits(&run, 2), bits_of(&hops.end), "the state at the end");

    rows.push(case.by(Method::Qss3).alone(REPETITIONS, |run| error(run.taken[last].time)));
    rows
}
