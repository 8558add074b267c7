//! Stiff systems with closed solutions, by linearly implicit quantisation.

use crate::support::{by, order, run, to};
use sophy_ir::Model;
use sophy_record::Side;
use sophy_run::Method;
use sophy_testkit::Build;

/// x₁′ = x₂/100, x₂′ = −100 x₁ − 100 x₂ + 2020 from (0, 20): eigenvalues −0.01 and −99.99.
fn pair() -> Model {
    let mut b = Build::default();
    b.component("");
    let (x1, x2) = (b.state("x1", 0.0), b.state("x2", 20.0));
    let here = b.location("all");
    let [hundredth, hundred, rest] = [0.01, 100.0, 2020.0].map(|n| b.number(n));
    let (first, second) = (b.read(x1), b.read(x2));
    let slow = b.mul(hundredth, second);
    let sum = b.add(first, second);
    let pulled = b.mul(hundred, sum);
    let fast = b.sub(rest, pulled);
    b.rate(here, x1, slow);
    b.rate(here, x2, fast);
    b.model()
}

/// x₁ and x₂ at `t`.
fn solution(t: f64) -> [f64; 2] {
    // λ² + 100 λ + 1 = 0
    let root = f64::sqrt(9996.0);
    let (slow, fast) = (-2.0 / (100.0 + root), -(100.0 + root) / 2.0);
    let b = (0.2 + 20.2 * slow) / (fast - slow);
    let a = -20.2 - b;
    let (ea, eb) = (a * libm::exp(slow * t), b * libm::exp(fast * t));
    [20.2 + ea + eb, 100.0 * (slow * ea + fast * eb)]
}

/// The literature's LIQSS2 takes 164 steps at a quantum of 1e-3 and QSS2 65 598.
#[test]
fn the_stiff_pair_takes_the_steps_of_its_slow_motion() {
    let mut before = None;
    let mut errors = Vec::new();
    for quantum in [1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6] {
        let result = run(&pair(), &by(Method::Liqss2, to(500.0, quantum)));
        let steps = result.report.statistics.engine.steps;
        if quantum == 1e-3 {
            assert!(steps <= 164, "{steps} steps");
        }
        if let Some(before) = before.replace(steps) {
            assert!(steps <= 5 * before, "{steps} after {before} steps at {quantum:e}");
        }
        let error = |t: f64| (result.trajectory.value(0, t, Side::Right) - solution(t)[0]).abs();
        let worst = (0..=500).map(f64::from).map(error).fold(0.0, f64::max);
        assert!(worst < 2.0 * quantum, "{worst:e} at {quantum:e}");
        errors.push((quantum, worst));
    }
    assert!(order(&errors) > 0.9, "{errors:?}");
    let steps = run(&pair(), &by(Method::Qss2, to(500.0, 1e-3))).report.statistics.engine.steps;
    assert!(steps.abs_diff(65_598) < 10, "{steps} steps");
}

/// A state that rests takes no further step, however stiff it is.
#[test]
fn a_stiff_state_comes_to_rest() {
    for method in [Method::Liqss1, Method::Liqss2] {
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
    for (method, quantum) in [(Method::Liqss1, 1e-5), (Method::Liqss2, 1e-7)] {
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

/// u′ᵢ = N(uᵢ₋₁ − uᵢ) − 1000 uᵢ(uᵢ − ½)(uᵢ − 1), u₀ = 1: a front that travels through cells at rest.
fn advection_reaction() -> Model {
    let mut b = Build::default();
    b.component("");
    let start = |i| if i < CELLS * 3 / 10 { 1.0 } else { 0.0 };
    let cells: Vec<_> = (0..CELLS).map(|i| b.state(&format!("u{i}"), start(i))).collect();
    let here = b.location("all");
    let [one, half, speed, reaction] = [1.0, 0.5, CELLS as f64, 1000.0].map(|n| b.number(n));
    let mut before = one;
    for cell in cells {
        let u = b.read(cell);
        let step = b.sub(before, u);
        let (flow, middle, end) = (b.mul(step, speed), b.sub(u, half), b.sub(u, one));
        let product = b.mul(u, middle);
        let product = b.mul(product, end);
        let source = b.mul(product, reaction);
        let rate = b.sub(flow, source);
        b.rate(here, cell, rate);
        before = u;
    }
    b.model()
}

/// The same by the classical Runge–Kutta method with 1e-4 s.
fn advection_reaction_until(stop: f64) -> Vec<f64> {
    let rate = |u: &[f64]| -> Vec<f64> {
        let before = |i: usize| if i == 0 { 1.0 } else { u[i - 1] };
        (0..CELLS)
            .map(|i| CELLS as f64 * (before(i) - u[i]) - 1000.0 * u[i] * (u[i] - 0.5) * (u[i] - 1.0))
            .collect()
    };
    let along =
        |u: &[f64], k: &[f64], h: f64| -> Vec<f64> { u.iter().zip(k).map(|(u, k)| u + h * k).collect() };
    let mut u: Vec<f64> = (0..CELLS).map(|i| if i < CELLS * 3 / 10 { 1.0 } else { 0.0 }).collect();
    let h = 1e-4;
    for _ in 0..(stop / h).round() as usize {
        let k1 = rate(&u);
        let k2 = rate(&along(&u, &k1, h / 2.0));
        let k3 = rate(&along(&u, &k2, h / 2.0));
        let k4 = rate(&along(&u, &k3, h));
        for i in 0..CELLS {
            u[i] += h / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]);
        }
    }
    u
}

/// Work is proportional to activity: cells at rest take no steps, at any quantum, and none chases its neighbour.
#[test]
fn only_the_front_of_a_reaction_takes_steps() {
    let expected = advection_reaction_until(0.3);
    let mut before = None;
    for quantum in [1e-1, 1e-2, 1e-3, 1e-4] {
        let result = run(&advection_reaction(), &by(Method::Liqss2, to(0.3, quantum)));
        let engine = result.report.statistics.engine;
        assert!(engine.refreshes < engine.steps, "{engine:?}");
        if let Some(before) = before.replace(engine.steps) {
            assert!(engine.steps < 6 * before, "{} after {before} steps at {quantum:e}", engine.steps);
        }
        if quantum == 1e-3 {
            let error = |i: usize| (result.trajectory.value(i, 0.3, Side::Right) - expected[i]).abs();
            let worst = (0..CELLS).map(error).fold(0.0, f64::max);
            // The front is steep: where it stands counts for more than how high.
            assert!(worst < 0.02, "{worst}");
            assert!(engine.steps < 30 * CELLS as u64, "{engine:?}");
        }
    }
}
