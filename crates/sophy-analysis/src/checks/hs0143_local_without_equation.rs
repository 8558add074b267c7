//! A local, flag or output of a component has no equation.

use crate::lower::SymbolKind;
use sophy_diagnostics::{Code, Diagnostic, Span};

pub(crate) const CODE: Code = Code("HS0143");

/// `place` says where it has none.
pub(crate) fn diagnostic(
    name: &str,
    kind: SymbolKind,
    span: Span,
    place: &str,
    used: Option<Span>,
) -> Diagnostic {
    let what = match kind {
        SymbolKind::Flag => "flag",
        SymbolKind::Output => "output",
        _ => "local",
    };
    let mut error = Diagnostic::error(CODE, span, format!("{what} `{name}` has no equation{place}"));
    if let Some(used) = used {
        error = error.label(used, "it is needed here");
    }
    let help = match kind {
        SymbolKind::Flag => format!("add `{name} = …` to `dynamics`: the event is the change of its sign"),
        SymbolKind::Output => format!("add `{name} = …` to `output`, or assign `{name} := …` at events"),
        _ => format!("add `{name} = …` to `dynamics`"),
    };
    error.help(help)
}
