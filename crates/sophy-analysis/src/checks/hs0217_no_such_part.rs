//! A part that something does not have, or something that has parts only.

use super::suggestion::suggest;
use sophy_diagnostics::{Code, Diagnostic, Span};

pub(crate) const CODE: Code = Code("HS0217");

/// Record `path` has no `member`.
pub(crate) fn diagnostic(span: Span, path: &str, member: &str, entries: &[&str]) -> Diagnostic {
    Diagnostic::error(CODE, span, format!("`{path}` has no `{member}`"))
        .help(suggest(member, entries, "constants it has").help)
}

/// A record as a whole is no value.
pub(crate) fn whole_record(span: Span, path: &str, entries: &[&str]) -> Diagnostic {
    let example = entries.first().copied().unwrap_or("name");
    Diagnostic::error(CODE, span, format!("`{path}` is a record of constants, and has no value itself"))
        .help(format!("use one of its constants: `{path}.{example}`"))
}

/// A list of records is used without an index, or with a name.
pub(crate) fn whole_list(span: Span, path: &str) -> Diagnostic {
    Diagnostic::error(CODE, span, format!("`{path}` is a list of records"))
        .help(format!("choose one by its index: `{path}[1]`"))
}

/// A record has no indices.
pub(crate) fn record_indexed(span: Span, path: &str) -> Diagnostic {
    Diagnostic::error(CODE, span, format!("`{path}` is a record of constants, and has no indices"))
        .help(format!("use one of its constants by name: `{path}.name`"))
}

/// A constant of a data file that is no number, truth value or text.
pub(crate) fn unusable(span: Span, path: &str, reason: &str) -> Diagnostic {
    Diagnostic::error(CODE, span, format!("`{path}` is {reason}, which an expression cannot use"))
        .help("give it numbers in the data file")
}

/// `name` is `what`, which stands for no value.
pub(crate) fn no_value(span: Span, name: &str, what: &str, declared: Span) -> Diagnostic {
    Diagnostic::error(CODE, span, format!("`{name}` is {what}, and has no value"))
        .label(declared, "declared here")
        .help("use one of its variables in a connection")
}

/// A port of a component in an expression.
pub(crate) fn port(span: Span, name: &str) -> Diagnostic {
    Diagnostic::error(CODE, span, format!("expressions cannot read what belongs to component `{name}`"))
        .help("connect it: `component.output -> other.input;`")
}

/// `written` is no record.
pub(crate) fn no_parts(span: Span, written: &str, member: &str) -> Diagnostic {
    Diagnostic::error(CODE, span, format!("`{written}` has no part `{member}`: it is not a record"))
        .help("only records of constants, read with `data(\"file.toml\")`, have parts")
}
