use crate::arithmetic::{Binary, Unary};
use crate::dependencies::Reach;
use crate::graph::{Graph, Leaf, Node, NodeId};
use sophy_field::AlgebraicIndex;

/// Whether expressions of a system are affine in states, inputs and time, found once per node.
///
/// Decides exactly what [`Graph::affine`] decides with these and the algebraic variables as variables, and
/// asks besides that the algebraic variables are affine themselves, in every location.
#[derive(Clone, Debug, Default)]
pub struct Linearity {
    reach: Reach,
    known: Vec<Option<Degree>>,
    /// Per algebraic variable: whether it is affine in every location.
    algebraics: Vec<bool>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Degree {
    /// No variable occurs.
    Constant,
    Affine,
    Higher,
}

impl Linearity {
    /// Tells of an algebraic variable; in the order of their table, which is that of evaluation.
    pub fn algebraic(&mut self, graph: &Graph, index: AlgebraicIndex, nodes: &[NodeId]) {
        let affine = nodes.iter().all(|&node| self.is_affine(graph, node));
        if self.algebraics.len() <= index.position() {
            self.algebraics.resize(index.position() + 1, false);
        }
        self.algebraics[index.position()] = affine;
    }

    /// Whether `node` is affine, possibly constant.
    pub fn is_affine(&mut self, graph: &Graph, node: NodeId) -> bool {
        if self.known.len() < graph.len() {
            self.known.resize(graph.len(), None);
        }
        let (known, algebraics) = (&mut self.known, &self.algebraics);
        for &id in self.reach.beyond(graph, [node], |id| known[id.position()].is_some()) {
            known[id.position()] = Some(degree(graph, id, known, algebraics));
        }
        known[node.position()] != Some(Degree::Higher)
    }
}

/// The degree of a node whose operands are known.
fn degree(graph: &Graph, id: NodeId, known: &[Option<Degree>], algebraics: &[bool]) -> Degree {
    use Degree::{Affine, Constant, Higher};
    let of = |operand: NodeId| known[operand.position()].unwrap_or(Higher);
    let node = graph.node(id);
    if let Node::Leaf(leaf) = node {
        return match leaf {
            Leaf::State(_) | Leaf::Input(_) | Leaf::Time => Affine,
            Leaf::Algebraic(z) if algebraics.get(z.position()).copied().unwrap_or(false) => Affine,
            Leaf::Algebraic(_) => Higher,
            _ => Constant,
        };
    }
    let mut constant = true;
    graph.operands(id, |operand| constant &= of(operand) == Constant);
    if constant {
        return Constant;
    }
    let not_higher = |a: Degree, b: Degree| if a == Higher || b == Higher { Higher } else { Affine };
    match node {
        Node::Unary(Unary::Negate, a) => of(a),
        Node::Binary(Binary::Add | Binary::Subtract, a, b) => not_higher(of(a), of(b)),
        Node::Binary(Binary::Multiply, a, b) if of(a) == Constant || of(b) == Constant => {
            not_higher(of(a), of(b))
        }
        Node::Binary(Binary::Divide, a, b) if of(b) == Constant => of(a),
        Node::Select(condition, a, b) if of(condition) == Constant => not_higher(of(a), of(b)),
        _ => Higher,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use sophy_field::{ParameterIndex, StateIndex, TruthIndex};

    #[test]
    fn it_decides_as_affine_forms_do() {
        let mut g = Graph::default();
        let (x, y) = (g.leaf(Leaf::State(StateIndex(0))), g.leaf(Leaf::State(StateIndex(1))));
        let (p, b) = (g.leaf(Leaf::Parameter(ParameterIndex(0))), g.leaf(Leaf::Truth(TruthIndex(0))));
        let z = g.leaf(Leaf::Algebraic(AlgebraicIndex(0)));
        let mut nodes = vec![x, y, p, z];
        for _ in 0..2 {
            let before = nodes.clone();
            for &left in &before {
                let negated = g.unary(Unary::Negate, left);
                let sine = g.unary(Unary::Sin, left);
                let square = g.integer_power(left, 2);
                nodes.extend([negated, sine, square]);
                for &right in before.iter().take(6) {
                    let sum = g.add(left, right);
                    let (difference, product) = (g.subtract(left, right), g.multiply(left, right));
                    let (quotient, switch) = (g.divide(left, right), g.select(b, left, right));
                    nodes.extend([sum, difference, product, quotient, switch]);
                }
            }
        }
        let variable = |leaf: Leaf| matches!(leaf, Leaf::State(_) | Leaf::Algebraic(_));
        let mut linearity = Linearity::default();
        let sum = g.add(x, y);
        linearity.algebraic(&g, AlgebraicIndex(0), &[sum]);
        for &node in &nodes {
            let decided = linearity.is_affine(&g, node);
            assert_eq!(decided, g.affine(node, &variable).is_some(), "{node:?}");
        }
        // Through an algebraic variable that is not affine nothing is.
        let product = g.multiply(x, y);
        let mut linearity = Linearity::default();
        linearity.algebraic(&g, AlgebraicIndex(0), &[product]);
        let sum = g.add(x, z);
        assert!(!linearity.is_affine(&g, sum));
    }
}
