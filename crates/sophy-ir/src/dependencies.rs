use crate::arithmetic::Unary;
use crate::graph::{Graph, Leaf, Node, NodeId};
use rustc_hash::FxHashSet;
use std::collections::BTreeSet;

impl Graph {
    /// All nodes that `roots` need, operands before users, each once. The work is that of what is found, not
    /// of the whole graph; whoever asks often keeps a [`Reach`].
    pub fn reachable(&self, roots: impl IntoIterator<Item = NodeId>) -> Vec<NodeId> {
        self.found(roots, |_| true)
    }

    /// The same without what is inside of `smooth(…)`: the switches there are no events.
    pub fn reachable_switches(&self, roots: impl IntoIterator<Item = NodeId>) -> Vec<NodeId> {
        self.found(roots, |id| !matches!(self.node(id), Node::Unary(Unary::Smooth, _)))
    }

    fn found(&self, roots: impl IntoIterator<Item = NodeId>, enter: impl Fn(NodeId) -> bool) -> Vec<NodeId> {
        let mut seen: FxHashSet<NodeId> = FxHashSet::default();
        let mut pending: Vec<NodeId> = roots.into_iter().collect();
        while let Some(id) = pending.pop() {
            if seen.insert(id) && enter(id) {
                self.operands(id, |operand| pending.push(operand));
            }
        }
        let mut found: Vec<NodeId> = seen.into_iter().collect();
        found.sort_unstable();
        found
    }

    /// The leaves that `roots` refer to: a row of the thesis's coupling matrix D (§3.2.2).
    pub fn dependencies(&self, roots: impl IntoIterator<Item = NodeId>) -> BTreeSet<Leaf> {
        self.reachable(roots)
            .into_iter()
            .filter_map(|id| match self.node(id) {
                Node::Leaf(leaf) => Some(leaf),
                _ => None,
            })
            .collect()
    }
}

/// Finds what expressions need, again and again, without allocating: it remembers by node what it has seen.
#[derive(Clone, Debug, Default)]
pub struct Reach {
    round: u32,
    /// Per node: the round in which it was seen last.
    seen: Vec<u32>,
    pending: Vec<NodeId>,
    found: Vec<NodeId>,
}

impl Reach {
    /// All nodes that `roots` need, operands before users, each once.
    pub fn of(&mut self, graph: &Graph, roots: impl IntoIterator<Item = NodeId>) -> &[NodeId] {
        self.beyond(graph, roots, |_| false)
    }

    /// The same without what is `known`, and without what only that needs.
    pub fn beyond(
        &mut self,
        graph: &Graph,
        roots: impl IntoIterator<Item = NodeId>,
        known: impl Fn(NodeId) -> bool,
    ) -> &[NodeId] {
        self.entering(graph, roots, known, |_| true)
    }

    /// The same without what is needed only by nodes that `enter` keeps closed; these are found themselves.
    pub fn entering(
        &mut self,
        graph: &Graph,
        roots: impl IntoIterator<Item = NodeId>,
        known: impl Fn(NodeId) -> bool,
        enter: impl Fn(NodeId) -> bool,
    ) -> &[NodeId] {
        self.begin(graph);
        let (round, seen, pending) = (self.round, &mut self.seen, &mut self.pending);
        pending.extend(roots);
        while let Some(id) = pending.pop() {
            if seen[id.position()] != round && !known(id) {
                seen[id.position()] = round;
                self.found.push(id);
                if enter(id) {
                    graph.operands(id, |operand| pending.push(operand));
                }
            }
        }
        self.found.sort_unstable();
        &self.found
    }

    fn begin(&mut self, graph: &Graph) {
        if self.seen.len() < graph.len() {
            self.seen.resize(graph.len(), 0);
        }
        if self.round == u32::MAX {
            self.seen.fill(0);
            self.round = 0;
        }
        self.round += 1;
        self.found.clear();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use sophy_field::StateIndex;

    #[test]
    fn what_is_known_hides_what_only_it_needs() {
        let mut g = Graph::default();
        let [x, y, z] = [0, 1, 2].map(|i| g.leaf(Leaf::State(StateIndex(i))));
        let product = g.multiply(x, y);
        let sum = g.add(product, z);
        let mut reach = Reach::default();
        assert_eq!(reach.of(&g, [sum]), g.reachable([sum]));
        assert_eq!(reach.of(&g, [sum, product]), [x, y, z, product, sum]);
        assert_eq!(reach.beyond(&g, [sum], |id| id == product), [z, sum]);
        assert_eq!(reach.entering(&g, [sum], |_| false, |id| id != product), [z, product, sum]);
        let later = g.add(sum, x);
        assert_eq!(reach.of(&g, [later]).len(), 6, "the graph may grow in between");
    }
}
