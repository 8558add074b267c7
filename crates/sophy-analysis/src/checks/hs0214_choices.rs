//! A text that a variable can never be: usually a misspelling. The comparison would always be false.

use super::suggestion::suggest;
use sophy_diagnostics::{Code, Diagnostic, Span};

pub(crate) const CODE: Code = Code("HS0214");

/// The text stands in a comparison with a variable, whose name and declaration are given.
pub(crate) fn compared(
    span: Span,
    text: &str,
    choices: &[String],
    variable: Option<(String, Span)>,
) -> Diagnostic {
    let name = variable.as_ref().map_or("the variable".to_owned(), |(name, _)| format!("`{name}`"));
    let error = Diagnostic::error(CODE, span, format!("{name} is never \"{text}\""));
    let error = match variable {
        Some((_, declared)) => error.label(declared, "declared here"),
        None => error,
    };
    error.help(way_out(text, choices))
}

/// `what`, declared at `declared`, gets a text that is none of its own.
pub(crate) fn assigned(
    span: Span,
    what: &str,
    declared: Option<Span>,
    text: &str,
    choices: &[String],
) -> Diagnostic {
    let error = Diagnostic::error(CODE, span, format!("{what} cannot be \"{text}\""));
    let error = match declared {
        Some(declared) => error.label(declared, "declared here"),
        None => error,
    };
    error.help(way_out(text, choices))
}

/// `location` is compared with something that is no location.
pub(crate) fn no_location(span: Span, text: &str, locations: &[String]) -> Diagnostic {
    Diagnostic::error(CODE, span, format!("there is no location `{text}`")).help(way_out(text, locations))
}

fn way_out(text: &str, choices: &[String]) -> String {
    let choices: Vec<&str> = choices.iter().map(String::as_str).collect();
    suggest(text, &choices, "values it can have").help
}
