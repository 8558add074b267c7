//! Constants define one another, perhaps by way of functions: none of them has a value.

use crate::lower::Definition;
use sophy_diagnostics::{Code, Diagnostic};

pub(crate) const CODE: Code = Code("HS0301");

/// Each member needs the next, the last the first.
pub(crate) fn diagnostic(members: &[&Definition<'_>]) -> Diagnostic {
    let first = members[0];
    let message = if members.len() == 1 {
        format!("constant `{}` is defined by itself", first.name.value)
    } else {
        "constants define one another".to_owned()
    };
    let mut error = Diagnostic::error(CODE, first.text.map.whole(), message);
    for member in &members[1..] {
        error = error.label(member.text.map.whole(), format!("the value of `{}`", member.name.value));
    }
    let names = members.iter().chain(&members[..1]).map(|member| format!("`{}`", member.name.value));
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
               line 5 `x + a`: the value of `f`
               note: each needs the next: `a` → `b` → `f` → `a`
               help: give one of them a value of its own
             error[HS0301] line 4 `d`: constant `d` is defined by itself
               note: each needs the next: `d` → `d`
               help: give one of them a value of its own",
        );
    }
}
