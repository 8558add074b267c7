//! First sign change of a cubic, and when a cubic leaves a band about zero.
//!
//! The turns of the cubic cut s >= 0 into pieces on which it rises or falls; the first piece at whose end it is beyond
//! the level holds the root. There Newton's method starts where it converges from one side: where value and curvature
//! have one sign, or at the point of inflection between two turns, where the cubic is steepest.

use super::parabola::{finite, first_fall as parabola_first_fall, parabola_crossing, scaled};
use super::reach::{ENOUGH, first_reach, rising_root};
use crate::Sign;
use crate::exact::{two_product, two_sum};

/// Delay until `c₀ + c₁ s + c₂ s² + c₃ s³`, s >= 0, first leaves `sign` for the opposite sign, or `None` if never.
///
/// Its conventions are those of [`parabola_crossing`], which also answers if `c₃` is 0. A turn whose value is beyond
/// zero by less than rounding of the sixth order of magnitude (2⁻¹⁰⁰ of its terms) counts as touching.
///
/// - `c`: coefficients in the watch's unit, per s, per s² and per s³ of delay
/// - returns the delay in s, `>= 0`
#[must_use]
#[inline]
pub fn cubic_crossing(c: [f64; 4], sign: Sign) -> Option<f64> {
    let [c0, c1, c2, c3] = c;
    if c3 == 0.0 {
        return parabola_crossing([c0, c1, c2], sign);
    }
    if !c.iter().all(|c| c.is_finite()) {
        return None;
    }
    if Sign::after(&c) != sign {
        return Some(0.0);
    }
    let fall = if c.into_iter().all(is_ordinary) { first_fall } else { fall_at_any_scale };
    match sign {
        Sign::Positive => fall(c),
        Sign::Negative => fall(c.map(|c| -c)),
        Sign::Zero => None,
    }
}

/// Delay until `|d₀ + d₁ s + d₂ s² + d₃ s³|`, s >= 0, first reaches `band`; infinite if never, 0 if it is there already.
#[must_use]
#[inline(always)]
pub fn cubic_leaves(d: [f64; 4], band: f64) -> f64 {
    // In most cases it leaves the band where d₃ leads at last.
    match leaves_above(mirrored(d, d[3]), band) {
        Some(s) => s,
        None => leaves_elsewhere(d, band),
    }
}

/// That delay, if the upper edge is plainly the first that it reaches.
#[inline(always)]
fn leaves_above([d0, d1, d2, d3]: [f64; 4], band: f64) -> Option<f64> {
    let s = first_reach([d1, d2, d3], band - d0)?;
    // What leads down would not have been enough for the lower edge, even alone and all the way.
    let falling = |d: f64| if d < 0.0 { d } else { 0.0 };
    let fall = s * (falling(d1) + s * (falling(d2) + s * falling(d3)));
    if band + d0 + fall > 0.0 { Some(s) } else { None }
}

#[inline(always)]
fn mirrored(d: [f64; 4], side: f64) -> [f64; 4] {
    let side = 1.0_f64.copysign(side);
    d.map(|d| side * d)
}

/// That delay, at the other edge or by a search.
#[cold]
fn leaves_elsewhere(d: [f64; 4], band: f64) -> f64 {
    leaves_above(mirrored(d, -d[3]), band).unwrap_or_else(|| leaves_by_pieces(d, band))
}

/// That delay, whatever the cubic does.
fn leaves_by_pieces(d: [f64; 4], band: f64) -> f64 {
    let [d0, d1, d2, d3] = d;
    let is_inside = d0.abs() < band;
    if !is_inside {
        return 0.0;
    }
    if d3 != 0.0 && d1 * d3 >= 0.0 && d2 * d3 >= 0.0 {
        // It moves in one direction only.
        return rising_root([d1.abs(), d2.abs(), d3.abs()], band - d0 * d3.signum());
    }
    let cubic = Cubic(d);
    let (turns, count) = cubic.turns();
    let mut from = 0.0;
    let mut rises = Sign::after(&[d1, d2, d3]) == Sign::Positive;
    for &to in &turns[..count] {
        let edge = if rises { band } else { -band };
        let beyond = cubic.at(to) - edge;
        if if rises { beyond >= 0.0 } else { beyond <= 0.0 } {
            return Cubic([d0 - edge, d1, d2, d3]).root_between::<NEAR>(from, to);
        }
        (from, rises) = (to, !rises);
    }
    if d1 == 0.0 && d2 == 0.0 && d3 == 0.0 {
        return f64::INFINITY;
    }
    let edge = if rises { band } else { -band };
    Cubic([d0 - edge, d1, d2, d3]).root_behind::<NEAR>(from)
}

/// The s > 0 at which a cubic (c₃ ≠ 0) that is positive just right of 0 turns negative.
fn first_fall(p: [f64; 4]) -> Option<f64> {
    let [p0, p1, p2, p3] = p;
    if p0 == 0.0 {
        return parabola_first_fall([p1, p2, p3]);
    }
    if p3 > 0.0 && p1 >= 0.0 && p2 >= 0.0 {
        return None;
    }
    let cubic = Cubic(p);
    let (turns, count) = cubic.turns();
    let mut from = 0.0;
    let mut falls = Sign::after(&[p1, p2, p3]) == Sign::Negative;
    for &to in &turns[..count] {
        if falls && cubic.is_negative_at(to) {
            return finite(cubic.root_between::<EXACT>(from, to));
        }
        (from, falls) = (to, !falls);
    }
    if falls { finite(cubic.root_behind::<EXACT>(from)) } else { None }
}

/// [`first_fall`] of a cubic scaled by powers of two, in value and in s, to c₀ of about 1 and no larger coefficients.
#[cold]
fn fall_at_any_scale(p: [f64; 4]) -> Option<f64> {
    let [p0, p1, p2, p3] = p;
    if p0 == 0.0 {
        return parabola_first_fall([p1, p2, p3]);
    }
    let e0 = libm::ilogb(p0);
    let room =
        (1..4).filter(|&k| p[k as usize] != 0.0).map(|k| (e0 - libm::ilogb(p[k as usize])).div_euclid(k));
    let scale = room.min()?;
    let [q0, q1, q2, q3] = std::array::from_fn(|k| scaled(p[k], k as i32 * scale - e0));
    let fall = if q3 == 0.0 {
        parabola_crossing([q0, q1, q2], Sign::Positive)
    } else {
        first_fall([q0, q1, q2, q3])
    };
    fall.and_then(|u| finite(scaled(u, scale)))
}

/// Whether squares of `x` times small numbers neither overflow nor lose bits.
#[inline]
fn is_ordinary(x: f64) -> bool {
    x == 0.0 || (x.abs() < LARGE && x.abs() > SMALL)
}

/// 2^240.
const LARGE: f64 = f64::from_bits((1023 + 240) << 52);
/// 2^−240.
const SMALL: f64 = f64::from_bits((1023 - 240) << 52);

/// Coefficients, the constant first.
#[derive(Clone, Copy, Debug)]
struct Cubic([f64; 4]);

impl Cubic {
    #[inline]
    fn at(self, s: f64) -> f64 {
        let [c0, c1, c2, c3] = self.0;
        c0 + s * (c1 + s * (c2 + s * c3))
    }

    #[inline]
    fn slope_at(self, s: f64) -> f64 {
        let [_, c1, c2, c3] = self.0;
        c1 + s * (2.0 * c2 + s * (3.0 * c3))
    }

    /// Where it turns at s > 0, in order, and how many such places there are.
    #[inline]
    fn turns(self) -> ([f64; 2], usize) {
        let [_, c1, c2, c3] = self.0;
        let d = c2 * c2 - 3.0 * c1 * c3;
        if d <= 0.0 {
            return ([0.0; 2], 0);
        }
        let w = -(c2 + d.sqrt().copysign(c2));
        let (a, b) = (w / (3.0 * c3), c1 / w);
        let (low, high) = if a < b { (a, b) } else { (b, a) };
        match (low > 0.0 && low < f64::INFINITY, high > 0.0 && high < f64::INFINITY) {
            (true, true) => ([low, high], 2),
            (true, false) => ([low, 0.0], 1),
            (false, true) => ([high, 0.0], 1),
            (false, false) => ([0.0; 2], 0),
        }
    }

    /// Whether it is negative at a place where it turns; what rounding leaves of zero is not.
    fn is_negative_at(self, s: f64) -> bool {
        let plain = self.at(s);
        let [c0, c1, c2, c3] = self.0.map(f64::abs);
        let terms = c0 + s * (c1 + s * (c2 + s * c3));
        if plain.abs() > 8.0 * f64::EPSILON * terms {
            return plain < 0.0;
        }
        self.compensated_at(s) < -(terms * TOUCHING)
    }

    /// Horner's scheme in doubled precision (Ogita, Rump, Oishi, *Accurate sum and dot product*, SIAM J. Sci. Comput.
    /// 26, 2005).
    fn compensated_at(self, s: f64) -> f64 {
        let [c0, c1, c2, c3] = self.0;
        let (mut value, mut error) = (c3, 0.0);
        for c in [c2, c1, c0] {
            let (product, of_product) = two_product(value, s);
            let (sum, of_sum) = two_sum(product, c);
            (value, error) = (sum, error * s + (of_product + of_sum));
        }
        value + error
    }

    /// f f′/(f′² − ½ f f″): how far s is behind the root, by Halley's method.
    #[inline]
    fn halley_step(self, s: f64) -> f64 {
        let [_, _, c2, c3] = self.0;
        let (value, slope, bend) = (self.at(s), self.slope_at(s), c2 + s * (3.0 * c3));
        value * slope / (slope * slope - value * bend)
    }

    /// The root in a piece without turns, at whose ends the cubic has different signs.
    #[inline]
    fn root_between<const PRECISION: u8>(self, from: f64, to: f64) -> f64 {
        let [_, _, c2, c3] = self.0;
        let inflection = -c2 / (3.0 * c3);
        let start = if inflection > from && inflection < to {
            // Up to its inflection it becomes steeper, which may be very far: the root is not behind where the slope of
            // `from`, or two thirds of the curvature there, would lead.
            let (value, curvature) = (self.at(from), c2 + 3.0 * c3 * from);
            let by_line = from + (value / self.slope_at(from)).abs();
            let by_square = from + (1.5 * (value / curvature).abs()).sqrt();
            let near = if by_line < by_square { by_line } else { by_square };
            if near < inflection { near } else { inflection }
        } else {
            // Value and curvature have one sign at one end.
            let curvature = c2 + 1.5 * c3 * (from + to);
            if self.at(from) * curvature > 0.0 { from } else { to }
        };
        self.root_from::<PRECISION>(start, from, to)
    }

    /// The root behind the last turn; infinite if it is beyond all numbers.
    #[inline]
    fn root_behind<const PRECISION: u8>(self, from: f64) -> f64 {
        let [_, _, c2, c3] = self.0;
        let inflection = -c2 / (3.0 * c3);
        let mut from = from;
        if inflection > from && inflection < f64::INFINITY {
            // No turn is behind `from`, so that up to its inflection the cubic becomes flatter.
            if self.at(inflection) * self.at(from) <= 0.0 {
                return self.root_from::<PRECISION>(from, from, inflection);
            }
            from = inflection;
        }
        // All derivatives lead to the root.
        let (value, slope, curvature) = (self.at(from), self.slope_at(from), c2 + 3.0 * c3 * from);
        let near = from + rising_root([slope.abs(), curvature.abs(), c3.abs()], value.abs());
        if PRECISION == NEAR {
            return near;
        }
        // Twice as many digits and more, so that Newton's method begins where only rounding is left.
        let step = self.halley_step(near);
        let nearer = if step.is_finite() { near - step } else { near };
        self.newton(nearer, from, f64::INFINITY)
    }

    /// The root between two places, from a start from which Newton's method converges from one side.
    #[inline]
    fn root_from<const PRECISION: u8>(self, start: f64, from: f64, to: f64) -> f64 {
        if PRECISION == NEAR {
            let mut s = start;
            for _ in 0..MOST_NEAR_STEPS {
                let step = self.halley_step(s);
                let next = s - step;
                let is_inside = next >= from && next <= to;
                if !is_inside {
                    break;
                }
                s = next;
                if step.abs() <= ENOUGH * s {
                    return s;
                }
            }
        }
        self.newton(start, from, to)
    }

    /// Newton's method from a point from which it converges from one side, until it does not.
    #[inline]
    fn newton(self, start: f64, from: f64, to: f64) -> f64 {
        let mut s = start;
        let mut before = 0.0;
        for _ in 0..MOST_STEPS {
            let value = self.at(s);
            let step = -value / self.slope_at(s);
            // Rounding turns it round at the root, or makes it grow.
            if value == 0.0 || !step.is_finite() || step * before < 0.0 {
                break;
            }
            let next = (s + step).clamp(from, to);
            if next == s {
                break;
            }
            (s, before) = (next, step);
        }
        s
    }
}

/// A root to the last digits, for crossings.
const EXACT: u8 = 0;
/// A root at which the cubic is zero to 5 digits of its terms, for bands.
const NEAR: u8 = 1;
/// A turn is beyond zero if it is by this part of its terms.
const TOUCHING: f64 = 1.0 / (1_u128 << 100) as f64;
/// From a point on one side Newton's method takes fewer than ten.
const MOST_STEPS: u32 = 64;
/// Halley's method takes two or three; where it does not, Newton's is surer.
const MOST_NEAR_STEPS: u32 = 8;

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn of_any_size() -> impl Strategy<Value = f64> {
        prop_oneof![6 => (-2.0f64..2.0, -12i32..12).prop_map(|(c, e)| libm::scalbn(c, e)), 1 => Just(0.0)]
    }

    proptest! {
        #![proptest_config(ProptestConfig { cases: 50_000, failure_persistence: None, ..ProptestConfig::default() })]

        /// What is found without a search is what the search finds, at any scale of value and time.
        #[test]
        fn the_quick_way_out_of_a_band(
            d0 in prop_oneof![
                4 => -1.0f64..1.0,
                1 => Just(0.0),
                1 => (0i32..50).prop_map(|e| 1.0 - libm::scalbn(1.0, -e)),
            ],
            d1 in of_any_size(), d2 in of_any_size(), d3 in of_any_size(),
            time in -40i32..40, value in -60i32..60,
        ) {
            let d: [f64; 4] = std::array::from_fn(|k| libm::scalbn([d0, d1, d2, d3][k], value + time * k as i32));
            let band = libm::scalbn(1.0, value);
            let (found, searched) = (cubic_leaves(d, band), leaves_by_pieces(d, band));
            let is_near = found == searched || (found / searched - 1.0).abs() < 3e-6;
            // Beside a turn at the edge both are right, if nothing is beyond it between them.
            let (from, to) = if found < searched { (found, searched) } else { (searched, found) };
            let is_inside = |s: f64| {
                let size = Cubic(d.map(f64::abs)).at(s);
                Cubic(d).at(s).abs() - band < 1e-5 * size
            };
            let touches = || (0..=200).all(|k| is_inside(from + (to - from) * f64::from(k) / 200.0));
            prop_assert!(is_near || touches(), "{d:?} {band:e}: {found:e} {searched:e}");
        }
    }
}
