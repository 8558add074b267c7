//! An index does not select an element.

use crate::declarations::Spanned;
use sophy_diagnostics::{Code, Diagnostic, Span};

pub(crate) const CODE: Code = Code("HS0135");

pub(crate) fn outside(name: &Spanned<String>, index: i64, extent: usize, span: Span) -> Diagnostic {
    Diagnostic::error(CODE, span, format!("`{}` has no element {index}", name.value))
        .help(format!("indices run from 1 to {extent}"))
}

pub(crate) fn too_many(name: &Spanned<String>, indices: usize, shape: &str, span: Span) -> Diagnostic {
    let s = if indices == 1 { "an index" } else { "that many indices" };
    Diagnostic::error(CODE, span, format!("`{}` is {shape} and does not take {s}", name.value))
        .help("a vector takes one index, a matrix one (a row) or two")
}
