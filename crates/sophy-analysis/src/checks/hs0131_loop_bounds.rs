//! A loop does not run, or runs too often.

use sophy_diagnostics::{Code, Diagnostic, Span};

pub(crate) const CODE: Code = Code("HS0131");

pub(crate) fn too_many(from: i64, to: i64, from_span: Span, to_span: Span) -> Diagnostic {
    Diagnostic::error(CODE, from_span.to(to_span), format!("the loop from {from} to {to} has too many turns"))
        .help("a loop has at most ten million turns")
}

pub(crate) fn empty(from: i64, to: i64, from_span: Span, to_span: Span) -> Diagnostic {
    Diagnostic::warning(CODE, from_span.to(to_span), format!("the loop from {from} to {to} does nothing"))
        .help("write the smaller bound first")
}
