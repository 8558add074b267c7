//! Quantities in different units are added, compared, or put in one another's place. The numbers alone do not show
//! it: feet added to metres give a length that is neither.

use crate::units::{Mismatch, Unit};
use sophy_diagnostics::{Code, Diagnostic, Span};

pub(crate) const CODE: Code = Code("HS0209");

/// Two operands are `done`: added, subtracted, compared, or alternatives.
pub(crate) fn operands(done: &str, left: Span, right: Span, mismatch: Mismatch) -> Diagnostic {
    let error = Diagnostic::error(CODE, left, format!("quantities in {mismatch} are {done}"));
    with_labels(error, right, mismatch)
}

/// Two arguments of function `name` must be of one kind.
pub(crate) fn arguments(name: &str, left: Span, right: Span, mismatch: Mismatch) -> Diagnostic {
    let error = Diagnostic::error(CODE, left, format!("`{name}` gets quantities in {mismatch}"));
    with_labels(error, right, mismatch)
}

/// What a reduction combines is not of one kind.
pub(crate) fn reduced(span: Span, name: &str, mismatch: Mismatch) -> Diagnostic {
    let message = format!("`{name}` combines quantities in {mismatch}");
    with_way_out(Diagnostic::error(CODE, span, message), mismatch)
}

/// `what`, which is declared at `declared` in the right unit, gets a value in the left one.
pub(crate) fn assigned(span: Span, what: &str, declared: Option<Span>, mismatch: Mismatch) -> Diagnostic {
    let (has, gets) = (named(mismatch.right), named(mismatch.left));
    let error = Diagnostic::error(CODE, span, format!("{what} is in {has}, but its value is in {gets}"))
        .label_main(label(mismatch.left));
    let error = match declared {
        Some(declared) => error.label(declared, label(mismatch.right)),
        None => error,
    };
    with_way_out(error, mismatch)
}

/// `what` must be in a certain unit, the right one.
pub(crate) fn required(span: Span, what: &str, mismatch: Mismatch) -> Diagnostic {
    let (needed, given) = (named(mismatch.right), named(mismatch.left));
    let message = format!("{what} is in {given}, but must be in {needed}");
    with_way_out(Diagnostic::error(CODE, span, message).label_main(label(mismatch.left)), mismatch)
}

/// `what` must be a plain number.
pub(crate) fn not_a_number(span: Span, what: &str, mismatch: Mismatch) -> Diagnostic {
    let given = named(mismatch.left);
    let message = format!("{what} must be a plain number, but is in {given}");
    let error =
        with_conversion(Diagnostic::error(CODE, span, message).label_main(label(mismatch.left)), mismatch);
    error.help(if mismatch.is_of_scale() {
        "convert it first"
    } else {
        "divide it by a quantity in the same unit, or check the formula"
    })
}

fn with_labels(error: Diagnostic, right: Span, mismatch: Mismatch) -> Diagnostic {
    let error = error.label_main(label(mismatch.left)).label(right, label(mismatch.right));
    with_way_out(error, mismatch)
}

fn with_way_out(error: Diagnostic, mismatch: Mismatch) -> Diagnostic {
    with_conversion(error, mismatch).help(if mismatch.is_of_scale() {
        "convert one of them, or declare both in one unit"
    } else {
        "check the formula, and the units of what it uses"
    })
}

fn with_conversion(error: Diagnostic, mismatch: Mismatch) -> Diagnostic {
    match mismatch.conversion() {
        Some(conversion) => error.note(conversion),
        None => error,
    }
}

fn label(unit: Unit) -> String {
    format!("\"{unit}\"")
}

fn named(unit: Unit) -> String {
    format!("`{unit}`")
}
