//! A function is called with more or fewer arguments than it has parameters.

use sophy_diagnostics::{Code, Diagnostic, Span};

pub(crate) const CODE: Code = Code("HS0202");

/// `usage` shows how to call it.
pub(crate) fn diagnostic(
    span: Span,
    name: &str,
    given: usize,
    usage: &str,
    declared: Option<Span>,
) -> Diagnostic {
    let number = match given {
        0 => "no argument".to_owned(),
        1 => "1 argument".to_owned(),
        more => format!("{more} arguments"),
    };
    let error = Diagnostic::error(CODE, span, format!("`{name}` cannot be called with {number}"))
        .help(format!("call it as `{}`", usage.replace(" or ", "` or `")));
    match declared {
        Some(declared) => error.label(declared, "declared here"),
        None => error,
    }
}

#[cfg(test)]
mod tests {
    use crate::testing::check;

    #[test]
    fn arguments_match_parameters() {
        check(
            "function f(a, b) = a*b
             state x
             location A
               der x = f(x) + sin() + atan2(x) + min(x) + sat(x, 1)",
            "error[HS0202] line 4 `f`: `f` cannot be called with 1 argument
               line 1 `f`: declared here
               help: call it as `f(a, b)`
             error[HS0202] line 4 `sin`: `sin` cannot be called with no argument
               help: call it as `sin(x)`
             error[HS0202] line 4 `atan2`: `atan2` cannot be called with 1 argument
               help: call it as `atan2(y, x)`
             error[HS0202] line 4 `min`: `min` cannot be called with 1 argument
               help: call it as `min(a, b, …)`
             error[HS0202] line 4 `sat`: `sat` cannot be called with 2 arguments
               help: call it as `sat(x)` or `sat(x, low, high)`",
        );
    }
}
