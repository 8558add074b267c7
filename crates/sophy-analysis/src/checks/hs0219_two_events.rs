//! Two events at once. A component takes one event at a time, so the condition would never be true.

use sophy_diagnostics::{Code, Diagnostic, Span};

pub(crate) const CODE: Code = Code("HS0219");

/// `first and second`.
pub(crate) fn diagnostic(left: Span, first: &str, right: Span, second: &str) -> Diagnostic {
    Diagnostic::error(CODE, left, format!("events `{first}` and `{second}` are never true together"))
        .label(right, "the other event")
        .help("write `or`, or remember the first event in a mode")
}
