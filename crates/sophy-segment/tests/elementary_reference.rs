//! Enclosures of elementary functions contain the true values, known to 30 digits.

use sophy_segment::Interval;

const VALUES: &str = include_str!("../../../tests/reference/elementary/values.csv");

#[test]
fn enclosures_contain_the_true_values() {
    let mut rows = 0;
    for row in VALUES.lines().skip(1) {
        let fields: Vec<&str> = row.split(',').collect();
        let [function, x, y, value] = fields[..] else { panic!("four fields: {row}") };
        let enclosure = enclosure(function, number(x), number(y));
        assert!(inside(value, enclosure), "{row}: {enclosure:?}");
        // A lax enclosure would test nothing; only that of a periodic function may widen with its argument.
        let periodic = matches!(function, "sin" | "cos" | "tan");
        let narrow = 8.0 * f64::EPSILON * number(value).abs() + 8.0 * f64::from_bits(1);
        assert!(
            enclosure.width() <= narrow
                || periodic && number(x).abs() > 100.0
                || enclosure == Interval::ENTIRE,
            "{row}: {enclosure:?}"
        );
        rows += 1;
    }
    assert!(rows > 2000);
}

fn enclosure(function: &str, x: f64, y: f64) -> Interval {
    let argument = Interval::point(x);
    match function {
        "exp" => argument.exp(),
        "ln" => argument.ln(),
        "log10" => argument.log10(),
        "sin" => argument.sin(),
        "cos" => argument.cos(),
        "tan" => argument.tan(),
        "asin" => argument.asin(),
        "acos" => argument.acos(),
        "atan" => argument.atan(),
        "sinh" => argument.sinh(),
        "cosh" => argument.cosh(),
        "tanh" => argument.tanh(),
        "asinh" => argument.asinh(),
        "acosh" => argument.acosh(),
        "atanh" => argument.atanh(),
        "sqrt" => argument.sqrt(),
        "pow" => argument.pow(Interval::point(y)),
        "atan2" => argument.atan2(Interval::point(y)),
        _ => unreachable!("unknown function {function}"),
    }
}

fn inside(value: &str, enclosure: Interval) -> bool {
    let above = enclosure.lo.is_infinite() || decimal(&format!("{:.29e}", enclosure.lo)) <= decimal(value);
    let below = enclosure.hi.is_infinite() || decimal(value) <= decimal(&format!("{:.29e}", enclosure.hi));
    above && below
}

/// A key in the order of the numbers, from 30 digits: sign, exponent, mantissa.
fn decimal(text: &str) -> Option<(i8, i32, i128)> {
    let (mantissa, exponent) = text.split_once('e')?;
    let mantissa: i128 = mantissa.replace('.', "").parse().ok()?;
    let (sign, exponent): (i8, i32) = (mantissa.signum() as i8, exponent.parse().ok()?);
    Some((sign, i32::from(sign) * exponent, mantissa))
}

/// NaN, which is inside of nothing, for what is not a number.
fn number(text: &str) -> f64 {
    text.parse().unwrap_or(f64::NAN)
}
