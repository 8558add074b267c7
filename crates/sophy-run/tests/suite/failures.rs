//! Runs that cannot go on say why: livelock, Zeno, not a number, chattering, experiments that do not fit.

use crate::support::{to, try_run};
use sophy_ir::{Comparison, Unary};
use sophy_run::{Experiment, Outcome, SimulateError};
use sophy_testkit::{Build, problems};

fn failure(result: Result<crate::support::Result, SimulateError>) -> Box<sophy_run::Failure> {
    match result {
        Err(SimulateError::Failure(failure)) => failure,
        Err(other) => panic!("{other}"),
        Ok(_) => panic!("it should fail"),
    }
}

#[test]
fn a_livelock_is_reported_with_its_round() {
    let mut b = Build::default();
    b.component("");
    let x = b.state("x", 0.0);
    let read = b.read(x);
    let (low, high) = (b.location("Low"), b.location("High"));
    let (one, two) = (b.number(1.0), b.number(2.0));
    b.rate(low, x, one);
    b.rate(high, x, one);
    let over = b.greater(read, two);
    b.when(low, "up", over, high, &[]);
    b.when(high, "down", over, low, &[]);
    let failure = failure(try_run(&b.model(), &to(5.0, 1e-3)));
    assert_eq!(failure.code.0, "SR0007");
    assert!((failure.time - 2.0).abs() < 1e-12);
    let round = failure.notes.join("\n");
    assert!(round.contains("`up` (Low → High)") && round.contains("`down` (High → Low)"), "{round}");
    assert!(round.contains("returns exactly"), "{round}");
}

/// A ball with restitution 0.8 from 1 m: the bounces accumulate at t* = √(2h/g)·(1 + e)/(1 − e).
#[test]
fn zeno_is_reported_with_its_limit() {
    let mut b = Build::default();
    b.component("");
    let (y, v) = (b.state("y", 1.0), b.state("v", 0.0));
    let (ry, rv) = (b.read(y), b.read(v));
    let here = b.location("Flying");
    let (g, e) = (b.number(-9.81), b.number(-0.8));
    b.rate(here, y, rv);
    b.rate(here, v, g);
    let zero = b.number(0.0);
    let (below, down) = (b.compare(Comparison::LessEqual, ry, zero), b.less(rv, zero));
    let hits = b.graph().and(below, down);
    let back = b.mul(e, rv);
    b.when(here, "bounce", hits, here, &[(v, back)]);
    let result = try_run(&b.model(), &to(10.0, 1e-3)).expect("Zeno is an outcome");
    let Outcome::Zeno(accumulation) = &result.report.outcome else { panic!("{:?}", result.report.outcome) };
    let exact = (2.0f64 / 9.81).sqrt() * 1.8 / 0.2;
    assert!((accumulation.limit - exact).abs() < 1e-9, "{} for {exact}", accumulation.limit);
    assert!((accumulation.ratio - 0.8).abs() < 1e-3);
    assert_eq!(accumulation.cycle.len(), 1);
}

#[test]
fn a_rate_that_is_not_a_number_names_equation_and_values() {
    let mut b = Build::default();
    b.component("");
    let x = b.state("x", 1.0);
    let read = b.read(x);
    let here = b.location("all");
    let root = b.unary(Unary::Sqrt, read);
    let one = b.number(1.0);
    let rate = b.sub(root, one);
    let two = b.number(2.0);
    let rate = b.sub(rate, two);
    b.rate(here, x, rate);
    let failure = failure(try_run(&b.model(), &to(50.0, 1e-3)));
    assert_eq!(failure.code.0, "SR0001");
    let text = format!("{failure}\n{}", failure.notes.join("\n"));
    assert!(text.contains("the derivative of `x` is NaN"), "{text}");
    assert!(text.contains("der(x) = sqrt(x) - 1.0 - 2.0"), "{text}");
    assert!(text.contains("with x = "), "{text}");
}

/// x′ = −sign(x): both fields point at the surface.
#[test]
fn sliding_is_recognised_and_said() {
    let mut b = Build::default();
    b.component("");
    let x = b.state("x", 1.0);
    let read = b.read(x);
    let here = b.location("all");
    let side = b.unary(Unary::Sign, read);
    let rate = b.unary(Unary::Negate, side);
    b.rate(here, x, rate);
    let failure = failure(try_run(&b.model(), &to(5.0, 1e-3)));
    assert_eq!(failure.code.0, "SR0006");
    assert!((failure.time - 1.0).abs() < 1e-9);
}

#[test]
fn all_mistakes_of_an_experiment_are_named_with_a_way_out() {
    let experiment = Experiment {
        knobs: vec![("TUA".to_owned(), 1.0)],
        initial: vec![("ydott".to_owned(), 1.0)],
        record: None,
        tolerance: 2.0,
        ..to(5.0, 1e-3)
    };
    let Err(SimulateError::Experiment(errors)) = try_run(&problems::Hopper::TAU40.model(), &experiment)
    else {
        panic!("it should not start")
    };
    assert_eq!(errors.len(), 3, "{errors:?}");
    assert!(errors.iter().any(|e| e.help.as_deref() == Some("did you mean `tau`?")), "{errors:?}");
    assert!(errors.iter().any(|e| e.help.as_deref() == Some("did you mean `ydot`?")), "{errors:?}");
}

/// A run of no length has a start, its micro-steps, and an end.
#[test]
fn a_run_of_no_length_ends_at_once() {
    let mut b = Build::default();
    b.component("");
    let x = b.state("x", 1.0);
    let read = b.read(x);
    let (here, there) = (b.location("here"), b.location("there"));
    let sine = b.unary(Unary::Sin, read);
    b.rate(here, x, sine);
    b.rate(there, x, sine);
    let half = b.number(0.5);
    let over = b.greater(sine, half);
    b.when(here, "over", over, there, &[]);
    let result = try_run(&b.model(), &to(0.0, 1e-3)).expect("runs");
    assert_eq!((result.events.len(), result.report.time), (1, 0.0));
}
