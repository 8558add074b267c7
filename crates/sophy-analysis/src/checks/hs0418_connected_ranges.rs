//! A connection feeds a port with values that it does not allow.

use crate::component::{Builder, Port};
use sophy_diagnostics::{Code, Diagnostic, Span};

pub(crate) const CODE: Code = Code("HS0418");

/// Compares the ranges of two ports, where both have one.
pub(crate) fn find(builder: &mut Builder<'_, '_>, from: (&Port, Span), to: (&Port, Span)) {
    if let (Some([low, high]), Some([least, greatest])) = (from.0.bounds, to.0.bounds)
        && (low < least || high > greatest)
    {
        let warning = Diagnostic::warning(
            CODE,
            from.1,
            format!("`{}` can leave the range of `{}`", from.0.name, to.0.name),
        )
        .label_main(format!("({low}, {high})"))
        .label(to.1, format!("({least}, {greatest})"));
        builder.report(warning.help("limit it in a component, or widen the range of the input"));
    }
    let allowed = &to.0.choices;
    let strange: Vec<usize> = from
        .0
        .choices
        .iter()
        .copied()
        .filter(|choice| !allowed.is_empty() && !allowed.contains(choice))
        .collect();
    if let Some(&first) = strange.first() {
        let text = builder.shared.texts.get(first).cloned().unwrap_or_default();
        let message = format!("`{}` can be \"{text}\", which `{}` does not allow", from.0.name, to.0.name);
        let error = Diagnostic::error(CODE, from.1, message).label(to.1, "this end has other values");
        builder.report(error.help("add the value to the set of the input"));
    }
}
