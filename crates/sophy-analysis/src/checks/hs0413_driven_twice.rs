//! A port is fed by two connections, or an event is sent to a port by two.

use sophy_diagnostics::{Code, Diagnostic, Span};

pub(crate) const CODE: Code = Code("HS0413");

pub(crate) fn diagnostic(name: &str, first: Span, again: Span) -> Diagnostic {
    Diagnostic::error(CODE, again, format!("`{name}` is fed twice"))
        .label(first, "first here")
        .help("delete one of the connections; a sum of two signals needs a component that adds them")
}

/// Event `from` is connected to `to` twice.
pub(crate) fn event(from: &str, to: &str, first: Span, again: Span) -> Diagnostic {
    Diagnostic::error(CODE, again, format!("`{from}` is connected to `{to}` twice"))
        .label(first, "first here")
        .help("delete one of the connections")
}
