//! Something is assigned that cannot be assigned.

use super::suggestion::suggest;
use crate::declarations::Spanned;
use crate::lower::{SymbolKind, Symbols};
use sophy_diagnostics::{Code, Diagnostic, Span};

pub(crate) const CODE: Code = Code("HS0133");

pub(crate) fn diagnostic(name: &Spanned<String>, kind: SymbolKind, declared: Span) -> Diagnostic {
    let help = match kind {
        SymbolKind::Output => {
            "an output that is assigned needs no equation; one with an equation cannot be assigned"
        }
        SymbolKind::Flag => "a flag is defined by an equation; assign what it depends on",
        SymbolKind::Input => "what an input is, is decided where the component is connected",
        SymbolKind::Knob | SymbolKind::Parameter | SymbolKind::Constant => {
            "parameters do not change during a run: declare a mode"
        }
        SymbolKind::Event => "write `emit` to send an event",
        _ => "declare a mode for what changes at instants",
    };
    let message = format!("`{}` is {}, which cannot be assigned", name.value, kind.with_article());
    Diagnostic::error(CODE, name.span, message).label(declared, "declared here").help(help)
}

pub(crate) fn unknown(name: &Spanned<String>, symbols: &Symbols<'_>) -> Diagnostic {
    let names = symbols.names();
    let assignable = |kind| matches!(kind, SymbolKind::State | SymbolKind::Mode | SymbolKind::Local);
    let candidates: Vec<&str> =
        names.iter().filter(|(_, symbol)| assignable(symbol.kind)).map(|(name, _)| *name).collect();
    let help = suggest(&name.value, &candidates, "states, modes and locals").help;
    Diagnostic::error(CODE, name.span, format!("`{}` is assigned, but not declared", name.value)).help(help)
}
