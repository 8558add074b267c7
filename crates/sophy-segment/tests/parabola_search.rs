//! The closed form equals a slow exhaustive search in exact arithmetic.

use std::cmp::Ordering;

use proptest::prelude::*;
use sophy_segment::{Sign, parabola_crossing};

/// Steps per unit of s on the grid of the search.
const GRID: i128 = 1 << 24;

/// Sign of n₀ + n₁ s + n₂ s² at s = j/GRID, exactly.
fn sign_at(n: [i64; 3], j: i128) -> Sign {
    let [n0, n1, n2] = n.map(i128::from);
    sign_of(n0 * GRID * GRID + n1 * j * GRID + n2 * j * j)
}

fn sign_of(n: i128) -> Sign {
    match n.cmp(&0) {
        Ordering::Less => Sign::Negative,
        Ordering::Equal => Sign::Zero,
        Ordering::Greater => Sign::Positive,
    }
}

/// The first s, to 1/GRID, at which the polynomial has the sign opposite to the one just right of 0.
///
/// Walks over cells of 1/16. Inside a cell only a pair of roots can hide; it is there if the vertex is and
/// has the opposite sign, which the exact discriminant tells.
fn search(n: [i64; 3], sign: Sign) -> Option<f64> {
    let [n0, n1, n2] = n.map(i128::from);
    let turned = |j: i128| sign_at(n, j) == sign.opposite();
    let cell = GRID / 16;
    // all roots are below 1 + max |n| / |last| <= 1 + 2^11
    let last = 2050 * GRID;
    let crosses_twice = n2 != 0 && n1 * n1 - 4 * n0 * n2 > 0;
    let mut from = 0;
    while from < last {
        let to = from + cell;
        // vertex −n₁/2n₂ in (from, to)?
        let (vertex, unit) = (-n1 * GRID * n2.signum(), 2 * n2.abs());
        let hides_pair = crosses_twice && sign_of(n2) == sign && from * unit < vertex && vertex < to * unit;
        let end = if turned(to) {
            Some(to as f64)
        } else if hides_pair {
            Some(vertex as f64 / unit as f64)
        } else {
            None
        };
        if let Some(end) = end {
            // the lower root of the quadratic in this cell, bisected in exact integers where it can be
            let (mut lo, mut hi) = (from, end as i128);
            if !turned(hi) {
                return Some(end / GRID as f64); // the pair is thinner than the grid
            }
            while hi - lo > 1 {
                let middle = i128::midpoint(lo, hi);
                if turned(middle) { hi = middle } else { lo = middle }
            }
            return Some(hi as f64 / GRID as f64);
        }
        from = to;
    }
    None
}

fn assert_equal_to_search(n: [i64; 3]) -> Result<(), TestCaseError> {
    let c = n.map(|n| n as f64 / 64.0);
    let sign = Sign::after(&c);
    prop_assume!(sign != Sign::Zero);
    prop_assert_eq!(parabola_crossing(c, sign.opposite()), Some(0.0));
    prop_assert_eq!(parabola_crossing(c, Sign::Zero), Some(0.0));
    let (found, expected) = (parabola_crossing(c, sign), search(n, sign));
    match (found, expected) {
        (Some(found), Some(expected)) => {
            let tolerance = 1.001 / GRID as f64 + 4.0 * f64::EPSILON * expected;
            prop_assert!((found - expected).abs() <= tolerance, "{:?}: {} {}", n, found, expected);
        }
        _ => prop_assert_eq!(found, expected, "{:?}", n),
    }
    Ok(())
}

/// Failures are not written into the source tree; a case worth keeping becomes a test of its own.
fn cases(cases: u32) -> ProptestConfig {
    ProptestConfig { cases, failure_persistence: None, ..ProptestConfig::default() }
}

proptest! {
    #![proptest_config(cases(400))]

    #[test]
    fn random_coefficients(n in [-2000_i64..2000, -2000_i64..2000, -2000_i64..2000]) {
        assert_equal_to_search(n)?;
    }

    /// Zeros among the coefficients, roots at 0, double roots, straight lines.
    #[test]
    fn few_small_coefficients(n in [-4_i64..5, -4_i64..5, -4_i64..5]) {
        assert_equal_to_search(n)?;
    }
}

proptest! {
    #![proptest_config(cases(20_000))]

    /// a (s − p)(s − q) with p, q in 64ths: the answer is known.
    #[test]
    fn known_roots(a in 1_i64..9, p in -640_i64..640, q in -640_i64..640, negative: bool) {
        let a = if negative { -a } else { a };
        let c = [(a * p * q) as f64 / 4096.0, (-a * (p + q)) as f64 / 64.0, a as f64];
        let sign = Sign::after(&c);
        let first = [p.min(q), p.max(q)].into_iter().find(|&r| r > 0);
        let expected = first.filter(|_| p != q).map(|r| r as f64 / 64.0);
        prop_assert_eq!(parabola_crossing(c, sign), expected);
    }

    /// Coefficients of 52 bits whose discriminant is nearly or exactly zero: its sign decides.
    #[test]
    fn nearly_double_roots(a in 1_i64 << 50..1_i64 << 51, b in 1_i64 << 50..1_i64 << 51, off in -3_i128..4) {
        let product = 4 * i128::from(a) * i128::from(b);
        let middle = -((product as f64).sqrt() as i128 + off);
        prop_assume!(middle.abs() < 1 << 53);
        let crosses = middle * middle > product;
        let c = [a as f64, middle as f64, b as f64];
        let found = parabola_crossing(c, Sign::Positive);
        prop_assert_eq!(found.is_some(), crosses, "{:?}", c);
        // both roots are near the vertex
        let vertex = -c[1] / (2.0 * c[2]);
        prop_assert!(found.is_none_or(|s| (s / vertex - 1.0).abs() < 1e-7));
    }

    #[test]
    fn exact_double_roots(k in 1_i64..1 << 26, m in 1_i64..1 << 25) {
        let c = [(k * k) as f64, (-2 * k * m) as f64, (m * m) as f64];
        prop_assert_eq!(parabola_crossing(c, Sign::Positive), None);
        prop_assert_eq!(parabola_crossing(c.map(|c| -c), Sign::Negative), None);
    }

    /// Powers of two in s and in the value change nothing but the exponent of the root.
    #[test]
    fn scales(c in [-4.0..4.0, -4.0..4.0, -4.0..4.0], m in -500_i32..500, k in -200_i32..200) {
        let sign = Sign::after(&c);
        let scaled = [libm::scalbn(c[0], m), libm::scalbn(c[1], m + k), libm::scalbn(c[2], m + 2 * k)];
        let expected = parabola_crossing(c, sign).map(|s| libm::scalbn(s, -k));
        prop_assert_eq!(parabola_crossing(scaled, sign), expected);
    }

    /// Any three doubles: the result is a delay, and mirrored polynomials cross together.
    #[test]
    fn all_doubles(c in [prop::num::f64::ANY, prop::num::f64::ANY, prop::num::f64::ANY]) {
        for sign in [Sign::Negative, Sign::Zero, Sign::Positive] {
            let s = parabola_crossing(c, sign);
            prop_assert!(s.is_none_or(|s| s.is_finite() && s >= 0.0));
            prop_assert_eq!(s, parabola_crossing(c.map(|c| -c), sign.opposite()));
        }
    }
}
