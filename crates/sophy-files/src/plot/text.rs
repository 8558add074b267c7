//! Words on pictures: their width, their escapes, units as people write them.

/// The face of all text; the embedded font in PNG, the first one at hand elsewhere.
pub(crate) const FAMILY: &str = "Roboto, Helvetica, Arial, sans-serif";

/// Advance widths of U+0020 … U+007E in the embedded font, in 1/2048 of the font size.
const ADVANCES: [u16; 95] = [
    508, 528, 656, 1261, 1151, 1500, 1274, 358, 701, 713, 882, 1162, 403, 566, 540, 845, 1151, 1151, 1151,
    1151, 1151, 1151, 1151, 1151, 1151, 1151, 496, 433, 1041, 1124, 1071, 968, 1839, 1336, 1276, 1333, 1344,
    1164, 1132, 1395, 1461, 557, 1130, 1285, 1103, 1788, 1461, 1409, 1292, 1409, 1262, 1216, 1222, 1328,
    1304, 1817, 1284, 1230, 1227, 543, 841, 543, 856, 924, 633, 1114, 1150, 1072, 1155, 1086, 712, 1150,
    1128, 498, 490, 1038, 498, 1796, 1131, 1168, 1150, 1164, 694, 1057, 670, 1129, 992, 1539, 1016, 969,
    1016, 693, 500, 693, 1393,
];

/// Width of `text` at `size` pixels, without kerning.
pub(crate) fn width(text: &str, size: f64) -> f64 {
    let advance = |c: char| {
        let known = (c as usize).checked_sub(0x20).and_then(|i| ADVANCES.get(i));
        f64::from(known.copied().unwrap_or(1150))
    };
    text.chars().map(advance).sum::<f64>() * size / 2048.0
}

/// `text`, with its middle left out if it is wider than `room`.
pub(crate) fn fitted(text: &str, size: f64, room: f64) -> String {
    if width(text, size) <= room {
        return text.to_owned();
    }
    let characters: Vec<char> = text.chars().collect();
    let mut keep = characters.len();
    while keep > 2 {
        keep -= 1;
        let (head, tail) = (keep.div_ceil(2), keep / 2);
        let short: String =
            characters[..head].iter().chain(&['…']).chain(&characters[characters.len() - tail..]).collect();
        if width(&short, size) <= room {
            return short;
        }
    }
    "…".to_owned()
}

/// Escapes a text for XML and HTML, in elements and in attributes. Characters that XML cannot hold become U+FFFD.
pub(super) fn escaped(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            '\'' => out.push_str("&#39;"),
            '\t' | '\n' | '\r' => out.push(' '),
            '\0'..='\u{1f}' | '\u{fffe}' | '\u{ffff}' => out.push('\u{fffd}'),
            c => out.push(c),
        }
    }
    out
}

/// A unit in typeset form: `m/s^2` is m/s², `N*m` is N·m.
pub(crate) fn unit(unit: &str) -> String {
    let mut out = String::new();
    let mut raised = false;
    for c in unit.chars() {
        raised = match c {
            '^' => true,
            c if raised && superscript(c).is_some() => true,
            _ => false,
        };
        match (c, superscript(c)) {
            ('^', _) => {}
            ('*', _) => out.push('·'),
            (_, Some(high)) if raised => out.push(high),
            _ => out.push(c),
        }
    }
    out
}

/// A power of ten: 10⁻³.
pub(super) fn power_of_ten(exponent: i32) -> String {
    let digits = exponent.to_string();
    format!("10{}", digits.chars().filter_map(superscript).collect::<String>())
}

fn superscript(c: char) -> Option<char> {
    Some(match c {
        '-' => '⁻',
        '1' => '¹',
        '2' => '²',
        '3' => '³',
        '0' => '⁰',
        '4'..='9' => char::from_u32('⁴' as u32 + (c as u32 - '4' as u32))?,
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_are_typeset() {
        let cases = [("m/s^2", "m/s²"), ("kg*m^-1", "kg·m⁻¹"), ("1/s", "1/s"), ("m^10/s", "m¹⁰/s"), ("", "")];
        for (written, set) in cases {
            assert_eq!(unit(written), set);
        }
        assert_eq!(power_of_ten(-12), "10⁻¹²");
    }

    #[test]
    fn nothing_escapes_from_markup() {
        assert_eq!(escaped("</script>&\"'\u{1}"), "&lt;/script&gt;&amp;&quot;&#39;\u{fffd}");
    }

    #[test]
    fn a_long_name_keeps_its_ends() {
        let short = fitted("vehicle.left.thruster.speed", 11.0, 80.0);
        assert!(short.starts_with("veh") && short.ends_with("eed") && short.contains('…'), "{short}");
        assert!(width(&short, 11.0) <= 80.0);
    }
}
