//! An output with the name of a state is that state. A map that says something else would give one name two
//! values.

use crate::declarations::EquationDeclaration;
use sophy_diagnostics::{Code, Diagnostic, Span};

pub(crate) const CODE: Code = Code("HS0111");

pub(crate) fn diagnostic(map: &EquationDeclaration, declared: Span) -> Diagnostic {
    let name = &map.target.name.value;
    let message = format!("output `{name}` has the name of a state, but another value");
    Diagnostic::error(CODE, map.right.span, message)
        .label(declared, "the state")
        .help(format!("give the output another name, or write `{name} = {name}`"))
}

#[cfg(test)]
mod tests {
    use crate::testing::check;

    #[test]
    fn one_name_has_one_value() {
        check(
            "state x
             output x
             location A
               der x = 1
               out x = 2*x",
            "error[HS0111] line 5 `2*x`: output `x` has the name of a state, but another value
               line 1 `x`: the state
               help: give the output another name, or write `x = x`",
        );
    }
}
