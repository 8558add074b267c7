//! Truth values are stored as 1 and 0; where a condition is wanted, a number counts as true above ½.

use sophy_ir::{Comparison, Graph, Leaf, Node, NodeId, Unary};

/// Whether an expression is a condition; `None` if it can be read as either.
fn kind(graph: &Graph, mut node: NodeId) -> Option<bool> {
    loop {
        match graph.node(node) {
            Node::Boolean(_) | Node::Compare(..) | Node::Not(_) | Node::And(..) | Node::Or(..) => {
                return Some(true);
            }
            Node::Leaf(Leaf::Truth(_)) => return Some(true),
            Node::Leaf(Leaf::Special(_)) => return None,
            Node::Select(_, then, _) => node = then,
            _ => return Some(false),
        }
    }
}

pub(super) fn as_condition(graph: &mut Graph, node: NodeId) -> NodeId {
    if kind(graph, node) != Some(false) {
        return node;
    }
    let half = graph.number(0.5);
    graph.compare(Comparison::Greater, node, half)
}

pub(super) fn as_number(graph: &mut Graph, node: NodeId) -> NodeId {
    if kind(graph, node) != Some(true) {
        return node;
    }
    let (one, zero) = (graph.number(1.0), graph.number(0.0));
    graph.select(node, one, zero)
}

/// A number whose switches are no events. A condition is always one: it has no slope that could hide it.
pub(super) fn smooth(graph: &mut Graph, node: NodeId) -> NodeId {
    if kind(graph, node) == Some(true) { node } else { graph.unary(Unary::Smooth, node) }
}

/// The same operation; operands are numbers or conditions as it wants them.
pub(super) fn rebuild(graph: &mut Graph, node: Node) -> NodeId {
    let fitting = match node {
        Node::Number(_) | Node::Boolean(_) | Node::Leaf(_) => node,
        Node::Unary(function, a) => Node::Unary(function, as_number(graph, a)),
        Node::IntegerPower(a, n) => Node::IntegerPower(as_number(graph, a), n),
        Node::Binary(function, a, b) => Node::Binary(function, as_number(graph, a), as_number(graph, b)),
        Node::Compare(comparison, a, b) => {
            Node::Compare(comparison, as_number(graph, a), as_number(graph, b))
        }
        Node::Locate(column, a) => Node::Locate(column, as_number(graph, a)),
        Node::Lookup(column, a) => Node::Lookup(column, as_number(graph, a)),
        Node::Not(a) => Node::Not(as_condition(graph, a)),
        Node::And(a, b) => Node::And(as_condition(graph, a), as_condition(graph, b)),
        Node::Or(a, b) => Node::Or(as_condition(graph, a), as_condition(graph, b)),
        Node::Select(c, a, b) => {
            let c = as_condition(graph, c);
            if kind(graph, a) == Some(true) || kind(graph, b) == Some(true) {
                Node::Select(c, as_condition(graph, a), as_condition(graph, b))
            } else {
                Node::Select(c, a, b)
            }
        }
    };
    graph.rebuild(fitting)
}
