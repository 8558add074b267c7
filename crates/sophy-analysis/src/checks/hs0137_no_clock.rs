//! A discrete-time component does not say when it executes.

use crate::declarations::Spanned;
use sophy_diagnostics::{Code, Diagnostic, Span};

pub(crate) const CODE: Code = Code("HS0137");

pub(crate) fn diagnostic(component: &Spanned<String>) -> Diagnostic {
    Diagnostic::error(CODE, component.span, format!("`{}` does not say when it executes", component.value))
        .help("declare a period, `tsample every 0.01;`, or the next instant, `tsample t_next := 0;`, which the update moves")
}

pub(crate) fn never_moved(clock: &Spanned<String>) -> Diagnostic {
    let name = &clock.value;
    Diagnostic::error(
        CODE,
        clock.span,
        format!("no update moves `{name}`: the component would execute without end"),
    )
    .help(format!("add `{name} := {name} + Ts;` to the update, or `{name} := never;` to execute once"))
}

pub(crate) fn not_positive(span: Span) -> Diagnostic {
    Diagnostic::error(CODE, span, "the period is not positive")
        .help("a period is a number of seconds greater than 0")
}
