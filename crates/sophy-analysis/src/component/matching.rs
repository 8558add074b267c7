use super::equations::Defined;
use sophy_ir::{Constraint, Graph, Leaf, VariableId};
use std::collections::{BTreeMap, BTreeSet};

/// Which constraints determine which quantities.
#[derive(Debug, Default)]
pub(crate) struct Matched {
    /// Quantities that no constraint is left for.
    pub(crate) undetermined: Vec<VariableId>,
    /// Positions of constraints that determine nothing.
    pub(crate) superfluous: Vec<usize>,
}

/// Assigns a constraint to each quantity that has no equation.
///
/// A constraint can determine what it reads, what the equations of that read, and, if it may be `differentiated`
/// (Pantelides), what the derivatives of the states in it read. States without a derivative of their own can be
/// determined, too, but need not be.
pub(crate) fn match_constraints(
    graph: &Graph,
    defined: &Defined,
    constraints: &[Constraint],
    unknowns: &[VariableId],
    is_state: impl Fn(VariableId) -> bool,
    differentiated: bool,
) -> Matched {
    if constraints.is_empty() {
        return Matched { undetermined: unknowns.to_vec(), superfluous: Vec::new() };
    }
    let wanted: BTreeSet<VariableId> = unknowns.iter().copied().collect();
    let mut edges: Vec<Vec<VariableId>> = Vec::with_capacity(constraints.len());
    for constraint in constraints {
        let mut reached = BTreeSet::new();
        let mut pending: Vec<Leaf> =
            graph.dependencies([constraint.left, constraint.right]).into_iter().collect();
        let mut found = Vec::new();
        while let Some(leaf) = pending.pop() {
            let Leaf::Variable(id) = leaf else { continue };
            if !reached.insert(id) {
                continue;
            }
            let rate = defined.rates.get(&id);
            let value = defined.values.get(&id);
            if wanted.contains(&id) || (rate.is_none() && value.is_none() && is_state(id)) {
                found.push(id);
            }
            let nodes = rate
                .filter(|_| differentiated)
                .into_iter()
                .chain(value)
                .filter_map(|definition| definition.right);
            pending.extend(graph.dependencies(nodes));
        }
        found.sort_by_key(|id| (!wanted.contains(id), *id));
        edges.push(found);
    }
    let mut matched_to: BTreeMap<VariableId, usize> = BTreeMap::new();
    let mut superfluous = Vec::new();
    for start in 0..edges.len() {
        if !augment(start, &edges, &mut matched_to) {
            superfluous.push(start);
        }
    }
    let undetermined = unknowns.iter().copied().filter(|id| !matched_to.contains_key(id)).collect();
    Matched { undetermined, superfluous }
}

/// One augmenting path of the bipartite matching, breadth first.
fn augment(start: usize, edges: &[Vec<VariableId>], matched_to: &mut BTreeMap<VariableId, usize>) -> bool {
    let mut reached_from: BTreeMap<VariableId, usize> = BTreeMap::new();
    let mut queue = std::collections::VecDeque::from([start]);
    while let Some(constraint) = queue.pop_front() {
        for &id in &edges[constraint] {
            if reached_from.contains_key(&id) {
                continue;
            }
            reached_from.insert(id, constraint);
            match matched_to.get(&id) {
                Some(&other) => queue.push_back(other),
                None => {
                    // Turn the path round.
                    let mut free = id;
                    loop {
                        let constraint = reached_from[&free];
                        let before = edges[constraint]
                            .iter()
                            .copied()
                            .find(|other| matched_to.get(other) == Some(&constraint));
                        matched_to.insert(free, constraint);
                        match before {
                            Some(before) if constraint != start => free = before,
                            _ => return true,
                        }
                    }
                }
            }
        }
    }
    false
}
