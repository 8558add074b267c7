//! Two event sections, rules or transitions can act at the same instant and assign the same variable: what it is
//! afterwards would be undecided.

use sophy_diagnostics::{Code, Diagnostic, Span};

pub(crate) const CODE: Code = Code("HS0146");

/// `first` and `second` assign `name`.
pub(crate) fn diagnostic(name: &str, first: Span, second: Span) -> Diagnostic {
    Diagnostic::note_at(CODE, first, format!("`{name}` may be assigned twice at one instant"))
        .label(second, "this assigns it, too, and can happen at the same instant")
        .help("give one of the two a `priority`: a smaller number goes first, the other one an instant step later")
}
