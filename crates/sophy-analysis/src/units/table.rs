//! The units that are known, with their factors from the definitions, and the SI prefixes.
//!
//! A whole word of the table wins over prefix and unit: `min` is the minute, `ft` the foot, `kt` the knot, `cd`
//! the candela. `g` is the gram; the acceleration is `g0` or `gee`. `C` and `F` are coulomb and farad. `lb` is
//! the mass, except in the torques `lb-ft`, `ft-lb`, `lb-in`, `in-lb`, where it can only be the force. `cal` is
//! the thermochemical calorie, `gal` the US gallon, `hp` the mechanical horsepower, `year` 365.25 days.

use super::Dimension;
use std::collections::HashMap;
use std::f64::consts::PI;
use std::sync::LazyLock;

/// Which SI prefixes make sense before a unit.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Prefixes {
    Never,
    /// Those below one, as in `mrad`.
    Small,
    /// Those above one, as in `kbit`.
    Large,
    All,
}

/// How values in a unit relate to values in the SI unit.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Relation {
    /// By a factor.
    Factor,
    /// By a factor and another zero; differences by the factor alone.
    Offset,
    /// By a logarithm.
    Logarithm,
}

/// One unit under all its names.
pub(super) struct Row {
    /// As in formulas; the first is how it is written in messages.
    pub(crate) symbols: &'static [&'static str],
    /// In words, which also have a plural in `s` and take the prefixes in words.
    names: &'static [&'static str],
    prefixes: Prefixes,
    pub(crate) dimension: Dimension,
    pub(crate) factor: f64,
    pub(crate) relation: Relation,
}

impl Row {
    const fn offset(self) -> Row {
        Row { relation: Relation::Offset, ..self }
    }

    const fn logarithm(self) -> Row {
        Row { relation: Relation::Logarithm, ..self }
    }
}

const fn row(
    symbols: &'static [&'static str],
    names: &'static [&'static str],
    prefixes: Prefixes,
    exponents: [i8; 7],
    factor: f64,
) -> Row {
    let dimension = Dimension::new(exponents);
    Row { symbols, names, prefixes, dimension, factor, relation: Relation::Factor }
}

// Exponents of kg, m, s, A, K, mol, cd.
const NUMBER: [i8; 7] = [0; 7];
const MASS: [i8; 7] = [1, 0, 0, 0, 0, 0, 0];
const LENGTH: [i8; 7] = [0, 1, 0, 0, 0, 0, 0];
const TIME: [i8; 7] = [0, 0, 1, 0, 0, 0, 0];
const TEMPERATURE: [i8; 7] = [0, 0, 0, 0, 1, 0, 0];
const AREA: [i8; 7] = [0, 2, 0, 0, 0, 0, 0];
const VOLUME: [i8; 7] = [0, 3, 0, 0, 0, 0, 0];
const RATE: [i8; 7] = [0, 0, -1, 0, 0, 0, 0];
const SPEED: [i8; 7] = [0, 1, -1, 0, 0, 0, 0];
const ACCELERATION: [i8; 7] = [0, 1, -2, 0, 0, 0, 0];
const DOSE: [i8; 7] = [0, 2, -2, 0, 0, 0, 0];
const FORCE: [i8; 7] = [1, 1, -2, 0, 0, 0, 0];
const PRESSURE: [i8; 7] = [1, -1, -2, 0, 0, 0, 0];
const ENERGY: [i8; 7] = [1, 2, -2, 0, 0, 0, 0];
const POWER: [i8; 7] = [1, 2, -3, 0, 0, 0, 0];
const CHARGE: [i8; 7] = [0, 0, 1, 1, 0, 0, 0];

// Exact by definition (international yard and pound 1959, CGPM 1901, SI 2019).
const INCH: f64 = 0.0254;
const FOOT: f64 = 0.3048;
const MILE: f64 = 1609.344;
const POUND: f64 = 0.453_592_37;
const GRAVITY: f64 = 9.806_65;
const POUND_FORCE: f64 = POUND * GRAVITY;
const PSI: f64 = POUND_FORCE / (INCH * INCH);
const MERCURY: f64 = 133.322_387_415;
const MINUTE: f64 = 60.0;
const HOUR: f64 = 3600.0;
const DAY: f64 = 86_400.0;
const DEGREE: f64 = PI / 180.0;

use Prefixes::{All, Large, Never, Small};

pub(super) static TABLE: &[Row] = &[
    // SI base units, and the gram that bears the prefixes of the kilogram.
    row(&["m"], &["metre", "meter"], All, LENGTH, 1.0),
    row(&["kg"], &[], Never, MASS, 1.0),
    row(&["g"], &["gram", "gramme"], All, MASS, 1e-3),
    row(&["s", "sec"], &["second"], All, TIME, 1.0),
    row(&["A"], &["ampere", "amp"], All, [0, 0, 0, 1, 0, 0, 0], 1.0),
    row(&["K"], &["kelvin"], All, TEMPERATURE, 1.0),
    row(&["mol"], &["mole"], All, [0, 0, 0, 0, 0, 1, 0], 1.0),
    row(&["cd"], &["candela"], All, [0, 0, 0, 0, 0, 0, 1], 1.0),
    // SI derived units.
    row(&["N"], &["newton"], All, FORCE, 1.0),
    row(&["Pa"], &["pascal"], All, PRESSURE, 1.0),
    row(&["J"], &["joule"], All, ENERGY, 1.0),
    row(&["W"], &["watt"], All, POWER, 1.0),
    row(&["C"], &["coulomb"], All, CHARGE, 1.0),
    row(&["V"], &["volt"], All, [1, 2, -3, -1, 0, 0, 0], 1.0),
    row(&["Ohm", "ohm", "\u{3a9}", "\u{2126}"], &[], All, [1, 2, -3, -2, 0, 0, 0], 1.0),
    row(&["S"], &["siemens"], All, [-1, -2, 3, 2, 0, 0, 0], 1.0),
    row(&["F"], &["farad"], All, [-1, -2, 4, 2, 0, 0, 0], 1.0),
    row(&["Wb"], &["weber"], All, [1, 2, -2, -1, 0, 0, 0], 1.0),
    row(&["T"], &["tesla"], All, [1, 0, -2, -1, 0, 0, 0], 1.0),
    row(&["H"], &["henry"], All, [1, 2, -2, -2, 0, 0, 0], 1.0),
    row(&["Hz"], &["hertz"], All, RATE, 1.0),
    row(&["lm"], &["lumen"], All, [0, 0, 0, 0, 0, 0, 1], 1.0),
    row(&["lx"], &["lux"], All, [0, -2, 0, 0, 0, 0, 1], 1.0),
    row(&["Bq"], &["becquerel"], All, RATE, 1.0),
    row(&["Gy"], &["gray"], All, DOSE, 1.0),
    row(&["Sv"], &["sievert"], All, DOSE, 1.0),
    row(&["kat"], &["katal"], Never, [0, 0, -1, 0, 0, 1, 0], 1.0),
    // Products that are written as one word.
    row(&["Nm"], &[], All, ENERGY, 1.0),
    row(&["Nms"], &[], All, [1, 2, -1, 0, 0, 0, 0], 1.0),
    row(&["Ns"], &[], All, [1, 1, -1, 0, 0, 0, 0], 1.0),
    row(&["Ws"], &[], All, ENERGY, 1.0),
    row(&["As"], &[], All, CHARGE, 1.0),
    row(&["Vs"], &[], All, [1, 2, -2, -1, 0, 0, 0], 1.0),
    row(&["VA", "var"], &[], All, POWER, 1.0),
    row(&["Wh"], &[], All, ENERGY, HOUR),
    row(&["Ah"], &[], All, CHARGE, HOUR),
    // Numbers and angles.
    row(&["%", "percent"], &[], Never, NUMBER, 1e-2),
    row(&["‰"], &[], Never, NUMBER, 1e-3),
    row(&["ppm"], &[], Never, NUMBER, 1e-6),
    row(&["pu"], &["dimensionless", "unitless", "none"], Never, NUMBER, 1.0),
    row(&["dB"], &["decibel"], Never, NUMBER, 1.0).logarithm(),
    row(&["rad"], &["radian"], All, NUMBER, 1.0),
    row(&["sr"], &["steradian"], All, NUMBER, 1.0),
    row(&["deg", "°", "º"], &["degree"], Small, NUMBER, DEGREE),
    row(&["arcmin"], &[], Never, NUMBER, DEGREE / 60.0),
    row(&["arcsec"], &[], Small, NUMBER, DEGREE / 3600.0),
    row(&["gon", "grad"], &[], Never, NUMBER, PI / 200.0),
    row(&["rev"], &["revolution", "turn"], Never, NUMBER, 2.0 * PI),
    row(&["rpm"], &[], Never, RATE, 2.0 * PI / MINUTE),
    row(&["bit"], &["bits"], Large, NUMBER, 1.0),
    row(&["byte", "B"], &["bytes"], Large, NUMBER, 8.0),
    row(&["bps"], &[], Large, RATE, 1.0),
    // Time.
    row(&["min"], &["minute"], Never, TIME, MINUTE),
    row(&["h", "hr", "hrs"], &["hour"], Never, TIME, HOUR),
    row(&["day", "d"], &["days"], Never, TIME, DAY),
    row(&["week"], &["weeks"], Never, TIME, 7.0 * DAY),
    row(&["year", "yr"], &["years"], Never, TIME, 365.25 * DAY),
    // Length, area, volume.
    row(&["in"], &["inch", "inches"], Never, LENGTH, INCH),
    row(&["ft"], &["foot", "feet"], Never, LENGTH, FOOT),
    row(&["yd"], &["yard"], Never, LENGTH, 3.0 * FOOT),
    row(&["mi"], &["mile"], Never, LENGTH, MILE),
    row(&["nmi"], &[], Never, LENGTH, 1852.0),
    row(&["\u{c5}", "\u{212b}"], &["angstrom"], Never, LENGTH, 1e-10),
    row(&["micron"], &[], Never, LENGTH, 1e-6),
    row(&["au", "AU"], &[], Never, LENGTH, 149_597_870_700.0),
    row(&["ha"], &["hectare"], Never, AREA, 1e4),
    row(&["l", "L"], &["litre", "liter"], All, VOLUME, 1e-3),
    row(&["cc", "ccm"], &[], Never, VOLUME, 1e-6),
    row(&["gal"], &["gallon"], Never, VOLUME, 231.0 * INCH * INCH * INCH),
    // Speed and acceleration.
    row(&["kn", "kt", "kts"], &["knot"], Never, SPEED, 1852.0 / HOUR),
    row(&["mph"], &[], Never, SPEED, MILE / HOUR),
    row(&["fps"], &[], Never, SPEED, FOOT),
    row(&["kph"], &[], Never, SPEED, 1000.0 / HOUR),
    row(&["g0", "gee"], &[], Never, ACCELERATION, GRAVITY),
    // Mass and force.
    row(&["t"], &["tonne"], Large, MASS, 1e3),
    row(&["lb", "lbm", "lbs"], &["pound"], Never, MASS, POUND),
    row(&["oz"], &["ounce"], Never, MASS, POUND / 16.0),
    row(&["slug"], &[], Never, MASS, POUND_FORCE / FOOT),
    row(&["lbf"], &[], Never, FORCE, POUND_FORCE),
    row(&["kip"], &[], Never, FORCE, 1e3 * POUND_FORCE),
    row(&["kgf"], &[], Never, FORCE, GRAVITY),
    row(&["dyn"], &["dyne"], Never, FORCE, 1e-5),
    row(&["lb-ft", "ft-lb"], &[], Never, ENERGY, POUND_FORCE * FOOT),
    row(&["lb-in", "in-lb"], &[], Never, ENERGY, POUND_FORCE * INCH),
    // Pressure and viscosity.
    row(&["bar"], &[], All, PRESSURE, 1e5),
    row(&["atm"], &["atmosphere"], Never, PRESSURE, 101_325.0),
    row(&["psi"], &[], Never, PRESSURE, PSI),
    row(&["ksi"], &[], Never, PRESSURE, 1e3 * PSI),
    row(&["mmHg"], &[], Never, PRESSURE, MERCURY),
    row(&["inHg"], &[], Never, PRESSURE, 25.4 * MERCURY),
    row(&["Torr", "torr"], &[], Small, PRESSURE, 101_325.0 / 760.0),
    row(&["cP"], &[], Never, [1, -1, -1, 0, 0, 0, 0], 1e-3),
    row(&["cSt"], &[], Never, [0, 2, -1, 0, 0, 0, 0], 1e-6),
    // Energy and power.
    row(&["cal"], &["calorie"], All, ENERGY, 4.184),
    row(&["erg"], &[], Never, ENERGY, 1e-7),
    row(&["eV"], &[], All, ENERGY, 1.602_176_634e-19),
    row(&["hp"], &["horsepower"], Never, POWER, 550.0 * POUND_FORCE * FOOT),
    // Temperature.
    row(&["degC", "°C", "ºC", "℃", "deg C", "° C"], &["celsius"], Never, TEMPERATURE, 1.0).offset(),
    row(&["degF", "°F", "ºF", "℉", "deg F", "° F"], &["fahrenheit"], Never, TEMPERATURE, 5.0 / 9.0).offset(),
    row(&["degR", "°R"], &["rankine"], Never, TEMPERATURE, 5.0 / 9.0),
];

/// The symbols of the table that are not one word, for which a reader of words must look first.
pub(super) const NOT_ONE_WORD: [&str; 8] =
    ["lb-ft", "ft-lb", "lb-in", "in-lb", "deg C", "deg F", "° C", "° F"];

/// Symbol, word, factor.
type Prefix = (&'static str, &'static str, f64);

const PREFIXES: [Prefix; 22] = [
    ("y", "yocto", 1e-24),
    ("z", "zepto", 1e-21),
    ("a", "atto", 1e-18),
    ("f", "femto", 1e-15),
    ("p", "pico", 1e-12),
    ("n", "nano", 1e-9),
    ("u", "micro", 1e-6),
    ("\u{b5}", "micro", 1e-6),
    ("\u{3bc}", "micro", 1e-6),
    ("m", "milli", 1e-3),
    ("c", "centi", 1e-2),
    ("da", "deca", 1e1),
    ("d", "deci", 1e-1),
    ("h", "hecto", 1e2),
    ("k", "kilo", 1e3),
    ("M", "mega", 1e6),
    ("G", "giga", 1e9),
    ("T", "tera", 1e12),
    ("P", "peta", 1e15),
    ("E", "exa", 1e18),
    ("Z", "zetta", 1e21),
    ("Y", "yotta", 1e24),
];

/// Every word of the table with its row and whether it is a symbol or a name.
static WORDS: LazyLock<HashMap<&str, (&Row, bool)>> = LazyLock::new(|| {
    let words = |row: &'static Row| {
        let symbols = row.symbols.iter().map(move |symbol| (*symbol, (row, true)));
        symbols.chain(row.names.iter().map(move |name| (*name, (row, false))))
    };
    TABLE.iter().flat_map(words).collect()
});

/// The unit that a word means, and the factor of its prefix.
pub(super) fn find(word: &str) -> Option<(&'static Row, f64)> {
    let named = |word: &str| {
        let singular = word.strip_suffix('s').unwrap_or(word);
        let (row, is_symbol) = WORDS.get(word).or_else(|| WORDS.get(singular))?;
        (!is_symbol).then_some(*row)
    };
    let symbol = |word: &str| WORDS.get(word).filter(|(_, is_symbol)| *is_symbol).map(|(row, _)| *row);
    if let Some(row) = symbol(word).or_else(|| named(word)) {
        return Some((row, 1.0));
    }
    PREFIXES.iter().find_map(|&(short, long, factor)| {
        let row = word.strip_prefix(short).and_then(symbol);
        let row = row.or_else(|| word.strip_prefix(long).and_then(named))?;
        allows(row.prefixes, factor).then_some((row, factor))
    })
}

fn allows(prefixes: Prefixes, factor: f64) -> bool {
    match prefixes {
        Never => false,
        Small => factor < 1.0,
        Large => factor > 100.0,
        All => true,
    }
}

/// A known word that may have been meant: one that differs in case (`khz`), else a similar one (`metres`).
pub(super) fn closest(word: &str) -> Option<String> {
    let lower = word.to_lowercase();
    let same = |candidate: &str| candidate.to_lowercase() == lower;
    // Kilo and mega come before milli: `MHZ` is not a slow oscillation.
    const USUAL: [&str; 8] = ["k", "M", "m", "u", "c", "G", "n", "h"];
    for row in TABLE {
        let plain = row.symbols.iter().map(|symbol| (*symbol).to_owned());
        let usual = PREFIXES
            .iter()
            .filter(|(short, _, factor)| USUAL.contains(short) && allows(row.prefixes, *factor));
        let mut prefixes: Vec<&str> = usual.map(|(short, ..)| *short).collect();
        prefixes.sort_by_key(|short| USUAL.iter().position(|usual| usual == short));
        let prefixed =
            prefixes.iter().flat_map(|p| row.symbols.iter().map(move |symbol| format!("{p}{symbol}")));
        if let Some(meant) = plain.chain(prefixed).find(|candidate| same(candidate)) {
            return Some(meant);
        }
    }
    // Of two letters that differ in one nothing can be guessed.
    if word.chars().count() < 3 {
        return None;
    }
    let words = TABLE.iter().flat_map(|row| row.symbols.iter().chain(row.names));
    sophy_diagnostics::closest(word, words.copied()).map(str::to_owned)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_word_of_the_table_stands_twice() {
        let mut seen = HashMap::new();
        for (number, row) in TABLE.iter().enumerate() {
            for word in row.symbols.iter().chain(row.names) {
                assert_eq!(seen.insert(*word, number), None, "{word}");
            }
        }
    }

    /// The table decides; these are all the cases where it has to.
    #[test]
    fn ambiguities_are_few_and_known() {
        let mut meanings: HashMap<String, usize> = HashMap::new();
        for row in TABLE {
            for symbol in row.symbols {
                *meanings.entry((*symbol).to_owned()).or_default() += 1;
                for (prefix, _, factor) in PREFIXES {
                    if allows(row.prefixes, factor) {
                        *meanings.entry(format!("{prefix}{symbol}")).or_default() += 1;
                    }
                }
            }
        }
        let mut ambiguous: Vec<String> =
            meanings.into_iter().filter(|(_, count)| *count > 1).map(|(word, _)| word).collect();
        ambiguous.sort();
        assert_eq!(ambiguous, ["kg", "kt"]);
    }

    #[test]
    fn what_is_not_one_word_is_in_the_table() {
        let word = |symbol: &&str| !symbol.contains([' ', '-']);
        let listed = TABLE.iter().flat_map(|row| row.symbols).filter(|symbol| !word(symbol));
        let mut listed: Vec<_> = listed.copied().collect();
        let mut expected = NOT_ONE_WORD.to_vec();
        listed.sort_unstable();
        expected.sort_unstable();
        assert_eq!(listed, expected);
    }

    #[test]
    fn what_may_have_been_meant() {
        for (word, expected) in [
            ("Kg", Some("kg")),
            ("khz", Some("kHz")),
            ("MHZ", Some("MHz")),
            ("hz", Some("Hz")),
            ("secnds", Some("second")),
            ("meeter", Some("meter")),
            ("degs", Some("deg")),
            ("furlongs", None),
            ("USD", None),
            ("qx", None),
        ] {
            assert_eq!(closest(word).as_deref(), expected, "{word}");
        }
    }
}
