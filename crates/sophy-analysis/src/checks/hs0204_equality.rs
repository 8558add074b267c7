//! `=` or `<>` between quantities that vary continuously. Two such quantities are equal for an instant at most, and
//! in floating-point arithmetic not even then: the condition would be a matter of luck.

use sophy_diagnostics::{Code, Diagnostic, Span};
use sophy_ir::Comparison;

pub(crate) const CODE: Code = Code("HS0204");

/// `left operator right`, as written.
pub(crate) fn diagnostic(span: Span, operator: Comparison, left: &str, right: &str) -> Diagnostic {
    let side = if operator == Comparison::Equal { "<" } else { ">" };
    let symbol = operator.symbol();
    let message = format!("`{left} {symbol} {right}` asks for equality of what varies continuously");
    Diagnostic::error(CODE, span, message)
        .help("for the instant of a crossing compare with `<` or `>`")
        .help(format!("for values that change only at transitions write `abs({left} - {right}) {side} 0.5`"))
}

#[cfg(test)]
mod tests {
    use crate::testing::check;

    #[test]
    fn continuous_quantities_are_not_compared_for_equality() {
        check(
            "constant k = 2
             state x
             location A
               der x = if k = 2 then 1 else 2
               transition t when x = k goto A
               transition u when (x > 1) = (x > 2) goto A
                 reset x = 0",
            "error[HS0204] line 5 `=`: `x = k` asks for equality of what varies continuously
               help: for the instant of a crossing compare with `<` or `>`
               help: for values that change only at transitions write `abs(x - k) < 0.5`",
        );
    }

    #[test]
    fn a_function_is_judged_where_it_is_called() {
        check(
            "constant k = 2
             function zero(a) = if a = 0 then 1 else 0
             state x
             location A
               der x = zero(k) + zero(x)",
            "error[HS0204] line 5 `zero`: in this call of `zero`: `a = 0` asks for equality of what varies continuously
               line 2 `=`: here
               help: for the instant of a crossing compare with `<` or `>`
               help: for values that change only at transitions write `abs(a - 0) < 0.5`",
        );
    }
}
