//! Nodes of a graph, those of copies of a component once: where a stretch of nodes repeats the one before it up to numbers
//! that go up by the same from copy to copy, it is computed.

use crate::graph::{Leaf, Node, NodeId};
use rustc_hash::{FxHashMap, FxHasher};
use sophy_field::{AlgebraicIndex, InputIndex, ParameterIndex, StairIndex, StateIndex, TruthIndex};
use std::hash::{Hash, Hasher};

/// A sequence of nodes that does not change any more.
#[derive(Clone, Debug, Default)]
pub(crate) struct Packed {
    stretches: Vec<Stretch>,
    nodes: Vec<Node>,
    /// By how much the numbers of nodes go up from copy to copy; only of stretches that repeat.
    strides: Vec<Numbers>,
    /// For each so many positions: the stretch that holds the first of them.
    index: Vec<u32>,
    length: u32,
}

/// Nodes at positions in a row: as they stand, or copies of the first ones.
#[derive(Clone, Copy, Debug)]
struct Stretch {
    start: u32,
    end: u32,
    /// Where its nodes begin.
    nodes: u32,
    /// Where their strides begin.
    strides: u32,
    /// How many nodes a copy has.
    period: u32,
    /// 2⁶⁴/period, rounded up: what is multiplied by it is divided by the period. 0 if nothing repeats.
    inverse: u64,
}

/// What an operation refers to: operands, or the index of a leaf.
type Numbers = [u32; 3];

/// Positions per entry of the index, as a power of two.
const INDEXED: u32 = 7;
/// So many nodes in a row must look alike before a repetition is tried.
const WINDOW: usize = 3;
/// The longest copy that is looked for.
const LONGEST: usize = 4096;
/// So many copies are worth it.
const LEAST_COPIES: usize = 4;

impl Packed {
    /// The nodes of a sequence.
    pub(crate) fn new(nodes: &[Node]) -> Self {
        let mut packed = Packed { length: nodes.len() as u32, ..Packed::default() };
        let mut seen: FxHashMap<u64, usize> = FxHashMap::default();
        let (mut plain, mut at) = (0, 0);
        while at + WINDOW <= nodes.len() {
            let before = seen.insert(look(&nodes[at..][..WINDOW]), at).filter(|&before| before >= plain);
            let period = before.map_or(0, |before| at - before);
            let copies =
                if period == 0 || period > LONGEST { 0 } else { copies(&nodes[at - period..], period) };
            if copies < LEAST_COPIES {
                at += 1;
                continue;
            }
            packed.stand(&nodes[plain..at - period], plain);
            packed.repeat(&nodes[at - period..][..2 * period], at - period, copies);
            at += (copies - 1) * period;
            plain = at;
        }
        packed.stand(&nodes[plain..], plain);
        packed.nodes.shrink_to_fit();
        packed.strides.shrink_to_fit();
        packed.find_index();
        packed
    }

    /// Nodes that stand as they are.
    fn stand(&mut self, nodes: &[Node], start: usize) {
        if !nodes.is_empty() {
            self.stretch(start, nodes.len(), 0);
            self.nodes.extend_from_slice(nodes);
        }
    }

    /// Nodes whose first two copies these are.
    fn repeat(&mut self, nodes: &[Node], start: usize, copies: usize) {
        let (first, second) = nodes.split_at(nodes.len() / 2);
        self.stretch(start, copies * first.len(), first.len() as u32);
        self.nodes.extend_from_slice(first);
        self.strides.extend(first.iter().zip(second).map(|(a, b)| stride(*a, *b)));
    }

    fn stretch(&mut self, start: usize, length: usize, period: u32) {
        self.stretches.push(Stretch {
            start: start as u32,
            end: (start + length) as u32,
            nodes: self.nodes.len() as u32,
            strides: self.strides.len() as u32,
            period,
            inverse: u64::MAX.checked_div(u64::from(period)).map_or(0, |inverse| inverse.saturating_add(1)),
        });
    }

    fn find_index(&mut self) {
        let mut stretch = 0;
        for block in 0..self.length.div_ceil(1 << INDEXED) {
            while self.stretches[stretch].end <= block << INDEXED {
                stretch += 1;
            }
            self.index.push(stretch as u32);
        }
    }

    pub(crate) fn len(&self) -> usize {
        self.length as usize
    }

    /// The node at a position.
    #[inline]
    pub(crate) fn node(&self, position: usize) -> Node {
        let at = position as u32;
        let mut stretch = &self.stretches[self.index[position >> INDEXED] as usize..];
        while at >= stretch[0].end {
            stretch = &stretch[1..];
        }
        let stretch = stretch[0];
        let behind = at - stretch.start;
        if stretch.inverse == 0 {
            return self.nodes[(stretch.nodes + behind) as usize];
        }
        let copy = ((u128::from(stretch.inverse) * u128::from(behind)) >> 64) as u32;
        let copy = if stretch.period == 1 { behind } else { copy };
        let place = behind - copy * stretch.period;
        let [a, b, c] = self.strides[(stretch.strides + place) as usize];
        shifted(
            self.nodes[(stretch.nodes + place) as usize],
            [a, b, c].map(|stride| stride.wrapping_mul(copy)),
        )
    }
}

/// How often the first `period` nodes are repeated, themselves included.
fn copies(nodes: &[Node], period: usize) -> usize {
    let alike = |at: usize| -> Option<bool> {
        let (first, second) = (nodes[at % period], *nodes.get(period + at % period)?);
        let node = *nodes.get(at)?;
        let copy = (at / period) as u32;
        Some(
            form(first) == form(second)
                && node == shifted(first, stride(first, second).map(|stride| stride.wrapping_mul(copy))),
        )
    };
    let count = (period..).take_while(|&at| alike(at) == Some(true)).count();
    1 + count / period
}

/// What nodes look like, whatever they refer to.
fn look(nodes: &[Node]) -> u64 {
    let mut hasher = FxHasher::default();
    nodes.iter().for_each(|&node| form(node).hash(&mut hasher));
    hasher.finish()
}

fn stride(from: Node, to: Node) -> Numbers {
    let (from, to) = (numbers(from), numbers(to));
    std::array::from_fn(|k| to[k].wrapping_sub(from[k]))
}

/// A node that refers to the first of everything.
fn form(node: Node) -> Node {
    let numbers = numbers(node);
    shifted(node, numbers.map(u32::wrapping_neg))
}

/// What a node refers to.
fn numbers(node: Node) -> Numbers {
    let of = |id: NodeId| id.position() as u32;
    match node {
        Node::Number(_) | Node::Boolean(_) => [0; 3],
        Node::Leaf(leaf) => [index(leaf), 0, 0],
        Node::Unary(_, a) | Node::IntegerPower(a, _) | Node::Not(a) => [of(a), 0, 0],
        Node::Locate(_, a) | Node::Lookup(_, a) => [of(a), 0, 0],
        Node::Binary(_, a, b) | Node::Compare(_, a, b) | Node::And(a, b) | Node::Or(a, b) => {
            [of(a), of(b), 0]
        }
        Node::Select(a, b, c) => [of(a), of(b), of(c)],
    }
}

fn index(leaf: Leaf) -> u32 {
    match leaf {
        Leaf::Parameter(ParameterIndex(i))
        | Leaf::State(StateIndex(i))
        | Leaf::Input(InputIndex(i))
        | Leaf::Algebraic(AlgebraicIndex(i))
        | Leaf::Truth(TruthIndex(i))
        | Leaf::Stair(StairIndex(i)) => i,
        Leaf::Variable(_) | Leaf::Special(_) | Leaf::Time => 0,
    }
}

/// A node that refers to what stands so much further on.
fn shifted(node: Node, [a1, b1, c1]: Numbers) -> Node {
    let to = |id: NodeId, by: u32| NodeId::new((id.position() as u32).wrapping_add(by) as usize);
    match node {
        Node::Number(_) | Node::Boolean(_) => node,
        Node::Leaf(leaf) => Node::Leaf(shifted_leaf(leaf, a1)),
        Node::Unary(function, a) => Node::Unary(function, to(a, a1)),
        Node::IntegerPower(a, n) => Node::IntegerPower(to(a, a1), n),
        Node::Not(a) => Node::Not(to(a, a1)),
        Node::Locate(column, a) => Node::Locate(column, to(a, a1)),
        Node::Lookup(column, a) => Node::Lookup(column, to(a, a1)),
        Node::Binary(function, a, b) => Node::Binary(function, to(a, a1), to(b, b1)),
        Node::Compare(comparison, a, b) => Node::Compare(comparison, to(a, a1), to(b, b1)),
        Node::And(a, b) => Node::And(to(a, a1), to(b, b1)),
        Node::Or(a, b) => Node::Or(to(a, a1), to(b, b1)),
        Node::Select(a, b, c) => Node::Select(to(a, a1), to(b, b1), to(c, c1)),
    }
}

fn shifted_leaf(leaf: Leaf, by: u32) -> Leaf {
    match leaf {
        Leaf::Parameter(ParameterIndex(i)) => Leaf::Parameter(ParameterIndex(i.wrapping_add(by))),
        Leaf::State(StateIndex(i)) => Leaf::State(StateIndex(i.wrapping_add(by))),
        Leaf::Input(InputIndex(i)) => Leaf::Input(InputIndex(i.wrapping_add(by))),
        Leaf::Algebraic(AlgebraicIndex(i)) => Leaf::Algebraic(AlgebraicIndex(i.wrapping_add(by))),
        Leaf::Truth(TruthIndex(i)) => Leaf::Truth(TruthIndex(i.wrapping_add(by))),
        Leaf::Stair(StairIndex(i)) => Leaf::Stair(StairIndex(i.wrapping_add(by))),
        Leaf::Variable(_) | Leaf::Special(_) | Leaf::Time => leaf,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::arithmetic::{Binary, Unary};
    use proptest::prelude::*;

    fn node(kind: u8, a: u32, b: u32) -> Node {
        let id = |k: u32| NodeId::new(k as usize);
        match kind % 7 {
            0 => Node::Leaf(Leaf::State(StateIndex(a))),
            1 => Node::Leaf(Leaf::Time),
            2 => Node::Number(u64::from(b % 3)),
            3 => Node::Unary(Unary::Sin, id(a)),
            4 => Node::Binary(Binary::Add, id(a), id(b)),
            5 => Node::Select(id(a), id(b), id(a + b)),
            _ => Node::IntegerPower(id(b), (a % 2) as i32),
        }
    }

    proptest! {
        /// What is packed is what was given: copies, copies with something between, and nothing that repeats.
        #[test]
        fn nodes_are_what_they_were(
            parts in prop::collection::vec(
                (prop::collection::vec((any::<u8>(), 0..9_u32, 0..9_u32), 1..6), 1..40_u32, 0..3_u32),
                0..6,
            )
        ) {
            let mut nodes = Vec::new();
            for (pattern, copies, stride) in parts {
                for copy in 0..copies {
                    nodes.extend(pattern.iter().map(|&(kind, a, b)| node(kind, a + copy * stride, b + 2 * copy)));
                }
            }
            let packed = Packed::new(&nodes);
            prop_assert_eq!(packed.len(), nodes.len());
            for (position, &node) in nodes.iter().enumerate() {
                prop_assert_eq!(packed.node(position), node, "at {}", position);
            }
        }
    }

    #[test]
    fn copies_stand_once() {
        let copy = |k: u32| [node(0, k, 0), node(3, 4 * k, 0), node(4, 4 * k, 4 * k + 1), node(2, 0, 1)];
        let nodes: Vec<Node> = (0..10_000).flat_map(copy).collect();
        let packed = Packed::new(&nodes);
        assert!(packed.nodes.len() < 20, "{}", packed.nodes.len());
        assert_eq!(packed.node(39_998), nodes[39_998]);
    }
}
