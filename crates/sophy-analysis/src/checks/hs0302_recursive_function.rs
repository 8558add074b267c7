//! A function calls itself, directly or by way of others. Functions are put in the place of their calls, which
//! would never end.

use crate::lower::Definition;
use sophy_diagnostics::{Code, Diagnostic};

pub(crate) const CODE: Code = Code("HS0302");

/// Each member calls the next, the last the first.
pub(crate) fn diagnostic(members: &[&Definition<'_>]) -> Diagnostic {
    let first = members[0];
    let message = format!("function `{}` calls itself", first.name.value);
    let mut error = Diagnostic::error(CODE, first.text.span, message);
    for member in &members[1..] {
        error = error.label(member.text.span, format!("the body of `{}`", member.name.value));
    }
    let names = members.iter().chain(&members[..1]).map(|member| format!("`{}`", member.name.value));
    let circle: Vec<String> = names.collect();
    error
        .note(format!("each calls the next: {}", circle.join(" → ")))
        .help("a repetition is a matter of states and transitions; write the function without it")
}

#[cfg(test)]
mod tests {
    use crate::testing::check;

    #[test]
    fn the_cycle_is_printed() {
        check(
            "function f(x) = g(x) + 1
             function g(x) = h(x)*2
             function h(x) = if x < 0 then 0 else f(x - 1)
             state x
             location A
               der x = f(x)",
            "error[HS0302] line 1 `g(x) + 1`: function `f` calls itself
               line 2 `h(x)*2`: the body of `g`
               line 3 `if x < 0 then 0 else f(x - 1)`: the body of `h`
               note: each calls the next: `f` → `g` → `h` → `f`
               help: a repetition is a matter of states and transitions; write the function without it",
        );
    }
}
