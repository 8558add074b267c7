//! Connected quantities have different units: what one component calls 1 is something else to the other.

use crate::component::Port;
use crate::units::Mismatch;
use sophy_diagnostics::{Code, Diagnostic, Span};

pub(crate) const CODE: Code = Code("HS0412");

pub(crate) fn diagnostic(from: (&Port, Span), to: (&Port, Span), mismatch: &Mismatch) -> Diagnostic {
    let error = Diagnostic::error(CODE, from.1, "connected quantities have different units")
        .label_main(unit(from.0))
        .label(to.1, unit(to.0));
    let help = format!("convert in a component, or declare `{}` in {}", to.0.name, unit(from.0));
    with_way_out(error, mismatch, help)
}

/// A 1 or -1 in a composition matrix connects two ports, whose full names are `written`.
pub(crate) fn in_matrix(
    matrix: Span,
    written: (&str, &str),
    from: &Port,
    to: &Port,
    mismatch: &Mismatch,
) -> Diagnostic {
    let message = format!("the matrix connects `{}` to `{}`, which has another unit", written.0, written.1);
    let error =
        Diagnostic::error(CODE, matrix, message).label(from.span, unit(from)).label(to.span, unit(to));
    with_way_out(error, mismatch, "write the factor that converts into the matrix".to_owned())
}

fn with_way_out(error: Diagnostic, mismatch: &Mismatch, convert: String) -> Diagnostic {
    match mismatch.conversion() {
        Some(conversion) => error.note(conversion).help(convert),
        None => error
            .help("these are different physical quantities: one of the two connections or units is wrong"),
    }
}

fn unit(port: &Port) -> String {
    format!("\"{}\"", port.unit.as_deref().unwrap_or("1"))
}
