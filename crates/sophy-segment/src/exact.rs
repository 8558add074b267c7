//! Sums and products together with their rounding errors, without fused multiply-add.
//!
//! T. J. Dekker, *A floating-point technique for extending the available precision*, Numer. Math. 18
//! (1971); D. E. Knuth, *The Art of Computer Programming* 2, §4.2.2.

/// `(s, e)` with `s = fl(a + b)` and `a + b = s + e` exactly, unless the sum overflows.
#[inline]
pub(crate) fn two_sum(a: f64, b: f64) -> (f64, f64) {
    let s = a + b;
    let b_in_s = s - a;
    (s, (a - (s - b_in_s)) + (b - b_in_s))
}

/// `(p, e)` with `p = fl(a b)` and `a b = p + e` exactly, where [`product_is_exact`] holds.
#[inline]
pub(crate) fn two_product(a: f64, b: f64) -> (f64, f64) {
    let p = a * b;
    let (a_high, a_low) = split(a);
    let (b_high, b_low) = split(b);
    let e = a_low * b_low - (((p - a_high * b_high) - a_low * b_high) - a_high * b_low);
    (p, e)
}

/// Whether [`two_product`] of `a` and `b` neither overflows nor loses bits to underflow.
#[inline]
pub(crate) fn product_is_exact(a: f64, b: f64) -> bool {
    let p = (a * b).abs();
    a.abs() < HUGE && b.abs() < HUGE && p < HUGE && p > TINY
}

/// 2^990: below it, splitting and products of halves cannot overflow.
pub(crate) const HUGE: f64 = f64::from_bits((1023 + 990) << 52);
/// 2^−960: above it, the error of a product is a normal or exact subnormal number.
pub(crate) const TINY: f64 = f64::from_bits((1023 - 960) << 52);

/// Veltkamp's splitting of `a` into two halves of at most 26 bits.
#[inline]
fn split(a: f64) -> (f64, f64) {
    const FACTOR: f64 = 134_217_729.0; // 2^27 + 1
    let c = FACTOR * a;
    let high = c - (c - a);
    (high, a - high)
}

#[cfg(test)]
mod tests {
    use super::{two_product, two_sum};
    use proptest::prelude::*;

    proptest! {
        /// Integers of 53 bits are doubles and their products fit into 106 bits.
        #[test]
        fn products_are_exact(a in -(1_i64 << 53)..(1_i64 << 53), b in -(1_i64 << 53)..(1_i64 << 53)) {
            let (p, e) = two_product(a as f64, b as f64);
            prop_assert_eq!(p as i128 + e as i128, i128::from(a) * i128::from(b));
        }

        #[test]
        fn sums_are_exact(a in -(1_i64 << 53)..(1_i64 << 53), b in -(1_i64 << 53)..(1_i64 << 53), k in 0_u32..40) {
            let scale = (1_i64 << k) as f64;
            let (s, e) = two_sum(a as f64 * scale, b as f64);
            prop_assert_eq!(s as i128 + e as i128, (i128::from(a) << k) + i128::from(b));
        }
    }
}
