use crate::arithmetic::{Binary, Comparison, Unary};
use crate::graph::{Graph, Leaf, Node, NodeId};
use rustc_hash::FxHashMap;

impl Graph {
    /// ∂`root`/∂`leaf`, or `None` if `root` does not depend on `leaf`.
    ///
    /// Exact inside a branch: the derivative of a switch (`if`, `abs`, `min`, `sign`, `floor`, a table, …) is that of
    /// the branch taken. Structural zeros are left out, numbers are never multiplied away.
    pub fn derivative(&mut self, root: NodeId, leaf: Leaf) -> Option<NodeId> {
        self.directional(root, &mut |graph, other| (other == leaf).then(|| graph.number(1.0)))
    }

    /// Derivative of `root` along a direction: `tangent` gives the rate of each leaf, `None` for zero. With
    /// the rates of the states it is the Lie derivative.
    pub fn directional(
        &mut self,
        root: NodeId,
        tangent: &mut impl FnMut(&mut Graph, Leaf) -> Option<NodeId>,
    ) -> Option<NodeId> {
        let mut known: FxHashMap<NodeId, Option<NodeId>> = FxHashMap::default();
        for id in self.reachable([root]) {
            let rate = self.node_rate(id, &known, tangent);
            known.insert(id, rate);
        }
        known[&root]
    }

    fn node_rate(
        &mut self,
        id: NodeId,
        known: &FxHashMap<NodeId, Option<NodeId>>,
        tangent: &mut impl FnMut(&mut Graph, Leaf) -> Option<NodeId>,
    ) -> Option<NodeId> {
        let rate = |operand: NodeId| known.get(&operand).copied().flatten();
        match self.node(id) {
            Node::Leaf(leaf) => tangent(self, leaf),
            Node::Number(_)
            | Node::Boolean(_)
            | Node::Compare(..)
            | Node::Not(_)
            | Node::And(..)
            | Node::Or(..)
            | Node::Locate(..)
            | Node::Lookup(..) => None,
            Node::Unary(function, a) => {
                let da = rate(a)?;
                self.unary_rate(function, id, a, da)
            }
            Node::IntegerPower(_, 0) => None,
            Node::IntegerPower(a, n) => {
                let da = rate(a)?;
                let lower = self.integer_power(a, n - 1);
                let factor = self.number(f64::from(n));
                let slope = self.multiply(factor, lower);
                Some(self.multiply(slope, da))
            }
            Node::Binary(function, a, b) => self.binary_rate(function, id, (a, rate(a)), (b, rate(b))),
            Node::Select(condition, a, b) => {
                let (da, db) = (rate(a), rate(b));
                if da.is_none() && db.is_none() {
                    return None;
                }
                let zero = self.number(0.0);
                Some(self.select(condition, da.unwrap_or(zero), db.unwrap_or(zero)))
            }
        }
    }

    /// f′(a)·da; `id` is the node f(a) itself.
    fn unary_rate(&mut self, function: Unary, id: NodeId, a: NodeId, da: NodeId) -> Option<NodeId> {
        let one = self.number(1.0);
        let slope = match function {
            Unary::Negate => return Some(self.unary(Unary::Negate, da)),
            Unary::Sign | Unary::Floor => return None,
            Unary::Smooth => return Some(da),
            Unary::Sin => self.unary(Unary::Cos, a),
            Unary::Cos => {
                let sine = self.unary(Unary::Sin, a);
                self.unary(Unary::Negate, sine)
            }
            Unary::Tan => {
                let square = self.integer_power(id, 2);
                self.add(one, square)
            }
            Unary::Sinh => self.unary(Unary::Cosh, a),
            Unary::Cosh => self.unary(Unary::Sinh, a),
            Unary::Tanh => {
                let square = self.integer_power(id, 2);
                self.subtract(one, square)
            }
            Unary::Exp => id,
            Unary::Abs => self.unary(Unary::Sign, a),
            Unary::Ln => return Some(self.divide(da, a)),
            Unary::Log10 => {
                let ten = self.number(std::f64::consts::LN_10);
                let scaled = self.multiply(ten, a);
                return Some(self.divide(da, scaled));
            }
            Unary::Sqrt => {
                let two = self.number(2.0);
                let twice = self.multiply(two, id);
                return Some(self.divide(da, twice));
            }
            Unary::Asin | Unary::Acos => {
                let square = self.integer_power(a, 2);
                let rest = self.subtract(one, square);
                let root = self.unary(Unary::Sqrt, rest);
                let rate = self.divide(da, root);
                return Some(if function == Unary::Acos { self.unary(Unary::Negate, rate) } else { rate });
            }
            Unary::Atan | Unary::Atanh => {
                let square = self.integer_power(a, 2);
                let below = match function {
                    Unary::Atan => self.add(one, square),
                    _ => self.subtract(one, square),
                };
                return Some(self.divide(da, below));
            }
            Unary::Asinh | Unary::Acosh => {
                let square = self.integer_power(a, 2);
                let rest = match function {
                    Unary::Asinh => self.add(square, one),
                    _ => self.subtract(square, one),
                };
                let root = self.unary(Unary::Sqrt, rest);
                return Some(self.divide(da, root));
            }
        };
        Some(self.multiply(slope, da))
    }

    fn binary_rate(
        &mut self,
        function: Binary,
        id: NodeId,
        (a, da): (NodeId, Option<NodeId>),
        (b, db): (NodeId, Option<NodeId>),
    ) -> Option<NodeId> {
        if da.is_none() && db.is_none() {
            return None;
        }
        let zero = self.number(0.0);
        Some(match function {
            Binary::Add => match (da, db) {
                (Some(x), Some(y)) => self.add(x, y),
                (Some(x), None) | (None, Some(x)) => x,
                (None, None) => return None,
            },
            Binary::Subtract => match (da, db) {
                (Some(x), Some(y)) => self.subtract(x, y),
                (Some(x), None) => x,
                (None, Some(y)) => self.unary(Unary::Negate, y),
                (None, None) => return None,
            },
            Binary::Multiply => {
                let left = da.map(|x| self.multiply(x, b));
                let right = db.map(|y| self.multiply(a, y));
                self.sum(left, right)?
            }
            // (a/b)′ = (a′ − (a/b)·b′)/b
            Binary::Divide => {
                let correction = db.map(|y| self.multiply(id, y));
                let above = match (da, correction) {
                    (Some(x), Some(c)) => self.subtract(x, c),
                    (Some(x), None) => x,
                    (None, Some(c)) => self.unary(Unary::Negate, c),
                    (None, None) => return None,
                };
                self.divide(above, b)
            }
            // (aᵇ)′ = b·aᵇ⁻¹·a′ + aᵇ·ln a·b′
            Binary::Power => {
                let left = da.map(|x| {
                    let one = self.number(1.0);
                    let lower = self.subtract(b, one);
                    let power = self.binary(Binary::Power, a, lower);
                    let slope = self.multiply(b, power);
                    self.multiply(slope, x)
                });
                let right = db.map(|y| {
                    let logarithm = self.unary(Unary::Ln, a);
                    let slope = self.multiply(id, logarithm);
                    self.multiply(slope, y)
                });
                self.sum(left, right)?
            }
            Binary::Min | Binary::Max => {
                let condition = self.compare(Comparison::Less, a, b);
                let (x, y) = (da.unwrap_or(zero), db.unwrap_or(zero));
                if function == Binary::Min {
                    self.select(condition, x, y)
                } else {
                    self.select(condition, y, x)
                }
            }
            // atan2(a, b)′ = (b·a′ − a·b′)/(a² + b²)
            Binary::Atan2 => {
                let left = da.map(|x| self.multiply(b, x));
                let right = db.map(|y| {
                    let product = self.multiply(a, y);
                    self.unary(Unary::Negate, product)
                });
                let above = self.sum(left, right)?;
                let (a2, b2) = (self.integer_power(a, 2), self.integer_power(b, 2));
                let below = self.add(a2, b2);
                self.divide(above, below)
            }
        })
    }

    fn sum(&mut self, a: Option<NodeId>, b: Option<NodeId>) -> Option<NodeId> {
        match (a, b) {
            (Some(x), Some(y)) => Some(self.add(x, y)),
            (one, None) | (None, one) => one,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Value, evaluate};
    use sophy_field::StateIndex;

    /// d/dx by a symmetric difference, for comparison.
    fn check(build: impl Fn(&mut Graph, NodeId) -> NodeId, at: f64) {
        let mut graph = Graph::default();
        let leaf = Leaf::State(StateIndex(0));
        let x = graph.leaf(leaf);
        let f = build(&mut graph, x);
        let value = |graph: &Graph, node, x| match evaluate(graph, node, &mut |_| Value::Real(x)) {
            Value::Real(y) => y,
            Value::Boolean(_) => f64::NAN,
        };
        let h = 1e-5;
        let difference = (value(&graph, f, at + h) - value(&graph, f, at - h)) / (2.0 * h);
        let exact = graph.derivative(f, leaf).map_or(0.0, |d| value(&graph, d, at));
        assert!(
            (exact - difference).abs() < 1e-7 * (1.0 + exact.abs()),
            "{exact} against {difference} at {at}"
        );
    }

    #[test]
    fn derivatives_agree_with_difference_quotients() {
        use Unary::*;
        for function in [
            Negate, Sin, Cos, Tan, Asin, Acos, Atan, Sinh, Cosh, Tanh, Asinh, Atanh, Exp, Ln, Log10, Sqrt,
            Abs,
        ] {
            for at in [0.3, 0.7] {
                check(|g, x| g.unary(function, x), at);
            }
        }
        check(|g, x| g.unary(Acosh, x), 1.7);
        for function in
            [Binary::Add, Binary::Subtract, Binary::Multiply, Binary::Divide, Binary::Power, Binary::Atan2]
        {
            check(
                |g, x| {
                    let sine = g.unary(Sin, x);
                    let square = g.integer_power(x, 2);
                    g.binary(function, sine, square)
                },
                0.8,
            );
        }
        check(
            |g, x| {
                let c = g.number(0.5);
                g.binary(Binary::Max, x, c)
            },
            0.9,
        );
        check(|g, x| g.integer_power(x, -3), 1.2);
    }
}
