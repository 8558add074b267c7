//! When what happens next.

/// A 4-ary heap of `(time, slot)` with the keys in its nodes; ties go to the smaller slot.
///
/// Slots are numbered by the engine: states first, then watches, then timers. A slot without a time is not in
/// the heap.
#[derive(Clone, Debug, Default)]
pub struct Agenda {
    heap: Vec<(f64, u32)>,
    /// Position of each slot in the heap, or `ABSENT`.
    position: Vec<u32>,
}

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
        self.heap.first().copied()
    }

    /// The time of a slot; infinite if it has none.
    #[inline]
    pub fn time(&self, slot: u32) -> f64 {
        match self.position[slot as usize] {
            ABSENT => f64::INFINITY,
            position => self.heap[position as usize].0,
        }
    }

    /// Gives a slot a time; an infinite one takes it off the agenda. `time` must not be NaN.
    #[inline]
    pub fn set(&mut self, slot: u32, time: f64) {
        let position = self.position[slot as usize];
        if position == ABSENT {
            if time < f64::INFINITY {
                self.heap.push((time, slot));
                self.rise(self.heap.len() - 1, (time, slot));
            }
            return;
        }
        let position = position as usize;
        if time < f64::INFINITY {
            if earlier((time, slot), self.heap[position]) {
                self.rise(position, (time, slot));
            } else {
                self.sink(position, (time, slot));
            }
        } else {
            self.remove(position);
        }
    }

    fn remove(&mut self, position: usize) {
        let (_, slot) = self.heap[position];
        self.position[slot as usize] = ABSENT;
        let Some(last) = self.heap.pop() else { return };
        if position < self.heap.len() {
            if earlier(last, self.heap[position]) {
                self.rise(position, last);
            } else {
                self.sink(position, last);
            }
        }
    }

    #[inline]
    fn rise(&mut self, mut position: usize, item: (f64, u32)) {
        while position > 0 {
            let parent = (position - 1) / ARITY;
            if !earlier(item, self.heap[parent]) {
                break;
            }
            self.place(position, self.heap[parent]);
            position = parent;
        }
        self.place(position, item);
    }

    #[inline]
    fn sink(&mut self, mut position: usize, item: (f64, u32)) {
        loop {
            let first = position * ARITY + 1;
            let end = (first + ARITY).min(self.heap.len());
            let Some(mut least) = (first < end).then_some(first) else { break };
            for child in first + 1..end {
                if earlier(self.heap[child], self.heap[least]) {
                    least = child;
                }
            }
            if !earlier(self.heap[least], item) {
                break;
            }
            self.place(position, self.heap[least]);
            position = least;
        }
        self.place(position, item);
    }

    #[inline]
    fn place(&mut self, position: usize, item: (f64, u32)) {
        self.heap[position] = item;
        self.position[item.1 as usize] = position as u32;
    }
}

#[inline]
fn earlier(a: (f64, u32), b: (f64, u32)) -> bool {
    a.0 < b.0 || (a.0 == b.0 && a.1 < b.1)
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
                let time = if time == 255 { f64::INFINITY } else { f64::from(time) };
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
