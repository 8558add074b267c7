//! A state has no equation in a location: it keeps its value there, which may not be what was meant. If no
//! location has one, the equation was forgotten, and the model is refused.

use crate::declarations::{Declarations, LocationDeclaration};
use crate::names::{Kind, Names};
use sophy_diagnostics::{Code, Diagnostic, Diagnostics, Span};

pub(crate) const CODE: Code = Code("HS0110");

/// Looks through all states and locations. A state that a misspelt equation was meant for (`meant`, with the
/// position of the location) has been reported.
pub(crate) fn find(
    declarations: &Declarations,
    names: &Names<'_>,
    meant: &[(usize, String)],
    diagnostics: &mut Diagnostics,
) {
    if declarations.locations.is_empty() {
        return;
    }
    for state in names.of_kind(Kind::State) {
        let Some(symbol) = names.symbol(state) else { continue };
        let defines =
            |location: &LocationDeclaration| location.dynamics.iter().any(|e| e.target.value == state);
        let was_meant = |position: usize| meant.iter().any(|(l, name)| *l == position && name == state);
        if !declarations.locations.iter().any(defines) {
            if !meant.iter().any(|(_, name)| name == state) {
                diagnostics.push(nowhere(state, symbol.span));
            }
            continue;
        }
        for (position, location) in declarations.locations.iter().enumerate() {
            if !defines(location) && !was_meant(position) {
                diagnostics.push(diagnostic(state, symbol.span, location));
            }
        }
    }
}

fn diagnostic(state: &str, declared: Span, location: &LocationDeclaration) -> Diagnostic {
    let message = format!("state `{state}` has no equation in location `{}`", location.name.value);
    Diagnostic::warning(CODE, location.name.span, message)
        .label(declared, "declared here")
        .note("it keeps its value while the system is in this location")
        .help(format!("if that is meant, say so: `der({state}) = 0`"))
}

fn nowhere(state: &str, declared: Span) -> Diagnostic {
    Diagnostic::error(CODE, declared, format!("state `{state}` has no equation in any location"))
        .help(format!("add `der({state}) = …`; if it changes only at transitions, `der({state}) = 0`"))
}

#[cfg(test)]
mod tests {
    use crate::testing::{check, check_model};
    use sophy_ir::VariableKind;

    #[test]
    fn a_forgotten_equation_is_a_warning_where_another_location_has_one() {
        let model = check_model(
            "state x
             state ETA2
             location A
               der x = 1
               der ETA2 = 0
               transition t when x > 1 goto B
             location B
               der x = ETA2",
            "warning[HS0110] line 7 `B`: state `ETA2` has no equation in location `B`
               line 2 `ETA2`: declared here
               note: it keeps its value while the system is in this location
               help: if that is meant, say so: `der(ETA2) = 0`",
        );
        assert_eq!(model.components[0].locations[1].dynamics.len(), 1);
        assert_eq!(model.variables[1].kind, VariableKind::State(None));
    }

    #[test]
    fn a_state_without_any_equation_is_an_error() {
        check(
            "state x
             location A",
            "error[HS0110] line 1 `x`: state `x` has no equation in any location
               help: add `der(x) = …`; if it changes only at transitions, `der(x) = 0`",
        );
    }
}
