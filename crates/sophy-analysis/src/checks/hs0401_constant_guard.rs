//! A guard does not depend on anything that changes: the transition is taken the instant its location is entered,
//! or never. `false` together with input events is a way to say that only the events count.

use crate::component::{BuiltLocation, BuiltTransition};
use crate::declarations::TriggerDeclaration;
use sophy_diagnostics::{Code, Diagnostic, Diagnostics, Span};
use sophy_ir::{Graph, Node};

pub(crate) const CODE: Code = Code("HS0401");

pub(crate) fn find(locations: &[BuiltLocation<'_>], graph: &Graph, diagnostics: &mut Diagnostics) {
    for location in locations {
        for transition in &location.transitions {
            let without = location.declaration.is_some_and(|l| l.invariant.is_none());
            if let (TriggerDeclaration::Invariant(span, _), true) = (&transition.declaration.trigger, without)
            {
                diagnostics.push(without_invariant(&transition.declaration.name.value, *span));
            }
            if let Some(Node::Boolean(value)) = transition.guard.map(|guard| graph.node(guard)) {
                let name = location.declaration.map_or("", |l| l.name.value.as_str());
                diagnostics_of(name, transition, value, diagnostics);
            }
        }
    }
}

fn without_invariant(transition: &str, span: Span) -> Diagnostic {
    Diagnostic::warning(CODE, span, format!("`{transition}` is never taken: its location has no invariant"))
        .help("write `invariant CONDITION;` in the location, or `when CONDITION` in place of `on invariant`")
}

fn diagnostics_of(
    location: &str,
    transition: &BuiltTransition<'_>,
    value: bool,
    diagnostics: &mut Diagnostics,
) {
    let transition = transition.declaration;
    let (guard, by_event) = match &transition.trigger {
        TriggerDeclaration::When(Some(guard)) => (guard, false),
        TriggerDeclaration::WhenOrOn(Some(guard), events) => (guard, !events.is_empty()),
        _ => return,
    };
    let written = guard.expression.as_ref().and_then(|e| guard.text.get(e.range()));
    if written.map(str::trim) == Some("false") && by_event {
        return;
    }
    let (name, span) = (&transition.name.value, guard.span);
    diagnostics.push(if value {
        let message = format!("the guard of `{name}` is always true");
        Diagnostic::warning(CODE, span, message)
            .note(format!("location `{location}` is left the instant it is entered"))
            .help("say on which state, input or time the guard depends")
    } else {
        let message = format!("the guard of `{name}` is never true");
        Diagnostic::warning(CODE, span, message)
            .help("say on which state, input or time the guard depends, or delete the transition")
    });
}

#[cfg(test)]
mod tests {
    use crate::testing::check;

    #[test]
    fn a_guard_depends_on_something() {
        check(
            "state x
             location A
               der x = 1
               transition a when true goto B
               transition b when 1 > 2 goto B
               transition c when false goto B
                 on go
             location B
               der x = 1",
            "warning[HS0401] line 4 `true`: the guard of `a` is always true
               note: location `A` is left the instant it is entered
               help: say on which state, input or time the guard depends
             warning[HS0401] line 5 `1 > 2`: the guard of `b` is never true
               help: say on which state, input or time the guard depends, or delete the transition",
        );
    }
}
