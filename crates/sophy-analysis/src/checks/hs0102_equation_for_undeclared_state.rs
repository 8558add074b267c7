//! An equation states the derivative of something that is not a state: the equation has no effect, and the state
//! that was meant has none.

use super::places::{further_places, grouped};
use super::suggestion::suggest;
use crate::component::Stray;
use sophy_diagnostics::{Code, Diagnostic, Span};

pub(crate) const CODE: Code = Code("HS0102");

/// One message per name, with the state that was meant; `states` are the candidates, likelier ones first.
pub(crate) fn find(strays: &[Stray], states: &[&str]) -> Vec<(Diagnostic, Option<String>)> {
    let named = strays.iter().map(|stray| (stray.name.as_str(), stray));
    grouped(named).into_iter().map(|(name, strays)| diagnostic(name, &strays, states)).collect()
}

fn diagnostic(name: &str, strays: &[&Stray], states: &[&str]) -> (Diagnostic, Option<String>) {
    let spans: Vec<Span> = strays.iter().map(|stray| stray.span).collect();
    if let Some((kind, declared)) = strays[0].found {
        let message = format!("`{name}` is {}, and only states have equations", kind.with_article());
        let error = Diagnostic::error(CODE, spans[0], message).label(declared, "declared here");
        let error = further_places(error, &spans[1..]);
        return (error.help(format!("declare `{name}` as a state, or delete the equation")), None);
    }
    let suggestion = suggest(name, states, "states");
    let message = format!("`{name}` has an equation, but is not declared as a state");
    let error = further_places(Diagnostic::error(CODE, spans[0], message), &spans[1..]);
    (error.help(suggestion.help), suggestion.meant.map(str::to_owned))
}

#[cfg(test)]
mod tests {
    use crate::testing::check;

    #[test]
    fn a_state_without_an_equation_is_suggested_and_not_reported_again() {
        check(
            "state Capacity
             state ChargeMode
             location A
               der M = 0
               der C = 1
               transition t when Capacity > 1 goto B
             location B
               der M = 0
               der C = 2",
            "error[HS0102] line 4 `M`: `M` has an equation, but is not declared as a state
               line 8 `M`: also here
               help: did you mean `ChargeMode`?
             error[HS0102] line 5 `C`: `C` has an equation, but is not declared as a state
               line 9 `C`: also here
               help: did you mean `Capacity`?",
        );
    }

    #[test]
    fn an_input_has_no_equation() {
        check(
            "state x
             input u
             location A
               der x = u
               der u = 0",
            "error[HS0102] line 5 `u`: `u` is an input, and only states have equations
               line 2 `u`: declared here
               help: declare `u` as a state, or delete the equation",
        );
    }
}
