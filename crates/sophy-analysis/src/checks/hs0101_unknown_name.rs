//! An expression uses a name that nothing declares: usually a misspelling, or a constant that was forgotten.
//! Without a value for it nothing that depends on it can be computed.

use super::places::{further_places, grouped};
use super::suggestion::suggest;
use crate::findings::UnknownName;
use sophy_diagnostics::{Code, Diagnostic, Span};

pub(crate) const CODE: Code = Code("HS0101");

/// One message per name, however often it occurs, with the name that was suggested.
pub(crate) fn find(unknown_names: &[UnknownName]) -> Vec<(Diagnostic, Option<String>)> {
    let values = unknown_names.iter().filter(|unknown| !unknown.called);
    grouped(values.map(|unknown| (unknown.name.as_str(), unknown)))
        .into_iter()
        .map(|(name, uses)| {
            let mut candidates: Vec<&str> =
                uses.iter().flat_map(|u| &u.candidates).map(String::as_str).collect();
            candidates.extend(["true", "false"].into_iter().filter(|word| word.eq_ignore_ascii_case(name)));
            let mut seen = std::collections::HashSet::new();
            candidates.retain(|candidate| seen.insert(*candidate));
            let spans: Vec<Span> = uses.iter().map(|unknown| unknown.span).collect();
            let (diagnostic, meant) = diagnostic(name, &spans, &candidates);
            (diagnostic, meant.map(str::to_owned))
        })
        .collect()
}

fn diagnostic<'n>(name: &str, spans: &[Span], candidates: &[&'n str]) -> (Diagnostic, Option<&'n str>) {
    let suggestion = suggest(name, candidates, "names that exist");
    let error = Diagnostic::error(CODE, spans[0], format!("`{name}` is not declared"));
    (further_places(error, &spans[1..]).help(suggestion.help), suggestion.meant)
}

#[cfg(test)]
mod tests {
    use crate::testing::check;

    #[test]
    fn a_misspelt_name_is_reported_once_with_its_places() {
        check(
            "state Capacity
             input Pin
             location A
               der Capacity = Capcity + Capcity + Pin
               transition t when Capcity > 1 goto A
                 reset Capacity = Capcity * Capcity",
            "error[HS0101] line 4 `Capcity`: `Capcity` is not declared
               line 4 `Capcity`: also here
               line 5 `Capcity`: also here
               line 6 `Capcity`: also here
               note: and 1 more place
               help: did you mean `Capacity`?",
        );
    }

    #[test]
    fn where_nothing_is_close_the_names_that_exist_are_listed() {
        check(
            "state Position
             location A
               der Position = 1
               transition t when Position > FootHeight goto A",
            "error[HS0101] line 4 `FootHeight`: `FootHeight` is not declared
               help: declare it, or use one of the names that exist: `Position`, `pi`, `time`",
        );
    }

    #[test]
    fn names_in_an_expression_with_a_mistake_of_grammar_are_checked_too() {
        check(
            "state Capacity
             location A
               der Capacity = 1
               transition t when C > 1) goto A",
            "error[HS0101] line 4 `C`: `C` is not declared
               help: did you mean `Capacity`?",
        );
    }

    #[test]
    fn a_parameter_of_the_function_may_be_meant() {
        check(
            "function f(width) = widht * 2
             state x
             location A
               der x = f(x)",
            "error[HS0101] line 1 `widht`: `widht` is not declared
               help: did you mean `width`?",
        );
    }

    #[test]
    fn true_in_capitals_is_true() {
        check(
            "state x
             location A
               der x = 1
               transition t when True goto A",
            "error[HS0101] line 4 `True`: `True` is not declared
               help: did you mean `true`?",
        );
    }
}
