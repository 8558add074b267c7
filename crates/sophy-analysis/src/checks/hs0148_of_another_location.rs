//! A name is used that a location declares for itself: what it stands for exists there only.

use crate::lower::SymbolKind;
use sophy_diagnostics::{Code, Diagnostic, Span};

pub(crate) const CODE: Code = Code("HS0148");

/// `place` is the location, `declared` where it declares the name.
pub(crate) fn diagnostic(
    name: &str,
    span: Span,
    kind: SymbolKind,
    place: &str,
    declared: Span,
) -> Diagnostic {
    Diagnostic::error(CODE, span, format!("`{name}` exists only while location `{place}` holds"))
        .label(declared, format!("declared here, as {}", kind.with_article()))
        .help("declare it in the body, so that it exists in all locations")
}

/// It is assigned on the way to another location, where it does not exist any more.
pub(crate) fn left(name: &str, span: Span, kind: SymbolKind, place: &str, declared: Span) -> Diagnostic {
    Diagnostic::error(CODE, span, format!("`{name}` does not exist any more once location `{place}` is left"))
        .label(declared, format!("declared here, as {}", kind.with_article()))
        .help("delete the assignment, or declare it in the body, so that it exists in all locations")
}
