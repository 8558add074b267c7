//! Operations that IEEE arithmetic rounds correctly, and those that are exact.
//!
//! Each operation on points returns the tightest pair of doubles around the exact result, found from the
//! sign of the rounding error; operations on intervals are hulls of the results at their ends.

use std::ops::{Add, Div, Mul, Neg, Sub};

use super::Interval;
use crate::exact::{HUGE, TINY, product_is_exact, two_product, two_sum};

impl Add for Interval {
    type Output = Interval;
    #[inline]
    fn add(self, other: Interval) -> Interval {
        Interval { lo: sum(self.lo, other.lo).lo, hi: sum(self.hi, other.hi).hi }
    }
}

impl Sub for Interval {
    type Output = Interval;
    #[inline]
    fn sub(self, other: Interval) -> Interval {
        self + -other
    }
}

impl Neg for Interval {
    type Output = Interval;
    #[inline]
    fn neg(self) -> Interval {
        Interval { lo: -self.hi, hi: -self.lo }
    }
}

impl Mul for Interval {
    type Output = Interval;
    #[inline]
    fn mul(self, other: Interval) -> Interval {
        let (a, b) = (self, other);
        if a.lo == a.hi && b.lo == b.hi {
            return product(a.lo, b.lo);
        }
        if a.lo < 0.0 && a.hi <= 0.0 {
            return -(-a * b);
        }
        let between = |(x, y), (z, w)| Interval { lo: product(x, y).lo, hi: product(z, w).hi };
        match (a.lo >= 0.0, b.lo >= 0.0, b.hi <= 0.0) {
            (true, true, _) => between((a.lo, b.lo), (a.hi, b.hi)),
            (true, _, true) => between((a.hi, b.lo), (a.lo, b.hi)),
            (true, _, _) => between((a.hi, b.lo), (a.hi, b.hi)),
            (_, true, _) => between((a.lo, b.hi), (a.hi, b.hi)),
            (_, _, true) => between((a.hi, b.lo), (a.lo, b.lo)),
            _ => between((a.lo, b.hi), (a.lo, b.lo)).hull(between((a.hi, b.lo), (a.hi, b.hi))),
        }
    }
}

impl Div for Interval {
    type Output = Interval;
    /// The whole line if the divisor contains 0.
    #[inline]
    fn div(self, other: Interval) -> Interval {
        let (a, b) = (self, other);
        if b.contains_zero() {
            return Interval::ENTIRE;
        }
        (quotient(a.lo, b.lo).hull(quotient(a.lo, b.hi)))
            .hull(quotient(a.hi, b.lo).hull(quotient(a.hi, b.hi)))
    }
}

impl Interval {
    /// x², never negative.
    #[must_use]
    #[inline]
    pub fn square(self) -> Interval {
        let a = self.abs();
        Interval { lo: product(a.lo, a.lo).lo, hi: product(a.hi, a.hi).hi }
    }

    /// xⁿ for an integer n; x⁰ = 1, and a negative power of an interval that contains 0 is the whole line.
    #[must_use]
    pub fn powi(self, n: i32) -> Interval {
        let k = n.unsigned_abs();
        let power = if k.is_multiple_of(2) {
            let a = self.abs();
            Interval { lo: point_power(a.lo, k).lo.max(0.0), hi: point_power(a.hi, k).hi }
        } else {
            Interval { lo: point_power(self.lo, k).lo, hi: point_power(self.hi, k).hi }
        };
        if n < 0 { Interval::point(1.0) / power } else { power }
    }

    /// √x.
    #[must_use]
    pub fn sqrt(self) -> Interval {
        if self.hi < 0.0 {
            return Interval::ENTIRE;
        }
        Interval { lo: root(self.lo.max(0.0)).lo.max(0.0), hi: root(self.hi).hi }
    }

    /// |x|.
    #[must_use]
    #[inline]
    pub fn abs(self) -> Interval {
        if self.lo >= 0.0 {
            self
        } else if self.hi <= 0.0 {
            -self
        } else {
            Interval { lo: 0.0, hi: self.magnitude() }
        }
    }

    /// The smaller of two.
    #[must_use]
    #[inline]
    pub fn min(self, other: Interval) -> Interval {
        Interval { lo: self.lo.min(other.lo), hi: self.hi.min(other.hi) }
    }

    /// The larger of two.
    #[must_use]
    #[inline]
    pub fn max(self, other: Interval) -> Interval {
        Interval { lo: self.lo.max(other.lo), hi: self.hi.max(other.hi) }
    }

    /// The largest integer not above x.
    #[must_use]
    #[inline]
    pub fn floor(self) -> Interval {
        Interval { lo: self.lo.floor(), hi: self.hi.floor() }
    }

    /// −1, 0 or 1.
    #[must_use]
    #[inline]
    pub fn sign(self) -> Interval {
        let sign = |x: f64| f64::from(u8::from(x > 0.0)) - f64::from(u8::from(x < 0.0));
        Interval { lo: sign(self.lo), hi: sign(self.hi) }
    }
}

/// The tightest doubles around a + b.
#[inline]
fn sum(a: f64, b: f64) -> Interval {
    let (s, error) = two_sum(a, b);
    around(s, if error.is_finite() { error } else { f64::NAN })
}

/// The tightest doubles around a b; 0 times anything is 0, so that unbounded ends act as limits.
#[inline]
fn product(a: f64, b: f64) -> Interval {
    if a == 0.0 || b == 0.0 {
        return Interval::ZERO;
    }
    if product_is_exact(a, b) {
        let (p, error) = two_product(a, b);
        around(p, error)
    } else {
        around(a * b, f64::NAN)
    }
}

/// The tightest doubles around a / b for b ≠ 0; unbounded ends act as limits.
#[inline]
fn quotient(a: f64, b: f64) -> Interval {
    if a == 0.0 {
        return Interval::ZERO;
    }
    if b.is_infinite() {
        // x/∞ → 0 for every finite x; ∞/∞ can be anything of its sign.
        let far = if a.is_infinite() { a * b } else { 0.0 };
        return Interval { lo: far.min(0.0), hi: far.max(0.0) };
    }
    let q = a / b;
    if product_is_exact(q, b) && a.abs() > TINY && a.abs() < HUGE {
        let (p, e) = two_product(q, b);
        // a − p is exact, so the sign of the remainder a − q b is.
        let remainder = (a - p) - e;
        around(q, if b < 0.0 { -remainder } else { remainder })
    } else {
        around(q, f64::NAN)
    }
}

/// The tightest doubles around √a for a ≥ 0.
#[inline]
fn root(a: f64) -> Interval {
    let r = a.sqrt();
    if a == 0.0 {
        Interval::ZERO
    } else if a > TINY && a < HUGE {
        let (p, e) = two_product(r, r);
        around(r, (a - p) - e)
    } else {
        around(r, f64::NAN)
    }
}

/// An enclosure of xᵏ by repeated squaring.
fn point_power(x: f64, k: u32) -> Interval {
    let mut power = Interval { lo: 1.0, hi: 1.0 };
    for bit in (0..u32::BITS - k.leading_zeros()).rev() {
        power = power.square();
        if k >> bit & 1 == 1 {
            power = power * Interval { lo: x, hi: x };
        }
    }
    power
}

/// The doubles around a rounded `value`, given the sign of exact − value; NaN if it is not known.
#[inline]
fn around(value: f64, error: f64) -> Interval {
    if value.is_nan() {
        return Interval::ENTIRE;
    }
    Interval {
        lo: if error >= 0.0 { value } else { value.next_down() },
        hi: if error <= 0.0 { value } else { value.next_up() },
    }
}

#[cfg(test)]
mod tests {
    use super::Interval;

    const INF: f64 = f64::INFINITY;

    fn i(lo: f64, hi: f64) -> Interval {
        Interval { lo, hi }
    }

    #[test]
    fn exact_results_stay_points() {
        let p = Interval::point;
        assert_eq!(p(0.1) + Interval::ZERO, p(0.1));
        assert_eq!(p(1.5) - p(0.25), p(1.25));
        assert_eq!(p(0.1) * p(8.0), p(0.8));
        assert_eq!(p(0.75) / p(-3.0), p(-0.25));
        assert_eq!(p(2.25).sqrt(), p(1.5));
        assert_eq!(p(-3.0).powi(3), p(-27.0));
        assert_eq!(p(2.0).powi(-2), p(0.25));
        assert_eq!(p(7.0).powi(0), p(1.0));
        assert_eq!(p(0.1) - p(0.1), Interval::ZERO);
    }

    #[test]
    fn inexact_results_are_neighbours() {
        for x in [
            Interval::point(0.1) + Interval::point(0.2),
            Interval::point(0.1) * Interval::point(0.1),
            Interval::point(1.0) / Interval::point(3.0),
            Interval::point(2.0).sqrt(),
        ] {
            assert_eq!(x.lo.next_up(), x.hi);
        }
    }

    #[test]
    fn signs_of_factors() {
        assert_eq!(i(-1.0, 2.0) * i(-3.0, 5.0), i(-6.0, 10.0));
        assert_eq!(i(1.0, 2.0) / i(-4.0, -2.0), i(-1.0, -0.25));
        assert_eq!(i(1.0, 2.0) / i(-1.0, 2.0), Interval::ENTIRE);
        assert_eq!(i(1.0, 2.0) / i(0.0, 2.0), Interval::ENTIRE);
        assert_eq!(i(-2.0, 1.0).square(), i(0.0, 4.0));
        assert_eq!(i(-2.0, 1.0).powi(3), i(-8.0, 1.0));
        assert_eq!(i(-2.0, 1.0).powi(-1), Interval::ENTIRE);
    }

    /// Which ends matter follows from the signs: all four products are tried here.
    #[test]
    fn products_are_hulls_of_the_products_of_ends() {
        let ends = [-INF, f64::MIN, -3.0, -0.1, -0.0, 0.0, 1e-100, 0.1, 7.0, f64::MAX, INF];
        let all: Vec<Interval> = ends
            .into_iter()
            .flat_map(|lo| ends.map(|hi| i(lo, hi)))
            .filter(|x| x.lo <= x.hi && x.lo < INF && x.hi > -INF)
            .collect();
        for (&a, &b) in all.iter().flat_map(|a| all.iter().map(move |b| (a, b))) {
            let products = [(a.lo, b.lo), (a.lo, b.hi), (a.hi, b.lo), (a.hi, b.hi)];
            let hull = products.map(|(x, y)| super::product(x, y)).into_iter().reduce(Interval::hull);
            assert_eq!(Some(a * b), hull, "{a:?} {b:?}");
        }
    }

    #[test]
    fn unbounded_ends_act_as_limits() {
        assert_eq!(Interval::ZERO * Interval::ENTIRE, Interval::ZERO);
        assert_eq!(i(2.0, INF) * i(3.0, 4.0), i(6.0, INF));
        assert_eq!(i(1.0, INF) / i(1.0, INF), i(0.0, INF));
        assert_eq!(i(1.0, INF) - i(1.0, INF), Interval::ENTIRE);
        assert_eq!(i(f64::MAX, f64::MAX) + i(f64::MAX, f64::MAX), i(f64::MAX, INF));
        assert!((i(1e-200, 1e-200) * i(1e-200, 1e-200)).contains(0.0));
    }

    #[test]
    fn roots_of_partly_negative_intervals() {
        assert_eq!(i(-1.0, 4.0).sqrt(), i(0.0, 2.0));
        assert_eq!(i(-4.0, -1.0).sqrt(), Interval::ENTIRE);
    }

    #[test]
    fn steps() {
        assert_eq!(i(-2.0, 1.0).abs(), i(0.0, 2.0));
        assert_eq!(i(-2.0, -1.0).abs(), i(1.0, 2.0));
        assert_eq!(i(-0.5, 1.5).floor(), i(-1.0, 1.0));
        assert_eq!(i(0.0, 1.5).sign(), i(0.0, 1.0));
        assert_eq!(i(-3.0, 1.0).min(i(-1.0, 0.5)), i(-3.0, 0.5));
        assert_eq!(i(-3.0, 1.0).max(i(-1.0, 0.5)), i(-1.0, 1.0));
    }
}
