//! A flag has no event section: nothing happens when its sign changes.

use sophy_diagnostics::{Code, Diagnostic, Span};

pub(crate) const CODE: Code = Code("HS0144");

pub(crate) fn diagnostic(name: &str, span: Span) -> Diagnostic {
    Diagnostic::note_at(CODE, span, format!("nothing listens to flag `{name}`"))
        .help(format!("add `event({name}) … end event;`, or declare `{name}` as a local"))
}
