//! Crossings of cubics against known roots, exact arithmetic and a dense search.

use proptest::prelude::*;
use sophy_segment::{Sign, cube_reach, cube_root, cubic_crossing, cubic_leaves, rising_root};

/// Failures are not written into the source tree; a case worth keeping becomes a test of its own.
fn cases(cases: u32) -> ProptestConfig {
    ProptestConfig { cases, failure_persistence: None, ..ProptestConfig::default() }
}

/// a (s − p)(s − q)(s − r) with roots in 8ths; all coefficients are exact.
fn with_roots(a: i64, roots: [i64; 3]) -> [f64; 4] {
    let [p, q, r] = roots;
    [-a * p * q * r, a * (p * q + q * r + r * p) * 8, -a * (p + q + r) * 64, a * 512]
        .map(|n| n as f64 / 512.0)
}

/// The first positive root of odd multiplicity.
fn first_change(mut roots: [i64; 3]) -> Option<i64> {
    roots.sort_unstable();
    roots.chunk_by(|a, b| a == b).find(|equal| equal[0] > 0 && equal.len() % 2 == 1).map(|equal| equal[0])
}

fn value(c: [f64; 4], s: f64) -> f64 {
    c[0] + s * (c[1] + s * (c[2] + s * c[3]))
}

proptest! {
    #![proptest_config(cases(20_000))]

    #[test]
    fn known_roots(a in 1_i64..9, roots in [-80_i64..80, -80_i64..80, -80_i64..80], negative: bool) {
        let c = with_roots(if negative { -a } else { a }, roots);
        let sign = Sign::after(&c);
        let (found, expected) = (cubic_crossing(c, sign), first_change(roots).map(|r| r as f64 / 8.0));
        prop_assert_eq!(found.is_some(), expected.is_some(), "{:?}: {:?} {:?}", c, found, expected);
        if let (Some(found), Some(expected)) = (found, expected) {
            // A root near others, or one of three, is as blurred as rounding makes it.
            let rest = roots.iter().filter(|&&r| r as f64 / 8.0 != expected).count();
            let tolerance = if rest == 2 { 1e-10 } else { 1e-3 };
            prop_assert!((found - expected).abs() <= tolerance * (1.0 + expected), "{} {}", found, expected);
        }
        prop_assert_eq!(cubic_crossing(c, sign.opposite()), Some(0.0));
        prop_assert_eq!(cubic_crossing(c, Sign::Zero), Some(0.0));
    }

    /// Double roots are touched, whatever stands before and behind.
    #[test]
    fn few_small_roots(a in 1_i64..3, roots in [-2_i64..4, -2_i64..4, -2_i64..4], negative: bool, scale in -900_i32..900) {
        let factor = libm::scalbn(1.0, scale);
        let c = with_roots(if negative { -a } else { a }, roots).map(|c| c * factor);
        let expected = first_change(roots).map(|r| r as f64 / 8.0);
        let found = cubic_crossing(c, Sign::after(&c));
        prop_assert_eq!(found.is_some(), expected.is_some(), "{:?}: {:?} {:?}", c, found, expected);
        prop_assert!(found.zip(expected).is_none_or(|(a, b)| (a - b).abs() < 1e-4));
    }

    /// A scale of time changes the exponent of the root only, up to rounding.
    #[test]
    fn any_scale_of_time(
        a in 1_i64..9, roots in [1_i64..80, 81_i64..160, 161_i64..240], scale in -250_i32..250
    ) {
        let c = with_roots(a, roots);
        let stretched = std::array::from_fn(|k| libm::scalbn(c[k], -scale * k as i32));
        let found = cubic_crossing(stretched, Sign::after(&c)).map(|s| libm::scalbn(s, -scale));
        let expected = roots[0] as f64 / 8.0;
        prop_assert!(found.is_some_and(|s| (s / expected - 1.0).abs() < 1e-9), "{:?} {}", found, expected);
    }

    /// No sign change before what is found, one there, and none at all if none is found; by a dense search.
    #[test]
    fn random_cubics(c in [-4.0..4.0, -4.0..4.0, -4.0..4.0, -4.0..4.0]) {
        let sign = Sign::after(&c);
        let found = cubic_crossing(c, sign);
        // All roots are below 1 + max |c| / |c₃|.
        let end = found.unwrap_or(1.0 + 4.0 / c[3].abs()).min(1e6);
        let noise = |s: f64| 1e-13 * (1.0 + s * (1.0 + s * (1.0 + s))) * 4.0;
        for k in 0..4000 {
            let s = end * f64::from(k) / 4000.0;
            let beyond = value(c, s) * if sign == Sign::Positive { -1.0 } else { 1.0 };
            prop_assert!(beyond <= noise(s), "{:?} has changed at {s} before {:?}", c, found);
        }
        if let Some(s) = found {
            prop_assert!(value(c, s).abs() <= noise(s), "{:?} is {} at {s}", c, value(c, s));
        }
    }

    /// |d| is below the band before, and at its edge when it leaves.
    #[test]
    fn leaving_a_band(
        d0 in prop_oneof![3 => -0.99f64..0.99, 1 => Just(0.0)],
        d1 in prop_oneof![3 => -5.0f64..5.0, 1 => Just(0.0)],
        d2 in prop_oneof![3 => -5.0f64..5.0, 1 => Just(0.0)],
        d3 in prop_oneof![3 => -5.0f64..5.0, 1 => Just(0.0), 2 => (-1.0f64..1.0, 0..240).prop_map(|(c, e): (f64, i32)| libm::scalbn(c, -e))],
    ) {
        let d = [d0, d1, d2, d3];
        let delay = cubic_leaves(d, 1.0);
        prop_assert!(delay > 0.0);
        if delay.is_finite() {
            let size = 1.0 + delay * (d1.abs() + delay * (d2.abs() + delay * d3.abs()));
            prop_assert!((value(d, delay).abs() - 1.0).abs() < 1e-5 * size, "{:?} {delay}", d);
        } else {
            prop_assert!(d1 == 0.0 && d2 == 0.0 && d3 == 0.0);
        }
        let end = delay.min(1e3);
        for k in 0..2000 {
            let s = end * f64::from(k) / 2000.0;
            let size = 1.0 + s * (d1.abs() + s * (d2.abs() + s * d3.abs()));
            prop_assert!(value(d, s).abs() < 1.0 + 1e-5 * size, "{:?} left the band at {s}, predicted {delay}", d);
        }
    }
}

/// What rounding leaves of a cubic coefficient puts the next turn 10²³ times as far as the root.
#[test]
fn a_cubic_that_is_almost_a_parabola() {
    let d = [0.000_586_963, -69.781, -469_039.4, 1.974_837_217_590_476_3e-13];
    let delay = cubic_leaves(d, 1e-3);
    assert!((value(d, delay).abs() - 1e-3).abs() < 1e-8, "{delay}");
    let level = [d[0] + 1e-3, d[1], d[2], d[3]];
    let crossing = cubic_crossing(level, Sign::Positive).expect("crosses");
    assert!(value(level, crossing).abs() < 1e-15 && crossing < 3e-5, "{crossing}");
    assert!((crossing - delay).abs() < 1e-6 * delay, "{crossing} {delay}");
}

#[test]
fn conventions() {
    use Sign::{Negative, Positive, Zero};
    let table = [
        ([1.0, 0.0, 0.0, -8.0], Positive, Some(0.5)),
        ([1.0, 0.0, 0.0, 8.0], Positive, None),
        ([-1.0, 0.0, 0.0, 8.0], Negative, Some(0.5)),
        // on the surface, leaving to the decided side
        ([0.0, 0.0, 0.0, 1.0], Positive, None),
        ([0.0, 0.0, 0.0, -1.0], Negative, None),
        ([0.0, 0.0, 1.0, -1.0], Positive, Some(1.0)),
        // begins with the other sign
        ([0.0, 0.0, 0.0, 1.0], Negative, Some(0.0)),
        ([0.0, 0.0, 0.0, 1.0], Zero, Some(0.0)),
        // as a parabola
        ([1.0, -2.0, 1.0, 0.0], Positive, None),
        ([0.0, 0.0, 0.0, 0.0], Zero, None),
        // not finite
        ([1.0, 1.0, 1.0, f64::NAN], Positive, None),
    ];
    for (c, sign, crossing) in table {
        assert_eq!(cubic_crossing(c, sign), crossing, "{c:?} {sign:?}");
    }
    assert_eq!(cubic_leaves([1.0, 0.0, 0.0, 0.0], 1.0), 0.0);
    assert_eq!(cubic_leaves([f64::NAN, 0.0, 0.0, 0.0], 1.0), 0.0);
    assert!((cubic_leaves([0.0, 0.0, 0.0, -8.0], 1.0) - 0.5).abs() < 1e-7);
    assert_eq!(cubic_leaves([0.5, 0.0, 0.0, 0.0], 1.0), f64::INFINITY);
    assert_eq!(cubic_leaves([-1.0, 1.0, 1.0, 1.0], 1.0), 0.0);
    assert_eq!(cube_reach(0.0, 1.0), f64::INFINITY);
}

proptest! {
    #![proptest_config(cases(20_000))]

    #[test]
    fn cube_roots(mantissa in 1.0f64..2.0, exponent in -1070i32..1023) {
        let x = libm::scalbn(mantissa, exponent);
        let (found, expected) = (cube_root(x), libm::cbrt(x));
        prop_assert!((found / expected - 1.0).abs() < 4.0 * f64::EPSILON, "{found:e} {expected:e}");
    }

    /// As far as the quotient is a normal number.
    #[test]
    fn cube_reaches(c3 in -2.0f64..2.0, value in 1.0f64..2.0, of_c3 in -600i32..400, of_value in -600i32..400) {
        let (c3, value) = (libm::scalbn(c3, of_c3), libm::scalbn(value, of_value));
        let quotient = value / c3.abs();
        prop_assume!(quotient.is_normal());
        let (found, expected) = (cube_reach(c3, value), libm::cbrt(quotient));
        prop_assert!((found / expected - 1.0).abs() < 1e-8, "{found:e} {expected:e}");
    }

    /// One, two or three terms of any size.
    #[test]
    fn rising_roots(c in prop::array::uniform3(prop_oneof![4 => -40i32..40, 1 => Just(i32::MIN)]), root in -20i32..20) {
        let [c1, c2, c3] = c.map(|e| if e == i32::MIN { 0.0 } else { libm::scalbn(1.3, e) });
        prop_assume!(c1 + c2 + c3 > 0.0);
        let s = libm::scalbn(1.7, root);
        let found = rising_root([c1, c2, c3], s * (c1 + s * (c2 + s * c3)));
        prop_assert!((found / s - 1.0).abs() < 1e-6, "{found:e} {s:e}");
    }
}
