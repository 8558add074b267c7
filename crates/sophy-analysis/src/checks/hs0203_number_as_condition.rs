//! A number stands where something must be true or false. Sophy does not guess which numbers are meant to be true.
//! (The other way round is allowed: a condition used as a number is 1 or 0.)

use sophy_diagnostics::{Code, Diagnostic, Span};

pub(crate) const CODE: Code = Code("HS0203");

/// `number` is the value, if it is known.
pub(crate) fn diagnostic(span: Span, written: &str, number: Option<f64>) -> Diagnostic {
    let help = match number {
        Some(0.0) => "write `false`".to_owned(),
        Some(_) => "write `true`".to_owned(),
        None => format!("compare it with something, for example `{written} > 0`"),
    };
    Diagnostic::error(CODE, span, format!("`{written}` is a number, but a condition is needed here"))
        .help(help)
}

#[cfg(test)]
mod tests {
    use crate::testing::check;

    #[test]
    fn a_condition_is_true_or_false() {
        check(
            "state x
             location A
               der x = if x then 1 else (x > 0) + 1
               transition t when x > 0 and x goto A
               transition u when 0 goto A",
            "error[HS0203] line 3 `x`: `x` is a number, but a condition is needed here
               help: compare it with something, for example `x > 0`
             error[HS0203] line 4 `x`: `x` is a number, but a condition is needed here
               help: compare it with something, for example `x > 0`
             error[HS0203] line 5 `0`: `0` is a number, but a condition is needed here
               help: write `false`",
        );
    }
}
