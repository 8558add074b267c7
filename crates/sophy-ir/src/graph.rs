use crate::arithmetic::{Binary, Comparison, Unary, integer_power, locate, lookup};
use crate::class::VariableId;
use crate::column::Column;
use crate::packed::Packed;
use rustc_hash::FxBuildHasher;
use sophy_field::{
    AlgebraicIndex, ColumnIndex, InputIndex, ParameterIndex, StairIndex, StateIndex, TruthIndex,
};
use std::hash::BuildHasher;
use std::num::NonZeroU32;
use std::sync::Arc;

/// A node of a [`Graph`]. Equal expressions of one graph have equal ids.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct NodeId(NonZeroU32);

impl NodeId {
    /// The node at a position. One more is kept, so that `Option<NodeId>` is no longer than a position.
    pub(crate) fn new(position: usize) -> Self {
        let next = u32::try_from(position).unwrap_or(u32::MAX).saturating_add(1);
        NodeId(NonZeroU32::new(next).unwrap_or(NonZeroU32::MAX))
    }

    /// Position in the graph; operands come before what uses them.
    pub fn position(self) -> usize {
        self.0.get() as usize - 1
    }
}

/// What an expression can refer to. A [`crate::Class`] uses `Variable`, `Special` and
/// `Time`, a [`crate::System`] `Time` and the rest.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Leaf {
    /// A variable of a class.
    Variable(VariableId),
    /// Something else an expression of a class reads, by its place in [`crate::Class::specials`]; in a
    /// [`crate::System`] what cannot be run yet, by its place in [`crate::System::awaits`].
    Special(u32),
    /// A parameter.
    Parameter(ParameterIndex),
    /// A continuous state.
    State(StateIndex),
    /// A continuous input.
    Input(InputIndex),
    /// An algebraic variable.
    Algebraic(AlgebraicIndex),
    /// Simulated time, s.
    Time,
    /// A decided comparison (boolean).
    Truth(TruthIndex),
    /// The present integer of a `floor`, or the present piece of a table.
    Stair(StairIndex),
}

/// One operation. Numbers are kept by their bits, so that −0 and 0 differ and NaN equals itself.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Node {
    /// A number, as `f64::to_bits`.
    Number(u64),
    /// `true` or `false`.
    Boolean(bool),
    /// A reference.
    Leaf(Leaf),
    /// A function of one number.
    Unary(Unary, NodeId),
    /// A function of two numbers.
    Binary(Binary, NodeId, NodeId),
    /// A power with a whole exponent.
    IntegerPower(NodeId, i32),
    /// A comparison; its value is boolean.
    Compare(Comparison, NodeId, NodeId),
    /// Negation of a boolean.
    Not(NodeId),
    /// Both.
    And(NodeId, NodeId),
    /// At least one.
    Or(NodeId, NodeId),
    /// `if condition then a else b`; the branch not taken is not evaluated.
    Select(NodeId, NodeId, NodeId),
    /// The position in a column of knots of the last one that is not above a number; NaN outside of their range.
    Locate(ColumnIndex, NodeId),
    /// The number at a position of a column: the first one before it, the last one behind it.
    Lookup(ColumnIndex, NodeId),
}

/// A hash-consed expression graph: a node is stored once, operands before users.
///
/// Constructors fold numbers with [`crate::arithmetic`] and apply only identities that hold to the bit for
/// every IEEE value (`1·x`, `x/1`, `x¹`, `−(−x)`, constant conditions).
#[derive(Clone, Debug, Default)]
pub struct Graph {
    /// The first nodes, when the graph was built for the time being, and those that have come since.
    packed: Packed<Node>,
    nodes: Vec<Node>,
    /// Where to find a node: its position + 1 at the place of its hash or behind (open addressing), 0 where
    /// there is none. The length is a power of two.
    known: Vec<u32>,
    pub(crate) columns: Vec<Arc<Column>>,
}

impl Graph {
    /// The operation of a node.
    #[inline]
    pub fn node(&self, id: NodeId) -> Node {
        self.at(id.position())
    }

    #[inline]
    fn at(&self, position: usize) -> Node {
        match position.checked_sub(self.packed.len()) {
            Some(behind) => self.nodes[behind],
            None => self.packed.at(position),
        }
    }

    /// Number of distinct nodes.
    pub fn len(&self) -> usize {
        self.packed.len() + self.nodes.len()
    }

    /// All nodes, operands before users.
    pub fn ids(&self) -> impl Iterator<Item = NodeId> + use<> {
        (0..self.len()).map(NodeId::new)
    }

    /// Whether nothing was built yet.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    fn intern(&mut self, node: Node) -> NodeId {
        if 2 * self.len() >= self.known.len() {
            self.grow();
        }
        let mask = self.known.len() - 1;
        let mut at = hash(&node) & mask;
        while let Some(position) = self.known[at].checked_sub(1) {
            if self.at(position as usize) == node {
                return NodeId::new(position as usize);
            }
            at = (at + 1) & mask;
        }
        let id = NodeId::new(self.len());
        self.nodes.push(node);
        self.known[at] = id.0.get();
        id
    }

    fn grow(&mut self) {
        let length = (4 * self.len()).next_power_of_two().max(16);
        let mut known = vec![0; length];
        for position in 0..self.len() {
            let mut at = hash(&self.at(position)) & (length - 1);
            while known[at] != 0 {
                at = (at + 1) & (length - 1);
            }
            known[at] = position as u32 + 1;
        }
        self.known = known;
    }

    /// Forgets the nodes that came after the first `length`, which nothing may refer to any more.
    pub fn truncate(&mut self, length: usize) {
        if length < self.len() {
            self.nodes.truncate(length.saturating_sub(self.packed.len()));
            // It is found anew with the next node.
            self.known = Vec::new();
        }
    }

    /// Gives back what only building takes; a node built later costs that once.
    pub fn shrink_to_fit(&mut self) {
        // Once: what comes later is little.
        if self.packed.len() == 0 {
            self.packed = Packed::new(&self.nodes);
            self.nodes = Vec::new();
        }
        self.nodes.shrink_to_fit();
        self.known = Vec::new();
    }

    /// The number of a node, if it is one.
    pub fn as_number(&self, id: NodeId) -> Option<f64> {
        match self.node(id) {
            Node::Number(bits) => Some(f64::from_bits(bits)),
            _ => None,
        }
    }

    /// A number.
    pub fn number(&mut self, value: f64) -> NodeId {
        self.intern(Node::Number(value.to_bits()))
    }

    /// A truth value.
    pub fn boolean(&mut self, value: bool) -> NodeId {
        self.intern(Node::Boolean(value))
    }

    /// A reference.
    pub fn leaf(&mut self, leaf: Leaf) -> NodeId {
        self.intern(Node::Leaf(leaf))
    }

    /// A function of one number.
    pub fn unary(&mut self, function: Unary, a: NodeId) -> NodeId {
        if let Some(x) = self.as_number(a) {
            return self.number(function.apply(x));
        }
        if function == Unary::Negate
            && let Node::Unary(Unary::Negate, inner) = self.node(a)
        {
            return inner;
        }
        self.intern(Node::Unary(function, a))
    }

    /// A function of two numbers. A power with a small whole number becomes [`Node::IntegerPower`].
    pub fn binary(&mut self, function: Binary, a: NodeId, b: NodeId) -> NodeId {
        let (left, right) = (self.as_number(a), self.as_number(b));
        if function == Binary::Power
            && let Some(exponent) = right
            && exponent.fract() == 0.0
            && exponent.abs() <= 64.0
        {
            return self.integer_power(a, exponent as i32);
        }
        match (function, left, right) {
            (_, Some(x), Some(y)) => self.number(function.apply(x, y)),
            (Binary::Multiply, Some(1.0), _) => b,
            (Binary::Multiply | Binary::Divide, _, Some(1.0)) => a,
            _ => self.intern(Node::Binary(function, a, b)),
        }
    }

    /// `aⁿ`.
    pub fn integer_power(&mut self, a: NodeId, n: i32) -> NodeId {
        match (self.as_number(a), n) {
            (Some(x), _) => self.number(integer_power(x, n)),
            (None, 1) => a,
            _ => self.intern(Node::IntegerPower(a, n)),
        }
    }

    /// A comparison.
    pub fn compare(&mut self, comparison: Comparison, a: NodeId, b: NodeId) -> NodeId {
        if let (Some(x), Some(y)) = (self.as_number(a), self.as_number(b)) {
            return self.boolean(comparison.holds(x, y));
        }
        self.intern(Node::Compare(comparison, a, b))
    }

    /// Negation of a boolean.
    pub fn not(&mut self, a: NodeId) -> NodeId {
        match self.node(a) {
            Node::Boolean(value) => self.boolean(!value),
            Node::Not(inner) => inner,
            _ => self.intern(Node::Not(a)),
        }
    }

    /// Both of two booleans.
    pub fn and(&mut self, a: NodeId, b: NodeId) -> NodeId {
        match (self.node(a), self.node(b)) {
            (Node::Boolean(true), _) => b,
            (_, Node::Boolean(true)) => a,
            (Node::Boolean(false), _) | (_, Node::Boolean(false)) => self.boolean(false),
            _ => self.intern(Node::And(a, b)),
        }
    }

    /// At least one of two booleans.
    pub fn or(&mut self, a: NodeId, b: NodeId) -> NodeId {
        match (self.node(a), self.node(b)) {
            (Node::Boolean(false), _) => b,
            (_, Node::Boolean(false)) => a,
            (Node::Boolean(true), _) | (_, Node::Boolean(true)) => self.boolean(true),
            _ => self.intern(Node::Or(a, b)),
        }
    }

    /// `if condition then a else b`.
    pub fn select(&mut self, condition: NodeId, a: NodeId, b: NodeId) -> NodeId {
        match self.node(condition) {
            Node::Boolean(true) => a,
            Node::Boolean(false) => b,
            _ if a == b => a,
            _ => self.intern(Node::Select(condition, a, b)),
        }
    }

    /// The position of `a` among the knots of a column.
    pub fn locate(&mut self, column: ColumnIndex, a: NodeId) -> NodeId {
        match self.as_number(a) {
            Some(x) => {
                let position = locate(self.numbers(column), x);
                self.number(position)
            }
            None => self.intern(Node::Locate(column, a)),
        }
    }

    /// The number at a position of a column.
    pub fn lookup(&mut self, column: ColumnIndex, position: NodeId) -> NodeId {
        match self.as_number(position) {
            Some(position) => {
                let number = lookup(self.numbers(column), position);
                self.number(number)
            }
            None => self.intern(Node::Lookup(column, position)),
        }
    }

    /// `a + b`, for code that builds formulas.
    pub fn add(&mut self, a: NodeId, b: NodeId) -> NodeId {
        self.binary(Binary::Add, a, b)
    }

    /// `a − b`.
    pub fn subtract(&mut self, a: NodeId, b: NodeId) -> NodeId {
        self.binary(Binary::Subtract, a, b)
    }

    /// `a·b`.
    pub fn multiply(&mut self, a: NodeId, b: NodeId) -> NodeId {
        self.binary(Binary::Multiply, a, b)
    }

    /// `a/b`.
    pub fn divide(&mut self, a: NodeId, b: NodeId) -> NodeId {
        self.binary(Binary::Divide, a, b)
    }

    /// Calls `visit` on the operands of a node, in order.
    pub fn operands(&self, id: NodeId, mut visit: impl FnMut(NodeId)) {
        match self.node(id) {
            Node::Number(_) | Node::Boolean(_) | Node::Leaf(_) => {}
            Node::Unary(_, a)
            | Node::IntegerPower(a, _)
            | Node::Not(a)
            | Node::Locate(_, a)
            | Node::Lookup(_, a) => visit(a),
            Node::Binary(_, a, b) | Node::Compare(_, a, b) | Node::And(a, b) | Node::Or(a, b) => {
                visit(a);
                visit(b);
            }
            Node::Select(c, a, b) => {
                visit(c);
                visit(a);
                visit(b);
            }
        }
    }

    /// Builds a node through the folding constructors.
    pub fn rebuild(&mut self, node: Node) -> NodeId {
        match node {
            Node::Number(_) | Node::Boolean(_) | Node::Leaf(_) => self.intern(node),
            Node::Unary(function, a) => self.unary(function, a),
            Node::Binary(function, a, b) => self.binary(function, a, b),
            Node::IntegerPower(a, n) => self.integer_power(a, n),
            Node::Compare(comparison, a, b) => self.compare(comparison, a, b),
            Node::Not(a) => self.not(a),
            Node::And(a, b) => self.and(a, b),
            Node::Or(a, b) => self.or(a, b),
            Node::Select(c, a, b) => self.select(c, a, b),
            Node::Locate(column, a) => self.locate(column, a),
            Node::Lookup(column, a) => self.lookup(column, a),
        }
    }
}

/// The quick hash alone is linear in operands, and those of copies are equally spaced: it would crowd them.
fn hash(node: &Node) -> usize {
    let quick = FxBuildHasher.hash_one(node);
    let mixed = (quick ^ quick >> 32).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    (mixed >> 20) as usize
}

impl Node {
    /// The same operation on other operands.
    #[must_use]
    pub fn map(self, get: impl Fn(NodeId) -> NodeId) -> Node {
        match self {
            Node::Number(_) | Node::Boolean(_) | Node::Leaf(_) => self,
            Node::Unary(function, a) => Node::Unary(function, get(a)),
            Node::Binary(function, a, b) => Node::Binary(function, get(a), get(b)),
            Node::IntegerPower(a, n) => Node::IntegerPower(get(a), n),
            Node::Compare(comparison, a, b) => Node::Compare(comparison, get(a), get(b)),
            Node::Not(a) => Node::Not(get(a)),
            Node::And(a, b) => Node::And(get(a), get(b)),
            Node::Or(a, b) => Node::Or(get(a), get(b)),
            Node::Select(c, a, b) => Node::Select(get(c), get(a), get(b)),
            Node::Locate(column, a) => Node::Locate(column, get(a)),
            Node::Lookup(column, a) => Node::Lookup(column, get(a)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equal_expressions_are_one_node_and_numbers_fold() {
        let mut g = Graph::default();
        let x = g.leaf(Leaf::Time);
        let two = g.number(2.0);
        let (a, b) = (g.multiply(two, x), g.multiply(two, x));
        assert_eq!(a, b);
        let folded = g.add(two, two);
        assert_eq!(g.as_number(folded), Some(4.0));
        let one = g.number(1.0);
        assert_eq!(g.multiply(one, x), x);
        let zero = g.number(0.0);
        assert_ne!(g.multiply(zero, x), zero, "0·x is not 0 when x is NaN or infinite");
    }
}
