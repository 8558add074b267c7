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
