use crate::dependencies::Reach;
use crate::graph::{Graph, Leaf, Node, NodeId};

/// A number or a truth value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Value {
    /// A number.
    Real(f64),
    /// A truth value.
    Boolean(bool),
}

impl Value {
    /// The number; a truth value counts as 1 or 0.
    pub fn real(self) -> f64 {
        match self {
            Value::Real(x) => x,
            Value::Boolean(b) => f64::from(u8::from(b)),
        }
    }

    /// The truth value; a number other than 0 counts as true.
    pub fn boolean(self) -> bool {
        match self {
            Value::Real(x) => x != 0.0,
            Value::Boolean(b) => b,
        }
    }
}

/// The reference interpreter: the value of `root` when leaves have the values of `leaf`.
///
/// It walks the graph in its order and serves where speed does not matter, and as the witness that callable
/// equations are compared with. Branches not taken are evaluated too, without effect on the result.
pub fn evaluate(graph: &Graph, root: NodeId, leaf: &mut impl FnMut(Leaf) -> Value) -> Value {
    let order = graph.reachable([root]);
    let mut values: Vec<Value> = Vec::with_capacity(order.len());
    for &id in &order {
        // Operands stand before; both lists have one order.
        let get = |operand| order.binary_search(&operand).map_or(Value::Real(f64::NAN), |at| values[at]);
        let value = node_value(graph, id, get, leaf);
        values.push(value);
    }
    values.last().copied().unwrap_or(Value::Real(f64::NAN))
}

/// [`evaluate`] for many expressions whose leaves keep their values: what they share is evaluated once.
#[derive(Clone, Debug, Default)]
pub struct Evaluator {
    reach: Reach,
    known: Vec<Option<Value>>,
}

impl Evaluator {
    /// The value of `root`; `leaf` is asked once per leaf.
    pub fn value(&mut self, graph: &Graph, root: NodeId, leaf: &mut impl FnMut(Leaf) -> Value) -> Value {
        if self.known.len() < graph.len() {
            self.known.resize(graph.len(), None);
        }
        let known = &mut self.known;
        for &id in self.reach.beyond(graph, [root], |id| known[id.position()].is_some()) {
            let get = |operand: NodeId| known[operand.position()].unwrap_or(Value::Real(f64::NAN));
            let value = node_value(graph, id, get, leaf);
            known[id.position()] = Some(value);
        }
        known[root.position()].unwrap_or(Value::Real(f64::NAN))
    }
}

fn node_value(
    graph: &Graph,
    id: NodeId,
    get: impl Fn(NodeId) -> Value,
    leaf: &mut impl FnMut(Leaf) -> Value,
) -> Value {
    use crate::arithmetic::{integer_power, locate, lookup};
    match graph.node(id) {
        Node::Number(bits) => Value::Real(f64::from_bits(bits)),
        Node::Boolean(b) => Value::Boolean(b),
        Node::Leaf(reference) => leaf(reference),
        Node::Unary(function, a) => Value::Real(function.apply(get(a).real())),
        Node::Binary(function, a, b) => Value::Real(function.apply(get(a).real(), get(b).real())),
        Node::IntegerPower(a, n) => Value::Real(integer_power(get(a).real(), n)),
        Node::Compare(comparison, a, b) => Value::Boolean(comparison.holds(get(a).real(), get(b).real())),
        Node::Not(a) => Value::Boolean(!get(a).boolean()),
        Node::And(a, b) => Value::Boolean(get(a).boolean() && get(b).boolean()),
        Node::Or(a, b) => Value::Boolean(get(a).boolean() || get(b).boolean()),
        Node::Locate(column, a) => Value::Real(locate(graph.numbers(column), get(a).real())),
        Node::Lookup(column, a) => Value::Real(lookup(graph.numbers(column), get(a).real())),
        Node::Select(c, a, b) => {
            if get(c).boolean() {
                get(a)
            } else {
                get(b)
            }
        }
    }
}
