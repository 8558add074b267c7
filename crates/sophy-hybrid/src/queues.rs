use sophy_field::{AutomatonIndex, EventIndex};

/// Events that wait, a queue per automaton; an empty one takes four bytes.
#[derive(Clone, Debug)]
pub(crate) struct Queues {
    /// Per automaton: its last entry; [`NONE`] if none waits.
    last: Vec<u32>,
    entries: Vec<Entry>,
    /// The first entry that is free, which leads to the others.
    free: u32,
}

#[derive(Clone, Copy, Debug)]
struct Entry {
    event: EventIndex,
    /// The entry behind this one; behind the last of a queue its first.
    next: u32,
}

/// No entry.
const NONE: u32 = u32::MAX;

impl Queues {
    /// Nothing waits for any of so many automata.
    pub(crate) fn new(automata: usize) -> Self {
        Queues { last: vec![NONE; automata], entries: Vec::new(), free: NONE }
    }

    pub(crate) fn push(&mut self, automaton: AutomatonIndex, event: EventIndex) {
        let last = self.last[automaton.position()];
        let new = if self.free == NONE { self.entries.len() as u32 } else { self.free };
        let first = if last == NONE { new } else { self.entries[last as usize].next };
        let entry = Entry { event, next: first };
        match self.entries.get_mut(new as usize) {
            Some(free) => {
                self.free = free.next;
                *free = entry;
            }
            None => self.entries.push(entry),
        }
        if last != NONE {
            self.entries[last as usize].next = new;
        }
        self.last[automaton.position()] = new;
    }

    /// The event that has waited longest.
    pub(crate) fn front(&self, automaton: AutomatonIndex) -> Option<EventIndex> {
        self.of(automaton).next()
    }

    /// Takes off the event that has waited longest.
    pub(crate) fn pop(&mut self, automaton: AutomatonIndex) {
        let last = self.last[automaton.position()];
        if last == NONE {
            return;
        }
        let first = self.entries[last as usize].next;
        if first == last {
            self.last[automaton.position()] = NONE;
        } else {
            self.entries[last as usize].next = self.entries[first as usize].next;
        }
        self.entries[first as usize].next = self.free;
        self.free = first;
    }

    /// Those that wait for an automaton, in order.
    fn of(&self, automaton: AutomatonIndex) -> impl Iterator<Item = EventIndex> + Clone {
        let last = self.last[automaton.position()];
        let mut next = (last != NONE).then(|| self.entries[last as usize].next);
        std::iter::from_fn(move || {
            let at = next?;
            let entry = self.entries[at as usize];
            next = (at != last).then_some(entry.next);
            Some(entry.event)
        })
    }

    /// All that wait, in the order of automata.
    pub(crate) fn all(&self) -> impl Iterator<Item = EventIndex> + Clone {
        (0..self.last.len()).flat_map(|automaton| self.of(AutomatonIndex::new(automaton)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use std::collections::VecDeque;

    proptest! {
        /// As plain queues are.
        #[test]
        fn first_in_first_out(what in prop::collection::vec((0..5_u32, prop::option::of(0..9_u32)), 0..80)) {
            let mut queues = Queues::new(5);
            let mut plain = vec![VecDeque::new(); 5];
            for (automaton, event) in what {
                let (index, queue) = (AutomatonIndex(automaton), &mut plain[automaton as usize]);
                prop_assert_eq!(queues.front(index), queue.front().copied());
                match event.map(EventIndex) {
                    Some(event) => {
                        queues.push(index, event);
                        queue.push_back(event);
                    }
                    None => {
                        queues.pop(index);
                        queue.pop_front();
                    }
                }
                prop_assert!(queues.all().eq(plain.iter().flatten().copied()));
            }
            let waiting: usize = plain.iter().map(VecDeque::len).sum();
            prop_assert!(queues.entries.len() <= 80 && queues.entries.len() >= waiting);
        }
    }
}
