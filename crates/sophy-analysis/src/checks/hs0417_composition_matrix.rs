//! A composition matrix does not fit its components (thesis A.3, eq. A.15).

use crate::lower::Shape;
use sophy_diagnostics::{Code, Diagnostic, Span};

pub(crate) const CODE: Code = Code("HS0417");

pub(crate) fn shape(span: Span, shape: Shape, rows: &[String], columns: &[String]) -> Diagnostic {
    let message =
        format!("the matrix is {shape}, but there are {} rows and {} columns", rows.len(), columns.len());
    Diagnostic::error(CODE, span, message)
        .note(format!("rows are what is fed: {}", list(rows)))
        .note(format!("columns are what feeds: {}", list(columns)))
        .help("write one row for each input of the members and output of the composite, in this order")
}

fn list(names: &[String]) -> String {
    if names.is_empty() { "nothing".to_owned() } else { names.join(", ") }
}

pub(crate) fn not_known(span: Span) -> Diagnostic {
    Diagnostic::error(CODE, span, "the elements of a composition matrix must be known before a run")
        .help("write numbers, or expressions of constants and parameters with a value")
}

pub(crate) fn no_member(span: Span) -> Diagnostic {
    Diagnostic::error(CODE, span, "only members can be composed")
        .help("write the names of members of this composite")
}
