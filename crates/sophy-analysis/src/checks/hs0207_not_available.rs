//! A quantity is used where it has no value: a constant holds before any state exists, and a function knows only
//! what it is given.

use crate::lower::Scope;
use sophy_diagnostics::{Code, Diagnostic, Span};

pub(crate) const CODE: Code = Code("HS0207");

/// `name` is `what`; `scope` is where it is used.
pub(crate) fn diagnostic(
    span: Span,
    name: &str,
    what: &str,
    scope: Scope<'_>,
    declared: Option<Span>,
) -> Diagnostic {
    let (place, help) = match scope {
        Scope::Function { .. } => {
            ("a function", format!("make `{name}` a parameter, and pass it where it is called"))
        }
        Scope::Constants { what } => (what, "use numbers and constants only".to_owned()),
        Scope::Location { .. } => ("this expression", "use another quantity".to_owned()),
    };
    let error =
        Diagnostic::error(CODE, span, format!("{place} cannot use `{name}`, which is {what}")).help(help);
    match declared {
        Some(declared) => error.label(declared, "declared here"),
        None => error,
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
