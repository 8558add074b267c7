//! A section or declaration belongs to another kind of component.

use super::words::kind_with_article;
use crate::declarations::ComponentKind;
use sophy_diagnostics::{Code, Diagnostic, Span};

pub(crate) const CODE: Code = Code("HS0127");

/// `what` is a kind of variable with its article.
pub(crate) fn diagnostic(kind: ComponentKind, what: &str, name: &str, span: Span) -> Diagnostic {
    let help = match kind {
        ComponentKind::Dtc => "a DTC has `state`, `local` and `mode` variables; flags need a CTC",
        ComponentKind::Lbc => "an LBC has `mode` and `local` variables; states and flags need a CTC or DTC",
        ComponentKind::Cc | ComponentKind::System => {
            "a composite has components and parameters; declare the variable in one of the components"
        }
        ComponentKind::Ctc => "declare it as a state, local, mode or flag",
    };
    let message = format!("{} cannot have {what}: `{name}`", kind_with_article(kind));
    Diagnostic::error(CODE, span, message).help(help)
}

/// A section that this kind of component does not have.
pub(crate) fn section(kind: ComponentKind, section: &str, suits: &str, span: Span) -> Diagnostic {
    let message = format!("{} has no `{section}` section", kind_with_article(kind));
    if (kind, section) == (ComponentKind::Dtc, "dynamics") {
        return Diagnostic::error(CODE, span, message)
            .help("a DTC computes at its executions: write `update … end update;`, with `:=`");
    }
    Diagnostic::error(CODE, span, message).help(format!("move it to {suits}, or make this component one"))
}

pub(crate) fn system_input(name: &str, span: Span) -> Diagnostic {
    Diagnostic::error(CODE, span, format!("a SYSTEM has no inputs: `{name}`"))
        .help("add a component that generates the signal and connect it, or write `CC` instead of `SYSTEM`")
}
