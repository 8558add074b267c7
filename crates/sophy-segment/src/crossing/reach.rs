//! How soon a cubic without constant reaches a value, to 6 digits, and roots of third powers.
//!
//! The mean slope on the way, w = value/s, fulfils w³ = c₁ w² + c₂ value w + c₃ value², for which nothing is divided;
//! the first s > 0 belongs to the largest w > 0. Without its square, by w = y + c₁/3, it is y³ = p y + r. In units of
//! about (p³ + r²)^(1/6), y is near 1 whatever p and r >= 0 are, so that a polynomial of both has three digits of it,
//! and one step of Halley's method the rest. Then comes the only division.

/// The s > 0 at which `c₁ s + c₂ s² + c₃ s³` reaches `value`, to 6 digits.
///
/// - `c`: c₁, c₂ and c₃, not negative and not all 0
/// - `value`: positive
#[must_use]
#[inline]
pub fn rising_root(c: [f64; 3], value: f64) -> f64 {
    match first_reach(c, value) {
        Some(s) => s,
        None => rising_root_at_any_scale(c, value),
    }
}

/// The first s > 0 at which `c₁ s + c₂ s² + c₃ s³` reaches `value`, to 6 digits.
///
/// `None` says nothing: `value` is not positive, numbers are too large or small, or w is what is left of others that
/// cancel. Terms that all rise have a root of ordinary size always, so has a cubic with others small beside c₃.
#[inline(always)]
pub(super) fn first_reach([c1, c2, c3]: [f64; 3], value: f64) -> Option<f64> {
    let third = c1 * (1.0 / 3.0);
    let square = third * third;
    let c2 = c2 * value;
    let q = c2 + 2.0 * square;
    let p = q + square;
    let r = third * q + (c3 * value) * value;
    let size = r * r + p * (p * p);
    let unit = f64::from_bits(INVERSE_SIXTH_ROOT_OF_ONE.wrapping_sub(size.to_bits() / 6));
    let (third, p, r) = (third * unit, p * (unit * unit), (r * unit) * (unit * unit));
    // Beyond these, other roots come near or digits of w are lost. Terms that rise have a third of 0 to 0.59.
    let is_sure = (f64::MIN_POSITIVE..=f64::MAX).contains(&size)
        && r >= 0.0
        && p >= LEAST_P
        && third.abs() <= 0.65
        && value > 0.0;
    if !is_sure {
        return None;
    }
    let y = near_largest_root(p, r);
    // Halley's method: y − f f′/(f′² − ½ f f″), over one denominator with what follows.
    let square = y * y;
    let rest = y * (square - p) - r;
    let slope = (square - p) + (square + square);
    let steep = slope * slope - (3.0 * y) * rest;
    Some((value * unit) * steep / (steep * (y + third) - rest * slope))
}

/// The largest root y of y³ = p y + r to 5e-4, for r >= 0, p >= [`LEAST_P`] and p³ + r² between 0.82 and 1.2.
#[inline(always)]
fn near_largest_root(p: f64, r: f64) -> f64 {
    let pp = p * p;
    let c0 = (0.446_318_84 + 0.606_207_74 * p) + pp * (-0.045_091_42 - 0.007_644_52 * p);
    let c1 = 0.879_275_25 + p * (0.046_070_35 * p - 0.434_969_31);
    let c2 = (-0.425_362_37 + 0.161_354_63 * p) + 0.099_888_18 * r;
    c0 + r * (c1 + r * c2)
}

const LEAST_P: f64 = -0.5;

/// 7/6 of the bits of 1, less what makes the error smallest: with a sixth of the bits of x taken from it they are those
/// of x^(−1/6) to 3.1 %.
const INVERSE_SIXTH_ROOT_OF_ONE: u64 = 0x4A97_1800_0000_0000;

#[cold]
fn rising_root_at_any_scale([c1, c2, c3]: [f64; 3], value: f64) -> f64 {
    // Not before the root, and by less than half of it behind: where any one term alone would reach the value.
    let mut s = 1.0001 * near_cube_root(value / c3);
    for alone in [1.0001 * (value / c2).sqrt(), value / c1] {
        s = if alone < s { alone } else { s };
    }
    // From there Halley's method comes down.
    for _ in 0..MOST_STEPS {
        let rest = s * (c1 + s * (c2 + s * c3)) - value;
        let (slope, bend) = (c1 + s * (2.0 * c2 + s * (3.0 * c3)), c2 + s * (3.0 * c3));
        let step = rest * slope / (slope * slope - rest * bend);
        s -= step;
        if step.abs() <= ENOUGH * s || step.is_nan() {
            break;
        }
    }
    s
}

/// Halley's method has three digits for each that it had before: after so small a step, relative to s, 6 of them. A band
/// is a matter of taste: one that is left a millionth later is as good.
pub(super) const ENOUGH: f64 = 1e-2;
/// Halley's method takes two or three.
const MOST_STEPS: u32 = 64;

/// The s > 0 at which `|c₃| s³` reaches `value` > 0, to 8 digits; infinite if c₃ is 0.
#[must_use]
#[inline]
pub fn cube_reach(c3: f64, value: f64) -> f64 {
    let c3 = c3.abs();
    let cube = c3 * value * value;
    if !(f64::MIN_POSITIVE..=f64::MAX).contains(&cube) {
        return cube_root(value / c3);
    }
    // w³ = c₃ value², and s = value/w.
    let unit = f64::from_bits(INVERSE_CUBE_ROOT_OF_ONE - cube.to_bits() / 3);
    let [p0, p1, p2, p3, p4, p5] = INVERSE_CUBE_ROOT_BESIDE_ONE;
    let x = 1.0 - (cube * unit) * (unit * unit);
    let square = x * x;
    (value * unit) * ((p0 + p1 * x) + square * ((p2 + p3 * x) + square * (p4 + p5 * x)))
}

/// 4/3 of the bits of 1, less what makes the error smallest: with a third of the bits of x taken from it they are those
/// of ∛(1/x) to 3.7 %.
const INVERSE_CUBE_ROOT_OF_ONE: u64 = 0x553E_E000_0000_0000;

/// (1 − x)^(−1/3) to 5e-9 for |x| < 0.107, interpolated at Chebyshev's nodes.
const INVERSE_CUBE_ROOT_BESIDE_ONE: [f64; 6] = [
    1.000_000_005_291_304_3,
    0.333_333_350_124_936_15,
    0.222_213_918_685_842_1,
    0.172_827_797_511_014_35,
    0.145_959_806_715_521_56,
    0.126_865_368_295_473_82,
];

/// ∛x of a positive number to a few ulp, by multiplications and divisions only.
#[must_use]
#[inline]
pub fn cube_root(x: f64) -> f64 {
    // Beyond the normal numbers the first guess is none.
    if !(f64::MIN_POSITIVE..=f64::MAX / 8.0).contains(&x) {
        return libm::cbrt(x);
    }
    let near = near_cube_root(x);
    // 1/∛r for r near 1 to 23 bits, as FreeBSD's `cbrt` has it; then Halley's method once.
    let r = near * near * (near / x);
    let [p0, p1, p2, p3, p4] = INVERSE_CUBE_ROOT;
    let root = near * ((p0 + r * (p1 + r * p2)) + (r * r * r) * (p3 + r * p4));
    let cube = root * root * root;
    root * ((cube + 2.0 * x) / (2.0 * cube + x))
}

/// ∛x to 4 %, a third of the exponent and of the fraction with it (W. Kahan).
#[inline]
fn near_cube_root(x: f64) -> f64 {
    f64::from_bits(x.to_bits() / 3 + CUBE_ROOT_OF_ONE)
}

const INVERSE_CUBE_ROOT: [f64; 5] = [
    1.875_951_824_271_77,
    -1.884_979_795_433_771_7,
    1.621_429_720_105_354_5,
    -0.758_397_934_778_766,
    0.145_996_192_886_612_45,
];

/// Two thirds of the bits of 1, less what makes the error smallest.
const CUBE_ROOT_OF_ONE: u64 = 0x2A9F_7893_0000_0000;
