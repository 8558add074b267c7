use crate::graph::{Graph, Leaf, Node, NodeId};
use std::collections::BTreeSet;

impl Graph {
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
