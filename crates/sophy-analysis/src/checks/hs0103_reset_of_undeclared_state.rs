//! A transition resets something that is not a state: what was meant keeps its value.

use super::places::{further_places, grouped};
use super::suggestion::suggest;
use crate::declarations::Declarations;
use crate::lower::Strays;
use crate::names::{Kind, Names};
use sophy_diagnostics::{Code, Diagnostic, Diagnostics, Span};

pub(crate) const CODE: Code = Code("HS0103");

/// One message per name. States without an equation in the location are the likelier ones.
pub(crate) fn find(
    declarations: &Declarations,
    strays: &Strays<'_>,
    names: &Names<'_>,
    diagnostics: &mut Diagnostics,
) {
    let named =
        strays.resets.iter().map(|(location, r)| (r.target.value.as_str(), (*location, r.target.span)));
    for (name, places) in grouped(named.filter(|(name, _)| !name.is_empty())) {
        let written = &declarations.locations[places[0].0].dynamics;
        let has_equation = |state: &&str| written.iter().any(|e| e.target.value == **state);
        let (with, without): (Vec<&str>, Vec<&str>) = names.of_kind(Kind::State).partition(has_equation);
        let candidates: Vec<&str> = without.into_iter().chain(with).collect();
        let spans: Vec<Span> = places.iter().map(|&(_, span)| span).collect();
        diagnostics.push(diagnostic(name, &spans, names, &candidates));
    }
}

fn diagnostic(name: &str, spans: &[Span], names: &Names<'_>, candidates: &[&str]) -> Diagnostic {
    if let Some(symbol) = names.symbol(name) {
        let message = format!("`{name}` is {}, and only states can be reset", symbol.kind.with_article());
        let error = Diagnostic::error(CODE, spans[0], message).label(symbol.span, "declared here");
        return further_places(error, &spans[1..])
            .help(format!("declare `{name}` as a state, or delete the reset"));
    }
    let message = format!("`{name}` is reset, but is not declared as a state");
    further_places(Diagnostic::error(CODE, spans[0], message), &spans[1..])
        .help(suggest(name, candidates, "states").help)
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
