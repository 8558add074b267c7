//! A type does not suit what has it: a flag is a number whose sign counts, what a discrete component gives is held.

use super::words::kind_with_article;
use crate::declarations::ComponentKind;
use sophy_diagnostics::{Code, Diagnostic, Span};

pub(crate) const CODE: Code = Code("HS0125");

/// `what` is what has the type.
pub(crate) fn variable(kind: &str, what: &str, span: Span) -> Diagnostic {
    let help = if kind == "event" {
        "events are ports: `input(name, event);` or `output(name, event);`"
    } else {
        "leave the type out: a flag is a number whose sign changes are events"
    };
    Diagnostic::error(CODE, span, format!("{what} cannot have the type `{kind}`")).help(help)
}

/// A `real` output of a continuous-time component varies continuously; `equation` is what defines it, if it is no state.
pub(crate) fn continuous(name: &str, kind: Span, equation: Option<Span>) -> Diagnostic {
    let message = format!("output `{name}` varies continuously, but `real` is what changes at instants only");
    let error = Diagnostic::error(CODE, kind, message).help("write `signal`");
    match equation {
        Some(equation) => error.label(equation, "this varies continuously"),
        None => error,
    }
}

/// An event carries no value that could have a range, a unit or elements.
pub(crate) fn event_with_value(name: &str, span: Span) -> Diagnostic {
    Diagnostic::error(
        CODE,
        span,
        format!("event `{name}` carries no value: it has no range, unit or elements"),
    )
    .help("delete them; what goes with an event is another port, `real` say")
}

/// A discrete-time or logic component has an output that is a signal.
pub(crate) fn output(component: ComponentKind, name: &str, span: Span) -> Diagnostic {
    let message = format!(
        "output `{name}` of {} changes at instants only and is no signal",
        kind_with_article(component)
    );
    Diagnostic::error(CODE, span, message)
        .help("write `real`: a `real` output may be connected to a `signal` input, where it is held")
}
