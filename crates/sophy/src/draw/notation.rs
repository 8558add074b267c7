//! Texts as they are read on paper.

use sophy_ir::{Class, NodeId, Quantity, VariableId};

/// What an expression is written for.
#[derive(Clone, Copy)]
pub(super) struct Notation<'a> {
    pub(super) class: &'a Class,
    /// Those of the model.
    pub(super) texts: &'a [String],
}

impl Notation<'_> {
    /// An expression in short form: `2·x − 1 ≤ y`.
    pub(super) fn short(&self, node: NodeId) -> String {
        tidy(&self.class.written(node, Quantity::Real, self.texts))
    }

    /// The value of a variable in short form.
    pub(super) fn value(&self, variable: VariableId, node: NodeId) -> String {
        let quantity = self.class.variables.get(variable.0 as usize).map_or(Quantity::Real, |v| v.quantity);
        tidy(&self.class.written(node, quantity, self.texts))
    }

    /// `variable = value`; `None` if that says no more than that a variable is shown under its own name.
    pub(super) fn equation(&self, variable: VariableId, node: NodeId) -> Option<String> {
        let (name, value) = (self.name(variable), self.value(variable, node));
        match (name == value, value.contains(" = ")) {
            (true, _) => None,
            (false, true) => Some(format!("{name} = ({value})")),
            (false, false) => Some(format!("{name} = {value}")),
        }
    }

    pub(super) fn name(&self, id: VariableId) -> &str {
        self.class.variables.get(id.0 as usize).map_or("?", |variable| variable.name.as_str())
    }
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
