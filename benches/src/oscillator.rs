//! `oscillator`: x₁′ = x₂, x₂′ = −0.95 x₁ − 0.1 x₂ for 200 s with quanta of 1e-5.

use crate::case::{Case, bits, bits_of};
use crate::floor::oscillator::run as floor;
use crate::measure::Measured;
use sophy_field::StateIndex;
use sophy_run::Method;
use sophy_testkit::{Reference, problems::oscillator};

const STOP: f64 = 200.0;
const QUANTUM: f64 = 1e-5;
const REPETITIONS: usize = 51;

/// QSS2 beside the floor, to the bit; the others alone.
pub fn bench() -> Vec<Measured> {
    let reference = Reference::read("oscillator/reference.csv");
    let (times, x1) = (reference.numbers("t"), reference.numbers("x1"));
    assert_eq!(times.last(), Some(&STOP));
    let error = |x: f64| ("x1 at the end", (x - x1[x1.len() - 1]).abs());
    let case = Case::new("oscillator", &oscillator(), Method::Qss2, QUANTUM, STOP);
    let (mut rows, motion, run) =
        case.against(REPETITIONS, || floor(STOP, QUANTUM), |motion| error(motion.end[0]));
    assert_eq!(run.statistics().engine.steps, motion.steps, "steps");
    assert_eq!(bits(&run, 2), bits_of(&motion.end), "the state at the end");
    for method in [Method::Qss3, Method::Liqss2, Method::Liqss3] {
        rows.push(case.by(method).alone(REPETITIONS, |run| error(run.state(StateIndex(0)))));
    }
    rows
}
