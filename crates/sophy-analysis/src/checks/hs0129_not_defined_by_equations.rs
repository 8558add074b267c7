//! An equation defines something that has no equation, or has one of the other kind.

use crate::declarations::Spanned;
use crate::lower::SymbolKind;
use sophy_diagnostics::{Code, Diagnostic, Span};

pub(crate) const CODE: Code = Code("HS0129");

pub(crate) fn diagnostic(name: &Spanned<String>, kind: SymbolKind, declared: Span, rate: bool) -> Diagnostic {
    let (name, span) = (&name.value, name.span);
    let message = if rate {
        format!("`{name}` is {}, and only states have a derivative", kind.with_article())
    } else {
        format!("`{name}` is {}, which no equation `{name} = …` can define", kind.with_article())
    };
    let help = match kind {
        SymbolKind::State if !rate => format!("write `der({name}) = …`, or declare `{name}` as a local"),
        SymbolKind::Mode => format!(
            "a mode gets its values at instants: `{name} := …` in an event section, a transition or a rule"
        ),
        SymbolKind::Local | SymbolKind::Output | SymbolKind::Flag if rate => {
            format!("write `{name} = …`, or declare `{name}` as a state")
        }
        SymbolKind::Knob | SymbolKind::Parameter | SymbolKind::Constant => {
            "a parameter gets its value in `assignments`; declare a local for what is computed".to_owned()
        }
        SymbolKind::Input => "what an input is, is decided where the component is connected".to_owned(),
        _ => "declare a local or a state of another name".to_owned(),
    };
    Diagnostic::error(CODE, span, message).label(declared, "declared here").help(help)
}
