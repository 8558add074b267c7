//! An array of components is declared with indices or numbers of copies that make no array.

use sophy_diagnostics::{Code, Diagnostic, Span};

pub(crate) const CODE: Code = Code("HS0140");

pub(crate) fn extent(name: &str, extents: &[u32], span: Span) -> Diagnostic {
    let copies: u128 = extents.iter().map(|&n| u128::from(n)).product();
    Diagnostic::error(CODE, span, format!("`{name}` cannot have {copies} copies"))
        .help("an array has from 1 to 100 million copies")
}

pub(crate) fn not_positive(what: &str, number: i64, span: Span) -> Diagnostic {
    Diagnostic::error(CODE, span, format!("{what} is {number}"))
        .help("indices and numbers of copies count from 1")
}

pub(crate) fn both(name: &str, span: Span) -> Diagnostic {
    Diagnostic::error(CODE, span, format!("`{name}` is one element of an array and an array itself"))
        .help("write `name : Component[n];` for equal copies, or `name[i] : Component;` in a loop")
}
