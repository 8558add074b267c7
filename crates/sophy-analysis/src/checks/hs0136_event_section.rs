//! An event section does not say what happens when a flag changes its sign.

use super::suggestion::suggest;
use crate::declarations::Spanned;
use crate::lower::{SymbolKind, Symbols};
use sophy_diagnostics::{Code, Diagnostic, Span};

pub(crate) const CODE: Code = Code("HS0136");

pub(crate) fn no_flag(
    flag: &Spanned<String>,
    found: Option<(SymbolKind, Span)>,
    symbols: &Symbols<'_>,
) -> Diagnostic {
    let name = &flag.value;
    if let Some((kind, declared)) = found {
        let message = format!("`{name}` is {}, and only flags have event sections", kind.with_article());
        return Diagnostic::error(CODE, flag.span, message).label(declared, "declared here").help(format!(
            "declare a flag whose sign changes are the events: `flag S;`, and in `dynamics` `S = {name};` or what is meant"
        ));
    }
    let names = symbols.names();
    let flags: Vec<&str> =
        names.iter().filter(|(_, s)| s.kind == SymbolKind::Flag).map(|(name, _)| *name).collect();
    let help = suggest(name, &flags, "flags").help;
    Diagnostic::error(CODE, flag.span, format!("there is no flag `{name}`")).help(help)
}

pub(crate) fn vector(flag: &Spanned<String>) -> Diagnostic {
    Diagnostic::error(CODE, flag.span, format!("flag `{}` is a vector", flag.value))
        .help(format!("say which element: `event({}[1])`", flag.value))
}

pub(crate) fn nothing(flag: &Spanned<String>) -> Diagnostic {
    Diagnostic::warning(CODE, flag.span, format!("nothing happens when `{}` changes its sign", flag.value))
        .help("add `negative-to-positive` or `positive-to-negative`, or delete the section")
}
