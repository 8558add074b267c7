//! Systems with closed solutions: errors and steps against the quantum (thesis §3.3).

use crate::support::{METHODS, by, order, run, to};
use sophy_record::Side;
use sophy_run::{Experiment, Method, Quantum, QuantumRule};
use sophy_testkit::{Build, Reference, problems};

#[test]
fn the_oscillator_stays_within_the_bound_and_converges_at_first_order() {
    let reference = Reference::read("oscillator/reference.csv");
    let (times, x1) = (reference.numbers("t"), reference.numbers("x1"));
    let third = -1.0 / 3.0;
    for (method, steps_order) in [
        (Method::Qss3, third),
        (Method::Liqss3, third),
        (Method::Qss2, -0.5),
        (Method::Liqss2, -0.5),
        (Method::Qss1, -1.0),
        (Method::Liqss1, -1.0),
    ] {
        let (mut errors, mut steps) = (Vec::new(), Vec::new());
        for quantum in [1e-2, 3e-3, 1e-3, 3e-4, 1e-4] {
            let result = run(&problems::oscillator(), &by(method, to(60.0, quantum)));
            let error = |(t, x): (&f64, &f64)| (result.trajectory.value(0, *t, Side::Right) - x).abs();
            let worst = times.iter().zip(&x1).filter(|(t, _)| **t <= 60.0).map(error).fold(0.0, f64::max);
            // |V| |Re(Λ)⁻¹ Λ| |V⁻¹| ΔQ (thesis §3.3.1) is about 40 ΔQ for the two states together.
            assert!(worst < 40.0 * quantum, "{method:?}: {worst:e} at quantum {quantum:e}");
            errors.push((quantum, worst));
            steps.push((quantum, result.report.statistics.engine.steps as f64));
        }
        let slope = order(&errors);
        // LIQSS1 does better here.
        assert!(
            (0.75..1.25).contains(&slope) || method == Method::Liqss1 && slope > 1.0,
            "{method:?}: order {slope}, {errors:?}"
        );
        let slope = order(&steps);
        assert!((slope - steps_order).abs() < 0.12, "{method:?}: steps {slope}, {steps:?}");
    }
}

#[test]
fn the_two_timescale_system_is_followed_and_its_clock_needs_no_event() {
    let reference = Reference::read("two-timescale/reference.csv");
    let (times, x1) = (reference.numbers("t"), reference.numbers("x1"));
    let rule = |pattern: &str, quantum| QuantumRule {
        pattern: pattern.to_owned(),
        quantum: Quantum::absolute(quantum),
    };
    let experiment =
        Experiment { stop: 20.0, quanta: vec![rule("x1", 1e-3), rule("x2", 0.1)], ..Experiment::default() };
    let result = run(&problems::two_timescale(), &experiment);
    let error = |(t, x): (&f64, &f64)| (result.trajectory.value(0, *t, Side::Right) - x).abs();
    let worst = times.iter().zip(&x1).map(error).fold(0.0, f64::max);
    assert!(worst < 3e-3, "{worst:e}");
    assert_eq!(result.trajectory.segments(1), 1, "x2′ = 1 is constant");
    assert!(result.report.statistics.engine.steps < 20_000, "{:?}", result.report.statistics);
}

/// x′ = sin t and x′ = t⁵ have no quantised variable at all: the thesis's algorithm would follow the first
/// parabola for ever. Rates that bend are evaluated again in time.
#[test]
fn rates_of_time_alone_are_followed() {
    for method in METHODS {
        let mut b = Build::default();
        b.component("");
        let (sine, power) = (b.state("sine", 0.0), b.state("power", 0.0));
        let here = b.location("all");
        let t = b.time();
        let rate = b.unary(sophy_ir::Unary::Sin, t);
        b.rate(here, sine, rate);
        let fifth = b.graph().integer_power(t, 5);
        b.rate(here, power, fifth);
        let mut errors = Vec::new();
        // A quantum that the longest trusted time does not keep by itself.
        let least = if matches!(method, Method::Qss3 | Method::Liqss3) { 1e-9 } else { 1e-5 };
        for quantum in [100.0, 30.0, 10.0, 3.0, 1.0].map(|times| times * least) {
            let result = run(&b.model(), &by(method, to(1.5, quantum)));
            let mut worst = 0.0f64;
            for k in 0..=150 {
                let t = f64::from(k) / 100.0;
                let exact = [1.0 - libm::cos(t), libm::pow(t, 6.0) / 6.0];
                for (state, exact) in exact.into_iter().enumerate() {
                    worst = worst.max((result.trajectory.value(state, t, Side::Right) - exact).abs());
                }
            }
            errors.push((quantum, worst));
        }
        let slope = order(&errors);
        assert!((0.7..1.2).contains(&slope), "{method:?}: order {slope}, {errors:?}");
        assert!(errors[4].1 < 20.0 * errors[4].0, "{method:?}: {errors:?}");
    }
}
