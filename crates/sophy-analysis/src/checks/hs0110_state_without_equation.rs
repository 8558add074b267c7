//! A state has no equation in a location: it keeps its value there, which may not be what was meant. If no
//! location has one, the equation was forgotten, and the model is refused.

use sophy_diagnostics::{Code, Diagnostic, Span};

pub(crate) const CODE: Code = Code("HS0110");

/// Other locations have an equation for it.
pub(crate) fn diagnostic(state: &str, declared: Span, location: &str, location_span: Span) -> Diagnostic {
    let message = format!("state `{state}` has no equation in location `{location}`");
    Diagnostic::warning(CODE, location_span, message)
        .label(declared, "declared here")
        .note("it keeps its value while the system is in this location")
        .help(format!("if that is meant, say so: `der({state}) = 0`"))
}

/// No location, or the only one, has an equation for it.
pub(crate) fn nowhere(state: &str, declared: Span, has_locations: bool) -> Diagnostic {
    let place = if has_locations { " in any location" } else { "" };
    let otherwise = if has_locations {
        format!("if it changes only at transitions, `der({state}) = 0`")
    } else {
        "if it changes only at events, declare it as a mode".to_owned()
    };
    Diagnostic::error(CODE, declared, format!("state `{state}` has no equation{place}"))
        .help(format!("add `der({state}) = …`; {otherwise}"))
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
        assert_eq!(crate::testing::automaton(&model).locations[1].dynamics.len(), 1);
        assert_eq!(model.root().variables[1].kind, VariableKind::State(None));
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
