//! A member gets the value of a parameter that its component does not have.

use super::suggestion::suggest;
use crate::declarations::Spanned;
use sophy_diagnostics::{Code, Diagnostic, Span};

pub(crate) const CODE: Code = Code("HS0139");

/// `names` are those of the parameters that the component has.
pub(crate) fn diagnostic(name: &Spanned<String>, component: &Spanned<String>, names: &[&str]) -> Diagnostic {
    let help = suggest(&name.value, names, "parameters").help;
    Diagnostic::error(CODE, name.span, format!("`{}` has no parameter `{}`", component.value, name.value))
        .help(help)
        .help("a member can set the knobs and assignments of its component")
}

/// The parameter decides the structure of the component, so its value must be known when the model is built.
pub(crate) fn not_known(name: &Spanned<String>, component: &Spanned<String>, span: Span) -> Diagnostic {
    let message = format!(
        "`{}` decides the structure of `{}`, and this value is not known before a run",
        name.value, component.value
    );
    Diagnostic::error(CODE, span, message)
        .help("write a number, or an expression of constants and loop variables")
}
