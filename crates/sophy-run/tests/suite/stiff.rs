//! Stiff systems with closed solutions, by linearly implicit quantisation.

use crate::support::{by, order, run, to};
use sophy_record::Side;
use sophy_run::Method;
use sophy_testkit::Build;
use sophy_testkit::stiff::{AdvectionReaction, Smooth, stiff_pair, stiff_pair_at};

/// The literature's LIQSS2 takes 164 steps at a quantum of 1e-3, LIQSS3 85 and QSS2 65 598.
#[test]
fn the_stiff_pair_takes_the_steps_of_its_slow_motion() {
    for (method, most) in [(Method::Liqss2, 164), (Method::Liqss3, 85)] {
        slow_motion(method, most);
    }
    let steps = run(&stiff_pair(), &by(Method::Qss2, to(500.0, 1e-3))).report.statistics.engine.steps;
    assert!(steps.abs_diff(65_598) < 10, "{steps} steps");
}

/// The stiff pair at many quanta, in at most so many steps at a quantum of 1e-3.
fn slow_motion(method: Method, most: u64) {
    let mut before = None;
    let mut errors = Vec::new();
    for quantum in [1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6] {
        let result = run(&stiff_pair(), &by(method, to(500.0, quantum)));
        let steps = result.report.statistics.engine.steps;
        if quantum == 1e-3 {
            assert!(steps <= most, "{steps} steps by {method:?}");
        }
        if let Some(before) = before.replace(steps) {
            assert!(steps <= 5 * before, "{steps} after {before} steps at {quantum:e}");
        }
        let error = |t: f64| (result.trajectory.value(0, t, Side::Right) - stiff_pair_at(t)[0]).abs();
        let worst = (0..=500).map(f64::from).map(error).fold(0.0, f64::max);
        assert!(worst < 2.0 * quantum, "{worst:e} at {quantum:e}");
        errors.push((quantum, worst));
    }
    assert!(order(&errors) > 0.9, "{errors:?}");
}

/// A state that rests takes no further step, however stiff it is.
#[test]
fn a_stiff_state_comes_to_rest() {
    for method in [Method::Liqss1, Method::Liqss2, Method::Liqss3] {
        let mut b = Build::default();
        b.component("");
        let x = b.state("x", 0.0);
        let here = b.location("all");
        let (one, million, now) = (b.number(1.0), b.number(1e6), b.read(x));
        let gap = b.sub(one, now);
        let rate = b.mul(million, gap);
        b.rate(here, x, rate);
        let result = run(&b.model(), &by(method, to(1000.0, 1e-3)));
        let steps = result.report.statistics.engine.steps;
        assert!(steps < 600, "{method:?}: {steps} steps");
        assert!((result.trajectory.value(0, 1000.0, Side::Right) - 1.0).abs() < 1e-3);
        assert!(result.trajectory.segments(0) < 700);
    }
}

/// A state that grows by itself leaves rest, however near to it it begins.
#[test]
fn an_unstable_state_is_not_held() {
    for (method, quantum) in [(Method::Liqss1, 1e-5), (Method::Liqss2, 1e-7), (Method::Liqss3, 1e-7)] {
        let mut b = Build::default();
        b.component("");
        let x = b.state("x", 1e-4);
        let here = b.location("all");
        let now = b.read(x);
        b.rate(here, x, now);
        let result = run(&b.model(), &by(method, to(6.0, quantum)));
        let ratio = result.trajectory.value(0, 6.0, Side::Right) / (1e-4 * libm::exp(6.0));
        assert!((ratio - 1.0).abs() < 0.2, "{method:?}: {ratio}");
    }
}

const CELLS: usize = 200;

/// Work is proportional to activity: cells at rest take no steps, at any quantum, and none chases its neighbour.
#[test]
fn only_the_front_of_a_reaction_takes_steps() {
    let expected = AdvectionReaction(CELLS).runge_kutta(0.3, 1e-4);
    for method in [Method::Liqss2, Method::Liqss3] {
        let mut before = None;
        for quantum in [1e-1, 1e-2, 1e-3, 1e-4] {
            let result = run(&AdvectionReaction(CELLS).model(), &by(method, to(0.3, quantum)));
            let engine = result.report.statistics.engine;
            assert!(engine.refreshes < engine.steps, "{engine:?}");
            if let Some(before) = before.replace(engine.steps) {
                assert!(
                    engine.steps < 6 * before,
                    "{method:?}: {} after {before} steps at {quantum:e}",
                    engine.steps
                );
            }
            if quantum == 1e-3 {
                let error = |i: usize| (result.trajectory.value(i, 0.3, Side::Right) - expected[i]).abs();
                let worst = (0..CELLS).map(error).fold(0.0, f64::max);
                // The front is steep: where it stands counts for more than how high.
                assert!(worst < 0.03, "{worst}");
                assert!(engine.steps < 30 * CELLS as u64, "{engine:?}");
            }
        }
    }
}
