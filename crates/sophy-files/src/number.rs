/// Appends the shortest decimal that reads back as exactly `value`: at most 17 significant digits, with an
/// exponent where plain digits would be long. NaN and infinities are `NaN`, `inf`, `-inf`.
pub(crate) fn push_number(text: &mut String, value: f64) {
    use std::fmt::Write;
    let magnitude = value.abs();
    let plain = value == 0.0 || (1e-5..1e17).contains(&magnitude) || !value.is_finite();
    // Writing to a String does not fail.
    let _ = if plain { write!(text, "{value}") } else { write!(text, "{value:e}") };
}

#[cfg(test)]
mod tests {
    use super::push_number;
    use proptest::prelude::*;

    fn text(value: f64) -> String {
        let mut text = String::new();
        push_number(&mut text, value);
        text
    }

    #[test]
    fn awkward_numbers() {
        let cases: [(f64, &str); 9] = [
            (0.0, "0"),
            (-0.0, "-0"),
            (1.0, "1"),
            (0.1, "0.1"),
            (1e-9, "1e-9"),
            (1e300, "1e300"),
            (f64::NAN, "NaN"),
            (f64::INFINITY, "inf"),
            (f64::NEG_INFINITY, "-inf"),
        ];
        for (value, expected) in cases {
            assert_eq!(text(value), expected);
        }
    }

    proptest! {
        #[test]
        fn reads_back_to_the_bit(bits: u64) {
            let value = f64::from_bits(bits);
            let back: f64 = text(value).parse().unwrap();
            prop_assert!(back.to_bits() == bits || value.is_nan() && back.is_nan());
            prop_assert!(text(value).len() <= 24);
        }
    }
}
