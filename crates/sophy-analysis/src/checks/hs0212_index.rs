//! An index that does not exist, or too many of them. Indices are counted from 1.

use crate::lower::Shape;
use sophy_diagnostics::{Code, Diagnostic, Span};

pub(crate) const CODE: Code = Code("HS0212");

/// `written` has no element with this index.
pub(crate) fn out_of_bounds(
    span: Span,
    written: &str,
    index: i64,
    extent: usize,
    shape: Shape,
) -> Diagnostic {
    let help = match index {
        0 => "indices are counted from 1".to_owned(),
        _ => format!("its indices go from 1 to {extent}"),
    };
    Diagnostic::error(CODE, span, format!("index {index} is out of bounds: `{written}` is {shape}"))
        .help(help)
}

/// `written` has fewer extents than indices are given.
pub(crate) fn wrong_number(span: Span, written: &str, given: usize, shape: Shape) -> Diagnostic {
    let indices = if given == 1 { "an index".to_owned() } else { format!("{given} indices") };
    let error =
        Diagnostic::error(CODE, span, format!("`{written}` is {shape}, and has no element for {indices}"));
    match shape {
        Shape::Scalar => error.help("delete the index, or declare a vector"),
        _ => error.help("use fewer indices"),
    }
}

/// `what` must be whole.
pub(crate) fn not_whole(span: Span, what: &str, number: f64) -> Diagnostic {
    Diagnostic::error(CODE, span, format!("{what} must be a whole number, but this is {number}"))
        .help("write it without a fraction")
}

/// An extent of 0 or less.
pub(crate) fn no_such_extent(span: Span, number: i64) -> Diagnostic {
    Diagnostic::error(CODE, span, format!("an extent must be 1 or more, but this is {number}"))
        .help("vectors and matrices have at least one element")
}

/// `size(x, 3)`.
pub(crate) fn no_extent(span: Span, written: &str, which: i64, shape: Shape) -> Diagnostic {
    Diagnostic::error(CODE, span, format!("`{written}` is {shape}, and has no extent {which}"))
        .help("a vector has one extent, a matrix has two: rows and columns")
}
