//! The smallest or largest of nothing: the range is empty, or `where` leaves nothing of it.

use sophy_diagnostics::{Code, Diagnostic, Span};

pub(crate) const CODE: Code = Code("HS0216");

/// `name` is `min` or `max`.
pub(crate) fn diagnostic(span: Span, name: &str) -> Diagnostic {
    Diagnostic::error(CODE, span, format!("`{name}` of nothing has no value"))
        .note("no value of the loop is left")
        .help("check the range, and the condition after `where`")
}
