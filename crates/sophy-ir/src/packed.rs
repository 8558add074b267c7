//! What copies of a component repeat stands once: nodes of a graph, connections. Where a stretch of items repeats the one
//! before it up to numbers that go up by the same from copy to copy, it is computed.

use crate::graph::{Leaf, Node, NodeId};
use rustc_hash::{FxHashMap, FxHasher};
use sophy_field::{AlgebraicIndex, InputIndex, ParameterIndex, StairIndex, StateIndex, TruthIndex};
use std::hash::{Hash, Hasher};

/// What may repeat.
pub(crate) trait Repeat: Clone + PartialEq {
    /// The numbers that go up from copy to copy.
    fn numbers(&self) -> Numbers;

    /// The same with numbers that are so much larger, modulo 2³².
    fn shifted(&self, by: Numbers) -> Self;

    /// What tells it from others, whatever its numbers.
    fn look(&self, hasher: &mut FxHasher);

    /// The same with numbers that are 0.
    fn form(&self) -> Self {
        self.shifted(self.numbers().map(u32::wrapping_neg))
    }
}

/// A sequence of items that does not change any more.
#[derive(Clone, Debug)]
pub(crate) struct Packed<T> {
    stretches: Vec<Stretch>,
    items: Vec<T>,
    /// By how much the numbers of items go up from copy to copy; only of stretches that repeat.
    strides: Vec<Numbers>,
    /// For each so many positions: the stretch that holds the first of them.
    index: Vec<u32>,
    length: u32,
}

impl<T> Default for Packed<T> {
    fn default() -> Self {
        Packed { stretches: Vec::new(), items: Vec::new(), strides: Vec::new(), index: Vec::new(), length: 0 }
    }
}

/// Items at positions in a row: as they stand, or copies of the first ones.
#[derive(Clone, Copy, Debug)]
struct Stretch {
    start: u32,
    end: u32,
    /// Where its items begin.
    items: u32,
    /// Where their strides begin.
    strides: u32,
    /// How many items a copy has.
    period: u32,
    /// 2⁶⁴/period, rounded up: what is multiplied by it is divided by the period. 0 if nothing repeats.
    inverse: u64,
}

/// Numbers of an item: of a node what it refers to, operands or the index of a leaf.
pub(crate) type Numbers = [u32; 3];

/// Positions per entry of the index, as a power of two.
const INDEXED: u32 = 7;
/// So many items in a row must look alike before a repetition is tried.
const WINDOW: usize = 3;
/// The longest copy that is looked for.
const LONGEST: usize = 4096;
/// So many items of a copy may look alike.
const MOST_ALIKE: usize = 4;
/// So many copies are worth it.
const LEAST_COPIES: usize = 4;

impl<T: Repeat> Packed<T> {
    /// The items of a sequence.
    pub(crate) fn new(items: &[T]) -> Self {
        let mut packed = Packed { length: items.len() as u32, ..Packed::default() };
        let mut seen: FxHashMap<u64, usize> = FxHashMap::default();
        let (mut plain, mut at) = (0, 0);
        while at + WINDOW <= items.len() {
            let before = seen.insert(look(&items[at..][..WINDOW]), at).filter(|&before| before >= plain);
            // What looks like the one before may be alike only to every second or third.
            let periods =
                before.into_iter().flat_map(|before| (1..=MOST_ALIKE).map(move |k| k * (at - before)));
            let periods = periods.take_while(|&period| period <= LONGEST && plain + period <= at);
            let mut found = periods.map(|period| (period, copies(&items[at - period..], period)));
            let Some((period, copies)) = found.find(|&(_, copies)| copies >= LEAST_COPIES) else {
                at += 1;
                continue;
            };
            packed.stand(&items[plain..at - period], plain);
            packed.repeat(&items[at - period..][..2 * period], at - period, copies);
            at += (copies - 1) * period;
            plain = at;
        }
        packed.stand(&items[plain..], plain);
        packed.items.shrink_to_fit();
        packed.strides.shrink_to_fit();
        packed.find_index();
        packed
    }

    /// Items that stand as they are.
    fn stand(&mut self, items: &[T], start: usize) {
        if !items.is_empty() {
            self.stretch(start, items.len(), 0);
            self.items.extend_from_slice(items);
        }
    }

    /// Items whose first two copies these are.
    fn repeat(&mut self, items: &[T], start: usize, copies: usize) {
        let (first, second) = items.split_at(items.len() / 2);
        self.stretch(start, copies * first.len(), first.len() as u32);
        self.items.extend_from_slice(first);
        self.strides.extend(first.iter().zip(second).map(|(a, b)| stride(a, b)));
    }

    fn stretch(&mut self, start: usize, length: usize, period: u32) {
        self.stretches.push(Stretch {
            start: start as u32,
            end: (start + length) as u32,
            items: self.items.len() as u32,
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

    /// The item at a position.
    #[inline]
    pub(crate) fn at(&self, position: usize) -> T {
        let at = position as u32;
        let mut stretch = &self.stretches[self.index[position >> INDEXED] as usize..];
        while at >= stretch[0].end {
            stretch = &stretch[1..];
        }
        let stretch = stretch[0];
        let behind = at - stretch.start;
        if stretch.inverse == 0 {
            return self.items[(stretch.items + behind) as usize].clone();
        }
        let copy = ((u128::from(stretch.inverse) * u128::from(behind)) >> 64) as u32;
        let copy = if stretch.period == 1 { behind } else { copy };
        let place = behind - copy * stretch.period;
        let [a, b, c] = self.strides[(stretch.strides + place) as usize];
        let item = &self.items[(stretch.items + place) as usize];
        item.shifted([a, b, c].map(|stride| stride.wrapping_mul(copy)))
    }
}

/// How often the first `period` items are repeated, themselves included.
fn copies<T: Repeat>(items: &[T], period: usize) -> usize {
    let alike = |at: usize| -> Option<bool> {
        let (first, second) = (&items[at % period], items.get(period + at % period)?);
        let item = items.get(at)?;
        let copy = (at / period) as u32;
        let by = stride(first, second).map(|stride| stride.wrapping_mul(copy));
        Some(first.form() == second.form() && *item == first.shifted(by))
    };
    let count = (period..).take_while(|&at| alike(at) == Some(true)).count();
    1 + count / period
}

/// What items look like, whatever their numbers.
fn look<T: Repeat>(items: &[T]) -> u64 {
    let mut hasher = FxHasher::default();
    items.iter().for_each(|item| item.look(&mut hasher));
    hasher.finish()
}

fn stride<T: Repeat>(from: &T, to: &T) -> Numbers {
    let (from, to) = (from.numbers(), to.numbers());
    std::array::from_fn(|k| to[k].wrapping_sub(from[k]))
}

impl Repeat for Node {
    #[inline]
    fn numbers(&self) -> Numbers {
        let of = |id: NodeId| id.position() as u32;
        match *self {
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

    #[inline]
    fn shifted(&self, [a1, b1, c1]: Numbers) -> Self {
        let to = |id: NodeId, by: u32| NodeId::new((id.position() as u32).wrapping_add(by) as usize);
        match *self {
            node @ (Node::Number(_) | Node::Boolean(_)) => node,
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

    fn look(&self, hasher: &mut FxHasher) {
        self.form().hash(hasher);
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
                prop_assert_eq!(packed.at(position), node, "at {}", position);
            }
        }
    }

    #[test]
    fn copies_stand_once() {
        let copy = |k: u32| [node(0, k, 0), node(3, 4 * k, 0), node(4, 4 * k, 4 * k + 1), node(2, 0, 1)];
        let nodes: Vec<Node> = (0..10_000).flat_map(copy).collect();
        let packed = Packed::new(&nodes);
        assert!(packed.items.len() < 20, "{}", packed.items.len());
        assert_eq!(packed.at(39_998), nodes[39_998]);
    }
}
