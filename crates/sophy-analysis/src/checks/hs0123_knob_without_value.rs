//! A knob has no value, so that nothing that depends on it can be computed before somebody turns it.

use sophy_diagnostics::{Code, Diagnostic, Span};

pub(crate) const CODE: Code = Code("HS0123");

pub(crate) fn diagnostic(name: &str, span: Span) -> Diagnostic {
    Diagnostic::error(CODE, span, format!("knob `{name}` has no value"))
        .help(format!("give it one that holds until an experiment says otherwise: `assignments {name} : …; end assignments;`"))
}
