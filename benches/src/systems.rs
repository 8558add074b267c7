//! Systems of the literature on quantised states: a stiff pair, a front that travels through cells at rest, a line of
//! coils and capacitors, and a converter.

use crate::case::{Case, bits, bits_of, largest_error};
use crate::floor::line::run as floor;
use crate::language::model;
use crate::measure::Measured;
use sophy_run::{Method, Run};
use sophy_testkit::stiff::{AdvectionReaction, LcLine, Smooth, stiff_pair, stiff_pair_at};

const REPETITIONS: usize = 7;
const SECTIONS: usize = 500;

/// All of them.
pub fn bench() -> Vec<Measured> {
    [pair(), front(), line(), buck()].concat()
}

fn pair() -> Vec<Measured> {
    let end = stiff_pair_at(500.0);
    let case = Case::new("stiff pair", &stiff_pair(), Method::Qss2, 1e-3, 500.0);
    by_each(&case, &[Method::Qss2, Method::Liqss2, Method::Liqss3], &end)
}

fn front() -> Vec<Measured> {
    let front = AdvectionReaction(1000);
    let end = front.runge_kutta(1.0, 2e-4);
    let case = Case::new("advection–reaction-1000", &front.model(), Method::Qss2, 1e-3, 1.0);
    by_each(&case, &[Method::Qss2, Method::Liqss2, Method::Liqss3], &end)
}

/// With quanta as in the literature, absolute and relative. By its end every period is as the one before; see
/// `tests/reference/buck`.
fn buck() -> Vec<Measured> {
    let end = [-7.427_911_190_013_591e-5, 15.713_924_165_610_011];
    let model = model(include_str!("../../examples/buck/buck.hsml"), &mut Vec::new());
    let case = Case::new("buck converter", &model, Method::Liqss2, 1e-4, 0.01).relative(1e-4);
    let rows = by_each(&case, &[Method::Liqss2, Method::Liqss3], &end);
    assert!(rows.iter().all(|row| row.transitions == Some(400)), "{rows:?}");
    rows
}

/// QSS2 beside the floor, to the bit; the others alone.
fn line() -> Vec<Measured> {
    let line = LcLine(SECTIONS);
    let (quantum, stop) = (1e-4, 100.0);
    let end = line.runge_kutta(stop, 0.01);
    let case = Case::new("LC line-1000", &line.model(), Method::Qss2, quantum, stop);
    let error = |x: &[f64]| {
        let errors = x.iter().zip(&end).map(|(x, end)| (x - end).abs());
        (ANY, errors.fold(0.0, f64::max))
    };
    let (mut rows, given, run) =
        case.against(REPETITIONS, || floor(SECTIONS, stop, quantum), |given| error(&given.end));
    assert_eq!(run.statistics().engine.steps, given.steps, "steps");
    assert_eq!(bits(&run, 2 * SECTIONS), bits_of(&given.end), "the states at the end");
    rows.extend(by_each(&case, &[Method::Qss3, Method::Liqss2], &end));
    rows
}

const ANY: &str = "any state at the end";

fn by_each(case: &Case, methods: &[Method], end: &[f64]) -> Vec<Measured> {
    let error = |run: &Run| (ANY, largest_error(run, end));
    methods.iter().map(|&method| case.by(method).alone(REPETITIONS, error)).collect()
}
