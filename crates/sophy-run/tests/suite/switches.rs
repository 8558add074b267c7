//! Switches and what reads them: truths and stairs are never stale.

use crate::support::{run, to};
use sophy_ir::{Comparison, Unary};
use sophy_record::Side;
use sophy_run::{AtEnd, Experiment, Interpolation, Signal};
use sophy_testkit::Build;

/// x = t, y′ = sign(x) from x = 0: the truth right of the start is that of the motion, also for y, which reads
/// nothing else.
#[test]
fn a_truth_decided_by_the_motion_at_the_start_reaches_its_readers() {
    let mut b = Build::default();
    b.component("");
    let (x, y) = (b.state("x", 0.0), b.state("y", 0.0));
    let read = b.read(x);
    let here = b.location("all");
    let one = b.number(1.0);
    b.rate(here, x, one);
    let side = b.unary(Unary::Sign, read);
    b.rate(here, y, side);
    let result = run(&b.model(), &to(2.0, 1e-3));
    assert_eq!(result.trajectory.value(1, 2.0, Side::Right), 2.0);
}

/// A reset onto the surface, left again on the side it was on: x ≥ 0 stays true.
#[test]
fn a_reset_onto_the_surface_keeps_the_side_of_the_motion() {
    let mut b = Build::default();
    b.component("");
    let (x, y) = (b.state("x", 0.25), b.state("y", 0.0));
    let read = b.read(x);
    let here = b.location("all");
    let (one, zero) = (b.number(1.0), b.number(0.0));
    b.rate(here, x, one);
    let side = b.unary(Unary::Sign, read);
    b.rate(here, y, side);
    let over = b.compare(Comparison::GreaterEqual, read, one);
    b.when(here, "back", over, here, &[(x, zero)]);
    let result = run(&b.model(), &to(3.0, 1e-3));
    assert_eq!(result.events.len(), 3);
    assert_eq!(result.trajectory.value(1, 3.0, Side::Right), 3.0);
}

/// y′ = ⌊u⌋ for a held input that jumps by several steps, up and down.
#[test]
fn a_stair_follows_jumps_of_its_argument() {
    let mut b = Build::default();
    b.component("");
    let y = b.state("y", 0.0);
    let u = b.input("u");
    let read = b.read(u);
    let (here, high) = (b.location("low"), b.location("high"));
    let steps = b.unary(Unary::Floor, read);
    b.rate(here, y, steps);
    b.rate(high, y, steps);
    let four = b.number(4.0);
    let over = b.compare(Comparison::GreaterEqual, steps, four);
    b.when(here, "over", over, high, &[]);
    let signal = Signal {
        times: vec![0.0, 1.0, 2.0, 3.0, 4.0],
        values: vec![0.5, 3.5, 1.5, 4.0, -0.5],
        interpolation: Interpolation::Hold,
        at_end: AtEnd::Hold,
        origin: "a test".to_owned(),
    };
    let experiment = Experiment { inputs: vec![("u".to_owned(), signal)], ..to(5.0, 1e-3) };
    let result = run(&b.model(), &experiment);
    let expected = [0.0, 0.0, 3.0, 4.0, 8.0, 7.0];
    for (t, expected) in expected.into_iter().enumerate() {
        assert_eq!(result.trajectory.value(0, t as f64, Side::Right), expected, "at {t}");
    }
    assert_eq!(result.events.iter().map(|e| e.time).collect::<Vec<_>>(), [3.0]);
}

/// A guard that reads only another automaton's output, which jumps with that automaton's location.
#[test]
fn a_guard_sees_an_output_jump_with_its_location() {
    let mut b = Build::default();
    b.component("sender");
    let (clock, y) = (b.state("clock", 0.0), b.output("y"));
    let read = b.read(clock);
    let (low, high) = (b.location("low"), b.location("high"));
    let [zero, one, five] = [0.0, 1.0, 5.0].map(|n| b.number(n));
    for (place, value) in [(low, zero), (high, five)] {
        b.rate(place, clock, one);
        b.value(place, y, value);
    }
    let late = b.compare(Comparison::GreaterEqual, read, one);
    b.when(low, "rise", late, high, &[]);
    b.component("receiver");
    let u = b.input("u");
    let input = b.read(u);
    let (idle, busy) = (b.location("idle"), b.location("busy"));
    let over = b.greater(input, one);
    b.when(idle, "wake", over, busy, &[]);
    b.connect(y, u);
    let result = run(&b.model(), &to(2.0, 1e-3));
    let events: Vec<(f64, u32, &str)> =
        result.events.iter().map(|e| (e.time, e.step, e.transition.as_str())).collect();
    assert_eq!(events, [(1.0, 0, "rise"), (1.0, 1, "wake")]);
}

/// √x > 1 from x = 0: the derivative is infinite there, the value is not.
#[test]
fn a_guard_may_have_an_infinite_derivative() {
    let mut b = Build::default();
    b.component("");
    let x = b.state("x", 0.0);
    let read = b.read(x);
    let (here, there) = (b.location("here"), b.location("there"));
    let one = b.number(1.0);
    b.rate(here, x, one);
    let root = b.unary(Unary::Sqrt, read);
    let over = b.greater(root, one);
    b.when(here, "over", over, there, &[]);
    let result = run(&b.model(), &to(2.0, 1e-3));
    assert_eq!(result.events.len(), 1);
    assert!((result.events[0].time - 1.0).abs() < 1e-12);
}

/// A cascade of 2500 transitions at one instant ends; it is neither Zeno nor a livelock.
#[test]
fn a_long_cascade_at_one_instant_ends() {
    let mut b = Build::default();
    b.component("");
    let (clock, n) = (b.state("clock", 0.0), b.state("n", 2500.0));
    let (time, left) = (b.read(clock), b.read(n));
    let here = b.location("here");
    let [zero, one] = [0.0, 1.0].map(|k| b.number(k));
    b.rate(here, clock, one);
    b.rate(here, n, zero);
    let late = b.compare(Comparison::GreaterEqual, time, one);
    let some = b.greater(left, zero);
    let both = b.graph().and(late, some);
    let less = b.sub(left, one);
    b.when(here, "count", both, here, &[(n, less)]);
    let result = run(&b.model(), &to(2.0, 1e-3));
    assert_eq!(result.events.len(), 2500);
    assert_eq!(result.report.time, 2.0);
}

/// Forty components hand an event on, one after the other, at one instant.
#[test]
fn a_long_chain_of_events_is_no_livelock() {
    let mut b = Build::default();
    let first = b.component("c0");
    let clock = b.state("clock", 0.0);
    let read = b.read(clock);
    let (here, done) = (b.location("here"), b.location("done"));
    let one = b.number(1.0);
    b.rate(here, clock, one);
    b.rate(done, clock, one);
    let late = b.compare(Comparison::GreaterEqual, read, one);
    b.when(here, "start", late, done, &[]);
    b.emit(here, "next");
    let mut previous = first;
    for k in 1..=40 {
        let component = b.component(&format!("c{k}"));
        let here = b.location("here");
        b.on(here, "go", here, &[]);
        b.emit(here, "next");
        b.connect_event((previous, "next"), (component, "go"));
        previous = component;
    }
    let result = run(&b.model(), &to(2.0, 1e-3));
    assert_eq!(result.events.len(), 41);
}
