use crate::arithmetic::{Binary, Unary};
use crate::graph::{Graph, Leaf, Node, NodeId};

/// What is nested deeper is shown as `…`.
const DEEPEST: u32 = 200;

/// Writes an operand, in parentheses if its level is less than the given one.
pub(crate) type Write<'w> = &'w dyn Fn(NodeId, u8) -> String;

impl Graph {
    /// `root` in the notation of the language, with as few parentheses as precedence allows; `name` says
    /// what leaves are called.
    pub fn display(&self, root: NodeId, name: &impl Fn(Leaf) -> String) -> String {
        self.display_with(root, name, &|_, _| None)
    }

    /// The same, but `instead` may have other words for a node: its level and its text, from what it can have
    /// written.
    pub(crate) fn display_with(
        &self,
        root: NodeId,
        name: &impl Fn(Leaf) -> String,
        instead: &impl Fn(NodeId, Write<'_>) -> Option<(u8, String)>,
    ) -> String {
        self.write(root, 0, 0, name, instead)
    }

    /// Levels: 0 `if`, 1 `or`, 2 `and`, 3 `not`, 4 comparison, 5 sum, 6 product, 7 sign, 8 power, 9 atom.
    fn write(
        &self,
        id: NodeId,
        least: u8,
        depth: u32,
        name: &impl Fn(Leaf) -> String,
        instead: &impl Fn(NodeId, Write<'_>) -> Option<(u8, String)>,
    ) -> String {
        if depth > DEEPEST {
            return "…".to_owned();
        }
        let write = |operand: NodeId, least: u8| self.write(operand, least, depth + 1, name, instead);
        let infix = |level: u8, symbol: &str, a: NodeId, b: NodeId, right: u8| {
            let (a, b) = (write(a, level), write(b, right));
            (level, format!("{a} {symbol} {b}"))
        };
        let call = |function: &str, operands: &[NodeId]| {
            let operands: Vec<_> = operands.iter().map(|&o| write(o, 0)).collect();
            (9, format!("{function}({})", operands.join(", ")))
        };
        let (level, text) = instead(id, &write).unwrap_or_else(|| match self.node(id) {
            Node::Number(bits) => {
                let value = f64::from_bits(bits);
                (if value.is_sign_negative() { 7 } else { 9 }, format!("{value:?}"))
            }
            Node::Boolean(value) => (9, value.to_string()),
            Node::Leaf(leaf) => (9, name(leaf)),
            Node::Unary(Unary::Negate, a) => (7, format!("-{}", write(a, 7))),
            Node::Unary(function, a) => call(function.name(), &[a]),
            Node::Binary(Binary::Add, a, b) => infix(5, "+", a, b, 6),
            Node::Binary(Binary::Subtract, a, b) => infix(5, "-", a, b, 6),
            Node::Binary(Binary::Multiply, a, b) => infix(6, "*", a, b, 7),
            Node::Binary(Binary::Divide, a, b) => infix(6, "/", a, b, 7),
            Node::Binary(Binary::Power, a, b) => (8, format!("{}^{}", write(a, 9), write(b, 8))),
            Node::Binary(function, a, b) => call(function.name(), &[a, b]),
            Node::IntegerPower(a, n) => (8, format!("{}^{n}", write(a, 9))),
            Node::Compare(comparison, a, b) => infix(4, comparison.symbol(), a, b, 5),
            Node::Not(a) => (3, format!("not {}", write(a, 3))),
            Node::And(a, b) => infix(2, "and", a, b, 3),
            Node::Or(a, b) => infix(1, "or", a, b, 2),
            Node::Locate(column, a) => {
                (9, format!("locate({:?}, {})", self.column_name(column), write(a, 0)))
            }
            Node::Lookup(column, a) => {
                (9, format!("lookup({:?}, {})", self.column_name(column), write(a, 0)))
            }
            Node::Select(c, a, b) => {
                (0, format!("if {} then {} else {}", write(c, 1), write(a, 1), write(b, 0)))
            }
        });
        if level < least { format!("({text})") } else { text }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Comparison;

    #[test]
    fn parentheses_only_where_needed() {
        let mut g = Graph::default();
        let t = g.leaf(Leaf::Time);
        let two = g.number(2.0);
        let sum = g.add(t, two);
        let product = g.multiply(two, sum);
        let difference = g.subtract(t, product);
        let nested = g.subtract(t, difference);
        let square = g.integer_power(sum, 2);
        let guard = g.compare(Comparison::Less, nested, square);
        let text = g.display(guard, &|_| "t".to_owned());
        assert_eq!(text, "t - (t - 2.0 * (t + 2.0)) < (t + 2.0)^2");
    }
}
