//! A value lies outside the range that was declared for it, or the range is no range.

use sophy_diagnostics::{Code, Diagnostic, Span};

pub(crate) const CODE: Code = Code("HS0126");

pub(crate) fn diagnostic(
    name: &str,
    value: f64,
    least: f64,
    greatest: f64,
    at: Span,
    range: Span,
) -> Diagnostic {
    Diagnostic::error(CODE, at, format!("`{name}` is {value}, outside its range ({least}, {greatest})"))
        .label(range, "the range")
        .help("change the value or the range")
}

pub(crate) fn not_in_set(name: &str, at: Span, set: Span) -> Diagnostic {
    Diagnostic::error(CODE, at, format!("the value of `{name}` is not one of those it can have"))
        .label(set, "these")
        .help("change the value, or add it to the set")
}

pub(crate) fn reversed(least: f64, greatest: f64, low: Span, high: Span) -> Diagnostic {
    Diagnostic::error(CODE, low, format!("the range ({least}, {greatest}) is empty"))
        .label(high, "less than the lower bound")
        .help("write the smaller bound first")
}
