//! A constant or an input is not used in any expression: it is left over, or something that should use it does
//! not.

use sophy_diagnostics::{Code, Diagnostic, Span};

pub(crate) const CODE: Code = Code("HS0118");

/// `what` is what is declared: `input`.
pub(crate) fn diagnostic(what: &str, name: &str, span: Span) -> Diagnostic {
    Diagnostic::note_at(CODE, span, format!("{what} `{name}` is not used"))
        .help("delete it, or use it where it was meant")
}

#[cfg(test)]
mod tests {
    use crate::testing::check;

    #[test]
    fn what_is_not_used_is_noted() {
        check(
            "constant G = 9.82
             constant H = 2*G
             constant K = H
             input u
             input Pin
             state x
             location A
               der x = Pn",
            "note[HS0118] line 3 `K`: constant `K` is not used
               help: delete it, or use it where it was meant
             note[HS0118] line 4 `u`: input `u` is not used
               help: delete it, or use it where it was meant
             error[HS0101] line 8 `Pn`: `Pn` is not declared
               help: did you mean `Pin`?",
        );
    }
}
