//! No chain of transitions leads from the first location to this one. Usually a destination was mistaken, or
//! another location was to be the first.

use crate::component::BuiltLocation;
use crate::declarations::{ComponentDeclaration, Dialect, TriggerDeclaration};
use sophy_diagnostics::{Code, Diagnostic, Diagnostics, Span};
use sophy_ir::{Graph, Node};

pub(crate) const CODE: Code = Code("HS0116");

/// Follows all transitions from the first location. Says nothing while a destination is unknown: it may be the
/// missing way.
pub(crate) fn find(
    declaration: &ComponentDeclaration,
    locations: &[BuiltLocation<'_>],
    graph: &Graph,
    diagnostics: &mut Diagnostics,
) {
    let all_known = locations.iter().flat_map(|l| &l.transitions).all(|t| t.destination.is_some());
    let first = match &declaration.initial_location {
        Some(name) => declaration.locations.iter().position(|l| l.name.value == name.value),
        None => Some(0),
    };
    let (Some(first), true, false) = (first, all_known, declaration.locations.is_empty()) else { return };
    let mut reached = vec![false; locations.len()];
    let mut pending = vec![first];
    while let Some(position) = pending.pop() {
        if std::mem::replace(&mut reached[position], true) {
            continue;
        }
        for transition in &locations[position].transitions {
            let never = transition.guard.is_some_and(|guard| graph.node(guard) == Node::Boolean(false));
            let by_event = match &transition.declaration.trigger {
                TriggerDeclaration::WhenOrOn(_, events) => !events.is_empty(),
                _ => false,
            };
            if !never || by_event {
                pending.extend(transition.destination);
            }
        }
    }
    let start = &declaration.locations[first].name;
    let whole = if declaration.dialect == Dialect::Xml { "run" } else { "component" };
    for (location, _) in declaration.locations.iter().zip(reached).filter(|(_, reached)| !reached) {
        let repeated = declaration.locations.iter().filter(|l| l.name.value == location.name.value).count();
        if repeated == 1 {
            let (name, span) = (&location.name.value, location.name.span);
            diagnostics.push(diagnostic(name, span, &start.value, start.span, whole));
        }
    }
}

fn diagnostic(name: &str, span: Span, start: &str, start_span: Span, whole: &str) -> Diagnostic {
    Diagnostic::warning(CODE, span, format!("location `{name}` cannot be reached"))
        .label(start_span, format!("a {whole} starts here"))
        .note(format!("no chain of transitions leads from `{start}` to `{name}`"))
        .help("add a transition to it, or start in another location")
}

#[cfg(test)]
mod tests {
    use crate::testing::check;

    #[test]
    fn a_location_needs_a_way_into_it() {
        check(
            "state x
             start B
             location A
               der x = 1
               transition t when x > 1 goto B
             location B
               der x = 1
               transition t when x > 2 goto C
             location C
               der x = 1",
            "warning[HS0116] line 3 `A`: location `A` cannot be reached
               line 6 `B`: a run starts here
               note: no chain of transitions leads from `B` to `A`
               help: add a transition to it, or start in another location",
        );
    }

    #[test]
    fn an_event_opens_a_way_that_its_guard_does_not() {
        check(
            "state x
             location A
               der x = 1
               transition t when false goto B
                 on go
             location B
               der x = 1",
            "",
        );
    }
}
