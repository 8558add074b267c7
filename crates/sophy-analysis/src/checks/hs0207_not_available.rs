//! A quantity is used where it has no value: a constant holds before any state exists, and a function knows only
//! what it is given.

use crate::declarations::Dialect;
use crate::lower::{Place, Varies};
use sophy_diagnostics::{Code, Diagnostic, Span};

pub(crate) const CODE: Code = Code("HS0207");

/// `name` is `what`; it is used in `place`, or in a function.
pub(crate) fn diagnostic(
    span: Span,
    name: &str,
    what: &str,
    place: Option<(Place, Dialect)>,
    declared: Option<Span>,
) -> Diagnostic {
    let (where_used, help) = match place {
        None => ("a function", format!("make `{name}` a parameter, and pass it where it is called")),
        Some((place, dialect)) => (place.what, available(place, dialect).to_owned()),
    };
    let error = Diagnostic::error(CODE, span, format!("{where_used} cannot use `{name}`, which is {what}"));
    match declared {
        Some(declared) => error.label(declared, "declared here"),
        None => error,
    }
    .help(help)
}

/// The shape of something is asked for before its declaration.
pub(crate) fn too_early(span: Span, name: &str, declared: Span) -> Diagnostic {
    Diagnostic::error(CODE, span, format!("the shape of `{name}` is not known yet"))
        .label(declared, "declared here")
        .help("declare it above, or write its extents by a parameter that both use")
}

fn available(place: Place, dialect: Dialect) -> &'static str {
    match place.most {
        Varies::Never => "use numbers and constants only",
        Varies::Parameters if dialect == Dialect::Xml => "use numbers and constants only",
        Varies::Parameters => "use numbers, constants and parameters only",
        Varies::Instants => "use what changes at instants only: modes, held inputs, parameters",
        Varies::Continuously if !place.conditions => {
            "`rises`, `falls`, `changes`, `chance` and events belong into conditions and actions"
        }
        Varies::Continuously => "use another quantity",
    }
}

#[cfg(test)]
mod tests {
    use crate::testing::check;

    #[test]
    fn constants_and_functions_know_no_states() {
        check(
            "constant k = 2*x
             function f(a) = a*x + time
             state x
             initial x = x + k
             location A
               der x = f(x) + k",
            "error[HS0207] line 1 `x`: a constant cannot use `x`, which is a state
               line 3 `x`: declared here
               help: use numbers and constants only
             error[HS0207] line 2 `x`: a function cannot use `x`, which is a state
               line 3 `x`: declared here
               help: make `x` a parameter, and pass it where it is called
             error[HS0207] line 2 `time`: a function cannot use `time`, which is the simulated time
               help: make `time` a parameter, and pass it where it is called
             error[HS0207] line 4 `x`: an initial value cannot use `x`, which is a state
               line 3 `x`: declared here
               help: use numbers and constants only",
        );
    }
}
