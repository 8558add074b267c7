//! A quantity has two definitions, which can hardly both hold: two equations of a state in one location, two maps
//! of an output, two resets of a state in one transition, two initial values, two units.

use sophy_diagnostics::{Code, Diagnostic, Span};

pub(crate) const CODE: Code = Code("HS0108");

/// `what` was given at `first`, and again at `again`.
pub(crate) fn diagnostic(what: &str, first: Span, again: Span) -> Diagnostic {
    if first == again {
        return Diagnostic::error(CODE, again, format!("{what} is given again by each turn of the loop"))
            .help("write it outside of the loop, or with an index");
    }
    Diagnostic::error(CODE, again, format!("{what} is given twice"))
        .label(first, "first here")
        .help("delete one of the two")
}

#[cfg(test)]
mod tests {
    use crate::testing::check;

    #[test]
    fn everything_has_one_definition() {
        check(
            "state x
             output y
             initial x = 1
             initial x = 2
             location A
               der x = 1
               der x = 2
               out y = x
               out y = 2*x
               transition t when x > 1 goto A
                 reset x = 0
                 reset x = 1",
            "error[HS0108] line 4 `x`: the initial value of `x` is given twice
               line 3 `x`: first here
               help: delete one of the two
             error[HS0108] line 7 `x`: `der(x)` in location `A` is given twice
               line 6 `x`: first here
               help: delete one of the two
             error[HS0108] line 9 `y`: output `y` in location `A` is given twice
               line 8 `y`: first here
               help: delete one of the two
             error[HS0108] line 12 `x`: the reset of `x` in transition `t` is given twice
               line 11 `x`: first here
               help: delete one of the two",
        );
    }
}
