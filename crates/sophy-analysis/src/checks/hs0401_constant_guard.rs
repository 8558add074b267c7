//! A guard does not depend on anything that changes: the transition is taken the instant its location is entered,
//! or never. `false` together with input events is a way to say that only the events count.

use crate::declarations::{Declarations, LocationDeclaration, TransitionDeclaration};
use crate::lower::LoweredLocation;
use sophy_diagnostics::{Code, Diagnostic, Diagnostics};
use sophy_ir::{Graph, Node};

pub(crate) const CODE: Code = Code("HS0401");

pub(crate) fn find(
    declarations: &Declarations,
    locations: &[LoweredLocation],
    graph: &Graph,
    diagnostics: &mut Diagnostics,
) {
    for (location, lowered) in declarations.locations.iter().zip(locations) {
        for (transition, lowered) in location.transitions.iter().zip(&lowered.transitions) {
            if let Some(Node::Boolean(value)) = lowered.guard.map(|guard| graph.node(guard)) {
                diagnostics_of(location, transition, value, diagnostics);
            }
        }
    }
}

fn diagnostics_of(
    location: &LocationDeclaration,
    transition: &TransitionDeclaration,
    value: bool,
    diagnostics: &mut Diagnostics,
) {
    let Some(guard) = &transition.guard else { return };
    let on_event_only = guard.text.trim() == "false" && !transition.input_events.is_empty();
    if on_event_only {
        return;
    }
    let (name, span) = (&transition.name.value, guard.map.whole());
    diagnostics.push(if value {
        let message = format!("the guard of `{name}` is always true");
        Diagnostic::warning(CODE, span, message)
            .note(format!("location `{}` is left the instant it is entered", location.name.value))
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
