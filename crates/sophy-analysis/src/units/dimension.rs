//! The exponents of a quantity over the SI base units.

use std::fmt;

/// Exponents are kept in sixtieths: halves, thirds, quarters, fifths and what these make with one another.
const PARTS: i16 = 60;

/// The base units in the order of the exponents.
const BASES: [&str; 7] = ["kg", "m", "s", "A", "K", "mol", "cd"];

/// Exponents over kilogram, metre, second, ampere, kelvin, mole and candela.
///
/// They may be fractions (of a noise density, say), and have bounds: an operation that would leave them, or
/// give an exponent that is no multiple of 1/60, returns `None`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) struct Dimension {
    sixtieths: [i16; 7],
}

impl Dimension {
    /// The dimension of numbers and angles.
    pub(crate) const ONE: Dimension = Dimension::new([0; 7]);

    /// A dimension with whole exponents of kg, m, s, A, K, mol, cd.
    pub(crate) const fn new(exponents: [i8; 7]) -> Dimension {
        let mut sixtieths = [0; 7];
        let mut i = 0;
        while i < 7 {
            sixtieths[i] = PARTS * exponents[i] as i16;
            i += 1;
        }
        Dimension { sixtieths }
    }

    /// Whether this is the dimension of numbers.
    pub(crate) fn is_one(self) -> bool {
        self == Dimension::ONE
    }

    /// The dimension of a product.
    pub(crate) fn times(self, other: Dimension) -> Option<Dimension> {
        self.combined(other, i16::checked_add)
    }

    /// The dimension of a quotient.
    pub(crate) fn over(self, other: Dimension) -> Option<Dimension> {
        self.combined(other, i16::checked_sub)
    }

    fn combined(self, other: Dimension, with: fn(i16, i16) -> Option<i16>) -> Option<Dimension> {
        let mut sixtieths = self.sixtieths;
        for (exponent, other) in sixtieths.iter_mut().zip(other.sixtieths) {
            *exponent = with(*exponent, other)?;
        }
        Some(Dimension { sixtieths })
    }

    /// The dimension of a power. Thirds are given as the nearest `f64`.
    pub(crate) fn power(self, exponent: f64) -> Option<Dimension> {
        const NEAR: f64 = 1e-6;
        let mut sixtieths = self.sixtieths;
        for part in &mut sixtieths {
            let exact = f64::from(*part) * exponent;
            let whole = exact.round();
            let fits = (exact - whole).abs() <= NEAR && whole.abs() <= f64::from(i16::MAX);
            if !fits {
                return None;
            }
            *part = whole as i16;
        }
        Some(Dimension { sixtieths })
    }

    /// The whole exponents of kg, m and s with 0 for a fraction: candidates for another unit in their place.
    pub(super) fn whole_mass_length_time(self) -> [i16; 3] {
        let [mass, length, time, ..] = self.sixtieths;
        [mass, length, time].map(|part| if part % PARTS == 0 { part / PARTS } else { 0 })
    }

    /// Writes the dimension with other names for the base units: `kg.m2/(s3.A)`, `1/s`, `m^(1/2)`, `1`.
    pub(super) fn write(self, f: &mut fmt::Formatter<'_>, bases: [&str; 7]) -> fmt::Result {
        let factors = || bases.iter().zip(self.sixtieths);
        let below = factors().filter(|(_, part)| *part < 0).count();
        let mut separator = "";
        for (base, part) in factors().filter(|(_, part)| *part > 0) {
            write!(f, "{separator}{base}")?;
            write_exponent(f, part.unsigned_abs())?;
            separator = ".";
        }
        if separator.is_empty() {
            f.write_str("1")?;
        }
        separator = if below > 1 { "/(" } else { "/" };
        for (base, part) in factors().filter(|(_, part)| *part < 0) {
            write!(f, "{separator}{base}")?;
            write_exponent(f, part.unsigned_abs())?;
            separator = ".";
        }
        if below > 1 { f.write_str(")") } else { Ok(()) }
    }
}

fn write_exponent(f: &mut fmt::Formatter<'_>, sixtieths: u16) -> fmt::Result {
    let parts = PARTS.unsigned_abs();
    let common = greatest_common_divisor(sixtieths, parts);
    match (sixtieths / common, parts / common) {
        (1, 1) => Ok(()),
        (whole, 1) => write!(f, "{whole}"),
        (above, below) => write!(f, "^({above}/{below})"),
    }
}

fn greatest_common_divisor(a: u16, b: u16) -> u16 {
    if b == 0 { a } else { greatest_common_divisor(b, a % b) }
}

/// Dimensions that are better known under a name. Torque and energy share one, a flux and the
/// constant of a motor another; `N.m` and `V.s` mislead nobody.
const NAMED: [(&str, Dimension); 12] = [
    ("N", Dimension::new([1, 1, -2, 0, 0, 0, 0])),
    ("Pa", Dimension::new([1, -1, -2, 0, 0, 0, 0])),
    ("N.m", Dimension::new([1, 2, -2, 0, 0, 0, 0])),
    ("W", Dimension::new([1, 2, -3, 0, 0, 0, 0])),
    ("C", Dimension::new([0, 0, 1, 1, 0, 0, 0])),
    ("V", Dimension::new([1, 2, -3, -1, 0, 0, 0])),
    ("Ohm", Dimension::new([1, 2, -3, -2, 0, 0, 0])),
    ("S", Dimension::new([-1, -2, 3, 2, 0, 0, 0])),
    ("F", Dimension::new([-1, -2, 4, 2, 0, 0, 0])),
    ("V.s", Dimension::new([1, 2, -2, -1, 0, 0, 0])),
    ("T", Dimension::new([1, 0, -2, -1, 0, 0, 0])),
    ("H", Dimension::new([1, 2, -2, -2, 0, 0, 0])),
];

/// In SI units: by name where there is one (`N`), else `kg/s2`; `1` for numbers. [`super::parse`] reads it back.
impl fmt::Display for Dimension {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match NAMED.iter().find(|(_, dimension)| dimension == self) {
            Some((name, _)) => f.write_str(name),
            None => self.write(f, BASES),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const METRE: Dimension = Dimension::new([0, 1, 0, 0, 0, 0, 0]);

    #[test]
    fn it_is_written_as_one_would_write_it() {
        for (exponents, expected) in [
            ([0, 0, 0, 0, 0, 0, 0], "1"),
            ([0, 0, -1, 0, 0, 0, 0], "1/s"),
            ([0, 1, -2, 0, 0, 0, 0], "m/s2"),
            ([1, 1, -2, 0, 0, 0, 0], "N"),
            ([1, 2, -3, -1, 0, 0, 0], "V"),
            ([1, 0, -3, 0, -1, 0, 0], "kg/(s3.K)"),
            ([1, 2, -1, 0, 0, 0, 0], "kg.m2/s"),
            ([0, 0, 0, 0, 0, -1, -2], "1/(mol.cd2)"),
        ] {
            assert_eq!(Dimension::new(exponents).to_string(), expected);
        }
    }

    #[test]
    fn roots_are_exact_or_refused() {
        let root = METRE.power(0.5).unwrap();
        assert_eq!(root.to_string(), "m^(1/2)");
        assert_eq!(root.times(root), Some(METRE));
        let third = METRE.power(1.0 / 3.0).unwrap();
        assert_eq!(third.to_string(), "m^(1/3)");
        assert_eq!(third.power(3.0), Some(METRE));
        assert_eq!(METRE.power(1.8).unwrap().to_string(), "m^(9/5)");
        for refused in [1.0 / 7.0, 0.123, 1e9, f64::NAN, f64::INFINITY] {
            assert_eq!(METRE.power(refused), None, "{refused}");
        }
        assert_eq!(Dimension::ONE.power(0.123), Some(Dimension::ONE));
    }

    #[test]
    fn exponents_have_bounds() {
        let mut power = METRE;
        let mut doublings = 0;
        while let Some(square) = power.times(power) {
            power = square;
            doublings += 1;
        }
        assert_eq!(doublings, 9);
        assert_eq!(Dimension::ONE.over(power).and_then(|p| p.over(power)), None);
    }

    fn dimension() -> impl Strategy<Value = Dimension> {
        prop::array::uniform7(-4..5_i8).prop_map(Dimension::new)
    }

    proptest! {
        #[test]
        fn products_and_powers_follow_the_laws(a in dimension(), b in dimension(), c in dimension(), n in -3..4) {
            let n = f64::from(n);
            let product = a.times(b).unwrap();
            prop_assert_eq!(product.times(c), b.times(c).and_then(|bc| a.times(bc)));
            prop_assert_eq!(a.times(b), b.times(a));
            prop_assert_eq!(product.over(b), Some(a));
            prop_assert_eq!(product.power(n), a.power(n).unwrap().times(b.power(n).unwrap()));
            prop_assert_eq!(a.power(n).unwrap().times(a), a.power(n + 1.0));
            for root in [2.0, 3.0, 4.0, 5.0] {
                prop_assert_eq!(a.power(1.0 / root).unwrap().power(root), Some(a));
            }
        }
    }
}
