//! What copies of a component repeat stands once: nodes of a graph, connections, states, transitions. Where a stretch of
//! items repeats the one before it up to numbers that go up by the same from copy to copy, it is computed.

use rustc_hash::{FxHashMap, FxHasher};
use std::hash::Hasher;
use std::iter;

/// What may repeat.
pub trait Repeat: Clone + PartialEq {
    /// The same with each of its numbers replaced: those that go up from copy to copy, always in the same order.
    fn renumbered(&self, number: impl FnMut(u32) -> u32) -> Self;

    /// What tells it from most others, whatever its numbers.
    fn look(&self, hasher: &mut FxHasher);
}

/// A sequence of items that does not change any more.
#[derive(Clone, Debug)]
pub(crate) struct Packed<T> {
    stretches: Vec<Stretch>,
    items: Vec<T>,
    /// By how much the numbers of items go up from copy to copy; only of stretches that repeat.
    strides: Vec<u32>,
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
    /// How many strides an item has.
    width: u32,
    /// How many items a copy has.
    period: u32,
    /// 2⁶⁴/period, rounded up: what is multiplied by it is divided by the period. 0 if nothing repeats.
    inverse: u64,
}

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
            self.stretch(start, items.len(), 0, 0);
            self.items.extend_from_slice(items);
        }
    }

    /// Items whose first two copies these are.
    fn repeat(&mut self, items: &[T], start: usize, copies: usize) {
        let (first, second) = items.split_at(items.len() / 2);
        let strides: Vec<_> = first.iter().zip(second).map(|(a, b)| strides(a, b)).collect();
        let width = strides.iter().map(Vec::len).max().unwrap_or_default();
        self.stretch(start, copies * first.len(), first.len() as u32, width as u32);
        self.items.extend_from_slice(first);
        for of_item in strides {
            self.strides.extend(of_item.into_iter().chain(iter::repeat(0)).take(width));
        }
    }

    fn stretch(&mut self, start: usize, length: usize, period: u32, width: u32) {
        self.stretches.push(Stretch {
            start: start as u32,
            end: (start + length) as u32,
            items: self.items.len() as u32,
            strides: self.strides.len() as u32,
            width,
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
        let (stretch, place, copy) = self.find(position);
        let item = &self.items[(stretch.items + place) as usize];
        if copy == 0 {
            return item.clone();
        }
        shifted(item, &self.strides[(stretch.strides + place * stretch.width) as usize..], copy)
    }

    /// An item like that at a position but for its numbers.
    pub(crate) fn pattern(&self, position: usize) -> &T {
        let (stretch, place, _) = self.find(position);
        &self.items[(stretch.items + place) as usize]
    }

    /// The stretch of a position, which of its items is there, and in which copy.
    #[inline]
    fn find(&self, position: usize) -> (Stretch, u32, u32) {
        let at = position as u32;
        let mut stretch = &self.stretches[self.index[position >> INDEXED] as usize..];
        while at >= stretch[0].end {
            stretch = &stretch[1..];
        }
        let stretch = stretch[0];
        let behind = at - stretch.start;
        let copy = match stretch.period {
            1 => behind,
            _ => ((u128::from(stretch.inverse) * u128::from(behind)) >> 64) as u32,
        };
        (stretch, behind - copy * stretch.period, copy)
    }
}

/// How often the first `period` items are repeated, themselves included.
fn copies<T: Repeat>(items: &[T], period: usize) -> usize {
    let mut by = Vec::with_capacity(period);
    for place in 0..period {
        let (first, second) = (&items[place], items.get(period + place));
        let Some(second) = second.filter(|second| form(first) == form(second)) else { return 1 };
        by.push(strides(first, second));
    }
    let repeats = |(at, item): (usize, &T)| {
        let (place, copy) = (at % period, (at / period) as u32);
        *item == shifted(&items[place], &by[place], copy)
    };
    let count = items.iter().enumerate().skip(2 * period).take_while(|&item| repeats(item)).count();
    2 + count / period
}

/// The same with numbers that are 0.
fn form<T: Repeat>(item: &T) -> T {
    item.renumbered(|_| 0)
}

/// So many copies later: its numbers have gone up by the strides so often, modulo 2³².
#[inline]
fn shifted<T: Repeat>(item: &T, strides: &[u32], copies: u32) -> T {
    let mut strides = strides.iter();
    item.renumbered(|number| number.wrapping_add(strides.next().map_or(0, |by| by.wrapping_mul(copies))))
}

fn strides<T: Repeat>(from: &T, to: &T) -> Vec<u32> {
    let numbers = |item: &T| {
        let mut numbers = Vec::new();
        item.renumbered(|number| {
            numbers.push(number);
            number
        });
        numbers
    };
    numbers(from).into_iter().zip(numbers(to)).map(|(from, to)| to.wrapping_sub(from)).collect()
}

/// What items look like, whatever their numbers.
fn look<T: Repeat>(items: &[T]) -> u64 {
    let mut hasher = FxHasher::default();
    items.iter().for_each(|item| item.look(&mut hasher));
    hasher.finish()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::arithmetic::{Binary, Unary};
    use crate::graph::{Leaf, Node, NodeId};
    use proptest::prelude::*;
    use sophy_field::StateIndex;

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
