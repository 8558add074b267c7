//! Transitions lead round in a circle without time passing: one guard enables them all, and none of them changes what
//! it depends on. Once it holds, the run would never leave the instant.

use crate::component::{BuiltLocation, BuiltTransition};
use crate::declarations::TriggerDeclaration;
use sophy_diagnostics::{Code, Diagnostic, Diagnostics};
use sophy_ir::{Graph, Leaf, Node, NodeId};
use std::collections::BTreeMap;

pub(crate) const CODE: Code = Code("HS0403");

/// Follows, guard by guard, the transitions that leave it as it is.
pub(crate) fn find(locations: &[BuiltLocation<'_>], graph: &Graph, diagnostics: &mut Diagnostics) {
    let mut by_guard: BTreeMap<NodeId, Vec<(usize, &BuiltTransition<'_>)>> = BTreeMap::new();
    for (position, location) in locations.iter().enumerate() {
        for transition in &location.transitions {
            let Some(guard) = transition.guard.filter(|_| is_level(transition)) else { continue };
            if !matches!(graph.node(guard), Node::Boolean(_)) && !changes(graph, guard, transition) {
                by_guard.entry(guard).or_default().push((position, transition));
            }
        }
    }
    for ways in by_guard.values() {
        if let Some(circle) = circle(ways) {
            diagnostics.push(diagnostic(&circle, locations));
        }
    }
}

fn is_level(transition: &BuiltTransition<'_>) -> bool {
    matches!(transition.declaration.trigger, TriggerDeclaration::When(_) | TriggerDeclaration::WhenOrOn(..))
}

/// Whether a transition assigns something that its guard reads.
fn changes(graph: &Graph, guard: NodeId, transition: &BuiltTransition<'_>) -> bool {
    let read = graph.dependencies([guard]);
    transition.actions.assignments.iter().any(|a| read.contains(&Leaf::Variable(a.variable)))
        || read.iter().any(|leaf| matches!(leaf, Leaf::Special(_)))
}

/// The transitions of a circle. Of a location only the first way counts: it is the one that is taken.
fn circle<'t, 'a>(ways: &[(usize, &'t BuiltTransition<'a>)]) -> Option<Vec<&'t BuiltTransition<'a>>> {
    let next = |from: usize| ways.iter().find(|(source, _)| *source == from).map(|(_, way)| *way);
    for &(start, _) in ways {
        let mut path: Vec<&BuiltTransition<'a>> = Vec::new();
        let mut at = start;
        while let Some(way) = next(at) {
            path.push(way);
            at = way.destination?;
            // A transition to its own location may be there for what it emits or counts.
            if at == start && path.len() > 1 {
                return Some(path);
            }
            if at == start || path.len() > ways.len() {
                break;
            }
        }
    }
    None
}

fn diagnostic(circle: &[&BuiltTransition<'_>], locations: &[BuiltLocation<'_>]) -> Diagnostic {
    let names: Vec<String> = circle.iter().map(|way| format!("`{}`", way.declaration.name.value)).collect();
    let first = circle[0].declaration;
    let message = format!("{} lead round in a circle without time passing", names.join(", "));
    let mut error = Diagnostic::error(CODE, first.name.span, message);
    for way in &circle[1..] {
        error = error.label(way.declaration.name.span, "and then this one");
    }
    let last = circle[circle.len() - 1].destination.and_then(|d| locations.get(d)?.declaration);
    let place = last.map_or("", |location| location.name.value.as_str());
    error
        .note(format!("back in `{place}`, the guard is as true as before: nothing that it reads has changed"))
        .help("let a transition assign what the guard reads, or wait for something else on the way back")
}

#[cfg(test)]
mod tests {
    use crate::testing::check;

    #[test]
    fn there_and_back_on_one_condition() {
        check(
            "state x
             location A
               der x = 1
               transition there when x > 1 goto B
             location B
               der x = 1
               transition back when x > 1 goto A",
            "error[HS0403] line 4 `there`: `there`, `back` lead round in a circle without time passing
               line 7 `back`: and then this one
               note: back in `A`, the guard is as true as before: nothing that it reads has changed
               help: let a transition assign what the guard reads, or wait for something else on the way back",
        );
    }

    #[test]
    fn a_reset_or_another_condition_ends_it() {
        check(
            "state x
             location A
               der x = 1
               transition there when x > 1 goto B
               transition again when x > 2 goto A
                 reset x = 0
             location B
               der x = -1
               transition back when x < 1 goto A",
            "",
        );
    }
}
