//! A location defines something that is not declared as an output: nothing outside can see it.

use super::places::{further_places, grouped};
use super::suggestion::suggest;
use crate::declarations::Declarations;
use crate::lower::Strays;
use crate::names::Names;
use sophy_diagnostics::{Code, Diagnostic, Diagnostics, Span};

pub(crate) const CODE: Code = Code("HS0104");

/// One message per name; returns the outputs that were meant, with the position of the location.
pub(crate) fn find(
    declarations: &Declarations,
    strays: &Strays<'_>,
    names: &Names<'_>,
    diagnostics: &mut Diagnostics,
) -> Vec<(usize, String)> {
    let mut all_meant = Vec::new();
    let named = strays.maps.iter().map(|(location, e)| (e.target.value.as_str(), (*location, e.target.span)));
    for (name, places) in grouped(named.filter(|(name, _)| !name.is_empty())) {
        let written = &declarations.locations[places[0].0].outputs;
        let has_map = |output: &&str| written.iter().any(|e| e.target.value == **output);
        let outputs = declarations.outputs.iter().map(|output| output.name.value.as_str());
        let (with, without): (Vec<&str>, Vec<&str>) = outputs.partition(has_map);
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
        let message = format!("`{name}` is {}, not an output", symbol.kind.with_article());
        let error = Diagnostic::error(CODE, spans[0], message).label(symbol.span, "declared here");
        let error = further_places(error, &spans[1..]);
        return (error.help(format!("declare `{name}` as an output too, or delete the map")), None);
    }
    let suggestion = suggest(name, candidates, "outputs");
    let message = format!("`{name}` is defined, but is not declared as an output");
    let error = further_places(Diagnostic::error(CODE, spans[0], message), &spans[1..]);
    (error.help(suggestion.help), suggestion.meant)
}

#[cfg(test)]
mod tests {
    use crate::testing::check;

    #[test]
    fn a_map_needs_an_output() {
        check(
            "state x
             output Voltage
             location A
               der x = 1
               out V = x
               out x = x",
            "error[HS0104] line 5 `V`: `V` is defined, but is not declared as an output
               help: did you mean `Voltage`?
             error[HS0104] line 6 `x`: `x` is a state, not an output
               line 1 `x`: declared here
               help: declare `x` as an output too, or delete the map",
        );
    }
}
