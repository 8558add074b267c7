//! A member gets the value of a parameter that its component does not have.

use super::suggestion::suggest;
use crate::declarations::Spanned;
use sophy_diagnostics::{Code, Diagnostic, Span};
use sophy_ir::{Class, VariableKind};

pub(crate) const CODE: Code = Code("HS0139");

pub(crate) fn diagnostic(name: &Spanned<String>, component: &Spanned<String>, class: &Class) -> Diagnostic {
    let is_parameter = |kind| matches!(kind, VariableKind::Parameter { .. });
    let mut names: Vec<&str> = class
        .variables_of(is_parameter)
        .map(|id| class.variable(id).name.as_str())
        .map(|name| name.split_once('[').map_or(name, |(vector, _)| vector))
        .collect();
    names.dedup();
    let help = suggest(&name.value, &names, "parameters").help;
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
