//! No missed event: thin dips, touches and corners (thesis figure 8.2), affine and not.

use crate::support::{METHODS, by, is_first_order, run, to};
use sophy_ir::Unary;
use sophy_run::Experiment;
use sophy_testkit::{Build, problems};

#[test]
fn a_dip_of_a_millionth_is_entered_and_a_touch_is_not() {
    let result = run(&problems::dip(-1e-6), &to(2.0, 1e-3));
    assert_eq!(result.events.len(), 1);
    assert!((result.events[0].time - 0.999).abs() < 1e-9, "{:?}", result.events);
    assert!((result.table.real("x2").unwrap().last().unwrap() + 0.002).abs() < 1e-9);
    for offset in [0.0, 1e-6] {
        assert!(run(&problems::dip(offset), &to(3.0, 1e-3)).events.is_empty(), "offset {offset}");
    }
}

#[test]
fn a_corner_of_two_conditions_is_found_when_both_hold() {
    let result = run(&problems::corner(0.13), &to(1.2, 1e-6));
    assert_eq!(result.events.len(), 1);
    let exact = 1.0 + libm::asin(0.13);
    assert!((result.events[0].time - exact).abs() < 1e-4, "{:?}", result.events);
    assert!(run(&problems::corner(0.142), &to(1.2, 1e-6)).events.is_empty());
}

/// On a circle, x₁·x₂ > c and √(x₁² + x₂²) > r are not affine: they are located by enclosures.
#[test]
fn guards_that_are_not_affine_are_located_by_enclosures() {
    for method in METHODS {
        let mut b = Build::default();
        b.component("");
        let (x1, x2) = (b.state("x1", 1.0), b.state("x2", 0.0));
        let (r1, r2) = (b.read(x1), b.read(x2));
        let back = b.unary(Unary::Negate, r2);
        let (outside, inside) = (b.location("outside"), b.location("inside"));
        for place in [outside, inside] {
            b.rate(place, x1, back);
            b.rate(place, x2, r1);
        }
        let product = b.mul(r1, r2);
        let quarter = b.number(0.25);
        let high = b.greater(product, quarter);
        let low = b.less(product, quarter);
        b.when(outside, "in", high, inside, &[]);
        b.when(inside, "out", low, outside, &[]);
        let quantum = if is_first_order(method) { 1e-4 } else { 1e-6 };
        let result = run(&b.model(), &by(method, to(7.0, quantum)));
        // ½ sin 2t = ¼ at 2t = π/6, 5π/6 and again after a half turn.
        let pi = std::f64::consts::PI;
        let exact: Vec<f64> =
            [1.0, 5.0, 13.0, 17.0].iter().map(|k| k * pi / 12.0).chain([25.0 * pi / 12.0]).collect();
        assert_eq!(result.events.len(), 5, "{:?}", result.events);
        for (event, t) in result.events.iter().zip(exact) {
            assert!((event.time - t).abs() < 200.0 * quantum, "{method:?}: {} for {t}", event.time);
        }
    }
}

/// Kinks are located too: |t − 1|, min, sign, floor in a rate give the exact integral.
#[test]
fn kinks_in_rates_are_events() {
    let mut b = Build::default();
    b.component("");
    let clock = b.state("clock", 0.0);
    let states = ["abs", "floor", "sign"].map(|name| b.state(name, 0.0));
    let read = b.read(clock);
    let here = b.location("all");
    let one = b.number(1.0);
    b.rate(here, clock, one);
    let shifted = b.sub(read, one);
    for (state, function) in states.into_iter().zip([Unary::Abs, Unary::Floor, Unary::Sign]) {
        let rate = b.unary(function, shifted);
        b.rate(here, state, rate);
    }
    let result = run(&b.model(), &to(3.5, 1e-3));
    let last = |name: &str| *result.table.real(name).unwrap().last().unwrap();
    // ∫|t−1| = ½ + 2.5²/2; ∫⌊t−1⌋ = −1 + 0 + 1 + ½·2; ∫sign(t−1) = −1 + 2.5.
    assert!((last("abs") - 3.625).abs() < 1e-12, "{}", last("abs"));
    assert!((last("floor") - 1.0).abs() < 1e-12, "{}", last("floor"));
    assert!((last("sign") - 1.5).abs() < 1e-12, "{}", last("sign"));
    assert!(result.events.is_empty(), "kinks are not transitions");
    let all = run(&b.model(), &Experiment { all_events: true, ..to(3.5, 1e-3) });
    let kinks: Vec<(f64, &str)> = all.events.iter().map(|e| (e.time, e.transition.as_str())).collect();
    assert!(kinks.contains(&(1.0, "clock - 1.0 < 0")), "{kinks:?}");
    assert!(kinks.iter().any(|(time, _)| *time == 2.0), "floor steps at 2: {kinks:?}");
}
