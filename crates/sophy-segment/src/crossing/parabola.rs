//! First sign change of a parabola, in closed form.

use crate::Sign;
use crate::exact::two_product;

/// Delay until `c₀ + c₁ s + c₂ s²`, s >= 0, first leaves `sign` for the opposite sign, or `None` if never.
///
/// `sign` is the sign decided just right of s = 0, by [`Sign::after`] or remembered from the segment before.
///
/// | `sign` | the parabola begins | result |
/// | --- | --- | --- |
/// | ±1 | with `sign` | the first root at which the sign changes, if any |
/// | ±1 | with the other sign | 0: the crossing is at the joint |
/// | ±1 | identically zero | 0: the truth changes to that at zero |
/// | 0 | identically zero | `None` |
/// | 0 | with either sign | 0 |
///
/// Touching (a double root) is not crossing, and neither is leaving the surface at s = 0 on the side of
/// `sign`. Coefficients that are not finite give `None`: engines check values before they ask. A crossing
/// beyond the largest double gives `None` as well.
///
/// - `c`: coefficients in the watch's unit, per s and per s² of delay
/// - returns the delay in s, `>= 0`, the root to about an ulp at any scale of the coefficients: the root
///   formula is the one without cancellation, 2c₀/(−c₁ + √D) or (−c₁ − √D)/2c₂, and D, whose sign tells
///   touching from crossing, is computed without losing the errors of its two products.
#[must_use]
#[inline]
pub fn parabola_crossing(c: [f64; 3], sign: Sign) -> Option<f64> {
    let [c0, c1, c2] = c;
    if !(c0.is_finite() && c1.is_finite() && c2.is_finite()) {
        return None;
    }
    let begins = Sign::after(&c);
    if begins != sign {
        return Some(0.0);
    }
    match sign {
        Sign::Positive => first_fall([c0, c1, c2]),
        Sign::Negative => first_fall([-c0, -c1, -c2]),
        Sign::Zero => None,
    }
}

/// The s > 0 at which a parabola that is positive just right of 0 turns negative.
#[inline]
pub(super) fn first_fall([p0, p1, p2]: [f64; 3]) -> Option<f64> {
    if p2 >= 0.0 && (p1 >= 0.0 || p0 == 0.0) {
        return None;
    }
    if p2 == 0.0 {
        return finite(p0 / -p1);
    }
    if p0 == 0.0 {
        return finite(-(p1 / p2));
    }
    let (p1_squared, p0_p2) = (p1 * p1, 4.0 * p0 * p2);
    let ordinary = is_ordinary(p0) && is_ordinary(p2) && is_ordinary(p0_p2) && p1_squared < LARGE;
    if ordinary && (p1_squared > SMALL || p1 == 0.0) {
        fall([p0, p1, p2])
    } else {
        fall_at_any_scale([p0, p1, p2])
    }
}

/// [`first_fall`] for p₀ > 0, p₂ ≠ 0 and products that neither overflow nor underflow.
#[inline]
fn fall([p0, p1, p2]: [f64; 3]) -> Option<f64> {
    let d = discriminant(p0, p1, p2);
    if p2 > 0.0 {
        // p₁ < 0: two positive roots, the smaller one, if they are two
        if d > 0.0 { finite(2.0 * p0 / (d.sqrt() - p1)) } else { None }
    } else if p1 > 0.0 {
        finite((p1 + d.sqrt()) / (-2.0 * p2))
    } else {
        finite(2.0 * p0 / (d.sqrt() - p1))
    }
}

/// p₁² − 4 p₀ p₂ with the right sign.
#[inline]
fn discriminant(p0: f64, p1: f64, p2: f64) -> f64 {
    let plain = p1 * p1 - 4.0 * p0 * p2;
    if plain > 0.25 * (p1 * p1) {
        return plain;
    }
    // The products are near each other: their difference is exact, and that of their errors decides.
    let (square, square_error) = two_product(p1, p1);
    let (product, product_error) = two_product(4.0 * p0, p2);
    (square - product) + (square_error - product_error)
}

/// [`first_fall`] for p₀ > 0, p₂ ≠ 0: the parabola is scaled to p₀, |p₂| in [1, 8) by powers of two.
#[cold]
fn fall_at_any_scale([p0, p1, p2]: [f64; 3]) -> Option<f64> {
    // s = 2^k u turns p₂ s² into p₂ 2^2k u², of the size of p₀
    let (e0, e2) = (libm::ilogb(p0), libm::ilogb(p2));
    let k = (e0 - e2).div_euclid(2);
    let e1 = if p1 == 0.0 { -NEGLIGIBLE } else { libm::ilogb(p1) + k - e0 };
    if e1 >= NEGLIGIBLE {
        // one of the outer terms is far away: a straight line from p₀ or a parabola from 0
        return if p1 < 0.0 {
            finite(p0 / -p1)
        } else if p2 < 0.0 {
            finite(-(p1 / p2))
        } else {
            None
        };
    }
    let q0 = scaled(p0, -e0);
    let q1 = if e1 <= -NEGLIGIBLE { 0.0 } else { scaled(p1, k - e0) };
    let q2 = scaled(p2, 2 * k - e0);
    fall([q0, q1, q2]).and_then(|u| finite(scaled(u, k)))
}

/// x 2^n for n beyond what one multiplication reaches.
pub(super) fn scaled(x: f64, n: i32) -> f64 {
    libm::scalbn(libm::scalbn(x, n / 2), n - n / 2)
}

#[inline]
pub(super) fn finite(s: f64) -> Option<f64> {
    s.is_finite().then_some(s)
}

/// Whether products of `x` by numbers of like size neither overflow nor lose bits.
#[inline]
fn is_ordinary(x: f64) -> bool {
    x.abs() < LARGE && x.abs() > SMALL
}

/// 2^900.
const LARGE: f64 = f64::from_bits((1023 + 900) << 52);
/// 2^−900.
const SMALL: f64 = f64::from_bits((1023 - 900) << 52);
/// From 2^120 on, one part of the discriminant no longer changes the root's bits.
const NEGLIGIBLE: i32 = 120;

#[cfg(test)]
mod tests {
    use super::parabola_crossing;
    use crate::Sign::{self, Negative, Positive, Zero};

    #[test]
    fn conventions() {
        let table: [([f64; 3], Sign, Option<f64>); 24] = [
            // begins with the decided sign
            ([1.0, -2.0, 0.0], Positive, Some(0.5)),
            ([1.0, 2.0, 0.0], Positive, None),
            ([1.0, 2.0, 3.0], Positive, None),
            ([3.0, -4.0, 1.0], Positive, Some(1.0)),
            ([-3.0, 4.0, -1.0], Negative, Some(1.0)),
            ([-3.0, 2.0, 1.0], Negative, Some(1.0)),
            ([1.0, 0.0, -1.0], Positive, Some(1.0)),
            ([1.0, 0.0, 1.0], Positive, None),
            ([5.0, 0.0, 0.0], Positive, None),
            // on the surface, leaving to the decided side
            ([0.0, 1.0, 0.0], Positive, None),
            ([0.0, 2.0, -1.0], Positive, Some(2.0)),
            ([-0.0, 2.0, -1.0], Positive, Some(2.0)),
            ([0.0, 0.0, 1.0], Positive, None),
            ([0.0, 2.0, 1.0], Positive, None),
            // touching
            ([1.0, -2.0, 1.0], Positive, None),
            ([-1.0, 2.0, -1.0], Negative, None),
            // begins with the other sign: the joint
            ([1.0, -2.0, 0.0], Negative, Some(0.0)),
            ([0.0, -1.0, 9.0], Positive, Some(0.0)),
            ([0.0, 0.0, -1.0], Positive, Some(0.0)),
            // identically zero, before or now
            ([0.0, -0.0, 0.0], Positive, Some(0.0)),
            ([0.0, -0.0, 0.0], Zero, None),
            ([0.0, 0.0, 1.0], Zero, Some(0.0)),
            // not finite
            ([f64::NAN, 1.0, 1.0], Negative, None),
            ([1.0, f64::NEG_INFINITY, 1.0], Positive, None),
        ];
        for (c, sign, crossing) in table {
            assert_eq!(parabola_crossing(c, sign), crossing, "{c:?} {sign:?}");
        }
    }

    #[test]
    fn extreme_scales() {
        let (big, small, least) = (1e300, 1e-300, f64::from_bits(1));
        assert_eq!(
            parabola_crossing([big, -big, -big], Positive),
            parabola_crossing([1.0, -1.0, -1.0], Positive)
        );
        assert_eq!(
            parabola_crossing([small, -4.0 * small, 3.0 * small], Positive).map(|s| s as f32),
            Some(1.0 / 3.0)
        );
        // s = p₀/|p₁| or √(p₀/|p₂|) where the third term does not matter
        assert_eq!(parabola_crossing([big, -1.0, -least], Positive), Some(1e300));
        assert_eq!(parabola_crossing([small, small, -big], Positive), Some(1e-300));
        assert_eq!(parabola_crossing([1.0, big, -small], Positive), None);
        assert_eq!(parabola_crossing([1.0, big, -1.0], Positive), Some(1e300));
        assert_eq!(parabola_crossing([4.0 * least, 0.0, -least], Positive), Some(2.0));
        assert_eq!(parabola_crossing([least, -2.0 * least, least], Positive), None);
        assert_eq!(
            parabola_crossing([f64::MAX, -f64::MAX, f64::MAX / 8.0], Positive).map(|s| s as f32),
            Some(1.171_572_9)
        );
    }
}
