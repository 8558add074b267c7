//! A number or text stands where a condition is needed. `if x` might mean `x > 0` or `x <> 0`, and the two differ.

use sophy_diagnostics::{Code, Diagnostic, Span};

pub(crate) const CODE: Code = Code("HS0203");

/// `written` is a text, or a number with a value if that is known.
pub(crate) fn diagnostic(span: Span, written: &str, number: Option<f64>, text: bool) -> Diagnostic {
    let what = if text { "text" } else { "number" };
    let help = match number {
        _ if text => format!("compare it with a text, for example `{written} = \"…\"`"),
        Some(0.0) => "write `false`".to_owned(),
        Some(_) => "write `true`".to_owned(),
        None => format!("compare it with something, for example `{written} > 0`"),
    };
    Diagnostic::error(CODE, span, format!("`{written}` is a {what}, but a condition is needed here"))
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
