use crate::arithmetic::{Binary, Unary};
use crate::graph::{Graph, Leaf, Node, NodeId};
use rustc_hash::FxHashMap;
use std::collections::BTreeMap;

/// Σ coefficient·leaf + constant; coefficients and constant do not depend on the variables.
#[derive(Clone, Debug, PartialEq)]
pub struct Affine {
    /// The variables that occur, with their coefficients.
    pub terms: BTreeMap<Leaf, NodeId>,
    /// The rest; `None` is zero.
    pub constant: Option<NodeId>,
}

impl Graph {
    /// `root` as an affine form in the leaves for which `is_variable` holds, if it is one.
    ///
    /// Recognised structurally: sums, differences, products and quotients with what does not depend on a
    /// variable, and switches between affine forms whose condition does not either. `x·x − x·x` is not affine
    /// here, though it is 0.
    pub fn affine(&mut self, root: NodeId, is_variable: &impl Fn(Leaf) -> bool) -> Option<Affine> {
        let order = self.reachable([root]);
        let mut forms = Forms::default();
        for &id in &order {
            self.operands(id, |operand| *forms.uses.entry(operand).or_default() += 1);
        }
        for id in order {
            let form = self.node_affine(id, &mut forms, is_variable);
            forms.known.insert(id, form);
        }
        forms.known.remove(&root).flatten()
    }

    fn node_affine(
        &mut self,
        id: NodeId,
        forms: &mut Forms,
        is_variable: &impl Fn(Leaf) -> bool,
    ) -> Option<Affine> {
        let node = self.node(id);
        if let Node::Leaf(leaf) = node
            && is_variable(leaf)
        {
            let one = self.number(1.0);
            return Some(Affine { terms: BTreeMap::from([(leaf, one)]), constant: None });
        }
        let mut constant = true;
        self.operands(id, |operand| constant &= forms.is_constant(operand));
        if constant {
            return Some(Affine { terms: BTreeMap::new(), constant: Some(id) });
        }
        let mut form = |operand: NodeId| forms.take(operand);
        match node {
            Node::Unary(Unary::Negate, a) => {
                let a = form(a)?;
                Some(self.scale(a, |graph, c| graph.unary(Unary::Negate, c)))
            }
            Node::Binary(Binary::Add, a, b) => Some(self.combine(form(a)?, form(b)?, Binary::Add)),
            Node::Binary(Binary::Subtract, a, b) => Some(self.combine(form(a)?, form(b)?, Binary::Subtract)),
            Node::Binary(Binary::Multiply, a, b) => {
                let (left, right) = (form(a)?, form(b)?);
                if left.terms.is_empty() {
                    Some(self.scale(right, |graph, c| graph.multiply(a, c)))
                } else if right.terms.is_empty() {
                    Some(self.scale(left, |graph, c| graph.multiply(c, b)))
                } else {
                    None
                }
            }
            Node::Binary(Binary::Divide, a, b) => {
                let (above, below) = (form(a)?, form(b)?);
                below.terms.is_empty().then(|| self.scale(above, |graph, c| graph.divide(c, b)))
            }
            Node::Select(condition, a, b) => {
                let (left, right) = (form(a)?, form(b)?);
                form(condition)?.terms.is_empty().then(|| self.switch(condition, &left, &right))
            }
            _ => None,
        }
    }

    fn switch(&mut self, condition: NodeId, left: &Affine, right: &Affine) -> Affine {
        let zero = self.number(0.0);
        let leaves: std::collections::BTreeSet<Leaf> =
            left.terms.keys().chain(right.terms.keys()).copied().collect();
        let mut select = |a: Option<NodeId>, b: Option<NodeId>| {
            self.select(condition, a.unwrap_or(zero), b.unwrap_or(zero))
        };
        Affine {
            terms: leaves
                .into_iter()
                .map(|leaf| (leaf, select(left.terms.get(&leaf).copied(), right.terms.get(&leaf).copied())))
                .collect(),
            constant: Some(select(left.constant, right.constant)),
        }
    }

    fn scale(&mut self, form: Affine, by: impl Fn(&mut Graph, NodeId) -> NodeId) -> Affine {
        Affine {
            terms: form.terms.into_iter().map(|(leaf, c)| (leaf, by(self, c))).collect(),
            constant: form.constant.map(|c| by(self, c)),
        }
    }

    fn combine(&mut self, mut left: Affine, right: Affine, how: Binary) -> Affine {
        let join = |graph: &mut Graph, a: Option<NodeId>, b: NodeId| match (a, how) {
            (Some(a), _) => graph.binary(how, a, b),
            (None, Binary::Subtract) => graph.unary(Unary::Negate, b),
            (None, _) => b,
        };
        if how == Binary::Add && left.terms.len() < right.terms.len() {
            // The shorter into the longer: a sum of many terms may lean to either side.
            let shorter = std::mem::replace(&mut left.terms, right.terms);
            for (leaf, coefficient) in shorter {
                let joined = match left.terms.get(&leaf) {
                    Some(&other) => self.add(coefficient, other),
                    None => coefficient,
                };
                left.terms.insert(leaf, joined);
            }
        } else {
            for (leaf, coefficient) in right.terms {
                let joined = join(self, left.terms.get(&leaf).copied(), coefficient);
                left.terms.insert(leaf, joined);
            }
        }
        if let Some(constant) = right.constant {
            left.constant = Some(join(self, left.constant, constant));
        }
        left
    }
}

/// The forms of the nodes of one expression; each is given away at its last use, so that a sum of many terms
/// is not copied for each of them.
#[derive(Default)]
struct Forms {
    known: FxHashMap<NodeId, Option<Affine>>,
    uses: FxHashMap<NodeId, u32>,
}

impl Forms {
    fn is_constant(&self, node: NodeId) -> bool {
        self.known.get(&node).is_some_and(|form| form.as_ref().is_some_and(|form| form.terms.is_empty()))
    }

    fn take(&mut self, node: NodeId) -> Option<Affine> {
        let uses = self.uses.entry(node).or_default();
        *uses = uses.saturating_sub(1);
        if *uses == 0 { self.known.remove(&node).flatten() } else { self.known.get(&node).cloned().flatten() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use sophy_field::{ParameterIndex, StateIndex};

    #[test]
    fn affine_forms_are_recognised() {
        let mut g = Graph::default();
        let (x, y) = (g.leaf(Leaf::State(StateIndex(0))), g.leaf(Leaf::State(StateIndex(1))));
        let p = g.leaf(Leaf::Parameter(ParameterIndex(0)));
        let is_state = |leaf: Leaf| matches!(leaf, Leaf::State(_));
        let (three, two) = (g.number(3.0), g.number(2.0));
        // 3·x + p·(y − 2)/p − x
        let inner = g.subtract(y, two);
        let scaled = g.multiply(p, inner);
        let scaled = g.divide(scaled, p);
        let triple = g.multiply(three, x);
        let sum = g.add(triple, scaled);
        let form = g.subtract(sum, x);
        let affine = g.affine(form, &is_state).expect("affine");
        assert_eq!(affine.terms.len(), 2);
        assert_eq!(g.as_number(affine.terms[&Leaf::State(StateIndex(0))]), Some(2.0));
        let product = g.multiply(x, y);
        assert_eq!(g.affine(product, &is_state), None);
        let quotient = g.divide(p, x);
        assert_eq!(g.affine(quotient, &is_state), None);
        let constant = g.unary(Unary::Sin, p);
        assert!(g.affine(constant, &is_state).expect("constant").terms.is_empty());
    }
}
