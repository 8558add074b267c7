//! A transition resets something that is not a state: what was meant keeps its value.

use super::places::{further_places, grouped};
use super::suggestion::suggest;
use crate::component::Stray;
use sophy_diagnostics::{Code, Diagnostic, Span};

pub(crate) const CODE: Code = Code("HS0103");

/// One message per name; `states` are the candidates, likelier ones first.
pub(crate) fn find(strays: &[Stray], states: &[&str]) -> Vec<Diagnostic> {
    let named = strays.iter().map(|stray| (stray.name.as_str(), stray));
    grouped(named).into_iter().map(|(name, strays)| diagnostic(name, &strays, states)).collect()
}

fn diagnostic(name: &str, strays: &[&Stray], states: &[&str]) -> Diagnostic {
    let spans: Vec<Span> = strays.iter().map(|stray| stray.span).collect();
    if let Some((kind, declared)) = strays[0].found {
        let message = format!("`{name}` is {}, and only states can be reset", kind.with_article());
        let error = Diagnostic::error(CODE, spans[0], message).label(declared, "declared here");
        return further_places(error, &spans[1..])
            .help(format!("declare `{name}` as a state, or delete the reset"));
    }
    let message = format!("`{name}` is reset, but is not declared as a state");
    further_places(Diagnostic::error(CODE, spans[0], message), &spans[1..])
        .help(suggest(name, states, "states").help)
}

#[cfg(test)]
mod tests {
    use crate::testing::check;

    #[test]
    fn only_states_can_be_reset() {
        check(
            "constant k = 1
             state Clock
             location A
               der Clock = k
               transition t when Clock > 1 goto A
                 reset Clok = 0
                 reset k = 2",
            "error[HS0103] line 6 `Clok`: `Clok` is reset, but is not declared as a state
               help: did you mean `Clock`?
             error[HS0103] line 7 `k`: `k` is a constant, and only states can be reset
               line 1 `k`: declared here
               help: declare `k` as a state, or delete the reset",
        );
    }
}
