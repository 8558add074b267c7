//! `hold` asks for motion on the surface of a flag, and needs one.

use crate::declarations::Spanned;
use crate::lower::SymbolKind;
use sophy_diagnostics::{Code, Diagnostic, Span};

pub(crate) const CODE: Code = Code("HS0134");

pub(crate) fn diagnostic(
    flag: &Spanned<String>,
    found: Option<(SymbolKind, Span)>,
    place: &str,
) -> Diagnostic {
    let name = &flag.value;
    match found {
        Some((SymbolKind::Flag, _)) => {
            Diagnostic::error(CODE, flag.span, format!("`hold` has no meaning{place}"))
                .help("hold a flag in an event section or a transition")
        }
        Some((kind, declared)) => Diagnostic::error(
            CODE,
            flag.span,
            format!("`{name}` is {}, and only a flag can be held", kind.with_article()),
        )
        .label(declared, "declared here")
        .help("declare a flag, with an equation for the surface on which the motion is to stay"),
        None => Diagnostic::error(CODE, flag.span, format!("there is no flag `{name}`"))
            .help(format!("declare it: `flag {name};`, with an equation `{name} = …` in `dynamics`")),
    }
}
