//! A system without a location has no equations: there is nothing to run.

use sophy_diagnostics::{Code, Diagnostic, Span};

pub(crate) const CODE: Code = Code("HS0119");

pub(crate) fn diagnostic(name: &str, span: Span) -> Diagnostic {
    Diagnostic::error(CODE, span, format!("system `{name}` has no location"))
        .help("a system that does not switch has one location, with all its equations")
}

#[cfg(test)]
mod tests {
    use crate::testing::check;

    #[test]
    fn equations_need_a_location() {
        check(
            "system Empty
             state x",
            "error[HS0119] line 1 `Empty`: system `Empty` has no location
               help: a system that does not switch has one location, with all its equations",
        );
    }
}
