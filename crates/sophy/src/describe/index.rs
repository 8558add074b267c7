use sophy_ir::{Body, Class, Constraint, Leaf, Location, VariableId, VariableKind};
use std::collections::{HashMap, HashSet, VecDeque};

/// The index of a component's differential-algebraic equations, by structure: 0 without constraints, 1 if the
/// constraints can be solved for what no other equation defines, else 2, which stands for "2 or more".
///
/// The constraints of each location are matched with the quantities that they reach without being differentiated
/// (Pantelides' algorithm would differentiate those that find no partner). What is defined by other components counts as
/// known.
pub(super) fn index(class: &Class) -> u8 {
    let Body::Automaton(automaton) = &class.body else { return 0 };
    automaton.locations.iter().map(|location| index_in(class, location)).max().unwrap_or(0)
}

fn index_in(class: &Class, location: &Location) -> u8 {
    if location.constraints.is_empty() {
        return 0;
    }
    let values: HashMap<VariableId, _> = location.values.iter().map(|e| (e.variable, e.right)).collect();
    let moving: HashSet<VariableId> = location.dynamics.iter().map(|e| e.variable).collect();
    let unknown = |id: VariableId| match class.variables.get(id.0 as usize).map(|variable| variable.kind) {
        Some(VariableKind::Local | VariableKind::Output | VariableKind::Flag) => !values.contains_key(&id),
        Some(VariableKind::State(_)) => !moving.contains(&id),
        _ => false,
    };
    let reaches = |constraint: &Constraint| {
        let mut reached: HashSet<VariableId> = HashSet::new();
        let mut found = Vec::new();
        let mut pending = class.graph.dependencies([constraint.left, constraint.right]);
        while let Some(leaf) = pending.pop_first() {
            let Leaf::Variable(id) = leaf else { continue };
            if !reached.insert(id) {
                continue;
            }
            if unknown(id) {
                found.push(id);
            }
            pending.append(&mut class.graph.dependencies(values.get(&id).copied()));
        }
        found
    };
    let reached: Vec<Vec<VariableId>> = location.constraints.iter().map(reaches).collect();
    if matched(&reached) == reached.len() { 1 } else { 2 }
}

/// Size of the largest matching of rows with what they reach.
fn matched(rows: &[Vec<VariableId>]) -> usize {
    let mut row_of: HashMap<VariableId, usize> = HashMap::new();
    let mut partner: Vec<Option<VariableId>> = vec![None; rows.len()];
    for start in 0..rows.len() {
        // Breadth first to a free partner, then the path is turned round.
        let mut from: HashMap<VariableId, usize> = HashMap::new();
        let mut queue = VecDeque::from([start]);
        let mut end = None;
        'search: while let Some(row) = queue.pop_front() {
            for &id in &rows[row] {
                if from.contains_key(&id) {
                    continue;
                }
                from.insert(id, row);
                match row_of.get(&id) {
                    Some(&other) => queue.push_back(other),
                    None => {
                        end = Some(id);
                        break 'search;
                    }
                }
            }
        }
        while let Some(id) = end {
            let Some(&row) = from.get(&id) else { break };
            end = partner[row].replace(id);
            row_of.insert(id, row);
        }
    }
    partner.iter().flatten().count()
}

#[cfg(test)]
mod tests {
    use super::matched;
    use sophy_ir::VariableId;

    #[test]
    fn matchings_turn_paths_round() {
        let rows = |rows: &[&[u32]]| -> Vec<Vec<VariableId>> {
            rows.iter().map(|row| row.iter().map(|&id| VariableId(id)).collect()).collect()
        };
        assert_eq!(matched(&rows(&[&[0, 1], &[0], &[1, 2]])), 3);
        assert_eq!(matched(&rows(&[&[0], &[0], &[0, 1]])), 2);
        assert_eq!(matched(&rows(&[&[]])), 0);
    }
}
