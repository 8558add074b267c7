//! Ball arithmetic: a middle and a radius within which the true value lies.
//!
//! It is coarser than intervals are and rounds generously, but it has no case distinctions, so that native code for it
//! is about as quick as for the middles alone. Engines ask it first whether a watch can cross at all.
//!
//! J. van der Hoeven, *Ball arithmetic* (2009); F. Johansson, *Arb: efficient arbitrary-precision
//! midpoint-radius interval arithmetic*, IEEE Trans. Computers 66 (2017).
//!
//! A radius is infinite, or NaN, where nothing is known: at a pole, beyond the domain of a function, after an overflow.
//! Which of the two does not matter, since neither is less than anything.

use crate::scalar::Scalar;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// All numbers that are not farther from `middle` than `radius`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct BallOf<T> {
    pub(crate) middle: T,
    pub(crate) radius: T,
}

/// Twice what one rounding may lose of a number, as a part of it.
const ROUNDING: f64 = f64::EPSILON;
/// The same for a function of the library.
const LIBRARY: f64 = 4.0 * f64::EPSILON;
/// The same for a polynomial of degree 3 and its derivatives.
const POLYNOMIAL: f64 = 64.0 * f64::EPSILON;
/// What underflow may lose.
const TINY: f64 = f64::MIN_POSITIVE;
/// Radii grow by this, for what was lost when they were computed: up to 16 roundings of terms that are not negative.
const GROWN: f64 = 1.0 + 16.0 * f64::EPSILON;
/// Slopes beside the edge of a domain are taken only so far from it that their rounding is small beside [`SLACK`].
const EDGE: f64 = 1.0 / 1_048_576.0;
const SLACK: f64 = 1.0001;

impl<T: Scalar> BallOf<T> {
    /// A number computed but for `loss` of it, relatively, of operands that move it by `radius`.
    #[inline]
    fn around(middle: T, radius: T, loss: f64) -> Self {
        let lost = middle.abs() * T::of(loss) + T::of(TINY);
        BallOf { middle, radius: (radius + lost) * T::of(GROWN) }
    }

    /// A function of the library whose slope on the ball is at most `slope`.
    #[inline]
    fn moved(self, middle: T, slope: T) -> Self {
        Self::around(middle, self.radius * slope, LIBRARY)
    }

    /// `radius` if `low < high`, else an infinite one.
    #[inline]
    fn if_less(low: T, high: T, radius: impl FnOnce() -> T) -> T {
        let [radius] = T::choose(low.less(high), || [radius()], || [T::of(f64::INFINITY)]);
        radius
    }

    /// The largest absolute value inside.
    #[inline]
    fn magnitude(self) -> T {
        self.middle.abs() + self.radius
    }

    /// The least number inside.
    #[inline]
    fn least(self) -> T {
        self.middle - self.radius
    }

    /// Anything at all.
    fn unknown() -> Self {
        BallOf { middle: T::of(0.0), radius: T::of(f64::INFINITY) }
    }
}

impl<T: Scalar> Add for BallOf<T> {
    type Output = Self;
    #[inline]
    fn add(self, other: Self) -> Self {
        Self::around(self.middle + other.middle, self.radius + other.radius, ROUNDING)
    }
}

impl<T: Scalar> Sub for BallOf<T> {
    type Output = Self;
    #[inline]
    fn sub(self, other: Self) -> Self {
        Self::around(self.middle - other.middle, self.radius + other.radius, ROUNDING)
    }
}

impl<T: Scalar> Neg for BallOf<T> {
    type Output = Self;
    #[inline]
    fn neg(self) -> Self {
        BallOf { middle: -self.middle, radius: self.radius }
    }
}

impl<T: Scalar> Mul for BallOf<T> {
    type Output = Self;
    #[inline]
    fn mul(self, other: Self) -> Self {
        let radius = self.middle.abs() * other.radius + self.radius * other.magnitude();
        Self::around(self.middle * other.middle, radius, ROUNDING)
    }
}

impl<T: Scalar> Div for BallOf<T> {
    type Output = Self;
    #[inline]
    fn div(self, other: Self) -> Self {
        // x/y − a/b = ((x − a) b − a (y − b)) / (y b)
        let middle = self.middle / other.middle;
        let least = other.middle.abs() - other.radius;
        let radius = || (self.radius + middle.abs() * other.radius) / least;
        Self::around(middle, Self::if_less(T::of(0.0), least, radius), ROUNDING)
    }
}

macro_rules! slope_at_most_1 {
    ($($name:ident),*) => {$(
        fn $name(self) -> Self {
            self.moved(self.middle.$name(), T::of(1.0))
        }
    )*};
}

impl<T: Scalar> Scalar for BallOf<T> {
    type Truth = T::Truth;

    slope_at_most_1!(sin, cos, atan, tanh, asinh);

    #[inline]
    fn of(value: f64) -> Self {
        BallOf { middle: T::of(value), radius: T::of(0.0) }
    }
    #[inline]
    fn abs(self) -> Self {
        BallOf { middle: self.middle.abs(), radius: self.radius }
    }
    #[inline]
    fn square(self) -> Self {
        self * self
    }
    fn sqrt(self) -> Self {
        // √x − √a = (x − a) / (√x + √a)
        let middle = self.middle.sqrt();
        let radius = Self::if_less(T::of(0.0), self.least(), || self.radius / middle);
        Self::around(middle, radius, ROUNDING)
    }
    fn exp(self) -> Self {
        let middle = self.middle.exp();
        // eʳ − 1 < r + r² for r < 1
        let growth = || self.radius + self.radius * self.radius;
        Self::around(middle, middle * Self::if_less(self.radius, T::of(1.0), growth), LIBRARY)
    }
    fn ln(self) -> Self {
        let slope = Self::if_less(T::of(0.0), self.least(), || T::of(1.0) / self.least());
        self.moved(self.middle.ln(), slope)
    }
    fn log10(self) -> Self {
        // 1/ln 10 < 0.45
        let slope = Self::if_less(T::of(0.0), self.least(), || T::of(0.45) / self.least());
        self.moved(self.middle.log10(), slope)
    }
    fn tan(self) -> Self {
        self.sin() / self.cos()
    }
    fn asin(self) -> Self {
        self.moved(self.middle.asin(), self.slope_of_asin())
    }
    fn acos(self) -> Self {
        self.moved(self.middle.acos(), self.slope_of_asin())
    }
    fn sinh(self) -> Self {
        self.moved(self.middle.sinh(), self.slope_of_sinh())
    }
    fn cosh(self) -> Self {
        self.moved(self.middle.cosh(), self.slope_of_sinh())
    }
    fn acosh(self) -> Self {
        let (one, least) = (T::of(1.0), self.least());
        let slope = || T::of(SLACK) / ((least - one) * (least + one)).sqrt();
        self.moved(self.middle.acosh(), Self::if_less(T::of(1.0 + EDGE), least, slope))
    }
    fn atanh(self) -> Self {
        let (one, magnitude) = (T::of(1.0), self.magnitude());
        let slope = || T::of(SLACK) / ((one - magnitude) * (one + magnitude));
        self.moved(self.middle.atanh(), Self::if_less(magnitude, T::of(1.0 - EDGE), slope))
    }
    fn atan2(self, x: Self) -> Self {
        // Right of 0 it is the angle of a quotient; elsewhere a branch cut may be near.
        let right = (self / x).atan().radius;
        let radius = Self::if_less(T::of(0.0), x.least(), || right);
        Self::around(self.middle.atan2(x.middle), radius, LIBRARY)
    }
    fn pow(self, exponent: Self) -> Self {
        let through = (self.ln() * exponent).exp();
        // Relative to what the library gives, which the other way misses by no more than its radius.
        let middle = self.middle.pow(exponent.middle);
        let radius = through.radius + (middle - through.middle).abs();
        Self::around(middle, Self::if_less(T::of(0.0), self.least(), || radius), LIBRARY)
    }
    fn floor(self) -> Self {
        let jump = Self::if_less(T::of(0.0), self.radius, || self.radius + T::of(1.0));
        let [radius] = T::choose(self.radius.equal(T::of(0.0)), || [T::of(0.0)], || [jump]);
        BallOf { middle: self.middle.floor(), radius }
    }
    fn sign(self) -> Self {
        let [radius] = T::choose(self.radius.less(self.middle.abs()), || [T::of(0.0)], || [T::of(2.0)]);
        BallOf { middle: self.middle.sign(), radius }
    }
    fn count(self) -> usize {
        self.middle.count()
    }
    // What engines enclose is smooth: knots were lifted.
    fn locate(self, _: &[Self]) -> Self {
        Self::unknown()
    }
    // Columns hold numbers: see `radius_of_lookup`.
    fn lookup(self, _: &[Self]) -> Self {
        Self::unknown()
    }
    #[inline]
    fn less(self, other: Self) -> T::Truth {
        self.middle.less(other.middle)
    }
    #[inline]
    fn equal(self, other: Self) -> T::Truth {
        self.middle.equal(other.middle)
    }
    #[inline]
    fn choose<const N: usize>(
        truth: T::Truth,
        yes: impl FnOnce() -> [Self; N],
        no: impl FnOnce() -> [Self; N],
    ) -> [Self; N] {
        let (yes, no) = (yes(), no());
        let middles = T::choose(truth, || yes.map(|ball| ball.middle), || no.map(|ball| ball.middle));
        let radii = T::choose(truth, || yes.map(|ball| ball.radius), || no.map(|ball| ball.radius));
        std::array::from_fn(|k| BallOf { middle: middles[k], radius: radii[k] })
    }
    fn decided(truth: T::Truth) -> bool {
        T::decided(truth)
    }

    /// The value; of derivatives nothing is said. Coefficients are numbers: their radii are 0.
    #[inline]
    fn follow<const N: usize>(c: &[Self], s: Self) -> [Self; N] {
        let zero = T::of(0.0);
        let [c0, c1, c2, c3] = [0, 1, 2, 3].map(|k| c.get(k).map_or(zero, |ball: &Self| ball.middle));
        let (m, r) = (s.middle, s.radius);
        // p(m + d) − p(m) = d (p′(m) + d (p″(m)/2 + d c3))
        let middle = c0 + m * (c1 + m * (c2 + m * c3));
        let slope = c1 + m * (T::of(2.0) * c2 + m * (T::of(3.0) * c3));
        let curvature = c2 + m * (T::of(3.0) * c3);
        let radius = r * (slope.abs() + r * (curvature.abs() + r * c3.abs()));
        let far = s.magnitude();
        let size = c0.abs() + far * (c1.abs() + far * (c2.abs() + far * c3.abs()));
        let value = Self::around(middle, radius + size * T::of(POLYNOMIAL), ROUNDING);
        std::array::from_fn(|k| if k == 0 { value } else { Self::unknown() })
    }
}

impl<T: Scalar> BallOf<T> {
    fn slope_of_asin(self) -> T {
        let (one, magnitude) = (T::of(1.0), self.magnitude());
        let slope = || T::of(SLACK) / ((one - magnitude) * (one + magnitude)).sqrt();
        Self::if_less(magnitude, T::of(1.0 - EDGE), slope)
    }

    /// And of cosh, which is less.
    fn slope_of_sinh(self) -> T {
        self.magnitude().cosh() * T::of(SLACK)
    }

    /// A position in a column is known, or nothing is.
    pub(crate) fn radius_of_lookup(self) -> T {
        let known = self.radius.equal(T::of(0.0));
        let [radius] = T::choose(known, || [T::of(0.0)], || [T::of(f64::INFINITY)]);
        radius
    }
}
