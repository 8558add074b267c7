//! An output has the name of a variable of the body and so is that variable, but their types differ.

use sophy_diagnostics::{Code, Diagnostic, Span};

pub(crate) const CODE: Code = Code("HS0128");

pub(crate) fn diagnostic(name: &str, port: Span, own: Span) -> Diagnostic {
    Diagnostic::error(
        CODE,
        port,
        format!("output `{name}` and the variable of that name have different types"),
    )
    .label(own, "the variable")
    .note("an output with the name of a state, local or mode is that variable")
    .help("give both the same type, or the output another name and an equation")
}
