//! A unit: a dimension and how many SI units it is.

use super::Dimension;
use super::wording::Wording;
use sophy_ir::Binary;

/// A multiple of the SI unit of its dimension.
///
/// The factor is `None` where it is not known: `0.3048*y` may be a conversion or may be not. Such a unit fits
/// every unit of its dimension. Units with an offset (`degC`) do not exist here; see [`super::parse`]. How it was
/// written is for messages only: units are equal without it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Unit {
    /// What is measured.
    pub(crate) dimension: Dimension,
    /// How many SI units one of it is, if that is known; positive and finite.
    pub(crate) factor: Option<f64>,
    /// In the modeller's words.
    pub(super) wording: Wording,
}

impl PartialEq for Unit {
    fn eq(&self, other: &Unit) -> bool {
        (self.dimension, self.factor) == (other.dimension, other.factor)
    }
}

impl Unit {
    /// The unit of numbers, and the radian.
    pub(crate) const ONE: Unit = Unit::si(Dimension::ONE);
    /// The unit of time.
    pub(crate) const SECOND: Unit = Unit::si(Dimension::new([0, 0, 1, 0, 0, 0, 0]));

    /// The SI unit of a dimension.
    pub(crate) const fn si(dimension: Dimension) -> Unit {
        Unit { dimension, factor: Some(1.0), wording: Wording::NONE }
    }

    /// `factor` SI units; of unknown factor if it is not a positive normal number.
    pub(crate) fn new(dimension: Dimension, factor: f64) -> Unit {
        let factor = Some(factor).filter(|f| f.is_normal() && *f > 0.0);
        Unit { dimension, factor, wording: Wording::NONE }
    }

    /// The same as the modeller wrote it.
    pub(super) fn written(self, text: &str) -> Unit {
        Unit { wording: Wording::of(text), ..self }
    }

    /// The same dimension in an unknown scale.
    pub(crate) fn of_unknown_scale(self) -> Unit {
        Unit { factor: None, wording: Wording::NONE, ..self }
    }

    /// The unit of a product; `None` if exponents grow beyond bounds.
    pub(crate) fn times(self, other: Unit) -> Option<Unit> {
        let dimension = self.dimension.times(other.dimension)?;
        let wording = Wording::combined(self.wording, other.wording, "*");
        Some(Unit { wording, ..self.scaled(other, dimension, |a, b| a * b) })
    }

    /// The unit of a quotient; `None` if exponents grow beyond bounds.
    pub(crate) fn over(self, other: Unit) -> Option<Unit> {
        let dimension = self.dimension.over(other.dimension)?;
        let wording = Wording::combined(self.wording, other.wording, "/");
        Some(Unit { wording, ..self.scaled(other, dimension, |a, b| a / b) })
    }

    fn scaled(self, other: Unit, dimension: Dimension, with: fn(f64, f64) -> f64) -> Unit {
        match (self.factor, other.factor) {
            (Some(a), Some(b)) => Unit::new(dimension, with(a, b)),
            _ => Unit::si(dimension).of_unknown_scale(),
        }
    }

    /// The unit of a power; `None` if there is no such dimension (see [`Dimension::power`]).
    pub(crate) fn power(self, exponent: f64) -> Option<Unit> {
        let dimension = self.dimension.power(exponent)?;
        let power = |factor| Unit::new(dimension, Binary::Power.apply(factor, exponent));
        Some(self.factor.map_or(Unit::si(dimension).of_unknown_scale(), power))
    }

    /// The unit of a square root.
    pub(crate) fn sqrt(self) -> Option<Unit> {
        self.power(0.5)
    }

    /// Whether both measure the same kind of quantity.
    pub(crate) fn same_dimension(self, other: Unit) -> bool {
        self.dimension == other.dimension
    }

    /// Whether a number means the same in both, or may do so because one scale is unknown.
    pub(crate) fn same_scale(self, other: Unit) -> bool {
        match (self.factor, other.factor) {
            (Some(a), Some(b)) => nearly_equal(a, b),
            _ => true,
        }
    }

    /// Whether a quantity in one can stand for a quantity in the other.
    pub(crate) fn fits(self, other: Unit) -> bool {
        self.same_dimension(other) && self.same_scale(other)
    }

    /// How many of `other` one of this unit is, if both scales are known and the dimensions are the same.
    pub(crate) fn in_terms_of(self, other: Unit) -> Option<f64> {
        let ratio = self.factor? / other.factor?;
        (self.same_dimension(other) && ratio.is_normal()).then_some(ratio)
    }
}

/// Equal but for the rounding of a few operations; far below any difference between two units.
pub(super) fn nearly_equal(a: f64, b: f64) -> bool {
    const RELATIVE: f64 = 1e-12;
    (a - b).abs() <= RELATIVE * a.abs().max(b.abs())
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn unit(text: &str) -> Unit {
        super::super::parse(text).unwrap().unit
    }

    #[test]
    fn scales_are_compared() {
        assert!(unit("ft").fits(unit("0.3048 m")));
        assert!(!unit("ft").same_scale(unit("m")));
        assert!(unit("ft").same_dimension(unit("m")));
        assert!(unit("ft").of_unknown_scale().fits(unit("m")));
        assert!(!unit("ft").of_unknown_scale().fits(unit("s")));
        assert!(unit("rad").fits(Unit::ONE));
        assert!(!unit("deg").fits(Unit::ONE));
    }

    #[test]
    fn a_scale_beyond_all_numbers_is_unknown() {
        let huge = unit("Ym").power(20.0).unwrap();
        assert_eq!(huge.factor, None);
        assert_eq!(Unit::new(Dimension::ONE, -1.0).factor, None);
        assert_eq!(Unit::new(Dimension::ONE, f64::NAN).factor, None);
    }

    #[test]
    fn one_unit_in_terms_of_another() {
        let per = |a: &str, b: &str| unit(a).in_terms_of(unit(b));
        assert_eq!(per("ft", "in").map(f64::round), Some(12.0));
        assert_eq!(per("ft", "s"), None);
        assert_eq!(unit("ft").of_unknown_scale().in_terms_of(unit("m")), None);
    }

    fn any_unit() -> impl Strategy<Value = Unit> {
        (prop::array::uniform7(-3..4_i8), 1e-3..1e3_f64)
            .prop_map(|(exponents, factor)| Unit::new(Dimension::new(exponents), factor))
    }

    proptest! {
        #[test]
        fn multiplication_is_associative_and_division_undoes_it(a in any_unit(), b in any_unit(), c in any_unit()) {
            let left = a.times(b).and_then(|ab| ab.times(c)).unwrap();
            let right = b.times(c).and_then(|bc| a.times(bc)).unwrap();
            prop_assert!(left.fits(right));
            prop_assert!(left.over(c).and_then(|ab| ab.over(b)).unwrap().fits(a));
        }

        #[test]
        fn powers_follow_the_laws(a in any_unit(), b in any_unit(), n in 1..4_i32) {
            let n = f64::from(n);
            let product = a.times(b).unwrap();
            prop_assert!(product.power(n).unwrap().fits(a.power(n).unwrap().times(b.power(n).unwrap()).unwrap()));
            prop_assert!(a.power(-n).unwrap().fits(Unit::ONE.over(a.power(n).unwrap()).unwrap()));
            let root = a.sqrt().unwrap();
            prop_assert!(root.times(root).unwrap().fits(a));
            let third = a.power(1.0 / 3.0).unwrap();
            prop_assert!(third.power(3.0).unwrap().fits(a));
        }
    }
}
