//! A value that decides the structure of a component must be known before a run: it cannot depend on what changes.

use sophy_diagnostics::{Code, Diagnostic, Span};

pub(crate) const CODE: Code = Code("HS0213");

/// `what` is needed to write out a loop or an array.
pub(crate) fn diagnostic(span: Span, what: &str) -> Diagnostic {
    Diagnostic::error(CODE, span, format!("{what} must be known before a run"))
        .note("loops and arrays are written out when the model is read")
        .help("use numbers, constants, loop variables and parameters with a value only")
}

/// The inverse of a large matrix.
pub(crate) fn inverse(span: Span, n: usize, largest: usize) -> Diagnostic {
    Diagnostic::error(CODE, span, format!("the elements of a {n}×{n} matrix that is inverted must be known before a run"))
        .note(format!("up to {largest}×{largest} an inverse is written out as a formula; beyond that it would lose all digits"))
        .help("compute it from numbers and parameters, or state the equations it solves in `constraints`")
}
