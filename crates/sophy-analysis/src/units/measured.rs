//! What is known of the unit of an expression, while it is lowered from its leaves to its root.
//!
//! | | means | in a product | in sums, comparisons, assignments |
//! | --- | --- | --- | --- |
//! | [`Unchecked`](Measured::Unchecked) | some operand has no unit | stays unchecked | stays unchecked |
//! | [`Number`](Measured::Number) | made of literals | is dimensionless; may convert | adapts to anything |
//! | [`Known`](Measured::Known) | has a unit | units are multiplied | the units must fit |
//!
//! A literal may be a conversion (`0.3048*y`) or a coefficient with a unit of its own (`-420*x` is a force), so the
//! product with one is unchecked. The factors 1, 2, 4, ½ and ¼ of formulas (`0.5*rho*v^2`) are neither and keep
//! the unit. A literal times a dimensionless quantity is a number again: `5*sin(w*t)` may be volts.

use super::{Unit, conversion};
use sophy_ir::{Binary, Unary};
use std::fmt;

/// What is known of an expression's unit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Measured {
    /// Some operand has no unit: nothing is checked.
    Unchecked,
    /// Made of literals only, with its value if that is known: adapts.
    Number(Option<f64>),
    /// A quantity in this unit.
    Known(Unit),
}

use Measured::{Known, Number, Unchecked};

/// Two units that do not fit where they meet.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Mismatch {
    /// The unit of the left or only operand.
    pub(crate) left: Unit,
    /// The unit of the right operand, or the unit that is required.
    pub(crate) right: Unit,
}

impl Mismatch {
    /// Whether both measure the same and only the scale differs: a conversion is missing.
    pub(crate) fn is_of_scale(self) -> bool {
        self.left.same_dimension(self.right)
    }

    /// The conversion that is missing: `1 ft = 0.3048 m`.
    pub(crate) fn conversion(self) -> Option<String> {
        let (left, right) = (self.left.to_string(), self.right.to_string());
        // Beside an angle in degrees a plain number is one in radians.
        let beside = |name: &str, other: &str| {
            let angle = ["deg", "rev", "arcsec", "rpm"].iter().any(|unit| other.starts_with(unit));
            match name.strip_prefix('1').filter(|below| below.is_empty() || below.starts_with('/')) {
                Some(below) if angle && self.is_of_scale() => format!("rad{below}"),
                Some("") => String::new(),
                _ if name.starts_with(|c: char| c.is_ascii_digit()) => format!("({name})"),
                _ => name.to_owned(),
            }
        };
        conversion((&beside(&left, &right), self.left), (&beside(&right, &left), self.right))
    }
}

/// "`ft` and `m`": the rest of the sentence depends on where they met.
impl fmt::Display for Mismatch {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "`{}` and `{}`", self.left, self.right)
    }
}

impl std::error::Error for Mismatch {}

impl From<Option<Unit>> for Measured {
    /// What is declared without a unit is unchecked, and so is what has a unit beyond all bounds.
    fn from(unit: Option<Unit>) -> Measured {
        unit.map_or(Unchecked, Known)
    }
}

impl Measured {
    /// A literal.
    pub(crate) fn literal(value: f64) -> Measured {
        Number(Some(value))
    }

    /// Where two values take one place: sum, difference, comparison, assignment, the branches of a condition,
    /// `min`, `max`, `hypot`, `mod`, `rem`, the limits of `sat`.
    ///
    /// # Errors
    /// Both units are known and do not fit.
    pub(crate) fn agree(self, other: Measured) -> Result<Measured, Mismatch> {
        match (self, other) {
            (Unchecked, _) | (_, Unchecked) => Ok(Unchecked),
            (Number(a), Number(b)) => Ok(Number(if a == b { a } else { None })),
            (Known(unit), Number(_)) | (Number(_), Known(unit)) => Ok(Known(unit)),
            (Known(left), Known(right)) if left.fits(right) => {
                Ok(Known(if left.factor.is_some() { left } else { right }))
            }
            (Known(left), Known(right)) => Err(Mismatch { left, right }),
        }
    }

    /// A product.
    pub(crate) fn times(self, other: Measured) -> Measured {
        match (self, other) {
            (Unchecked, _) | (_, Unchecked) => Unchecked,
            (Number(a), Number(b)) => Number(a.zip(b).map(|(a, b)| a * b)),
            (Known(unit), Number(value)) | (Number(value), Known(unit)) => by_number(unit, value),
            (Known(a), Known(b)) => a.times(b).into(),
        }
    }

    /// A quotient.
    pub(crate) fn over(self, other: Measured) -> Measured {
        match (self, other) {
            (Unchecked, _) | (_, Unchecked) => Unchecked,
            (Number(a), Number(b)) => Number(a.zip(b).map(|(a, b)| a / b)),
            (Known(unit), Number(value)) => by_number(unit, value),
            (Number(value), Known(unit)) => {
                Unit::ONE.over(unit).map_or(Unchecked, |inverse| by_number(inverse, value))
            }
            (Known(a), Known(b)) => a.over(b).into(),
        }
    }

    /// A power. Of a quantity with a dimension it is known only for a literal exponent.
    ///
    /// # Errors
    /// The exponent is not a plain number.
    pub(crate) fn power(self, exponent: Measured) -> Result<Measured, Mismatch> {
        exponent.require_number()?;
        Ok(match (self, exponent) {
            (Unchecked, _) | (_, Unchecked) => Unchecked,
            (Number(a), Number(b)) => Number(a.zip(b).map(|(a, b)| Binary::Power.apply(a, b))),
            (Number(_), Known(_)) => Known(Unit::ONE),
            (Known(base), Number(Some(exponent))) => base.power(exponent).into(),
            (Known(base), _) if base.fits(Unit::ONE) => Known(base),
            (Known(_), _) => Unchecked,
        })
    }

    /// A square root.
    pub(crate) fn sqrt(self) -> Measured {
        match self {
            Unchecked => Unchecked,
            Number(value) => Number(value.map(f64::sqrt)),
            Known(unit) => unit.sqrt().into(),
        }
    }

    /// `sin`, `exp`, `ln` …: of a plain number, giving one; of degrees or percent only after a conversion.
    ///
    /// # Errors
    /// The argument is not a plain number.
    pub(crate) fn transcendental(self) -> Result<Measured, Mismatch> {
        self.require_number()?;
        Ok(self.without_unit())
    }

    /// `sign`: a plain number, whatever the argument.
    pub(crate) fn sign(self) -> Measured {
        self.without_unit()
    }

    /// `atan2`: of two quantities that fit, in radians.
    ///
    /// # Errors
    /// The units do not fit.
    pub(crate) fn atan2(self, other: Measured) -> Result<Measured, Mismatch> {
        self.agree(other).map(Measured::without_unit)
    }

    /// The derivative with respect to time.
    pub(crate) fn rate(self) -> Measured {
        match self {
            Known(unit) => unit.over(Unit::SECOND).into(),
            Number(_) => Number(None),
            Unchecked => Unchecked,
        }
    }

    /// A function of one argument.
    ///
    /// # Errors
    /// The argument does not fit the function.
    pub(crate) fn unary(self, function: Unary) -> Result<Measured, Mismatch> {
        match function {
            Unary::Negate | Unary::Abs | Unary::Floor | Unary::Smooth => Ok(match self {
                Number(value) => Number(value.map(|value| function.apply(value))),
                other => other,
            }),
            Unary::Sqrt => Ok(self.sqrt()),
            Unary::Sign => Ok(self.sign()),
            Unary::Sin
            | Unary::Cos
            | Unary::Tan
            | Unary::Asin
            | Unary::Acos
            | Unary::Atan
            | Unary::Sinh
            | Unary::Cosh
            | Unary::Tanh
            | Unary::Asinh
            | Unary::Acosh
            | Unary::Atanh
            | Unary::Exp
            | Unary::Ln
            | Unary::Log10 => self.transcendental(),
        }
    }

    /// An operation on two arguments.
    ///
    /// # Errors
    /// The arguments do not fit one another.
    pub(crate) fn binary(self, operation: Binary, other: Measured) -> Result<Measured, Mismatch> {
        match operation {
            Binary::Add | Binary::Subtract | Binary::Min | Binary::Max => match (self, other) {
                (Number(a), Number(b)) => Ok(Number(a.zip(b).map(|(a, b)| operation.apply(a, b)))),
                _ => self.agree(other),
            },
            Binary::Multiply => Ok(self.times(other)),
            Binary::Divide => Ok(self.over(other)),
            Binary::Power => self.power(other),
            Binary::Atan2 => self.atan2(other),
        }
    }

    fn require_number(self) -> Result<(), Mismatch> {
        match self {
            Known(left) if !left.fits(Unit::ONE) => Err(Mismatch { left, right: Unit::ONE }),
            Known(_) | Number(_) | Unchecked => Ok(()),
        }
    }

    /// Of a quantity a plain number in its place, which does not adapt: `der(x) = cos(psi)` lacks a speed.
    fn without_unit(self) -> Measured {
        match self {
            Known(_) => Known(Unit::ONE),
            Number(_) => Number(None),
            Unchecked => Unchecked,
        }
    }
}

/// A quantity times or over a literal.
fn by_number(unit: Unit, value: Option<f64>) -> Measured {
    // No two units in use differ by these, but formulas are full of them.
    let converts = !value.is_some_and(|value| [0.25, 0.5, 1.0, 2.0, 4.0].contains(&value.abs()));
    match converts {
        false => Known(unit),
        true if unit.dimension.is_one() => Number(None),
        true => Unchecked,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn known(text: &str) -> Measured {
        Known(super::super::parse(text).unwrap().unit)
    }

    fn literal(value: f64) -> Measured {
        Measured::literal(value)
    }

    fn fits(a: Measured, b: Measured) -> bool {
        a.agree(b).is_ok()
    }

    #[test]
    fn who_agrees_with_whom() {
        let (metre, foot, second, number) = (known("m"), known("ft"), known("s"), known("1"));
        for (a, b, expected) in [
            (metre, metre, true),
            (metre, foot, false),
            (metre, second, false),
            (metre, number, false),
            (metre, literal(5.0), true),
            (number, literal(5.0), true),
            (metre, Unchecked, true),
            (literal(0.0), literal(1.0), true),
            (known("rad"), number, true),
            (known("deg"), number, false),
            (known("degC"), known("K"), true),
            (known("degC"), known("V"), false),
        ] {
            assert_eq!(fits(a, b), expected, "{a:?} {b:?}");
            assert_eq!(fits(b, a), expected, "{b:?} {a:?}");
        }
        assert_eq!(metre.agree(Unchecked), Ok(Unchecked));
        assert_eq!(literal(3.0).agree(metre), Ok(metre));
    }

    #[test]
    fn a_literal_may_convert_or_have_a_unit_of_its_own() {
        for factor in [0.3048, -420.0] {
            let product = literal(factor).times(known("ft"));
            assert!(fits(product, known("m")) && fits(product, known("N")));
        }
        assert!(fits(literal(1.0).over(known("ft")), known("1/ft")));
    }

    #[test]
    fn factors_of_formulas_do_not_convert() {
        let doubled = literal(2.0).times(known("ft"));
        assert!(fits(doubled, known("ft")) && !fits(doubled, known("m")));
        let half = known("ft").over(literal(2.0));
        assert!(!fits(half, known("m")));
        let quarter = literal(1.0).over(literal(4.0)).times(known("ft"));
        assert!(!fits(quarter, known("m")));
        // ½ ρ v² S is a force.
        let pressure = literal(0.5).times(known("kg/m3")).times(known("m/s").power(literal(2.0)).unwrap());
        assert!(fits(pressure.times(known("m2")), known("N")));
        assert!(!fits(pressure.times(known("ft2")), known("N")));
    }

    #[test]
    fn a_literal_gives_a_plain_number_its_unit() {
        let wave = known("rad/s").times(known("s")).transcendental().unwrap();
        assert!(!fits(wave, known("V")));
        assert!(fits(literal(5.0).times(wave), known("V")));
        assert!(fits(literal(100.0).times(known("m").sign()), known("N")));
        assert!(fits(literal(57.3).times(known("rad")), known("deg")));
        assert!(!fits(literal(2.0).times(known("rad")), known("deg")));
    }

    #[test]
    fn functions_want_plain_numbers() {
        assert_eq!(known("rad").transcendental(), Ok(known("1")));
        assert_eq!(literal(1.0).transcendental(), Ok(Number(None)));
        assert_eq!(Unchecked.transcendental(), Ok(Unchecked));
        for refused in ["deg", "%", "m", "ft"] {
            assert!(known(refused).transcendental().is_err(), "{refused}");
            assert!(known("m").power(known(refused)).is_err(), "{refused}");
        }
        assert!(known("m").over(known("m")).transcendental().is_ok());
        assert!(known("m").over(known("ft")).transcendental().is_err());
        assert!(literal(0.0174).times(known("deg")).transcendental().is_ok());
    }

    #[test]
    fn powers_and_roots() {
        let power = |base, exponent| known(base).power(exponent).unwrap();
        assert!(fits(power("m", literal(2.0)), known("m2")));
        assert!(fits(power("m2", literal(0.5)), known("m")));
        assert_eq!(power("m", literal(0.0)), known("1"));
        assert_eq!(power("m", literal(0.123)), Unchecked);
        assert_eq!(power("m", known("1")), Unchecked);
        assert_eq!(power("1", known("1")), known("1"));
        assert_eq!(literal(2.0).power(literal(3.0)), Ok(literal(8.0)));
        assert_eq!(literal(2.0).power(known("1")), Ok(known("1")));
        assert!(fits(known("m").times(known("m/s2")).sqrt(), known("m/s")));
        assert_eq!(literal(4.0).sqrt(), literal(2.0));
    }

    #[test]
    fn functions_of_the_graph() {
        use Binary::{Add, Atan2, Divide, Max, Multiply};
        assert_eq!(known("ft").unary(Unary::Abs), Ok(known("ft")));
        assert_eq!(known("ft").unary(Unary::Floor), Ok(known("ft")));
        assert_eq!(literal(2.0).unary(Unary::Negate), Ok(literal(-2.0)));
        assert_eq!(known("ft").unary(Unary::Sign), Ok(known("1")));
        assert!(known("deg").unary(Unary::Sin).is_err());
        assert_eq!(known("ft").binary(Atan2, known("ft")), Ok(known("rad")));
        assert!(known("ft").binary(Atan2, known("m")).is_err());
        assert!(known("ft").binary(Max, known("m")).is_err());
        assert_eq!(literal(1.0).binary(Add, literal(3.0)), Ok(literal(4.0)));
        assert_eq!(known("m").binary(Divide, known("s")), Ok(known("m/s")));
        assert_eq!(known("m").binary(Multiply, Unchecked), Ok(Unchecked));
    }

    #[test]
    fn the_derivative_is_per_second() {
        assert_eq!(known("deg").rate(), known("deg/s"));
        assert!(!fits(known("ft").rate(), known("m/s")));
        assert_eq!(literal(1.0).rate(), Number(None));
        assert_eq!(Unchecked.rate(), Unchecked);
    }

    #[test]
    fn what_has_an_exponent_beyond_bounds_is_unchecked() {
        let mut power = known("m");
        for _ in 0..100 {
            power = power.times(power);
        }
        assert_eq!(power, Unchecked);
    }

    #[test]
    fn a_mismatch_says_what_to_convert() {
        let said = |a: &str, b: &str| {
            let mismatch = known(a).agree(known(b)).unwrap_err();
            (mismatch.to_string(), mismatch.is_of_scale(), mismatch.conversion())
        };
        let own = |text: &str| text.to_owned();
        assert_eq!(said("ft", "m"), (own("`ft` and `m`"), true, Some(own("1 ft = 0.3048 m"))));
        assert_eq!(said("m/s", "km/h"), (own("`m/s` and `km/h`"), true, Some(own("1 m/s = 3.6 km/h"))));
        assert_eq!(said("N", "m/s"), (own("`N` and `m/s`"), false, None));
        assert_eq!(said("%", "1"), (own("`%` and `1`"), true, Some(own("1 % = 0.01"))));
        assert_eq!(said("1", "%"), (own("`1` and `%`"), true, Some(own("1 % = 0.01"))));
        assert_eq!(said("deg", "rad"), (own("`deg` and `rad`"), true, Some(own("1 rad = 57.2957795 deg"))));
        assert_eq!(said("1/s", "rpm"), (own("`1/s` and `rpm`"), true, Some(own("1 rad/s = 9.54929659 rpm"))));
        assert_eq!(said("deg", "m"), (own("`deg` and `m`"), false, None));
        assert_eq!(said("1", "deg/s"), (own("`1` and `deg/s`"), false, None));
        assert_eq!(said("kg*m/s^2", "lb ft/s2").0, "`kg*m/s^2` and `lb ft/s2`");
        assert_eq!(said("degF", "K"), (own("`degF` and `K`"), true, None));
        assert_eq!(said("60/s", "m"), (own("`60/s` and `m`"), false, None));
        assert_eq!(said("60/s", "1/s").2, Some(own("1 (60/s) = 60 (1/s)")));
    }

    #[test]
    fn what_is_computed_has_a_name_if_it_can() {
        let said = |unit: Measured| unit.require_number().unwrap_err().left.to_string();
        let quotient = |a, b| known(a).over(known(b));
        assert_eq!(said(quotient("m", "ft")), "m/ft");
        assert_eq!(said(quotient("kg*m", "s2")), "N");
        assert_eq!(said(quotient("lbf", "kg/s2").over(known("ft"))), "lbf/(kg/s2)/ft");
        assert_eq!(said(known("ft/s").times(known("s"))), "ft");
        let long = known(&format!("1000{}m", " ".repeat(40)));
        assert_eq!(said(long), "km");
    }

    fn measured() -> impl Strategy<Value = Measured> {
        let unit = (prop::array::uniform7(-2..3_i8), prop::option::of(1e-3..1e3_f64));
        prop_oneof![
            Just(Unchecked),
            prop::sample::select(vec![0.5, 2.0, 0.3048, 1.0]).prop_map(Measured::literal),
            unit.prop_map(|(exponents, factor)| {
                let unit = Unit::si(super::super::Dimension::new(exponents));
                Known(Unit { factor, ..unit })
            }),
        ]
    }

    proptest! {
        #[test]
        fn order_does_not_matter(a in measured(), b in measured()) {
            prop_assert_eq!(fits(a, b), fits(b, a));
            prop_assert_eq!(a.times(b), b.times(a));
            prop_assert!(fits(a, a));
        }

        /// How a product is bracketed never makes a mistake of it.
        #[test]
        fn products_agree_however_bracketed(a in measured(), b in measured(), c in measured()) {
            prop_assert!(fits(a.times(b).times(c), a.times(b.times(c))));
        }

        #[test]
        fn what_is_unchecked_stays_so(a in measured()) {
            prop_assert_eq!(a.agree(Unchecked), Ok(Unchecked));
            prop_assert_eq!(Unchecked.times(a), Unchecked);
            prop_assert_eq!(a.over(Unchecked), Unchecked);
        }
    }
}
