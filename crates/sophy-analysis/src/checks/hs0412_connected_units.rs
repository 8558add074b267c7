//! Connected quantities have different units: what one component calls 1 is something else to the other.

use crate::component::Port;
use crate::units::Mismatch;
use sophy_diagnostics::{Code, Diagnostic, Span};

pub(crate) const CODE: Code = Code("HS0412");

pub(crate) fn diagnostic(from: (&Port, Span), to: (&Port, Span), mismatch: &Mismatch) -> Diagnostic {
    let unit = |port: &Port| format!("\"{}\"", port.unit.as_deref().unwrap_or("1"));
    let mut error = Diagnostic::error(CODE, from.1, "connected quantities have different units")
        .label_main(unit(from.0))
        .label(to.1, unit(to.0));
    let help = match mismatch.conversion() {
        Some(conversion) => {
            error = error.note(conversion);
            format!("convert in a component, or declare `{}` in {}", to.0.name, unit(from.0))
        }
        None => {
            "these are different physical quantities: one of the two connections or units is wrong".to_owned()
        }
    };
    error.help(help)
}
