//! When what happens next.

/// A 4-ary heap of times and slots with the keys in its nodes; ties go to the smaller slot.
///
/// Slots are numbered by the engine: states first, then watches, then timers. A slot without a time is not in
/// the heap.
#[derive(Clone, Debug, Default)]
pub struct Agenda {
    heap: Vec<Node>,
    /// Position of each slot in the heap, or `ABSENT`.
    position: Vec<u32>,
}

/// A time and a slot as one number, which orders nodes: above 64 bits the time, as an integer of the same order.
type Node = i128;

const ABSENT: u32 = u32::MAX;
const ARITY: usize = 4;

impl Agenda {
    /// An agenda of `slots` slots, all without a time.
    pub fn new(slots: usize) -> Self {
        Agenda { heap: Vec::with_capacity(slots), position: vec![ABSENT; slots] }
    }

    /// The earliest time and its slot.
    #[inline]
    pub fn first(&self) -> Option<(f64, u32)> {
        self.heap.first().map(|&node| (time_of(node), slot_of(node)))
    }

    /// The time of a slot; infinite if it has none.
    #[inline]
    pub fn time(&self, slot: u32) -> f64 {
        match self.position[slot as usize] {
            ABSENT => f64::INFINITY,
            position => time_of(self.heap[position as usize]),
        }
    }

    /// Gives a slot a time; an infinite one takes it off the agenda. `time` must not be NaN.
    #[inline]
    pub fn set(&mut self, slot: u32, time: f64) {
        let mut position = self.position[slot as usize] as usize;
        let finite = time < f64::INFINITY;
        if position == ABSENT as usize || !finite {
            match (position == ABSENT as usize, finite) {
                (true, false) => return,
                (false, _) => return self.remove(position),
                (true, true) => {
                    position = self.heap.len();
                    self.heap.push(Node::MAX);
                }
            }
        }
        let node = node(time, slot);
        if node < self.heap[position] { self.rise(position, node) } else { self.sink(position, node) }
    }

    #[cold]
    fn remove(&mut self, position: usize) {
        self.position[slot_of(self.heap[position]) as usize] = ABSENT;
        let Some(last) = self.heap.pop() else { return };
        if position < self.heap.len() {
            if last < self.heap[position] { self.rise(position, last) } else { self.sink(position, last) }
        }
    }

    #[inline]
    fn rise(&mut self, mut position: usize, node: Node) {
        while position > 0 {
            let parent = (position - 1) / ARITY;
            let above = self.heap[parent];
            if node >= above {
                break;
            }
            self.place(position, above);
            position = parent;
        }
        self.place(position, node);
    }

    #[inline]
    fn sink(&mut self, mut position: usize, node: Node) {
        loop {
            let first = position * ARITY + 1;
            // Which child is the least cannot be foreseen: it is chosen without branches.
            let (least, at) = match self.heap.get(first..) {
                Some(&[a, b, c, d, ..]) => {
                    let (left, at_left) = if b < a { (b, 1) } else { (a, 0) };
                    let (right, at_right) = if d < c { (d, 3) } else { (c, 2) };
                    if right < left { (right, first + at_right) } else { (left, first + at_left) }
                }
                Some(&[a, ref others @ ..]) => {
                    others.iter().zip(first + 1..).fold((a, first), |least, (&node, at)| {
                        if node < least.0 { (node, at) } else { least }
                    })
                }
                _ => break,
            };
            if least >= node {
                break;
            }
            self.place(position, least);
            position = at;
        }
        self.place(position, node);
    }

    #[inline]
    fn place(&mut self, position: usize, node: Node) {
        self.heap[position] = node;
        self.position[slot_of(node) as usize] = position as u32;
    }
}

#[inline]
fn node(time: f64, slot: u32) -> Node {
    // −0 and 0 are one time.
    (Node::from(ordered((time + 0.0).to_bits() as i64)) << 64) | Node::from(slot)
}

#[inline]
fn time_of(node: Node) -> f64 {
    f64::from_bits(ordered((node >> 64) as i64) as u64)
}

#[inline]
fn slot_of(node: Node) -> u32 {
    node as u32
}

/// Bits of a float as an integer of the same order, and back.
#[inline]
fn ordered(bits: i64) -> i64 {
    bits ^ (((bits >> 63) as u64) >> 1) as i64
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn the_first_is_the_least_of_all(
            changes in prop::collection::vec((0u32..12, prop_oneof![4 => 0u8..20, 1 => Just(255u8)]), 1..200)
        ) {
            let mut agenda = Agenda::new(12);
            let mut plain = [f64::INFINITY; 12];
            for (slot, time) in changes {
                let time = if time == 255 { f64::INFINITY } else { f64::from(time) - 5.0 };
                agenda.set(slot, time);
                plain[slot as usize] = time;
                let least = (0..12u32).filter(|&s| plain[s as usize] < f64::INFINITY)
                    .min_by(|&a, &b| plain[a as usize].total_cmp(&plain[b as usize]).then(a.cmp(&b)));
                prop_assert_eq!(agenda.first(), least.map(|s| (plain[s as usize], s)));
                for s in 0..12 {
                    prop_assert_eq!(agenda.time(s), plain[s as usize]);
                }
            }
        }
    }
}
