//! An equation states the derivative of something that is not a state: the equation has no effect, and the state
//! that was meant has none.

use super::places::{further_places, grouped};
use super::suggestion::suggest;
use crate::declarations::Declarations;
use crate::lower::Strays;
use crate::names::{Kind, Names};
use sophy_diagnostics::{Code, Diagnostic, Diagnostics, Span};

pub(crate) const CODE: Code = Code("HS0102");

/// One message per name; returns the states that were meant, with the position of the location.
pub(crate) fn find(
    declarations: &Declarations,
    strays: &Strays<'_>,
    names: &Names<'_>,
    diagnostics: &mut Diagnostics,
) -> Vec<(usize, String)> {
    let mut all_meant = Vec::new();
    let named =
        strays.equations.iter().map(|(location, e)| (e.target.value.as_str(), (*location, e.target.span)));
    for (name, places) in grouped(named.filter(|(name, _)| !name.is_empty())) {
        let written = &declarations.locations[places[0].0].dynamics;
        let has_equation = |state: &&str| written.iter().any(|e| e.target.value == **state);
        let (with, without): (Vec<&str>, Vec<&str>) = names.of_kind(Kind::State).partition(has_equation);
        let candidates: Vec<&str> = without.into_iter().chain(with).collect();
        let spans: Vec<Span> = places.iter().map(|&(_, span)| span).collect();
        let (diagnostic, meant) = diagnostic(name, &spans, names, &candidates);
        all_meant
            .extend(meant.iter().flat_map(|meant| places.iter().map(|&(l, _)| (l, (*meant).to_owned()))));
        diagnostics.push(diagnostic);
    }
    all_meant
}

fn diagnostic<'n>(
    name: &str,
    spans: &[Span],
    names: &Names<'_>,
    candidates: &[&'n str],
) -> (Diagnostic, Option<&'n str>) {
    if let Some(symbol) = names.symbol(name) {
        let message = format!("`{name}` is {}, and only states have equations", symbol.kind.with_article());
        let error = Diagnostic::error(CODE, spans[0], message).label(symbol.span, "declared here");
        let error = further_places(error, &spans[1..]);
        return (error.help(format!("declare `{name}` as a state, or delete the equation")), None);
    }
    let suggestion = suggest(name, candidates, "states");
    let message = format!("`{name}` has an equation, but is not declared as a state");
    let error = further_places(Diagnostic::error(CODE, spans[0], message), &spans[1..]);
    (error.help(suggestion.help), suggestion.meant)
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
