use super::super::parse;
use super::*;
use proptest::prelude::*;

fn unit(text: &str) -> Unit {
    parse(text).unwrap_or_else(|error| panic!("{text}: {error} {:?}", error.range)).unit
}

/// Exponents of kg, m, s, A, K, mol, cd and the factor to six digits or more, from NIST SP 811 appendix B.
#[test]
fn units_as_engineers_write_them() {
    let acceleration = [0, 1, -2, 0, 0, 0, 0];
    let inertia = [1, 2, 0, 0, 0, 0, 0];
    let energy = [1, 2, -2, 0, 0, 0, 0];
    let pressure = [1, -1, -2, 0, 0, 0, 0];
    let force = [1, 1, -2, 0, 0, 0, 0];
    let power = [1, 2, -3, 0, 0, 0, 0];
    let rate = [0, 0, -1, 0, 0, 0, 0];
    let speed = [0, 1, -1, 0, 0, 0, 0];
    let length = [0, 1, 0, 0, 0, 0, 0];
    let mass = [1, 0, 0, 0, 0, 0, 0];
    let time = [0, 0, 1, 0, 0, 0, 0];
    let charge = [0, 0, 1, 1, 0, 0, 0];
    let number = [0; 7];
    let transfer = [1, 0, -3, 0, -1, 0, 0];
    let resistance = [1, 2, -3, -2, 0, 0, 0];
    let capacity = [-1, -2, 4, 2, 0, 0, 0];
    for (texts, exponents, factor) in [
        (
            "m/s2 | m/s^2 | m.s-2 | m·s⁻² | m s^-2 | m/s/s | m/(s.s) | m*s**-2 | m/s² | m s-2 | m.s^(-2) | m / s ^ 2",
            acceleration,
            1.0,
        ),
        ("kg*m^2 | kg m2 | kg.m2 | kg-m2 | kg·m² | kg × m^2 | (kg)(m2) | kg(m2)", inertia, 1.0),
        ("N.m | Nm | N m | J | W.s | kg.m2/s2 | newton metre | V.A.s", energy, 1.0),
        ("rad/s | 1/s | s^-1 | Hz | s-1", rate, 1.0),
        ("ft | feet | foot | 12 in", length, 0.3048),
        ("in | inch | 25.4 mm", length, 0.0254),
        ("nmi | 1852 m", length, 1852.0),
        ("mi | miles", length, 1609.344),
        ("um | µm | μm | micrometre | 1e-6 m | 10^-6 m", length, 1e-6),
        ("lb | pounds | lbm | 16 oz", mass, 0.45359237),
        ("g | gram", mass, 1e-3),
        ("dag", mass, 1e-2),
        ("t | Mg | 1000 kg", mass, 1e3),
        ("slug", mass, 14.5939029372),
        ("lbf", force, 4.4482216152605),
        ("slug.ft/s2 | slug ft/s^2", force, 4.4482216152605),
        ("lb-ft | ft-lb | ft-lbf | lbf-ft | lbf.ft | 12 in-lb | ft·lbf", energy, 1.3558179483314),
        ("lb.ft", [1, 1, 0, 0, 0, 0, 0], 0.138254954376),
        ("lb-ft2 | lb-ft^2 | lb-ft²", inertia, 0.0421401100938),
        ("psi | lbf/in2", pressure, 6894.75729317),
        ("mmHg", pressure, 133.322387415),
        ("inHg", pressure, 3386.38864034),
        ("bar | 1000 mbar | 100 kPa", pressure, 1e5),
        ("atm | 760 Torr", pressure, 101325.0),
        ("hPa | mbar", pressure, 100.0),
        ("cal | 4.184 J", energy, 4.184),
        ("kWh | kW.h | kW h", energy, 3.6e6),
        ("eV | 1eV", energy, 1.602176634e-19),
        ("hp", power, 745.699871582),
        ("kVA | kvar | kW | kilowatt", power, 1e3),
        ("A.h | Ah | A h | 1000 mAh", charge, 3600.0),
        ("Ohm | Ω | \u{2126} | ohm | V/A", resistance, 1.0),
        ("kΩ | kOhm", resistance, 1e3),
        ("uF | µF | \u{3bc}F", capacity, 1e-6),
        ("W/(m2.K) | W/m2/K | W/(m^2*K) | W.m-2.K-1 | W m⁻² K⁻¹ | W/(m2.degC) | W/m2-K", transfer, 1.0),
        ("kn | knot | knots | kt | nmi/h", speed, 0.514444444444),
        ("km/h | kph", speed, 0.277777777778),
        ("mph", speed, 0.44704),
        ("ft/s", speed, 0.3048),
        ("gee | g0", acceleration, 9.80665),
        ("mm/s2", acceleration, 1e-3),
        ("h | hr | 60 min | hours", time, 3600.0),
        ("min", time, 60.0),
        ("day | d | days | 24 h", time, 86400.0),
        ("year | yr | 365.25 d", time, 31_557_600.0),
        ("ms | millisecond", time, 1e-3),
        (" | - | 1 | pu |  - | rad | m/m | 100 % | dimensionless", number, 1.0),
        ("%", number, 0.01),
        ("deg | ° | degrees", number, 0.0174532925199),
        ("mrad", number, 1e-3),
        ("arcsec", number, 4.84813681110e-6),
        ("rev | turn | 360 deg", number, std::f64::consts::TAU),
        ("deg/s | °/s", rate, 0.0174532925199),
        ("deg/h | deg.h-1", rate, 4.84813681110e-6),
        ("rpm | rev/min", rate, 0.104719755120),
        ("kbit/s | kbps", rate, 1000.0),
        ("byte | 8 bit", number, 8.0),
        ("MB", number, 8e6),
        ("m^(1/2) m^0.5", length, 1.0),
        ("√m √(m) sqrt(s)^2/s", length, 1.0),
        ("Ym", length, 1e24),
        ("ym", length, 1e-24),
        ("dam", length, 10.0),
        ("mK/kK.K", [0, 0, 0, 0, 1, 0, 0], 1e-6),
        ("mmol.mcd", [0, 0, 0, 0, 0, 1, 1], 1e-6),
    ] {
        for text in texts.split(" | ") {
            let found = unit(text);
            assert_eq!(found.dimension, Dimension::new(exponents), "{text}");
            let known = found.factor.unwrap();
            assert!((known / factor - 1.0).abs() < 1e-11, "{text}: {known} is not {factor}");
        }
    }
}

#[test]
fn noise_densities_have_roots() {
    for text in ["V/sqrt(Hz)", "V/√Hz", "V/Hz^0.5", "V/Hz^(1/2)", "V.Hz^-0.5", "V·s^(1/2)"] {
        assert!(unit(text).fits(unit("V s^0.5")), "{text}");
    }
    assert!(unit("deg/sqrt(h)").power(2.0).unwrap().fits(unit("deg2/h")));
}

fn notes(text: &str) -> Vec<(NoteKind, &str)> {
    let notes = parse(text).unwrap().notes;
    notes.into_iter().map(|note| (note.kind, text.get(note.range).unwrap())).collect()
}

#[test]
fn a_product_after_a_division_stands_above_the_line_and_is_noted() {
    let noted = |text, at| {
        assert_eq!(notes(text), [(NoteKind::ProductAfterDivision, at)], "{text}");
    };
    noted("W/m2.K", ".K");
    noted("J/kg K", "K");
    noted("W/m2*K*s", "*K");
    assert!(unit("W/m2.K").fits(unit("W.K/m2")));
    for text in ["m/s/s", "W/(m2.K)", "W.K/m2", "lbf/ft-s", "1/s"] {
        assert_eq!(notes(text), [], "{text}");
    }
    assert!(unit("lbf/ft-s").fits(unit("lbf/(ft.s)")));
}

#[test]
fn temperatures_with_another_zero_have_the_scale_of_a_difference() {
    for text in ["degC", "°C", " degF ", "°F", "℃", "deg C", "celsius"] {
        assert_eq!(notes(text), [(NoteKind::Offset, text.trim())], "{text}");
        assert!(unit(text).same_dimension(unit("K")));
        assert_eq!(unit(text).fits(unit("K")), !text.contains('F'));
        assert!(!unit(text).fits(unit("V")));
    }
    assert_eq!(notes("W/degC"), []);
    assert!(unit("W/degC").fits(unit("W/K")));
    assert!(unit("J/degF").fits(unit("1.8 J/K")));
    assert!(unit("degC/s").same_scale(unit("K/s")));
    assert!(!unit("degF/s").same_scale(unit("K/s")));
}

#[test]
fn logarithms_are_numbers_of_unknown_scale() {
    assert_eq!(notes("dB"), [(NoteKind::Logarithm, "dB")]);
    assert!(unit("dB").fits(Unit::ONE));
    assert!(!unit("dB").fits(unit("m")));
}

#[test]
fn what_is_no_unit_says_where() {
    let unknown = |word: &str, suggestion: Option<&str>| UnitErrorKind::Unknown {
        word: word.to_owned(),
        suggestion: suggestion.map(str::to_owned),
    };
    for (text, kind, at) in [
        ("USD", unknown("USD", None), "USD"),
        ("kg/Sek", unknown("Sek", Some("sec")), "Sek"),
        ("µ/s", unknown("µ", None), "µ"),
        ("Kg.m", unknown("Kg", Some("kg")), "Kg"),
        ("N/khz2", unknown("khz", Some("kHz")), "khz"),
        ("mmin", unknown("mmin", Some("min")), "mmin"),
        ("m_e", unknown("m_e", Some("mole")), "m_e"),
        ("m/", UnitErrorKind::Missing, ""),
        ("()", UnitErrorKind::Missing, ""),
        ("m-", UnitErrorKind::Missing, ""),
        ("(m", UnitErrorKind::Unclosed, "("),
        ("m)", UnitErrorKind::Unexpected(')'), ")"),
        ("m//s", UnitErrorKind::Unexpected('/'), "/"),
        ("/s", UnitErrorKind::Unexpected('/'), "/"),
        ("m?", UnitErrorKind::Unexpected('?'), "?"),
        ("--", UnitErrorKind::Unexpected('-'), "-"),
        ("V/Hz^1/2", UnitErrorKind::NumberNotFirst, "2"),
        ("kg m 2", UnitErrorKind::NumberNotFirst, "2"),
        ("0 m", UnitErrorKind::Number, "0"),
        ("1e999 m", UnitErrorKind::Number, "1e999"),
        ("m^", UnitErrorKind::Exponent, "^"),
        ("m^(1/2", UnitErrorKind::Exponent, "^(1/2"),
        ("m^(1/0)", UnitErrorKind::Exponent, "m^(1/0)"),
        ("m^0.123", UnitErrorKind::Exponent, "m^0.123"),
        ("m⁻", UnitErrorKind::Exponent, "⁻"),
        ("m99999", UnitErrorKind::Exponent, "m99999"),
        ("m300.m300", UnitErrorKind::Exponent, ".m300"),
    ] {
        let error = parse(text).unwrap_err();
        assert_eq!((&error.kind, text.get(error.range.clone()).unwrap()), (&kind, at), "{text}");
    }
}

#[test]
fn depth_is_bounded_and_length_is_not() {
    let nested = |n: usize| format!("{}m{}", "(".repeat(n), ")".repeat(n));
    assert!(unit(&nested(DEEPEST)).fits(unit("m")));
    assert_eq!(parse(&nested(100_000)).unwrap_err().kind, UnitErrorKind::TooDeep);
    assert_eq!(parse(&"√".repeat(100_000)).unwrap_err().kind, UnitErrorKind::TooDeep);
    assert!(unit(&format!("m{}", "/s.s".repeat(10_000))).fits(unit("m")));
}

proptest! {
    #[test]
    fn any_text_is_read_or_refused_in_place(text in r"[-m s/.*^()0-9⁻²√°µegkldCbft%Ω_?]{0,16}|\PC{0,12}") {
        match parse(&text) {
            Ok(parsed) => prop_assert!(parsed.notes.iter().all(|note| text.get(note.range.clone()).is_some())),
            Err(error) => prop_assert!(text.get(error.range.clone()).is_some(), "{:?}", error),
        }
    }

    #[test]
    fn products_and_quotients_are_those_of_the_parts(a in "(m|ft|kg|deg|min|kPa|g0|A)[23]?", b in "(s|lb|in|rev|mV|K)(-?[23])?") {
        let (product, quotient, square) = (format!("{a}.{b}"), format!("{a}/{b}"), format!("({a} {b})^2"));
        let (a, b) = (unit(&a), unit(&b));
        prop_assert!(unit(&product).fits(a.times(b).unwrap()));
        prop_assert!(unit(&quotient).fits(a.over(b).unwrap()));
        prop_assert!(unit(&square).fits(a.times(b).unwrap().power(2.0).unwrap()));
    }
}
