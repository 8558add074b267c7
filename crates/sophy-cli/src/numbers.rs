//! Numbers as people like to read them.

/// Three significant digits, whole from 100 on, with thin groups of three.
pub(crate) fn brief(value: f64) -> String {
    if !value.is_finite() {
        return value.to_string();
    }
    if value.abs() >= 1e15 {
        return format!("{value:.2e}");
    }
    if value.abs() >= 99.95 {
        // Three digits count, the others are zeros.
        let mut unit = 1.0;
        while value.abs() / unit >= 999.5 {
            unit *= 10.0;
        }
        return grouped(((value.abs() / unit).round() * unit) as u64, value < 0.0);
    }
    let decimals = match value.abs() {
        x if x >= 9.995 => 1,
        x if x >= 0.9995 => 2,
        _ => 3,
    };
    format!("{value:.decimals$}")
}

/// `12 345`
pub(crate) fn count(value: u64) -> String {
    grouped(value, false)
}

fn grouped(value: u64, negative: bool) -> String {
    let digits = value.to_string();
    let mut text = if negative { "-".to_owned() } else { String::new() };
    for (position, digit) in digits.chars().enumerate() {
        if position > 0 && (digits.len() - position).is_multiple_of(3) {
            text.push(' ');
        }
        text.push(digit);
    }
    text
}

/// `1 row`, `2 rows`
pub(crate) fn plural(number: u64, noun: &str) -> String {
    format!("{} {noun}{}", count(number), if number == 1 { "" } else { "s" })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short_and_grouped() {
        let texts: Vec<String> = [0.123456, 1.2345, 12.345, 123.45, 123456.7, 99.96].map(brief).to_vec();
        assert_eq!(texts, ["0.123", "1.23", "12.3", "123", "123 000", "100"]);
        assert_eq!(plural(1, "row"), "1 row");
        assert_eq!(plural(1234567, "row"), "1 234 567 rows");
    }
}
