use serde::Serialize;
use sophy_ir::{Leaf, Node, NodeId, Row, System};

/// What the rate of a state reads.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Dependency {
    /// The state.
    pub state: String,
    /// States, inputs and `time` that occur in its rate, in the order of the columns.
    pub reads: Vec<String>,
    /// The same location by location, where it differs.
    pub by_location: Vec<(String, Vec<String>)>,
}

/// How full the coupling matrix D is: rows are rates, columns continuous states.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Sparsity {
    /// Number of rows and of columns.
    pub rows: u64,
    /// Entries that are not zero in some location.
    pub nonzeros: u64,
    /// Fewest entries of a row.
    pub least: u64,
    /// Mean number of entries of a row.
    pub mean: f64,
    /// Most entries of a row.
    pub most: u64,
    /// Largest distance of an entry from the diagonal.
    pub bandwidth: u64,
}

/// Quantities each of which depends on all others: a strongly connected component of the dependency graph.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Knot {
    /// How many there are.
    pub size: u64,
    /// Their names; of a large knot the first.
    pub members: Vec<String>,
}

/// Members of a knot that are named.
const NAMED: usize = 12;
/// Work up to which D is counted and written out, in visited nodes.
const MOST_WORK: u64 = 20_000_000;

/// What rates and algebraic quantities read.
pub(super) struct Coupling<'a> {
    system: &'a System,
    /// Positions of the continuous states among all states, and back.
    states: Vec<usize>,
    column: Vec<Option<usize>>,
}

/// A row of D: states, inputs and time, by the order of the leaves.
pub(super) type Reads = Vec<Leaf>;

impl<'a> Coupling<'a> {
    pub(super) fn new(system: &'a System) -> Self {
        let states: Vec<usize> =
            (0..system.states.len()).filter(|&x| !system.states.at(x).discrete).collect();
        let mut column = vec![None; system.states.len()];
        for (position, &state) in states.iter().enumerate() {
            column[state] = Some(position);
        }
        Coupling { system, states, column }
    }

    /// The rows of D for all locations together, and where it differs, for each; `None` if that is too much work.
    pub(super) fn rows(&self) -> Option<Vec<(Reads, Vec<Reads>)>> {
        let mut search = Search::new(self.system);
        let mut rows = Vec::with_capacity(self.states.len());
        for &state in &self.states {
            let row = self.system.states.at(state).rate;
            let nodes = self.system.nodes(row);
            let all = search.reads(nodes);
            let each = if self.system.is_constant(row) {
                Vec::new()
            } else {
                nodes.iter().map(|&node| search.reads(&[node])).collect()
            };
            if search.work > MOST_WORK {
                return None;
            }
            rows.push((all, each));
        }
        Some(rows)
    }

    pub(super) fn dependencies(&self, rows: &[(Reads, Vec<Reads>)]) -> Vec<Dependency> {
        let names = |reads: &Reads| -> Vec<String> {
            reads.iter().map(|&leaf| self.system.leaf_name(leaf)).collect()
        };
        let described = self.states.iter().zip(rows).map(|(&state, (all, each))| {
            let state = self.system.states.at(state);
            let differs = each.windows(2).any(|pair| pair[0] != pair[1]);
            let owner = self.system.automata.get(state.rate.owner.position());
            let locations = owner.as_ref().map_or(&[][..], |owner| &owner.kind.locations);
            let by_location = locations.iter().zip(each).filter(|_| differs);
            Dependency {
                state: state.name(self.system),
                reads: names(all),
                by_location: by_location
                    .map(|(location, reads)| (location.name.clone(), names(reads)))
                    .collect(),
            }
        });
        described.collect()
    }

    pub(super) fn sparsity(&self, rows: &[(Reads, Vec<Reads>)]) -> Sparsity {
        let mut sparsity = Sparsity {
            rows: rows.len() as u64,
            nonzeros: 0,
            least: if rows.is_empty() { 0 } else { u64::MAX },
            mean: 0.0,
            most: 0,
            bandwidth: 0,
        };
        for (row, (reads, _)) in rows.iter().enumerate() {
            let columns = reads.iter().filter_map(|leaf| match leaf {
                Leaf::State(state) => self.column.get(state.position()).copied().flatten(),
                _ => None,
            });
            let mut count = 0;
            for column in columns {
                count += 1;
                sparsity.bandwidth = sparsity.bandwidth.max(row.abs_diff(column) as u64);
            }
            sparsity.nonzeros += count;
            sparsity.least = sparsity.least.min(count);
            sparsity.most = sparsity.most.max(count);
        }
        sparsity.mean = sparsity.nonzeros as f64 / (rows.len().max(1)) as f64;
        sparsity
    }

    /// Strongly connected components of more than one state or algebraic quantity, the largest first.
    pub(super) fn knots(&self) -> Vec<Knot> {
        let system = self.system;
        let first_algebraic = self.states.len();
        let mut search = Search::new(system);
        let mut reads = |row: Row| -> Vec<usize> {
            let leaves = search.direct(system.nodes(row)).into_iter();
            leaves
                .filter_map(|leaf| match leaf {
                    Leaf::State(state) => self.column.get(state.position()).copied().flatten(),
                    Leaf::Algebraic(z) => Some(first_algebraic + z.position()),
                    _ => None,
                })
                .collect()
        };
        let rates = self.states.iter().map(|&state| system.states.at(state).rate);
        let rows = rates.chain(system.algebraics.iter().map(|z| z.value));
        let arcs: Vec<Vec<usize>> = rows.map(&mut reads).collect();
        let name = |node: usize| match self.states.get(node) {
            Some(&state) => system.states.at(state).name(system),
            None => system.algebraics.get(node - first_algebraic).map(|z| z.name(system)).unwrap_or_default(),
        };
        let mut knots: Vec<Vec<usize>> =
            strongly_connected(&arcs).into_iter().filter(|component| component.len() > 1).collect();
        knots.iter_mut().for_each(|knot| knot.sort_unstable());
        knots.sort_by(|a, b| b.len().cmp(&a.len()).then(a.cmp(b)));
        let knot = |knot: Vec<usize>| Knot {
            size: knot.len() as u64,
            members: knot.iter().take(NAMED).map(|&node| name(node)).collect(),
        };
        knots.into_iter().map(knot).collect()
    }
}

/// Finds leaves without forgetting how much work that was; marks are made once for all searches.
struct Search<'a> {
    system: &'a System,
    mark: u32,
    nodes: Vec<u32>,
    algebraics: Vec<u32>,
    work: u64,
}

impl<'a> Search<'a> {
    fn new(system: &'a System) -> Self {
        let (nodes, algebraics) = (vec![0; system.graph.len()], vec![0; system.algebraics.len()]);
        Search { system, mark: 0, nodes, algebraics, work: 0 }
    }

    /// States, inputs and time, through algebraic quantities.
    fn reads(&mut self, roots: &[NodeId]) -> Reads {
        self.leaves(roots, true)
    }

    /// States, inputs, time and algebraic quantities.
    fn direct(&mut self, roots: &[NodeId]) -> Reads {
        self.leaves(roots, false)
    }

    fn leaves(&mut self, roots: &[NodeId], through: bool) -> Reads {
        self.mark += 1;
        let mut found = Vec::new();
        let mut pending: Vec<NodeId> = roots.to_vec();
        while let Some(id) = pending.pop() {
            if std::mem::replace(&mut self.nodes[id.position()], self.mark) == self.mark {
                continue;
            }
            self.work += 1;
            match self.system.graph.node(id) {
                Node::Leaf(Leaf::Algebraic(z)) if through => {
                    let seen = std::mem::replace(&mut self.algebraics[z.position()], self.mark);
                    if seen != self.mark {
                        pending.extend_from_slice(
                            self.system.nodes(self.system.algebraics.at(z.position()).value),
                        );
                    }
                }
                Node::Leaf(leaf @ (Leaf::State(_) | Leaf::Input(_) | Leaf::Time | Leaf::Algebraic(_))) => {
                    found.push(leaf);
                }
                _ => self.system.graph.operands(id, |operand| pending.push(operand)),
            }
        }
        found.sort_unstable();
        found
    }
}

/// Tarjan's strongly connected components, without recursion.
fn strongly_connected(arcs: &[Vec<usize>]) -> Vec<Vec<usize>> {
    const UNSEEN: usize = usize::MAX;
    let mut number = vec![UNSEEN; arcs.len()];
    let mut low = vec![0; arcs.len()];
    let mut open = vec![false; arcs.len()];
    let (mut stack, mut components, mut next) = (Vec::new(), Vec::new(), 0);
    for start in 0..arcs.len() {
        if number[start] != UNSEEN {
            continue;
        }
        let mut path = vec![(start, 0_usize)];
        while let Some((node, arc)) = path.last_mut() {
            let node = *node;
            if *arc == 0 && number[node] == UNSEEN {
                (number[node], low[node], open[node]) = (next, next, true);
                next += 1;
                stack.push(node);
            }
            if let Some(&to) = arcs[node].get(*arc) {
                *arc += 1;
                if number[to] == UNSEEN {
                    path.push((to, 0));
                } else if open[to] {
                    low[node] = low[node].min(number[to]);
                }
                continue;
            }
            path.pop();
            if let Some(&(before, _)) = path.last() {
                low[before] = low[before].min(low[node]);
            }
            if low[node] == number[node] {
                let at = stack.iter().rposition(|&other| other == node).unwrap_or(0);
                let component = stack.split_off(at);
                component.iter().for_each(|&member| open[member] = false);
                components.push(component);
            }
        }
    }
    components
}

#[cfg(test)]
mod tests {
    use super::strongly_connected;

    /// Two nodes are in one component exactly if each reaches the other.
    #[test]
    fn components_are_mutual_reachability() {
        let mut seed = 1_u64;
        let mut random = |below: u64| {
            // Knuth's linear congruence.
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            ((seed >> 33) % below) as usize
        };
        for _ in 0..500 {
            let mut arcs = vec![Vec::new(); 12];
            let mut reaches = [[false; 12]; 12];
            for _ in 0..random(30) {
                let (a, b) = (random(12), random(12));
                arcs[a].push(b);
                reaches[a][b] = true;
            }
            for through in 0..12 {
                for a in 0..12 {
                    for b in 0..12 {
                        reaches[a][b] |= reaches[a][through] && reaches[through][b];
                    }
                }
            }
            let components = strongly_connected(&arcs);
            let of = |node: usize| components.iter().position(|component| component.contains(&node));
            let pairs = (0..12).flat_map(|a| (0..12).map(move |b| (a, b)));
            pairs.for_each(|(a, b)| {
                let together = a == b || (reaches[a][b] && reaches[b][a]);
                assert_eq!(of(a) == of(b), together, "{a} and {b} of {arcs:?}");
            });
            assert_eq!(components.iter().map(Vec::len).sum::<usize>(), 12);
        }
    }
}
