//! A file does not say what a run is to be started on.

use super::suggestion::suggest;
use crate::declarations::ComponentDeclaration;
use sophy_diagnostics::{Code, Diagnostic, Span};

pub(crate) const CODE: Code = Code("HS0142");

/// How many candidates are listed.
const SHOWN: usize = 8;

/// There is no component at all.
pub(crate) fn none(span: Span) -> Diagnostic {
    Diagnostic::error(CODE, span, "there is no component in this file")
        .help("write one; `sophy new ctc Name` prints a template")
}

/// No component of the name that was asked for.
pub(crate) fn unknown(name: &str, components: &[&ComponentDeclaration], span: Span) -> Diagnostic {
    let names: Vec<&str> = components.iter().map(|component| component.name.value.as_str()).collect();
    Diagnostic::error(CODE, span, format!("there is no component `{name}` in this file"))
        .help(suggest(name, &names, "components").help)
}

/// Several could be meant.
pub(crate) fn ambiguous(candidates: &[&ComponentDeclaration]) -> Diagnostic {
    let shown = &candidates[..candidates.len().min(SHOWN)];
    let names: Vec<String> = shown.iter().map(|component| format!("`{}`", component.name.value)).collect();
    let more = match candidates.len() - shown.len() {
        0 => String::new(),
        more => format!(" and {more} more"),
    };
    let mut error = Diagnostic::error(
        CODE,
        candidates[0].name.span,
        format!("several components could be run: {}{more}", names.join(", ")),
    );
    for component in &shown[1..] {
        error = error.label(component.name.span, "or this one");
    }
    error.help(
        "say which one: `--system NAME`, `system = \"NAME\"` in an experiment, or a SYSTEM that contains it",
    )
}
