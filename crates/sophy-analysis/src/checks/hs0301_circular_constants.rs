//! Constants define one another, perhaps by way of functions: none of them has a value.

use crate::declarations::{Dialect, ExpressionText, ParameterDeclaration, Spanned};
use sophy_diagnostics::{Code, Diagnostic};

pub(crate) const CODE: Code = Code("HS0301");

/// Each member needs the next, the last the first.
pub(crate) fn parameters(members: &[&ParameterDeclaration], dialect: Dialect) -> Diagnostic {
    let members: Vec<(&Spanned<String>, &ExpressionText)> =
        members.iter().map(|member| (&member.name, &member.value)).collect();
    diagnostic(&members, if dialect == Dialect::Xml { "constant" } else { "parameter" })
}

/// Members are constants, or functions that constants call.
pub(crate) fn diagnostic(members: &[(&Spanned<String>, &ExpressionText)], what: &str) -> Diagnostic {
    let (name, text) = members[0];
    let message = if members.len() == 1 {
        format!("{what} `{}` is defined by itself", name.value)
    } else {
        format!("{what}s define one another")
    };
    let mut error = Diagnostic::error(CODE, text.span, message);
    for (name, text) in &members[1..] {
        error = error.label(text.span, format!("the value of `{}`", name.value));
    }
    let names = members.iter().chain(&members[..1]).map(|(name, _)| format!("`{}`", name.value));
    let circle: Vec<String> = names.collect();
    error
        .note(format!("each needs the next: {}", circle.join(" → ")))
        .help("give one of them a value of its own")
}

#[cfg(test)]
mod tests {
    use crate::testing::check;

    #[test]
    fn the_cycle_is_printed() {
        check(
            "constant a = 2*b
             constant b = f(1)
             constant c = a + 1
             constant d = d
             function f(x) = x + a
             state x
             location A
               der x = a + b + c + d",
            "error[HS0301] line 1 `2*b`: constants define one another
               line 2 `f(1)`: the value of `b`
               note: each needs the next: `a` → `b` → `a`
               help: give one of them a value of its own
             error[HS0301] line 4 `d`: constant `d` is defined by itself
               note: each needs the next: `d` → `d`
               help: give one of them a value of its own",
        );
    }
}
