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
    let message = format!("`{}` is a `{}`, `{}` is a `{}`", from.0.name, a.name(), to.0.name, b.name());
    let error = Diagnostic::error(CODE, from.1, format!("{message}: they cannot be connected"))
        .label_main(a.name())
        .label(to.1, b.name());
    match (a, b) {
        (PortType::Signal, PortType::Held(Quantity::Real)) => {
            let what = receiver.map_or("a composite", kind_with_article);
            error.help(format!(
                "declare `{}` as `signal`: only a discrete-time component samples a signal, and this is {what}",
                to.0.name
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
