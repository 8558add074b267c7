//! A port is fed by two connections.

use sophy_diagnostics::{Code, Diagnostic, Span};

pub(crate) const CODE: Code = Code("HS0413");

pub(crate) fn diagnostic(name: &str, first: Span, again: Span) -> Diagnostic {
    Diagnostic::error(CODE, again, format!("`{name}` is fed twice"))
        .label(first, "first here")
        .help("delete one of the connections; a sum of two signals needs a component that adds them")
}
