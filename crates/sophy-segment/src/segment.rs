//! A polynomial in local time.

/// A continuous quantity between two events: `Σ c_k s^k` with `s = (t − start) / scale`.
///
/// Local time keeps the digits that absolute time would lose, and a `scale` equal to the segment's length
/// (s in [0, 1]) keeps coefficients of high order from overflowing. Engines that predict by derivatives use
/// `scale = 1`. The segment owns nothing; storage is the engine's or the record's.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SegmentRef<'a> {
    /// Time at which s = 0, in s.
    pub start: f64,
    /// Time per unit of local time, in s; positive.
    pub scale: f64,
    /// Coefficients c₀, c₁, … in the quantity's unit; none means identically zero.
    pub coefficients: &'a [f64],
}

impl SegmentRef<'_> {
    /// The value at time `t` (s).
    #[must_use]
    pub fn value(&self, t: f64) -> f64 {
        let s = (t - self.start) / self.scale;
        self.coefficients.iter().rev().fold(0.0, |sum, c| sum * s + c)
    }

    /// The derivative of `order` with respect to time at time `t` (s), per s^order; order 0 is the value.
    #[must_use]
    pub fn derivative(&self, t: f64, order: u32) -> f64 {
        let s = (t - self.start) / self.scale;
        let order = order as usize;
        // d^m s^k / ds^m = k (k−1) … (k−m+1) s^(k−m)
        let falling = |k: usize| ((k - order + 1)..=k).map(|i| i as f64).product::<f64>();
        let mut sum = 0.0;
        for k in (order..self.coefficients.len()).rev() {
            sum = sum * s + falling(k) * self.coefficients[k];
        }
        (0..order).fold(sum, |derivative, _| derivative / self.scale)
    }
}

#[cfg(test)]
mod tests {
    use super::SegmentRef;

    #[test]
    fn values_and_derivatives_of_a_cubic() {
        // x(t) = 1 + 2u − 3u² + 4u³ with u = t − 10, written for s = u / 2
        let segment = SegmentRef { start: 10.0, scale: 2.0, coefficients: &[1.0, 4.0, -12.0, 32.0] };
        for u in [-1.0, 0.0, 0.5, 2.0] {
            let t = 10.0 + u;
            assert_eq!(segment.value(t), 1.0 + 2.0 * u - 3.0 * u * u + 4.0 * u * u * u);
            assert_eq!(segment.derivative(t, 0), segment.value(t));
            assert_eq!(segment.derivative(t, 1), 2.0 - 6.0 * u + 12.0 * u * u);
            assert_eq!(segment.derivative(t, 2), -6.0 + 24.0 * u);
            assert_eq!(segment.derivative(t, 3), 24.0);
            assert_eq!(segment.derivative(t, 4), 0.0);
        }
    }

    #[test]
    fn no_coefficients_mean_zero() {
        let zero = SegmentRef { start: 0.0, scale: 1.0, coefficients: &[] };
        assert_eq!((zero.value(3.0), zero.derivative(3.0, 1)), (0.0, 0.0));
    }
}
