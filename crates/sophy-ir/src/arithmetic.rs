//! The one meaning of every operation.
//!
//! IEEE double, round to nearest; no contraction, no re-association, no `0·x → 0`. Elementary functions are
//! those of the `libm` crate on every platform, so that folding, interpreter and native code give the same
//! bits. `min(a, b)` is `if a < b then a else b`; integer powers are a fixed chain of products.

/// A function of one number.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[allow(missing_docs)] // the names are those of the language
pub enum Unary {
    Negate,
    Sin,
    Cos,
    Tan,
    Asin,
    Acos,
    Atan,
    Sinh,
    Cosh,
    Tanh,
    Asinh,
    Acosh,
    Atanh,
    Exp,
    Ln,
    Log10,
    Sqrt,
    Abs,
    Sign,
    Floor,
    /// The number itself: switches inside are no events.
    Smooth,
}

/// A function of two numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[allow(missing_docs)]
pub enum Binary {
    Add,
    Subtract,
    Multiply,
    Divide,
    Power,
    Min,
    Max,
    Atan2,
}

/// A comparison of two numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[allow(missing_docs)]
pub enum Comparison {
    Less,
    LessEqual,
    Greater,
    GreaterEqual,
    Equal,
    NotEqual,
}

impl Unary {
    /// The name in the language; `-` for [`Unary::Negate`].
    pub fn name(self) -> &'static str {
        match self {
            Unary::Negate => "-",
            Unary::Sin => "sin",
            Unary::Cos => "cos",
            Unary::Tan => "tan",
            Unary::Asin => "asin",
            Unary::Acos => "acos",
            Unary::Atan => "atan",
            Unary::Sinh => "sinh",
            Unary::Cosh => "cosh",
            Unary::Tanh => "tanh",
            Unary::Asinh => "asinh",
            Unary::Acosh => "acosh",
            Unary::Atanh => "atanh",
            Unary::Exp => "exp",
            Unary::Ln => "ln",
            Unary::Log10 => "log10",
            Unary::Sqrt => "sqrt",
            Unary::Abs => "abs",
            Unary::Sign => "sign",
            Unary::Floor => "floor",
            Unary::Smooth => "smooth",
        }
    }

    /// The value at `x`.
    #[inline]
    pub fn apply(self, x: f64) -> f64 {
        match self {
            Unary::Negate => -x,
            Unary::Sin => libm::sin(x),
            Unary::Cos => libm::cos(x),
            Unary::Tan => libm::tan(x),
            Unary::Asin => libm::asin(x),
            Unary::Acos => libm::acos(x),
            Unary::Atan => libm::atan(x),
            Unary::Sinh => libm::sinh(x),
            Unary::Cosh => libm::cosh(x),
            Unary::Tanh => libm::tanh(x),
            Unary::Asinh => libm::asinh(x),
            Unary::Acosh => acosh(x),
            Unary::Atanh => libm::atanh(x),
            Unary::Exp => libm::exp(x),
            Unary::Ln => libm::log(x),
            Unary::Log10 => libm::log10(x),
            Unary::Sqrt => x.sqrt(),
            Unary::Abs => {
                if x < 0.0 {
                    -x
                } else {
                    x
                }
            }
            Unary::Sign => sign(x),
            Unary::Floor => x.floor(),
            Unary::Smooth => x,
        }
    }
}

impl Binary {
    /// Infix symbol or function name.
    pub fn name(self) -> &'static str {
        match self {
            Binary::Add => "+",
            Binary::Subtract => "-",
            Binary::Multiply => "*",
            Binary::Divide => "/",
            Binary::Power => "^",
            Binary::Min => "min",
            Binary::Max => "max",
            Binary::Atan2 => "atan2",
        }
    }

    /// The value at `(a, b)`.
    #[inline]
    pub fn apply(self, a: f64, b: f64) -> f64 {
        match self {
            Binary::Add => a + b,
            Binary::Subtract => a - b,
            Binary::Multiply => a * b,
            Binary::Divide => a / b,
            Binary::Power => libm::pow(a, b),
            Binary::Min => {
                if a < b {
                    a
                } else {
                    b
                }
            }
            Binary::Max => {
                if a < b {
                    b
                } else {
                    a
                }
            }
            Binary::Atan2 => libm::atan2(a, b),
        }
    }
}

impl Comparison {
    /// The symbol in the language.
    pub fn symbol(self) -> &'static str {
        match self {
            Comparison::Less => "<",
            Comparison::LessEqual => "<=",
            Comparison::Greater => ">",
            Comparison::GreaterEqual => ">=",
            Comparison::Equal => "=",
            Comparison::NotEqual => "<>",
        }
    }

    /// Truth for plain numbers.
    #[inline]
    #[allow(clippy::float_cmp)]
    pub fn holds(self, a: f64, b: f64) -> bool {
        match self {
            Comparison::Less => a < b,
            Comparison::LessEqual => a <= b,
            Comparison::Greater => a > b,
            Comparison::GreaterEqual => a >= b,
            Comparison::Equal => a == b,
            Comparison::NotEqual => a != b,
        }
    }

    /// The comparison that says the same with the two sides exchanged.
    #[must_use]
    pub fn mirrored(self) -> Self {
        match self {
            Comparison::Less => Comparison::Greater,
            Comparison::LessEqual => Comparison::GreaterEqual,
            Comparison::Greater => Comparison::Less,
            Comparison::GreaterEqual => Comparison::LessEqual,
            same => same,
        }
    }
}

/// acosh, NaN below 1 (the library gives a number there).
#[inline]
pub fn acosh(x: f64) -> f64 {
    if x < 1.0 { f64::NAN } else { libm::acosh(x) }
}

/// The position of the last of increasing knots that is not above `x`; NaN outside of their range, up to rounding.
#[inline]
pub fn locate(knots: &[f64], x: f64) -> f64 {
    let (Some(&first), Some(&last)) = (knots.first(), knots.last()) else { return f64::NAN };
    // Equal means: within 4 ulp.
    let slack = |end: f64| 4.0 * (end.abs().next_up() - end.abs());
    if x >= first && x <= last {
        (knots.partition_point(|&knot| knot <= x) - 1) as f64
    } else if x < first && first - x <= slack(first) {
        0.0
    } else if x > last && x - last <= slack(last) {
        (knots.len() - 1) as f64
    } else {
        f64::NAN
    }
}

/// The number at a position: the first one before it, the last one behind it, NaN at NaN.
#[inline]
pub fn lookup(numbers: &[f64], position: f64) -> f64 {
    if position.is_nan() {
        return position;
    }
    // What is negative becomes 0.
    let at = (position as usize).min(numbers.len().saturating_sub(1));
    numbers.get(at).copied().unwrap_or(f64::NAN)
}

/// −1, 0 or 1 (+0 for both zeros); NaN stays NaN.
#[inline]
pub fn sign(x: f64) -> f64 {
    if x > 0.0 {
        1.0
    } else if x < 0.0 {
        -1.0
    } else if x.is_nan() {
        x
    } else {
        0.0
    }
}

/// `xⁿ` by binary powering, the lowest bit first; a negative `n` is one division at the end.
#[inline]
pub fn integer_power(x: f64, n: i32) -> f64 {
    let mut remaining = n.unsigned_abs();
    let mut square = x;
    let mut product = 1.0;
    while remaining > 0 {
        if remaining & 1 == 1 {
            product *= square;
        }
        remaining >>= 1;
        if remaining > 0 {
            square *= square;
        }
    }
    if n < 0 { 1.0 / product } else { product }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_conventions() {
        assert_eq!(sign(0.0), 0.0);
        assert_eq!(sign(-3.0), -1.0);
        assert!(sign(f64::NAN).is_nan());
        assert!(acosh(0.5).is_nan() && acosh(-5.0).is_nan() && acosh(1.0) == 0.0);
        assert_eq!(integer_power(2.0, 10), 1024.0);
        assert_eq!(integer_power(2.0, -2), 0.25);
        assert_eq!(integer_power(0.0, 0), 1.0);
        assert_eq!(Binary::Min.apply(1.0, 2.0), 1.0);
        assert_eq!(Binary::Max.apply(1.0, 2.0), 2.0);
    }
}
