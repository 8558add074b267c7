//! Transitions lead round in a circle without time passing: one guard enables them all, and none of them changes what
//! it depends on. Once it holds, the run would never leave the instant. So it is where one quantity is beyond the levels
//! of all guards, if these are different ones; whether it ever comes there is not known.

use crate::component::{BuiltLocation, BuiltTransition};
use crate::declarations::TriggerDeclaration;
use sophy_diagnostics::{Code, Diagnostic, Diagnostics, Severity};
use sophy_ir::{Comparison, Graph, Leaf, Node, NodeId, VariableId};
use std::collections::{BTreeMap, BTreeSet};

pub(crate) const CODE: Code = Code("HS0403");

/// Follows, guard by guard, the transitions that leave it as it is.
pub(crate) fn find(locations: &[BuiltLocation<'_>], graph: &Graph, diagnostics: &mut Diagnostics) {
    let mut by_guard: BTreeMap<NodeId, Vec<(usize, &BuiltTransition<'_>)>> = BTreeMap::new();
    let mut by_side: BTreeMap<(NodeId, bool), Vec<(usize, &BuiltTransition<'_>)>> = BTreeMap::new();
    for (position, location) in locations.iter().enumerate() {
        for transition in &location.transitions {
            let Some(guard) = transition.guard.filter(|_| is_level(transition) && transition.sound) else {
                continue;
            };
            let ends = [Some(location), transition.destination.and_then(|entered| locations.get(entered))];
            if !matches!(graph.node(guard), Node::Boolean(_)) && !changes(graph, guard, transition, ends) {
                by_guard.entry(guard).or_default().push((position, transition));
                if let Some(side) = side(graph, guard) {
                    by_side.entry(side).or_default().push((position, transition));
                }
            }
        }
    }
    for ways in by_guard.values() {
        if let Some(circle) = circle(ways) {
            diagnostics.push(diagnostic(&circle, locations, Severity::Error));
        }
    }
    for ways in by_side.values() {
        if let Some(circle) =
            circle(ways).filter(|circle| circle.iter().any(|way| way.guard != circle[0].guard))
        {
            diagnostics.push(diagnostic(&circle, locations, Severity::Warning));
        }
    }
}

/// The quantity that a guard compares with a number, and whether it must be above it.
fn side(graph: &Graph, guard: NodeId) -> Option<(NodeId, bool)> {
    let Node::Compare(comparison, a, b) = graph.node(guard) else { return None };
    let above = match comparison {
        Comparison::Greater | Comparison::GreaterEqual => true,
        Comparison::Less | Comparison::LessEqual => false,
        Comparison::Equal | Comparison::NotEqual => return None,
    };
    match (graph.as_number(a), graph.as_number(b)) {
        (None, Some(_)) => Some((a, above)),
        (Some(_), None) => Some((b, !above)),
        _ => None,
    }
}

fn is_level(transition: &BuiltTransition<'_>) -> bool {
    matches!(transition.declaration.trigger, TriggerDeclaration::When(_) | TriggerDeclaration::WhenOrOn(..))
}

/// Whether a transition may change something that its guard reads, also by way of equations: `ends` are the locations
/// that it leaves and enters.
fn changes(
    graph: &Graph,
    guard: NodeId,
    transition: &BuiltTransition<'_>,
    ends: [Option<&BuiltLocation<'_>>; 2],
) -> bool {
    let assigned: BTreeSet<VariableId> =
        transition.actions.assignments.iter().map(|assignment| assignment.variable).collect();
    let mut read: BTreeSet<VariableId> = BTreeSet::new();
    let mut pending: Vec<Leaf> = graph.dependencies([guard]).into_iter().collect();
    while let Some(leaf) = pending.pop() {
        match leaf {
            Leaf::Special(_) => return true,
            Leaf::Variable(id) if assigned.contains(&id) => return true,
            Leaf::Variable(id) if read.insert(id) => {
                let [before, after] = ends.map(|end| end.and_then(|l| l.defined.values.get(&id)?.right));
                if before != after {
                    return true;
                }
                pending.extend(before.into_iter().flat_map(|right| graph.dependencies([right])));
            }
            _ => {}
        }
    }
    false
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
            if at == start {
                return Some(path);
            }
            if path.len() > ways.len() {
                break;
            }
        }
    }
    None
}

fn diagnostic(
    circle: &[&BuiltTransition<'_>],
    locations: &[BuiltLocation<'_>],
    severity: Severity,
) -> Diagnostic {
    let names: Vec<String> = circle.iter().map(|way| format!("`{}`", way.declaration.name.value)).collect();
    let first = circle[0].declaration;
    let message = match names.as_slice() {
        [only] => format!("{only} leads to its own location without time passing, again and again"),
        _ => format!("{} lead round in a circle without time passing", names.join(", ")),
    };
    let certain = severity == Severity::Error;
    let mut error = if certain {
        Diagnostic::error(CODE, first.name.span, message)
    } else {
        let message = format!("{message}, where what they compare is beyond all their levels");
        Diagnostic::warning(CODE, first.name.span, message)
    };
    for way in &circle[1..] {
        error = error.label(way.declaration.name.span, "and then this one");
    }
    let last = circle[circle.len() - 1].destination.and_then(|d| locations.get(d)?.declaration);
    let place = last.map_or("", |location| location.name.value.as_str());
    if certain {
        let note =
            format!("back in `{place}`, the guard is as true as before: nothing that it reads has changed");
        error = error.note(note);
    }
    error.help("let a transition assign what the guard reads, or wait for something else on the way back")
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

    #[test]
    fn to_its_own_location() {
        check(
            "state x
             state n
             location A
               der x = 1
               der n = 0
               transition count when x > 1 goto A
                 reset n = n + 1
               transition back when x > 2 goto A
                 reset x = 0",
            "error[HS0403] line 6 `count`: `count` leads to its own location without time passing, again and again
               note: back in `A`, the guard is as true as before: nothing that it reads has changed
               help: let a transition assign what the guard reads, or wait for something else on the way back",
        );
    }
}
