//! The extent of a vector or matrix is no number of elements.

use sophy_diagnostics::{Code, Diagnostic, Span};

pub(crate) const CODE: Code = Code("HS0121");

/// The most elements a variable may have.
pub(crate) const LARGEST: usize = 1_000_000;

pub(crate) fn diagnostic(extent: i64, span: Span) -> Diagnostic {
    Diagnostic::error(CODE, span, format!("{extent} is no number of elements"))
        .help(format!("an extent is a whole number from 1 to {LARGEST}"))
}

/// More than two extents, or more elements than there may be.
pub(crate) fn too_many(extents: usize, span: Span) -> Diagnostic {
    if extents > 2 {
        return Diagnostic::error(CODE, span, format!("a variable cannot have {extents} extents"))
            .help("a vector has one extent, a matrix two; use an array of components for more");
    }
    Diagnostic::error(CODE, span, format!("the matrix has more than {LARGEST} elements"))
        .help("use an array of components for large structures")
}
