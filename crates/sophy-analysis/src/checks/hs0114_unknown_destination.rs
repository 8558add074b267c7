//! A transition leads to a location that does not exist: taking it, the system would be nowhere.

use super::places::{further_places, grouped};
use super::suggestion::suggest;
use crate::declarations::ComponentDeclaration;
use sophy_diagnostics::{Code, Diagnostic, Diagnostics, Span};

pub(crate) const CODE: Code = Code("HS0114");

/// One message per name.
pub(crate) fn find(declarations: &ComponentDeclaration, diagnostics: &mut Diagnostics) {
    let locations: Vec<&str> = declarations.locations.iter().map(|l| l.name.value.as_str()).collect();
    let destinations = declarations.locations.iter().flat_map(|l| &l.transitions).map(|t| &t.destination);
    let unknown = destinations.filter(|destination| {
        !destination.value.is_empty() && !locations.contains(&destination.value.as_str())
    });
    for (name, spans) in grouped(unknown.map(|destination| (destination.value.as_str(), destination.span))) {
        diagnostics.push(diagnostic(name, &spans, &locations));
    }
}

fn diagnostic(name: &str, spans: &[Span], locations: &[&str]) -> Diagnostic {
    let error = Diagnostic::error(CODE, spans[0], format!("there is no location `{name}`"));
    further_places(error, &spans[1..]).help(suggest(name, locations, "locations").help)
}

#[cfg(test)]
mod tests {
    use crate::testing::check;

    #[test]
    fn a_destination_is_a_location() {
        check(
            "state x
             location Nominal
               der x = 1
               transition a when x > 1 goto Charge
               transition b when x > 2 goto Payload
             location Payload
               der x = 2
               transition a when x > 1 goto Charge
               transition b when x > 3 goto Nominl",
            "error[HS0114] line 4 `Charge`: there is no location `Charge`
               line 8 `Charge`: also here
               help: declare it, or use one of the locations: `Nominal`, `Payload`
             error[HS0114] line 9 `Nominl`: there is no location `Nominl`
               help: did you mean `Nominal`?",
        );
    }
}
