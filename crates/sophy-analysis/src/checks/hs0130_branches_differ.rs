//! Not every branch of a conditional equation defines the same variables: where a branch says nothing, the variable
//! would have no value.

use sophy_diagnostics::{Code, Diagnostic, Span};

pub(crate) const CODE: Code = Code("HS0130");

pub(crate) fn diagnostic(name: &str, defined: Span, keyword: Span, no_else: bool) -> Diagnostic {
    let message = format!("`{name}` is defined in some branches of this `if` only");
    let help = if no_else { "add an `else` branch that defines it" } else { "define it in every branch" };
    Diagnostic::error(CODE, keyword, message).label(defined, "defined here").help(help)
}
