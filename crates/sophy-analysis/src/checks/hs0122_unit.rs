//! A unit cannot be read: nothing could be checked against it. Or it says more than a factor can: a zero, a logarithm.

use crate::declarations::Spanned;
use crate::findings::Findings;
use crate::units::{NoteKind, UnitError};
use sophy_diagnostics::{Code, Diagnostic};

pub(crate) const CODE: Code = Code("HS0122");

pub(crate) fn diagnostic(error: &UnitError, unit: &Spanned<String>) -> Diagnostic {
    let message = format!("the unit \"{}\" cannot be read: {error}", unit.value);
    Diagnostic::error(CODE, unit.span, message)
        .help("write it as in \"m/s2\", \"rad/s\", \"N.m\" or \"kg/(m.s)\"; \"1\" is dimensionless, and without a unit nothing is checked")
}

/// Something about a unit that may surprise: of the units of a file as such once, of how one is written each time.
pub(crate) fn note(kind: NoteKind, unit: &Spanned<String>, findings: &mut Findings) {
    let said = (unit.span.source, kind);
    if kind != NoteKind::ProductAfterDivision {
        if findings.unit_notes.contains(&said) {
            return;
        }
        findings.unit_notes.push(said);
    }
    let note = Diagnostic::note_at(CODE, unit.span, format!("the unit \"{}\": {kind}", unit.value));
    findings.report(match kind {
        NoteKind::Offset => note.help(
            "where a formula needs the temperature from absolute zero, add 273.15 K (459.67 degF) in it",
        ),
        NoteKind::Logarithm | NoteKind::ProductAfterDivision => note,
    });
}
