//! Outputs and locals define one another: to compute one of them, all must be known already.

use crate::component::Definition;
use sophy_diagnostics::{Code, Diagnostic, Span};

pub(crate) const CODE: Code = Code("HS0303");

/// Each equation needs the next, the last the first; `texts` are the right-hand sides. There is one at least.
pub(crate) fn diagnostic(place: &str, members: &[(String, Definition)], texts: &[String]) -> Diagnostic {
    let names: Vec<&str> = members.iter().map(|(name, _)| name.as_str()).collect();
    let message = if names.len() == 1 {
        format!("`{}` is defined by itself{place}", names[0])
    } else {
        format!("these equations form an algebraic loop{place}")
    };
    let mut error = Diagnostic::error(CODE, members[0].1.span, message);
    for (name, definition) in &members[1..] {
        error = error.label(definition.span, format!("defines `{name}`"));
    }
    for (position, name) in names.iter().enumerate() {
        let needed = names[(position + 1) % names.len()];
        let text = texts.get(position).map_or("…", String::as_str);
        error = error.note(format!("{name} = {text}   needs `{needed}`"));
    }
    error.help("solve the equations by hand, or make one of the quantities a state")
}

/// The same of the assignments of an `initial` section.
pub(crate) fn initial(members: &[(String, Option<Span>)], component: Span) -> Diagnostic {
    let spans: Vec<Span> = members.iter().map(|(_, span)| span.unwrap_or(component)).collect();
    let mut error = Diagnostic::error(CODE, spans[0], "these initial values need one another");
    for ((name, _), span) in members.iter().zip(&spans).skip(1) {
        error = error.label(*span, format!("the initial value of `{name}`"));
    }
    error.help("give one of them a value that does not depend on the others")
}

/// The same across components, after they were put together: full names, right-hand sides and places.
pub fn across_components(equations: &[(String, String, Option<Span>)], fallback: Span) -> Diagnostic {
    let place = |k: usize| equations.get(k).and_then(|(_, _, span)| *span);
    let mut error =
        Diagnostic::error(CODE, place(0).unwrap_or(fallback), "the composition has an algebraic loop");
    for (k, (name, ..)) in equations.iter().enumerate().skip(1) {
        if let Some(span) = place(k) {
            error = error.label(span, format!("defines `{name}`"));
        }
    }
    for (k, (name, text, _)) in equations.iter().enumerate() {
        let needed = &equations[(k + 1) % equations.len()].0;
        error = error.note(format!("{name} = {text}   needs `{needed}`"));
    }
    error.help("make one of the quantities a state of its component (every real device has a lag), or solve the equations in one component")
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
            "error[HS0303] line 8 `24 - 2*I`: these equations form an algebraic loop in location `A`
               line 9 `x/V`: defines `I`
               note: V = 24 - 2*I   needs `I`
               note: I = x/V   needs `V`
               help: solve the equations by hand, or make one of the quantities a state",
        );
    }
}
