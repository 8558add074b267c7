//! Outputs of a location define one another: to compute one of them, all must be known already.

use crate::declarations::EquationDeclaration;
use sophy_diagnostics::{Code, Diagnostic};

pub(crate) const CODE: Code = Code("HS0303");

/// Each equation needs the next, the last the first.
pub(crate) fn diagnostic(location: &str, members: &[&EquationDeclaration]) -> Diagnostic {
    let first = members[0];
    let message = format!("the outputs of location `{location}` form an algebraic loop");
    let mut error = Diagnostic::error(CODE, first.right.map.whole(), message);
    for member in &members[1..] {
        error = error.label(member.right.map.whole(), format!("defines `{}`", member.target.value));
    }
    for (position, member) in members.iter().enumerate() {
        let needed = members[(position + 1) % members.len()];
        let (name, needed) = (&member.target.value, &needed.target.value);
        error = error.note(format!("{name} = {}   needs `{needed}`", member.right.text));
    }
    error.help("solve the equations by hand, or make one of the quantities a state")
}

#[cfg(test)]
mod tests {
    use crate::testing::check;

    #[test]
    fn the_loop_is_printed_equation_by_equation() {
        check(
            "state x
             output V
             output I
             output P
             location A
               der x = P
               out P = V*I
               out V = 24 - 2*I
               out I = x/V",
            "error[HS0303] line 8 `24 - 2*I`: the outputs of location `A` form an algebraic loop
               line 9 `x/V`: defines `I`
               note: V = 24 - 2*I   needs `I`
               note: I = x/V   needs `V`
               help: solve the equations by hand, or make one of the quantities a state",
        );
    }
}
