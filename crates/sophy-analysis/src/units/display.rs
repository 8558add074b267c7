//! Units in messages.

use super::unit::nearly_equal;
use super::{Dimension, NoteKind, Unit, table};
use sophy_ir::Binary;
use std::fmt;

/// Units that messages use for a dimension of their own, where the SI unit is meant with a factor.
const SINGLE: [&str; 33] = [
    "kN", "MN", "lbf", "kgf", "kPa", "MPa", "hPa", "bar", "atm", "psi", "mmHg", "kW", "MW", "hp", "mW", "kJ",
    "MJ", "Wh", "kWh", "ft-lb", "in-lb", "mV", "kV", "Ah", "mA", "uF", "kOhm", "rpm", "kn", "mph", "g0", "l",
    "kHz",
];
/// Units that may stand in the place of kg, m and s, and before the rest.
const MASSES: [&str; 6] = ["kg", "g", "lb", "slug", "t", "mg"];
const LENGTHS: [&str; 9] = ["m", "ft", "mm", "cm", "km", "in", "nmi", "mi", "um"];
const TIMES: [&str; 7] = ["s", "min", "h", "ms", "us", "day", "year"];
const NUMBERS: [&str; 5] = ["deg", "%", "rev", "byte", "arcsec"];

/// As the modeller wrote it. What was computed, as an engineer would write it: `ft/s`, `deg/s`, `km/h`, `lbf`; else in
/// the words that it was computed of (`m/ft`) or as a multiple (`3.2 m/s`). A unit of unknown scale is written as its
/// dimension. [`super::parse`] reads it back.
impl fmt::Display for Unit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(written) = self.wording.as_written() {
            return f.write_str(written);
        }
        let Some(factor) = self.factor.filter(|factor| !nearly_equal(*factor, 1.0)) else {
            return self.dimension.fmt(f);
        };
        let whole_unit =
            |symbol: &&&str| factor_of(symbol, self.dimension).is_some_and(|x| nearly_equal(x, factor));
        if let Some(symbol) = SINGLE.iter().find(whole_unit) {
            return f.write_str(symbol);
        }
        for number in NUMBERS {
            let is_number = factor_of(number, Dimension::ONE).is_some_and(|x| nearly_equal(x, factor));
            if is_number {
                return write_multiple(f, number, self.dimension);
            }
        }
        if let Some([mass, length, time]) = other_bases(self.dimension, factor) {
            return self.dimension.write(f, [mass, length, time, "A", "K", "mol", "cd"]);
        }
        if let Some(words) = self.wording.text() {
            return f.write_str(words);
        }
        write!(f, "{}", rounded(factor, 13))?;
        if self.dimension.is_one() { Ok(()) } else { write_multiple(f, "", self.dimension) }
    }
}

/// `deg` and 1/s are `deg/s`, `deg` and m are `deg.m`.
fn write_multiple(f: &mut fmt::Formatter<'_>, number: &str, dimension: Dimension) -> fmt::Result {
    let rest = dimension.to_string();
    match rest.strip_prefix('1') {
        Some(below) => write!(f, "{number}{below}"),
        None if number.is_empty() => write!(f, " {rest}"),
        None => write!(f, "{number}.{rest}"),
    }
}

/// Names in the place of kg, m, s with which the dimension has the factor.
fn other_bases(dimension: Dimension, factor: f64) -> Option<[&'static str; 3]> {
    let [mass, length, time] = dimension.whole_mass_length_time();
    let scales = |symbols: &[&'static str], base: [i8; 7], exponent: i16| -> Vec<(&'static str, f64)> {
        let power = |symbol: &&'static str| {
            let factor = factor_of(symbol, Dimension::new(base))?;
            Some((*symbol, Binary::Power.apply(factor, f64::from(exponent))))
        };
        // Where the base unit does not occur, one name is as good as another.
        symbols.iter().take(if exponent == 0 { 1 } else { symbols.len() }).filter_map(power).collect()
    };
    let times = scales(&TIMES, [0, 0, 1, 0, 0, 0, 0], time);
    let lengths = scales(&LENGTHS, [0, 1, 0, 0, 0, 0, 0], length);
    for (mass, m) in scales(&MASSES, [1, 0, 0, 0, 0, 0, 0], mass) {
        for (length, l) in &lengths {
            let fits = |(_, t): &&(&str, f64)| nearly_equal(m * l * t, factor);
            if let Some((time, _)) = times.iter().find(fits) {
                return Some([mass, length, time]);
            }
        }
    }
    None
}

fn factor_of(symbol: &str, dimension: Dimension) -> Option<f64> {
    let (row, prefix) = table::find(symbol)?;
    (row.dimension == dimension).then_some(prefix * row.factor)
}

/// What to tell who mixed two scales: `1 ft = 0.3048 m`, in the direction with the shorter number.
///
/// The names are as the modeller wrote them, the empty one is that of plain numbers: `1 % = 0.01`. `None` if
/// there is no factor between the two.
pub(crate) fn conversion(a: (&str, Unit), b: (&str, Unit)) -> Option<String> {
    // Which temperature another one is takes more than a factor.
    let has_own_zero = |name: &str| {
        super::parse(name).is_ok_and(|parsed| parsed.notes.iter().any(|note| note.kind == NoteKind::Offset))
    };
    if has_own_zero(a.0) || has_own_zero(b.0) {
        return None;
    }
    let there = rounded(a.1.in_terms_of(b.1)?, 9);
    let back = rounded(b.1.in_terms_of(a.1)?, 9);
    let forward = b.0.is_empty() || (there.len() <= back.len() + 1 && !a.0.is_empty());
    let (one, number, other) = if forward { (a.0, there, b.0) } else { (b.0, back, a.0) };
    Some(format!("1 {one} = {number} {other}").trim_end().to_owned())
}

/// The shortest text with so many significant digits.
fn rounded(value: f64, digits: usize) -> String {
    let value = format!("{value:.*e}", digits - 1).parse().unwrap_or(value);
    let readable = (1e-5..1e9).contains(&value);
    if readable { format!("{value}") } else { format!("{value:e}") }
}

#[cfg(test)]
mod tests {
    use super::super::parse;
    use super::*;
    use proptest::prelude::*;

    /// A unit that nobody wrote.
    fn unit(text: &str) -> Unit {
        Unit { wording: super::super::wording::Wording::NONE, ..parse(text).unwrap().unit }
    }

    #[test]
    fn units_read_as_engineers_write_them() {
        for (text, expected) in [
            ("m/s2", "m/s2"),
            ("ft/s", "ft/s"),
            ("km/h", "km/h"),
            ("deg", "deg"),
            ("°/s", "deg/s"),
            ("rad/s", "1/s"),
            ("lbf", "lbf"),
            ("psi", "psi"),
            ("g", "g"),
            ("slug ft2", "slug.ft2"),
            ("lb/ft3", "lb/ft3"),
            ("min", "min"),
            ("%", "%"),
            ("kWh", "kWh"),
            ("rpm", "rpm"),
            ("1000 kg", "t"),
            ("7 m", "7 m"),
            ("7/s", "7/s"),
            ("7", "7"),
            ("degC", "K"),
        ] {
            assert_eq!(unit(text).to_string(), expected, "{text}");
            assert!(unit(&unit(text).to_string()).fits(unit(text)), "{text}");
        }
    }

    #[test]
    fn what_messages_name_is_known() {
        let all = SINGLE.iter().chain(&MASSES).chain(&LENGTHS).chain(&TIMES).chain(&NUMBERS);
        assert!(all.into_iter().all(|symbol| table::find(symbol).is_some()));
    }

    #[test]
    fn conversions_are_said_in_the_shorter_direction() {
        for (a, b, expected) in [
            ("ft", "m", Some("1 ft = 0.3048 m")),
            ("m", "ft", Some("1 ft = 0.3048 m")),
            ("kn", "m/s", Some("1 kn = 0.514444444 m/s")),
            ("h", "s", Some("1 h = 3600 s")),
            ("deg", "rad", Some("1 rad = 57.2957795 deg")),
            ("eV", "J", Some("1 eV = 1.60217663e-19 J")),
            ("m", "s", None),
            ("degC", "K", None),
            ("degF", "degC", None),
        ] {
            let said = conversion((a, unit(a)), (b, unit(b)));
            assert_eq!(said.as_deref(), expected, "{a} {b}");
        }
    }

    proptest! {
        #[test]
        fn a_dimension_is_read_back(exponents in prop::array::uniform7(-4..5_i8), root in 1..6) {
            let dimension = Dimension::new(exponents).power(1.0 / f64::from(root)).unwrap();
            let read = unit(&dimension.to_string());
            prop_assert_eq!(read.dimension, dimension);
            prop_assert_eq!(read.factor, Some(1.0));
        }

        #[test]
        fn a_unit_is_read_back(exponents in prop::array::uniform7(-3..4_i8), factor in 1e-12..1e12_f64) {
            let written = Unit::new(Dimension::new(exponents), factor);
            let read = unit(&written.to_string());
            prop_assert!(read.fits(written), "{} {:?}", written, read);
        }
    }
}
