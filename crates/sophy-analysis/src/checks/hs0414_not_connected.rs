//! An input of a member, or an output of a composite, is not connected: nothing says what it is.

use sophy_diagnostics::{Code, Diagnostic, Span};

pub(crate) const CODE: Code = Code("HS0414");

pub(crate) fn input(member: &str, port: &str, span: Span, declared: Span) -> Diagnostic {
    Diagnostic::error(CODE, span, format!("input `{port}` of `{member}` is not connected"))
        .label(declared, "the input")
        .help(format!("add `… -> {member}.{port};` to the connections"))
}

pub(crate) fn output(port: &str, span: Span) -> Diagnostic {
    Diagnostic::error(CODE, span, format!("output `{port}` of the composite is not connected"))
        .help(format!("add `member.port -> {port};` to the connections, or delete the output"))
}

/// An event input of a member that nothing is connected to; that may be meant.
pub(crate) fn event_input(member: &str, port: &str, span: Span, declared: Span) -> Diagnostic {
    Diagnostic::warning(
        CODE,
        span,
        format!("input event `{port}` of `{member}` is not connected: it never happens"),
    )
    .label(declared, "the event")
    .help(format!("add `… -> {member}.{port};` to the connections"))
}

/// An event output of a composite that nothing is connected to.
pub(crate) fn event_output(port: &str, span: Span) -> Diagnostic {
    Diagnostic::warning(
        CODE,
        span,
        format!("output event `{port}` of the composite is not connected: it never happens"),
    )
    .help(format!("add `member.event -> {port};` to the connections, or delete the output"))
}
