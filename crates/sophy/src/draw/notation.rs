//! Texts as they are read on paper.

use sophy_ir::{Class, NodeId};

/// An expression in short form: `2·x − 1 ≤ y`.
pub(super) fn short(class: &Class, node: NodeId) -> String {
    tidy(&class.text(node))
}

/// Writes operators as on paper and whole numbers without `.0`.
pub(super) fn tidy(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    let spaced = text
        .replace(" * ", "·")
        .replace(" / ", "/")
        .replace(" - ", " − ")
        .replace("<=", "≤")
        .replace(">=", "≥")
        .replace("<>", "≠");
    let letters: Vec<char> = spaced.chars().collect();
    let mut number = false;
    let mut position = 0;
    while let Some(&c) = letters.get(position) {
        let before = position.checked_sub(1).and_then(|p| letters.get(p));
        let starts = before.is_none_or(|b| !(b.is_alphanumeric() || "_.'".contains(*b)));
        number = c.is_ascii_digit() && (number || starts) || (number && c == '.');
        let ends = letters.get(position + 2).is_none_or(|next| !(next.is_alphanumeric() || *next == '_'));
        if number && c == '.' && letters.get(position + 1) == Some(&'0') && ends {
            position += 2;
            number = false;
            continue;
        }
        out.push(if c == '-' && !matches!(before, Some('e' | 'E')) { '−' } else { c });
        position += 1;
    }
    out
}

/// `omega` of `omega[2]`.
pub(super) fn without_index(name: &str) -> &str {
    match name.find('[') {
        Some(at) if at > 0 && name.ends_with(']') => &name[..at],
        _ => name,
    }
}
