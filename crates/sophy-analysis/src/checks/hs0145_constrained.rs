//! There are more, or fewer, equations than unknowns.

use sophy_diagnostics::{Code, Diagnostic, Span};

pub(crate) const CODE: Code = Code("HS0145");

/// More constraints than unknowns.
pub(crate) fn too_many(constraint: Span, place: &str) -> Diagnostic {
    Diagnostic::error(
        CODE,
        constraint,
        format!("this constraint determines nothing{place}: every quantity in it is defined already"),
    )
    .note("a constraint between states whose derivatives are all given is a system of higher index")
    .help("delete one of the equations that define these quantities, or the constraint")
}

/// A constraint that determines something only when it is differentiated.
pub(crate) fn higher_index(constraint: Span, place: &str) -> Diagnostic {
    Diagnostic::warning(
        CODE,
        constraint,
        format!(
            "this constraint determines nothing{place} before it is differentiated: the index is 2 or more"
        ),
    )
    .note("all that it reads has a derivative or an equation of its own")
    .help("differentiate it by hand until an unknown appears, or choose states that it leaves free")
}
