//! A declaration names a type that does not exist.

use super::suggestion::suggest;
use crate::component::TYPES;
use sophy_diagnostics::{Code, Diagnostic, Span};

pub(crate) const CODE: Code = Code("HS0120");

pub(crate) fn diagnostic(name: &str, span: Span) -> Diagnostic {
    let elsewhere = match name {
        "float" | "double" | "Real" | "f64" | "number" => Some("real"),
        "int" | "Integer" | "long" => Some("integer"),
        "bool" | "Boolean" | "logical" => Some("boolean"),
        "text" | "String" | "message" => Some("string"),
        _ => None,
    };
    let help = match elsewhere {
        Some(here) => format!("did you mean `{here}`?"),
        None => suggest(name, &TYPES, "types").help,
    };
    Diagnostic::error(CODE, span, format!("there is no type `{name}`")).help(help)
}
