//! The location in which a run is to start does not exist.

use super::suggestion::suggest;
use crate::declarations::{ComponentDeclaration, Dialect, Spanned};
use sophy_diagnostics::{Code, Diagnostic, Diagnostics};

pub(crate) const CODE: Code = Code("HS0115");

pub(crate) fn find(declarations: &ComponentDeclaration, diagnostics: &mut Diagnostics) {
    let Some(initial) = &declarations.initial_location else { return };
    let locations: Vec<&str> = declarations.locations.iter().map(|l| l.name.value.as_str()).collect();
    // A file of SOPHY XML without any location is told so.
    if declarations.dialect == Dialect::Xml && locations.is_empty() {
        return;
    }
    if !initial.value.is_empty() && !locations.contains(&initial.value.as_str()) {
        diagnostics.push(diagnostic(initial, &locations));
    }
}

fn diagnostic(initial: &Spanned<String>, locations: &[&str]) -> Diagnostic {
    let name = &initial.value;
    Diagnostic::error(CODE, initial.span, format!("there is no location `{name}` to start in"))
        .help(suggest(name, locations, "locations").help)
}

#[cfg(test)]
mod tests {
    use crate::testing::check;

    #[test]
    fn a_run_starts_in_a_location() {
        check(
            "state x
             start Fligt
             location Flight
               der x = 1",
            "error[HS0115] line 2 `Fligt`: there is no location `Fligt` to start in
               help: did you mean `Flight`?",
        );
    }
}
