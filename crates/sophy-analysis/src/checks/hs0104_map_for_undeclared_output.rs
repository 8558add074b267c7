//! A location defines something that is not declared as an output: nothing outside can see it.

use super::places::{further_places, grouped};
use super::suggestion::suggest;
use crate::component::Stray;
use sophy_diagnostics::{Code, Diagnostic, Span};

pub(crate) const CODE: Code = Code("HS0104");

/// One message per name, with the output that was meant; `outputs` are the candidates, likelier ones first, and
/// `what` they are.
pub(crate) fn find(strays: &[Stray], outputs: &[&str], what: &str) -> Vec<(Diagnostic, Option<String>)> {
    let named = strays.iter().map(|stray| (stray.name.as_str(), stray));
    grouped(named).into_iter().map(|(name, strays)| diagnostic(name, &strays, outputs, what)).collect()
}

fn diagnostic(name: &str, strays: &[&Stray], outputs: &[&str], what: &str) -> (Diagnostic, Option<String>) {
    let spans: Vec<Span> = strays.iter().map(|stray| stray.span).collect();
    if let Some((kind, declared)) = strays[0].found {
        let message = format!("`{name}` is {}, not an output", kind.with_article());
        let error = Diagnostic::error(CODE, spans[0], message).label(declared, "declared here");
        let error = further_places(error, &spans[1..]);
        return (error.help(format!("declare `{name}` as an output too, or delete the map")), None);
    }
    let suggestion = suggest(name, outputs, &format!("{what}s"));
    let article = if what.starts_with('o') { "an" } else { "a" };
    let message = format!("`{name}` is defined, but is not declared as {article} {what}");
    let error = further_places(Diagnostic::error(CODE, spans[0], message), &spans[1..]);
    (error.help(suggestion.help), suggestion.meant.map(str::to_owned))
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
