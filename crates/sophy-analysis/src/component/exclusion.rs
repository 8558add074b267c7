//! Which two conditions of rules never become true at one instant, so far as their form shows it.

use super::Builder;
use sophy_ir::{Comparison, Leaf, Node, NodeId, Special, VariableKind};

/// Parts of a conjunction that are looked at.
const MOST_PARTS: usize = 16;

/// A quantity compared with a number.
#[derive(Clone, Copy)]
struct Compared {
    quantity: NodeId,
    comparison: Comparison,
    level: f64,
}

impl Builder<'_, '_> {
    /// Whether the rules with these conditions cannot act together: some part of one excludes a part of the other, or
    /// they watch for two levels of one continuous quantity.
    pub(super) fn never_meet(&self, a: NodeId, b: NodeId) -> bool {
        let (left, right) = (self.conjuncts(a), self.conjuncts(b));
        left.iter().any(|&a| right.iter().any(|&b| self.exclude(a, b)))
            || self.compared(a).zip(self.compared(b)).is_some_and(|(a, b)| {
                a.quantity == b.quantity && a.level != b.level && self.is_continuous(a.quantity)
            })
    }

    fn conjuncts(&self, condition: NodeId) -> Vec<NodeId> {
        let mut parts = Vec::new();
        let mut pending = vec![condition];
        while let Some(node) = pending.pop() {
            match self.graph.node(node) {
                Node::And(a, b) if parts.len() + pending.len() < MOST_PARTS => pending.extend([a, b]),
                _ => parts.push(node),
            }
        }
        parts
    }

    fn exclude(&self, a: NodeId, b: NodeId) -> bool {
        match (self.graph.node(a), self.graph.node(b)) {
            (Node::Not(not), _) if not == b => true,
            (_, Node::Not(not)) if not == a => true,
            (Node::Leaf(Leaf::Special(a)), Node::Leaf(Leaf::Special(b))) => {
                let special = |k: u32| self.specials.get(k as usize);
                match (special(a), special(b)) {
                    (Some(Special::Rises(a)), Some(Special::Falls(b)))
                    | (Some(Special::Falls(a)), Some(Special::Rises(b))) => a == b,
                    _ => false,
                }
            }
            _ => self.compared(a).zip(self.compared(b)).is_some_and(|(a, b)| {
                a.quantity == b.quantity && disjoint((a.comparison, a.level), (b.comparison, b.level))
            }),
        }
    }

    fn compared(&self, node: NodeId) -> Option<Compared> {
        let Node::Compare(comparison, a, b) = self.graph.node(node) else { return None };
        match (self.known_value(a), self.known_value(b)) {
            (None, Some(level)) => Some(Compared { quantity: a, comparison, level }),
            (Some(level), None) => Some(Compared { quantity: b, comparison: mirrored(comparison), level }),
            _ => None,
        }
    }

    /// Whether a quantity takes its values one after the other, resets apart.
    fn is_continuous(&self, quantity: NodeId) -> bool {
        self.graph.dependencies([quantity]).into_iter().all(|leaf| match leaf {
            Leaf::Time => true,
            Leaf::Variable(id) => self.variables.get(id.0 as usize).is_some_and(|variable| {
                matches!(
                    variable.kind,
                    VariableKind::State(_)
                        | VariableKind::Parameter { .. }
                        | VariableKind::Input { continuous: true }
                )
            }),
            _ => false,
        })
    }
}

/// `2 < x` is `x > 2`.
fn mirrored(comparison: Comparison) -> Comparison {
    use Comparison::{Equal, Greater, GreaterEqual, Less, LessEqual, NotEqual};
    match comparison {
        Less => Greater,
        LessEqual => GreaterEqual,
        Greater => Less,
        GreaterEqual => LessEqual,
        Equal => Equal,
        NotEqual => NotEqual,
    }
}

/// Whether no number compares so with both levels.
fn disjoint(a: (Comparison, f64), b: (Comparison, f64)) -> bool {
    use Comparison::{Equal, Greater, GreaterEqual, Less, LessEqual, NotEqual};
    // The least and greatest number, and whether they are among them.
    let interval = |(comparison, level): (Comparison, f64)| match comparison {
        Less => Some(((f64::NEG_INFINITY, true), (level, false))),
        LessEqual => Some(((f64::NEG_INFINITY, true), (level, true))),
        Greater => Some(((level, false), (f64::INFINITY, true))),
        GreaterEqual => Some(((level, true), (f64::INFINITY, true))),
        Equal => Some(((level, true), (level, true))),
        NotEqual => None,
    };
    let ends_before = |(high, high_in): (f64, bool), (low, low_in): (f64, bool)| {
        high < low || (high == low && !(high_in && low_in))
    };
    match (interval(a), interval(b)) {
        (Some((a_low, a_high)), Some((b_low, b_high))) => {
            ends_before(a_high, b_low) || ends_before(b_high, a_low)
        }
        _ => a.1 == b.1 && matches!((a.0, b.0), (Equal, NotEqual) | (NotEqual, Equal)),
    }
}
