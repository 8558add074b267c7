//! Something is called that is not a function: a misspelling, a function of another language, or a product whose
//! `*` was forgotten.

use super::places::{further_places, grouped};
use super::suggestion::suggest;
use crate::findings::UnknownName;
use crate::predefined::Predefined;
use sophy_diagnostics::{Code, Diagnostic, Span};

pub(crate) const CODE: Code = Code("HS0201");

/// One message per name.
pub(crate) fn find(unknown_names: &[UnknownName]) -> Vec<Diagnostic> {
    let called = unknown_names.iter().filter(|unknown| unknown.called);
    let groups = grouped(called.map(|unknown| (unknown.name.as_str(), unknown))).into_iter();
    groups
        .map(|(name, uses)| {
            let spans: Vec<Span> = uses.iter().map(|unknown| unknown.span).collect();
            let functions = uses.iter().take(1).flat_map(|unknown| &unknown.candidates);
            let functions: Vec<&str> = functions.map(String::as_str).collect();
            diagnostic(name, &spans, &functions)
        })
        .collect()
}

fn diagnostic(name: &str, spans: &[Span], functions: &[&str]) -> Diagnostic {
    let error = Diagnostic::error(CODE, spans[0], format!("there is no function `{name}`"));
    further_places(error, &spans[1..]).help(match Predefined::called_elsewhere(name) {
        Some(here) => format!("it is called `{here}` here"),
        None => suggest(name, functions, "functions").help,
    })
}

/// `name` is `what`, but is called.
pub(crate) fn not_a_function(span: Span, name: &str, what: &str, declared: Option<Span>) -> Diagnostic {
    let error = Diagnostic::error(CODE, span, format!("`{name}` is {what}, not a function"))
        .help(format!("for a product write `{name} * (…)`"));
    match declared {
        Some(declared) => error.label(declared, "declared here"),
        None => error,
    }
}

/// What combines the values of a loop is `sum`, `min`, `max`, `all` or `any`.
pub(crate) fn not_a_reduction(span: Span, name: &str) -> Diagnostic {
    let reductions = ["sum", "min", "max", "all", "any"];
    Diagnostic::error(CODE, span, format!("`{name}` cannot combine the values of a loop"))
        .help(suggest(name, &reductions, "functions that can").help)
}

#[cfg(test)]
mod tests {
    use crate::testing::check;

    #[test]
    fn functions_are_known_by_name() {
        check(
            "state x
             location A
               der x = sgn(x) + sgn(2) + x(1 + x) + sinus(x)",
            "error[HS0201] line 3 `sgn`: there is no function `sgn`
               line 3 `sgn`: also here
               help: it is called `sign` here
             error[HS0201] line 3 `x`: `x` is a state, not a function
               line 1 `x`: declared here
               help: for a product write `x * (…)`
             error[HS0201] line 3 `sinus`: there is no function `sinus`
               help: did you mean `sin`?",
        );
    }
}
