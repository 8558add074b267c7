//! Sequences in which what copies of a component repeat stands once.

use crate::packed::{Packed, Repeat};
use std::ops::Deref;
use std::sync::Arc;

/// A growing sequence; once it is built, what repeats in it is kept once and computed where it is asked for.
#[derive(Clone, Debug)]
pub struct Repeated<T> {
    packed: Packed<T>,
    /// Those that have come since.
    items: Vec<T>,
}

impl<T> Default for Repeated<T> {
    fn default() -> Self {
        Repeated { packed: Packed::default(), items: Vec::new() }
    }
}

impl<T> From<Vec<T>> for Repeated<T> {
    fn from(items: Vec<T>) -> Self {
        Repeated { items, ..Repeated::default() }
    }
}

impl<T: Repeat> Repeated<T> {
    /// Appends one.
    pub fn push(&mut self, item: T) {
        self.items.push(item);
    }

    /// How many there are.
    pub fn len(&self) -> usize {
        self.packed.len() + self.items.len()
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The one at a position, which must be one of them.
    #[inline]
    pub fn at(&self, position: usize) -> T {
        match position.checked_sub(self.packed.len()) {
            Some(behind) => self.items[behind].clone(),
            None => self.packed.at(position),
        }
    }

    /// The one at a position, if there are so many.
    #[inline]
    pub fn get(&self, position: usize) -> Option<T> {
        (position < self.len()).then(|| self.at(position))
    }

    /// One like that at a position but for the numbers that go up from copy to copy: for names, units and kinds.
    pub fn pattern(&self, position: usize) -> &T {
        match position.checked_sub(self.packed.len()) {
            Some(behind) => &self.items[behind],
            None => self.packed.pattern(position),
        }
    }

    /// All of them.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = T> + DoubleEndedIterator + Clone {
        (0..self.len()).map(|position| self.at(position))
    }

    /// Those that may still be changed: all, until [`Repeated::shrink_to_fit`].
    pub fn unfinished(&mut self) -> &mut [T] {
        &mut self.items
    }

    /// Keeps once what repeats; few will come after that.
    pub fn shrink_to_fit(&mut self) {
        if self.packed.len() == 0 {
            self.packed = Packed::new(&self.items);
            self.items = Vec::new();
        }
    }
}

/// What many have in common; equal only if it is the same.
#[derive(Debug)]
pub struct Shared<T>(Arc<T>);

impl<T> Shared<T> {
    /// To be cloned by all that share it.
    pub fn new(value: T) -> Self {
        Shared(Arc::new(value))
    }

    /// Where it stands, as a number to tell it from others by.
    pub fn address(&self) -> usize {
        Arc::as_ptr(&self.0).addr()
    }
}

impl<T> Clone for Shared<T> {
    fn clone(&self) -> Self {
        Shared(Arc::clone(&self.0))
    }
}

impl<T> PartialEq for Shared<T> {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0)
    }
}

impl<T> Deref for Shared<T> {
    type Target = T;

    fn deref(&self) -> &T {
        &self.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::class::{Port, Sources, VariableId, Wire};

    #[test]
    fn connections_of_copies_stand_once() {
        let port = |copy| Port { member: Some(0), copy, variable: VariableId(1) };
        let mut wires = Repeated::default();
        let mut expected = Vec::new();
        for k in 0..1000 {
            for (from, to) in [(k, k + 1), (k + 1, k)] {
                let wire = Wire { to: port(to), from: Sources::One(port(from)), span: None };
                wires.push(wire.clone());
                expected.push(wire);
            }
        }
        let sum = Wire { to: port(0), from: Sources::Sum([(2.0, port(3))].into()), span: None };
        wires.push(sum.clone());
        expected.push(sum.clone());
        wires.shrink_to_fit();
        wires.push(sum.clone());
        expected.push(sum);
        assert_eq!(wires.iter().collect::<Vec<_>>(), expected);
        assert_eq!((wires.get(2001).as_ref(), wires.get(2002)), (expected.last(), None));
        assert_eq!(wires.pattern(1234).from, Sources::One(port(0)), "the first copy");
        let text = format!("{wires:?}");
        assert!(text.len() < 10_000, "what repeats stands once: {} letters", text.len());
    }
}
