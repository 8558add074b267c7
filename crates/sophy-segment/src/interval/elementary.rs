//! Exponentials, logarithms, hyperbolic functions and general powers.

use super::Interval;

impl Interval {
    /// eˣ.
    #[must_use]
    pub fn exp(self) -> Interval {
        increasing(libm::exp, self).clamped(0.0, f64::INFINITY)
    }

    /// The natural logarithm.
    #[must_use]
    pub fn ln(self) -> Interval {
        self.on_domain(0.0, f64::INFINITY, |x| increasing(libm::log, x))
    }

    /// The decimal logarithm.
    #[must_use]
    pub fn log10(self) -> Interval {
        self.on_domain(0.0, f64::INFINITY, |x| increasing(libm::log10, x))
    }

    /// The hyperbolic sine.
    #[must_use]
    pub fn sinh(self) -> Interval {
        increasing(libm::sinh, self)
    }

    /// The hyperbolic cosine.
    #[must_use]
    pub fn cosh(self) -> Interval {
        increasing(libm::cosh, self.abs()).clamped(1.0, f64::INFINITY)
    }

    /// The hyperbolic tangent.
    #[must_use]
    pub fn tanh(self) -> Interval {
        increasing(libm::tanh, self).clamped(-1.0, 1.0)
    }

    /// The inverse hyperbolic sine.
    #[must_use]
    pub fn asinh(self) -> Interval {
        increasing(libm::asinh, self)
    }

    /// The inverse hyperbolic cosine, defined from 1 on.
    #[must_use]
    pub fn acosh(self) -> Interval {
        self.on_domain(1.0, f64::INFINITY, |x| increasing(libm::acosh, x).clamped(0.0, f64::INFINITY))
    }

    /// The inverse hyperbolic tangent, defined on [−1, 1].
    #[must_use]
    pub fn atanh(self) -> Interval {
        self.on_domain(-1.0, 1.0, |x| increasing(libm::atanh, x))
    }

    /// x^y. A negative x has powers with integer exponents only.
    #[must_use]
    pub fn pow(self, exponent: Interval) -> Interval {
        let point = exponent.lo == exponent.hi;
        if point && exponent.lo.floor() == exponent.lo && exponent.lo.abs() <= f64::from(i32::MAX) {
            return self.powi(exponent.lo as i32);
        }
        if self.lo >= 0.0 {
            return positive_power(self, exponent);
        }
        if point && exponent.lo.floor() != exponent.lo {
            return self.on_domain(0.0, f64::INFINITY, |x| positive_power(x, exponent));
        }
        // Some exponents are integers, even or odd: both signs occur.
        let bound = positive_power(self.abs(), exponent).hi;
        Interval { lo: -bound, hi: bound }
    }

    /// `f` of the part inside [lo, hi]; the whole line if there is none.
    pub(super) fn on_domain(self, lo: f64, hi: f64, f: impl Fn(Interval) -> Interval) -> Interval {
        self.intersection(Interval { lo, hi }).map_or(Interval::ENTIRE, f)
    }

    /// The ends moved into [lo, hi], the known range of a function.
    pub(super) fn clamped(self, lo: f64, hi: f64) -> Interval {
        Interval { lo: self.lo.clamp(lo, hi), hi: self.hi.clamp(lo, hi) }
    }
}

/// The image of `x` under an increasing function.
pub(super) fn increasing(f: impl Fn(f64) -> f64, x: Interval) -> Interval {
    Interval { lo: image(&f, x.lo).lo, hi: image(&f, x.hi).hi }
}

/// f(x) of a library function, widened by 2 ulp; exact where the function is.
pub(super) fn image(f: impl Fn(f64) -> f64, x: f64) -> Interval {
    let value = f(x);
    // e⁰ = cos 0 = cosh 0 = 1, ln 1 = acos 1 = 0, odd functions of 0, …: at 0 and 1 the values 0 and 1 are
    // exact for every function used here.
    let exact = (x == 0.0 || x == 1.0) && (value == 0.0 || value == 1.0);
    if exact { Interval::point(value) } else { widened(value) }
}

/// `value` ± 2 ulp.
pub(super) fn widened(value: f64) -> Interval {
    Interval::new(value.next_down().next_down(), value.next_up().next_up())
}

/// x^y for x ≥ 0. The logarithm y ln x is bilinear, so the extremes are at the corners.
fn positive_power(x: Interval, y: Interval) -> Interval {
    let corner = |x: f64, y: f64| widened(libm::pow(x, y));
    (corner(x.lo, y.lo).hull(corner(x.lo, y.hi)))
        .hull(corner(x.hi, y.lo).hull(corner(x.hi, y.hi)))
        .clamped(0.0, f64::INFINITY)
}

#[cfg(test)]
mod tests {
    use super::Interval;

    const INF: f64 = f64::INFINITY;

    fn i(lo: f64, hi: f64) -> Interval {
        Interval { lo, hi }
    }

    #[test]
    fn exact_values() {
        let (zero, one) = (Interval::ZERO, Interval::point(1.0));
        for f in [Interval::sinh, Interval::tanh, Interval::asinh, Interval::atanh] {
            assert_eq!(f(zero), zero);
        }
        assert_eq!((zero.exp(), zero.cosh()), (one, one));
        assert_eq!((one.ln(), one.log10(), one.acosh()), (zero, zero, zero));
    }

    #[test]
    fn ranges_are_respected() {
        assert_eq!(i(-INF, INF).exp(), i(0.0, INF));
        assert_eq!(i(-1e9, -1e8).exp().lo, 0.0);
        assert_eq!(i(-1.0, 2.0).cosh().lo, 1.0);
        assert_eq!(i(-1e3, 1e3).tanh(), i(-1.0, 1.0));
    }

    #[test]
    fn domains() {
        assert_eq!(i(0.0, 1.0).ln(), i(-INF, 0.0));
        assert_eq!(i(-3.0, 1.0).ln(), i(-INF, 0.0));
        assert_eq!(i(-3.0, -1.0).ln(), Interval::ENTIRE);
        assert_eq!(i(-3.0, 0.5).acosh(), Interval::ENTIRE);
        assert_eq!(i(2.0, 3.0).atanh(), Interval::ENTIRE);
        assert_eq!(i(0.0, 3.0).atanh(), i(0.0, INF));
    }

    #[test]
    fn powers() {
        assert_eq!(i(-2.0, 3.0).pow(Interval::point(2.0)), i(0.0, 9.0));
        assert!(i(0.0, 4.0).pow(Interval::point(0.5)).contains(2.0));
        assert_eq!(i(0.0, 4.0).pow(Interval::point(-0.5)).hi, INF);
        assert_eq!(i(-4.0, -1.0).pow(Interval::point(0.5)), Interval::ENTIRE);
        assert!(i(-2.0, -2.0).pow(i(0.5, 3.5)).contains(-8.0));
    }
}
