//! A division by zero has no value: a run would stop where it is first evaluated.

use sophy_diagnostics::{Code, Diagnostic, Span};

pub(crate) const CODE: Code = Code("HS0205");

/// The divisor is the number 0 in every run.
pub(crate) fn by_number(span: Span, written: &str) -> Diagnostic {
    Diagnostic::error(CODE, span, format!("division by `{written}`, which is 0"))
        .help("divide by something that is not 0")
}

/// The divisor is a parameter whose value is 0, unless an experiment sets it.
pub(crate) fn by_parameter(span: Span, written: &str) -> Diagnostic {
    Diagnostic::warning(
        CODE,
        span,
        format!("division by `{written}`, which is 0 unless an experiment sets it"),
    )
    .help(format!("give `{written}` another value"))
}

#[cfg(test)]
mod tests {
    use crate::testing::check;

    #[test]
    fn nothing_is_divided_by_zero() {
        check(
            "constant M = 0
             state x
             location A
               der x = 1/(2 - 2) + x/M + mod(x, 0) + 0/x",
            "error[HS0205] line 4 `(2 - 2)`: division by `(2 - 2)`, which is 0
               help: divide by something that is not 0
             warning[HS0205] line 4 `M`: division by `M`, which is 0 unless an experiment sets it
               help: give `M` another value
             error[HS0205] line 4 `0`: division by `0`, which is 0
               help: divide by something that is not 0",
        );
    }
}
