use sophy_segment::Interval;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// What a jet's coefficients are made of: numbers, or enclosures of numbers.
pub(crate) trait Scalar:
    Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Div<Output = Self> + Neg<Output = Self>
{
    fn of(value: f64) -> Self;
    fn abs(self) -> Self;
    fn square(self) -> Self;
    fn sqrt(self) -> Self;
    fn exp(self) -> Self;
    fn ln(self) -> Self;
    fn log10(self) -> Self;
    fn sin(self) -> Self;
    fn cos(self) -> Self;
    fn tan(self) -> Self;
    fn asin(self) -> Self;
    fn acos(self) -> Self;
    fn atan(self) -> Self;
    fn sinh(self) -> Self;
    fn cosh(self) -> Self;
    fn tanh(self) -> Self;
    fn asinh(self) -> Self;
    fn acosh(self) -> Self;
    fn atanh(self) -> Self;
    fn atan2(self, x: Self) -> Self;
    fn pow(self, exponent: Self) -> Self;
    /// The chain of products of [`sophy_ir::arithmetic::integer_power`].
    fn integer_power(self, n: i32) -> Self {
        let mut remaining = n.unsigned_abs();
        let (mut square, mut product) = (self, Self::of(1.0));
        while remaining > 0 {
            if remaining & 1 == 1 {
                product = product * square;
            }
            remaining >>= 1;
            if remaining > 0 {
                square = square * square;
            }
        }
        if n < 0 { Self::of(1.0) / product } else { product }
    }
    fn floor(self) -> Self;
    fn sign(self) -> Self;
    /// A whole number that is not negative.
    fn count(self) -> usize;
    /// The position among the knots of a column.
    fn locate(self, knots: &[Self]) -> Self;
    /// The number at this position of a column.
    fn lookup(self, numbers: &[Self]) -> Self;
    /// What a comparison says: known at once, or only when the code that is being written runs.
    type Truth: Copy;
    /// Whether `self < other` at the point that decides a switch.
    fn less(self, other: Self) -> Self::Truth;
    /// Whether both are the same number.
    fn equal(self, other: Self) -> Self::Truth;
    /// One of two results, of which only the one chosen need be computed.
    fn choose<const N: usize>(
        truth: Self::Truth,
        yes: impl FnOnce() -> [Self; N],
        no: impl FnOnce() -> [Self; N],
    ) -> [Self; N];
    /// The jet, s after its start, of a trajectory with two to four coefficients.
    #[inline]
    fn follow<const N: usize>(c: &[Self], s: Self) -> [Self; N] {
        let (two, three) = (Self::of(2.0), Self::of(3.0));
        let mut all = [Self::of(0.0); 4];
        match *c {
            [c0, c1] => all = [c0 + s * c1, c1, all[2], all[3]],
            [c0, c1, c2] => all = [c0 + s * (c1 + s * c2), c1 + two * s * c2, c2, all[3]],
            [c0, c1, c2, c3] => {
                let bend = s * (three * c3);
                all = [c0 + s * (c1 + s * (c2 + s * c3)), c1 + s * (two * c2 + bend), c2 + bend, c3];
            }
            _ => {}
        }
        std::array::from_fn(|k| all[k])
    }
    /// Whether a program jumps; known wherever programs with jumps are run.
    fn decided(truth: Self::Truth) -> bool;
}

/// [`Scalar::choose`] where comparisons are known at once.
macro_rules! decided_at_once {
    () => {
        type Truth = bool;

        #[inline]
        fn choose<const N: usize>(
            truth: bool,
            yes: impl FnOnce() -> [Self; N],
            no: impl FnOnce() -> [Self; N],
        ) -> [Self; N] {
            if truth { yes() } else { no() }
        }

        #[inline]
        fn decided(truth: bool) -> bool {
            truth
        }
    };
}

macro_rules! through_libm {
    ($($name:ident),*) => {$(
        #[inline]
        fn $name(self) -> Self {
            libm::$name(self)
        }
    )*};
}

#[allow(clippy::float_cmp)]
impl Scalar for f64 {
    decided_at_once!();
    through_libm!(exp, log10, sin, cos, tan, asin, acos, atan, sinh, cosh, tanh, asinh, atanh);

    #[inline]
    fn acosh(self) -> Self {
        sophy_ir::arithmetic::acosh(self)
    }
    #[inline]
    fn of(value: f64) -> Self {
        value
    }
    #[inline]
    fn abs(self) -> Self {
        f64::abs(self)
    }
    #[inline]
    fn square(self) -> Self {
        self * self
    }
    #[inline]
    fn sqrt(self) -> Self {
        f64::sqrt(self)
    }
    #[inline]
    fn ln(self) -> Self {
        libm::log(self)
    }
    #[inline]
    fn atan2(self, x: Self) -> Self {
        libm::atan2(self, x)
    }
    #[inline]
    fn pow(self, exponent: Self) -> Self {
        libm::pow(self, exponent)
    }
    #[inline]
    fn integer_power(self, n: i32) -> Self {
        sophy_ir::arithmetic::integer_power(self, n)
    }
    #[inline]
    fn floor(self) -> Self {
        f64::floor(self)
    }
    #[inline]
    fn sign(self) -> Self {
        sophy_ir::arithmetic::sign(self)
    }
    #[inline]
    fn count(self) -> usize {
        self as usize
    }
    #[inline]
    fn locate(self, knots: &[Self]) -> Self {
        sophy_ir::arithmetic::locate(knots, self)
    }
    #[inline]
    fn lookup(self, numbers: &[Self]) -> Self {
        sophy_ir::arithmetic::lookup(numbers, self)
    }
    #[inline]
    fn less(self, other: Self) -> bool {
        self < other
    }
    #[inline]
    fn equal(self, other: Self) -> bool {
        self == other
    }
}

macro_rules! through_interval {
    ($($name:ident),*) => {$(
        fn $name(self) -> Self {
            Interval::$name(self)
        }
    )*};
}

impl Scalar for Interval {
    decided_at_once!();
    through_interval!(
        abs, square, sqrt, exp, ln, log10, sin, cos, tan, asin, acos, atan, sinh, cosh, tanh, asinh, acosh,
        atanh, floor, sign
    );

    fn of(value: f64) -> Self {
        Interval::point(value)
    }
    fn atan2(self, x: Self) -> Self {
        Interval::atan2(self, x)
    }
    fn pow(self, exponent: Self) -> Self {
        Interval::pow(self, exponent)
    }
    fn integer_power(self, n: i32) -> Self {
        Interval::powi(self, n)
    }
    fn follow<const N: usize>(c: &[Self], s: Self) -> [Self; N] {
        let all = enclosed(c, s);
        std::array::from_fn(|k| all[k])
    }
    fn count(self) -> usize {
        self.midpoint() as usize
    }
    // What engines enclose is smooth: knots were lifted.
    fn locate(self, _: &[Self]) -> Self {
        Interval::ENTIRE
    }
    fn lookup(self, numbers: &[Self]) -> Self {
        let last = numbers.len().saturating_sub(1);
        let end = |position: f64| (position as usize).min(last);
        let between = numbers.get(end(self.lo)..=end(self.hi)).unwrap_or(&[]);
        between.iter().copied().reduce(Interval::hull).unwrap_or(Interval::ENTIRE)
    }
    fn less(self, other: Self) -> bool {
        self.midpoint() < other.midpoint()
    }
    fn equal(self, other: Self) -> bool {
        self == other
    }
}

/// Enclosures of a polynomial and of its Taylor coefficients over `s`.
fn enclosed(c: &[Interval], s: Interval) -> [Interval; 4] {
    let number = Interval::point;
    let coefficient = |k: usize| c.get(k).copied().unwrap_or(Interval::ZERO);
    let [c0, c1, c2, c3] = [0, 1, 2, 3].map(coefficient);
    let cubic = c.len() > 3;
    // The mean-value form is the tighter one on short spans, the power form keeps exact points.
    let (middle, square) = (number(s.midpoint()), s.square());
    let bend = number(3.0) * c3;
    let curvature = if cubic { c2 + bend * s } else { c2 };
    let slope = if cubic {
        let power = c1 + number(2.0) * c2 * s + bend * square;
        let centred =
            c1 + middle * (number(2.0) * c2 + bend * middle) + number(2.0) * curvature * (s - middle);
        power.intersection(centred).unwrap_or(power)
    } else {
        c1 + number(2.0) * c2 * s
    };
    let power = c0 + c1 * s + c2 * square;
    let power = if cubic { power + c3 * square * s } else { power };
    let inner = if cubic { c2 + middle * c3 } else { c2 };
    let centred = c0 + middle * (c1 + middle * inner) + slope * (s - middle);
    [power.intersection(centred).unwrap_or(power), slope, curvature, c3]
}
