//! Enclosures of real numbers by pairs of doubles, rounded outward.
//!
//! [`arithmetic`] holds the operations that round correctly, [`elementary`] and [`trigonometric`] those
//! that call the `libm` crate, whose results are widened by two ulp.

mod arithmetic;
mod elementary;
mod trigonometric;

/// The closed interval [lo, hi] of real numbers, `lo <= hi`; infinite ends mean unbounded.
///
/// Every operation is an *enclosure*: if each operand's true value lies in its interval, the true value of
/// the result, wherever it is defined, lies in the result. Where an operand reaches beyond the domain of an
/// operation, the part outside contributes nothing (`sqrt [−1, 4] = [0, 2]`); if nothing of it is inside,
/// the result is [`Interval::ENTIRE`], as is a quotient by an interval that contains 0. No end is ever NaN.
///
/// Sums, products, quotients and square roots round outward only if they are inexact, so points stay points
/// while the arithmetic is exact. Library functions are widened by 2 ulp; a test holds them against
/// references of 30 digits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interval {
    /// Lower end, not +∞.
    pub lo: f64,
    /// Upper end, not −∞.
    pub hi: f64,
}

impl Interval {
    /// The whole line.
    pub const ENTIRE: Interval = Interval { lo: f64::NEG_INFINITY, hi: f64::INFINITY };
    /// The point 0.
    pub const ZERO: Interval = Interval { lo: 0.0, hi: 0.0 };

    /// The smallest interval with the ends `a` and `b`, in either order; the whole line if one is NaN.
    #[must_use]
    #[inline]
    pub fn new(a: f64, b: f64) -> Self {
        if a.is_nan() || b.is_nan() {
            return Interval::ENTIRE;
        }
        // A lower end +∞ means "beyond the largest double".
        Interval { lo: a.min(b).min(f64::MAX), hi: a.max(b).max(f64::MIN) }
    }

    /// The interval that contains `x` only; an overflow is unbounded, NaN the whole line.
    #[must_use]
    #[inline]
    pub fn point(x: f64) -> Self {
        Self::new(x, x)
    }

    /// The smallest interval that contains both.
    #[must_use]
    #[inline]
    pub fn hull(self, other: Interval) -> Self {
        Interval { lo: self.lo.min(other.lo), hi: self.hi.max(other.hi) }
    }

    /// What both have in common, or `None`.
    #[must_use]
    #[inline]
    pub fn intersection(self, other: Interval) -> Option<Self> {
        let common = Interval { lo: self.lo.max(other.lo), hi: self.hi.min(other.hi) };
        (common.lo <= common.hi).then_some(common)
    }

    /// Whether `x` is inside; the ends are.
    #[must_use]
    #[inline]
    pub fn contains(self, x: f64) -> bool {
        self.lo <= x && x <= self.hi
    }

    /// Whether 0 is inside.
    #[must_use]
    #[inline]
    pub fn contains_zero(self) -> bool {
        self.contains(0.0)
    }

    /// Whether both ends are finite.
    #[must_use]
    #[inline]
    pub fn is_finite(self) -> bool {
        self.lo.is_finite() && self.hi.is_finite()
    }

    /// A double inside, the middle if both ends are finite.
    #[must_use]
    #[inline]
    pub fn midpoint(self) -> f64 {
        match (self.lo.is_finite(), self.hi.is_finite()) {
            (true, true) => self.lo.midpoint(self.hi),
            (true, false) => self.lo.max(0.0),
            (false, true) => self.hi.min(0.0),
            (false, false) => 0.0,
        }
    }

    /// The distance of the ends, rounded to nearest.
    #[must_use]
    #[inline]
    pub fn width(self) -> f64 {
        self.hi - self.lo
    }

    /// The largest absolute value inside.
    #[must_use]
    #[inline]
    pub fn magnitude(self) -> f64 {
        self.lo.abs().max(self.hi.abs())
    }
}

#[cfg(test)]
mod tests {
    use super::Interval;

    #[test]
    fn ends_are_ordered_and_never_nan() {
        assert_eq!(Interval::new(2.0, -1.0), Interval { lo: -1.0, hi: 2.0 });
        assert_eq!(Interval::new(f64::NAN, 1.0), Interval::ENTIRE);
        assert_eq!(Interval::point(f64::INFINITY), Interval { lo: f64::MAX, hi: f64::INFINITY });
        assert_eq!(Interval::point(f64::NEG_INFINITY), Interval { lo: f64::NEG_INFINITY, hi: f64::MIN });
    }

    #[test]
    fn sets() {
        let (a, b, c) = (Interval::new(0.0, 2.0), Interval::new(1.0, 3.0), Interval::new(5.0, 6.0));
        assert_eq!(a.hull(c), Interval::new(0.0, 6.0));
        assert_eq!(a.intersection(b), Some(Interval::new(1.0, 2.0)));
        assert_eq!(a.intersection(c), None);
        assert!(a.contains(0.0) && a.contains(2.0) && !a.contains(2.0_f64.next_up()));
        assert!(a.contains_zero() && !b.contains_zero());
        assert_eq!((b.midpoint(), b.width(), Interval::new(-4.0, 3.0).magnitude()), (2.0, 2.0, 4.0));
        assert_eq!(Interval::new(f64::MIN, f64::MAX).midpoint(), 0.0);
    }
}
