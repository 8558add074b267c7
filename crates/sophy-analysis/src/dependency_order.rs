/// What depends on what, sorted out.
pub(crate) struct DependencyOrder {
    /// Items after everything they depend on; those in a cycle are left out.
    pub(crate) order: Vec<usize>,
    /// Cycles without a common member: each item depends on the next, the last on the first.
    pub(crate) cycles: Vec<Vec<usize>>,
}

/// Sorts items `0..dependencies.len()`; `dependencies[i]` lists what item `i` depends on.
///
/// Depth-first search with a stack of its own, so that a long chain of definitions costs no stack.
pub(crate) fn dependency_order(dependencies: &[Vec<usize>]) -> DependencyOrder {
    #[derive(Clone, Copy, PartialEq)]
    enum Mark {
        New,
        Open,
        Done,
    }
    let mut marks = vec![Mark::New; dependencies.len()];
    let mut cyclic = vec![false; dependencies.len()];
    let mut result = DependencyOrder { order: Vec::new(), cycles: Vec::new() };
    for root in 0..dependencies.len() {
        if marks[root] != Mark::New {
            continue;
        }
        marks[root] = Mark::Open;
        let mut path = vec![(root, 0)];
        while let Some((item, next)) = path.last_mut() {
            let item = *item;
            let Some(&dependency) = dependencies[item].get(*next) else {
                marks[item] = Mark::Done;
                result.order.push(item);
                path.pop();
                continue;
            };
            *next += 1;
            match marks[dependency] {
                Mark::New => {
                    marks[dependency] = Mark::Open;
                    path.push((dependency, 0));
                }
                Mark::Open => {
                    let start = path.iter().position(|&(open, _)| open == dependency).unwrap_or(0);
                    let cycle: Vec<usize> = path[start..].iter().map(|&(open, _)| open).collect();
                    if !cycle.iter().any(|&member| cyclic[member]) {
                        cycle.iter().for_each(|&member| cyclic[member] = true);
                        result.cycles.push(cycle);
                    }
                }
                Mark::Done => {}
            }
        }
    }
    result.order.retain(|&item| !cyclic[item]);
    result
}

#[cfg(test)]
mod tests {
    use super::dependency_order;

    #[test]
    fn what_is_needed_comes_first() {
        let sorted = dependency_order(&[vec![1, 2], vec![2], vec![]]);
        assert_eq!(sorted.order, [2, 1, 0]);
        assert!(sorted.cycles.is_empty());
    }

    #[test]
    fn a_cycle_is_listed_once_in_the_order_of_need() {
        let sorted = dependency_order(&[vec![1], vec![2], vec![0], vec![3], vec![0]]);
        assert_eq!(sorted.cycles, [vec![0, 1, 2], vec![3]]);
        assert_eq!(sorted.order, [4]);
    }

    #[test]
    fn a_long_chain_costs_no_stack() {
        let chain: Vec<Vec<usize>> =
            (0..200_000).map(|i| if i < 199_999 { vec![i + 1] } else { vec![] }).collect();
        assert_eq!(dependency_order(&chain).order.len(), 200_000);
    }
}
