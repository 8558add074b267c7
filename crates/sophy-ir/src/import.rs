use crate::dependencies::Reach;
use crate::graph::{Graph, Leaf, Node, NodeId};

impl Graph {
    /// Copies `root` of `from` into this graph, leaves replaced by `replace` (their nodes in this graph).
    /// Whoever copies often keeps an [`Importer`].
    pub fn import(
        &mut self,
        from: &Graph,
        root: NodeId,
        replace: &mut impl FnMut(&mut Graph, Leaf) -> NodeId,
    ) -> NodeId {
        let order = from.reachable([root]);
        let mut copied: Vec<NodeId> = Vec::with_capacity(order.len());
        for &id in &order {
            // Operands stand before; both lists have one order.
            let get = |operand: NodeId| order.binary_search(&operand).map_or(operand, |at| copied[at]);
            let copy = match from.node(id) {
                Node::Leaf(leaf) => replace(self, leaf),
                Node::Locate(column, a) => {
                    let column = self.adopt(from, column);
                    self.locate(column, get(a))
                }
                Node::Lookup(column, a) => {
                    let column = self.adopt(from, column);
                    self.lookup(column, get(a))
                }
                other => self.rebuild(other.map(get)),
            };
            copied.push(copy);
        }
        copied.last().copied().unwrap_or(root)
    }
}

/// Copies expressions of one graph into another, many times, each time with other leaves: the equations of a
/// component for every copy of it.
///
/// Within a copy everything is copied once, however many expressions share it; [`Importer::renew`] begins the
/// next copy. Nothing is allocated but the new nodes.
#[derive(Clone, Debug, Default)]
pub struct Importer {
    reach: Reach,
    round: u32,
    /// Per node of the source: the round in which it was copied last, and its copy then.
    copies: Vec<(u32, NodeId)>,
}

impl Importer {
    /// An importer that has copied nothing.
    pub fn new() -> Self {
        Importer { round: 1, ..Importer::default() }
    }

    /// Begins the next copy: leaves may mean something else, and the source may be another graph.
    pub fn renew(&mut self) {
        if self.round == u32::MAX {
            self.copies.clear();
            self.round = 0;
        }
        self.round += 1;
    }

    /// The copy of `root` of `from` in `into`, leaves replaced by `replace` (their nodes in `into`), which is
    /// asked once per leaf and copy.
    pub fn import(
        &mut self,
        into: &mut Graph,
        from: &Graph,
        root: NodeId,
        replace: &mut impl FnMut(&mut Graph, Leaf) -> NodeId,
    ) -> NodeId {
        if self.copies.len() < from.len() {
            self.copies.resize(from.len(), (0, root));
        }
        let (round, copies) = (self.round, &mut self.copies);
        if copies[root.position()].0 != round {
            let missing = self.reach.beyond(from, [root], |id| copies[id.position()].0 == round);
            for &id in missing {
                let copy = match from.node(id) {
                    Node::Leaf(leaf) => replace(into, leaf),
                    Node::Locate(column, a) => {
                        let column = into.adopt(from, column);
                        into.locate(column, copies[a.position()].1)
                    }
                    Node::Lookup(column, a) => {
                        let column = into.adopt(from, column);
                        into.lookup(column, copies[a.position()].1)
                    }
                    other => into.rebuild(other.map(|operand| copies[operand.position()].1)),
                };
                copies[id.position()] = (round, copy);
            }
        }
        copies[root.position()].1
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Unary;
    use sophy_field::StateIndex;

    #[test]
    fn every_copy_has_its_own_leaves_and_shares_within() {
        let mut class = Graph::default();
        let x = class.leaf(Leaf::State(StateIndex(0)));
        let sine = class.unary(Unary::Sin, x);
        let two = class.number(2.0);
        let double = class.multiply(two, sine);
        let mut flat = Graph::default();
        let mut importer = Importer::new();
        for copy in 0..3 {
            importer.renew();
            let mut asked = 0;
            let mut replace = |graph: &mut Graph, _| {
                asked += 1;
                graph.leaf(Leaf::State(StateIndex(copy)))
            };
            let copied = [sine, double].map(|root| importer.import(&mut flat, &class, root, &mut replace));
            assert_eq!(asked, 1);
            let plain =
                flat.import(&class, double, &mut |graph, _| graph.leaf(Leaf::State(StateIndex(copy))));
            assert_eq!(copied[1], plain);
        }
        assert_eq!(flat.len(), 1 + 3 * 3, "one 2, and three nodes per copy");
    }
}
