//! A connection joins ports of different types.

use super::words::kind_with_article;
use crate::component::{Port, PortType};
use crate::declarations::ComponentKind;
use sophy_diagnostics::{Code, Diagnostic, Span};
use sophy_ir::Quantity;

pub(crate) const CODE: Code = Code("HS0415");

pub(crate) fn diagnostic(
    from: (&Port, Span),
    to: (&Port, Span),
    receiver: Option<ComponentKind>,
) -> Diagnostic {
    let (a, b) = (from.0.kind, to.0.kind);
    let message = differ((&from.0.name, &to.0.name), (a, b));
    let error = Diagnostic::error(CODE, from.1, message).label_main(a.name()).label(to.1, b.name());
    with_way_out(error, from.0, to.0, receiver)
}

/// An entry of a composition matrix connects two ports, whose full names are `written`.
pub(crate) fn in_matrix(
    matrix: Span,
    written: (&str, &str),
    from: &Port,
    to: &Port,
    receiver: Option<ComponentKind>,
) -> Diagnostic {
    let error = Diagnostic::error(CODE, matrix, differ(written, (from.kind, to.kind)))
        .label(from.span, from.kind.name())
        .label(to.span, to.kind.name());
    with_way_out(error, from, to, receiver)
}

fn differ(names: (&str, &str), kinds: (PortType, PortType)) -> String {
    let ((from, to), (a, b)) = (names, (kinds.0.name(), kinds.1.name()));
    format!("`{from}` is a `{a}`, `{to}` is a `{b}`: they cannot be connected")
}

fn with_way_out(error: Diagnostic, from: &Port, to: &Port, receiver: Option<ComponentKind>) -> Diagnostic {
    match (from.kind, to.kind) {
        (PortType::Signal, PortType::Held(Quantity::Real)) => {
            let what = receiver.map_or("a composite", kind_with_article);
            error.help(format!(
                "declare `{}` as `signal`: only a discrete-time component samples a signal, and this is {what}",
                to.name
            ))
        }
        (PortType::Held(Quantity::Integer), PortType::Held(Quantity::Real) | PortType::Signal) => {
            error.help("declare both as `real`")
        }
        _ => error.help("declare both ports with one type, or convert in a component between them"),
    }
}

pub(crate) fn event_and_value(from: Span, to: Span) -> Diagnostic {
    Diagnostic::error(CODE, from, "an event can only be connected to an event")
        .label(to, "to this")
        .help("an event carries no value; a value that changes needs a port of type `real`, `integer`, `boolean` or `string`")
}

pub(crate) fn event_and_label(from: Span, to: Span) -> Diagnostic {
    Diagnostic::error(CODE, from, "an event and the label of synchronised transitions cannot be connected")
        .label(to, "to this")
        .help("join `sync` labels with one another: their transitions are taken together; events are sent and received")
}
