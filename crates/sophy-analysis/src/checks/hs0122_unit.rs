//! A unit cannot be read: nothing could be checked against it.

use crate::declarations::Spanned;
use crate::units::UnitError;
use sophy_diagnostics::{Code, Diagnostic};

pub(crate) const CODE: Code = Code("HS0122");

pub(crate) fn diagnostic(error: &UnitError, unit: &Spanned<String>) -> Diagnostic {
    let message = format!("the unit \"{}\" cannot be read: {error}", unit.value);
    Diagnostic::error(CODE, unit.span, message)
        .help("write it as in \"m/s2\", \"rad/s\", \"N.m\" or \"kg/(m.s)\"; \"1\" is dimensionless, and without a unit nothing is checked")
}

/// Something about a unit that may surprise.
pub(crate) fn note(what: &str, unit: &Spanned<String>) -> Diagnostic {
    Diagnostic::note_at(CODE, unit.span, format!("the unit \"{}\": {what}", unit.value))
}
