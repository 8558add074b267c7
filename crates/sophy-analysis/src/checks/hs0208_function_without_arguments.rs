//! A function is named without being called: by itself it has no value.

use sophy_diagnostics::{Code, Diagnostic, Span};

pub(crate) const CODE: Code = Code("HS0208");

/// `usage` shows how to call it.
pub(crate) fn diagnostic(span: Span, name: &str, usage: &str) -> Diagnostic {
    Diagnostic::error(CODE, span, format!("`{name}` is a function and needs arguments"))
        .help(format!("call it as `{}`", usage.replace(" or ", "` or `")))
}

#[cfg(test)]
mod tests {
    use crate::testing::check;

    #[test]
    fn a_function_is_called() {
        check(
            "function f(a, b) = a + b
             state x
             location A
               der x = 2*sin + f",
            "error[HS0208] line 4 `sin`: `sin` is a function and needs arguments
               help: call it as `sin(x)`
             error[HS0208] line 4 `f`: `f` is a function and needs arguments
               help: call it as `f(a, b)`",
        );
    }
}
