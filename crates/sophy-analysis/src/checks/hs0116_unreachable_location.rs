//! No chain of transitions leads from the first location to this one. Usually a destination was mistaken, or
//! another location was to be the first.

use crate::declarations::Declarations;
use crate::lower::LoweredLocation;
use sophy_diagnostics::{Code, Diagnostic, Diagnostics, Span};
use sophy_ir::{Graph, Node};

pub(crate) const CODE: Code = Code("HS0116");

/// Follows all transitions from the first location. Says nothing while a destination is unknown: it may be the
/// missing way.
pub(crate) fn find(
    declarations: &Declarations,
    locations: &[LoweredLocation],
    graph: &Graph,
    diagnostics: &mut Diagnostics,
) {
    let all_known = locations.iter().flat_map(|l| &l.transitions).all(|t| t.destination.is_some());
    let first = match &declarations.initial_location {
        Some(name) => declarations.locations.iter().position(|l| l.name.value == name.value),
        None => Some(0),
    };
    let (Some(first), true, false) = (first, all_known, locations.is_empty()) else { return };
    let mut reached = vec![false; locations.len()];
    let mut pending = vec![first];
    while let Some(position) = pending.pop() {
        if std::mem::replace(&mut reached[position], true) {
            continue;
        }
        let written = &declarations.locations[position].transitions;
        for (written, lowered) in written.iter().zip(&locations[position].transitions) {
            let never = lowered.guard.is_some_and(|guard| graph.node(guard) == Node::Boolean(false));
            if !(never && written.input_events.is_empty()) {
                pending.extend(lowered.destination);
            }
        }
    }
    let start = &declarations.locations[first].name;
    for (location, _) in declarations.locations.iter().zip(reached).filter(|(_, reached)| !reached) {
        let repeated = declarations.locations.iter().filter(|l| l.name.value == location.name.value).count();
        if repeated == 1 {
            diagnostics.push(diagnostic(&location.name.value, location.name.span, &start.value, start.span));
        }
    }
}

fn diagnostic(name: &str, span: Span, start: &str, start_span: Span) -> Diagnostic {
    Diagnostic::warning(CODE, span, format!("location `{name}` cannot be reached"))
        .label(start_span, "a run starts here")
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
