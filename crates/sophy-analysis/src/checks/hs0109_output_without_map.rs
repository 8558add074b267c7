//! An output is not defined in a location: while the system is there, it would have no value.

use super::places::further_places;
use sophy_diagnostics::{Code, Diagnostic, Span};

pub(crate) const CODE: Code = Code("HS0109");

/// `lacking` are the locations that do not define the output; there is one at least.
pub(crate) fn diagnostic(output: &str, declared: Span, lacking: &[(&str, Span)]) -> Diagnostic {
    let spans: Vec<Span> = lacking.iter().map(|&(_, span)| span).collect();
    let message = format!("output `{output}` is not defined in location `{}`", lacking[0].0);
    let error = Diagnostic::error(CODE, spans[0], message).label(declared, "declared here");
    further_places(error, &spans[1..]).help(format!("add `{output} = …` to the location"))
}

#[cfg(test)]
mod tests {
    use crate::testing::check;

    #[test]
    fn an_output_needs_a_map_in_every_location() {
        check(
            "state x
             output y
             location A
               der x = y
               out y = x
               transition t when x > 1 goto B
             location B
               der x = y
               transition t when x > 1 goto C
             location C
               der x = y",
            "error[HS0109] line 7 `B`: output `y` is not defined in location `B`
               line 2 `y`: declared here
               line 10 `C`: also here
               help: add `y = …` to the location",
        );
    }

    #[test]
    fn a_misspelt_map_is_one_mistake() {
        check(
            "state x
             output Voltage
             location A
               der x = 1
               out Voltge = x",
            "error[HS0104] line 5 `Voltge`: `Voltge` is defined, but is not declared as an output
               help: did you mean `Voltage`?",
        );
    }
}
