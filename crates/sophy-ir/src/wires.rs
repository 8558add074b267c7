//! The connections of a composite; those that copies repeat stand once.

use crate::class::{Port, Sources, Wire};
use crate::packed::{Numbers, Packed, Repeat};
use rustc_hash::FxHasher;
use std::hash::Hash;

/// The connections of a composite, in written order.
#[derive(Clone, Debug, Default)]
pub struct Wires {
    packed: Packed<Wire>,
    /// Those that have come since.
    wires: Vec<Wire>,
}

impl Wires {
    /// Appends one.
    pub fn push(&mut self, wire: Wire) {
        self.wires.push(wire);
    }

    /// The one at a position, if there are so many.
    pub fn get(&self, position: usize) -> Option<Wire> {
        match position.checked_sub(self.packed.len()) {
            Some(behind) => self.wires.get(behind).cloned(),
            None => Some(self.packed.at(position)),
        }
    }

    /// All of them.
    pub fn iter(&self) -> impl Iterator<Item = Wire> {
        let packed = (0..self.packed.len()).map(|position| self.packed.at(position));
        packed.chain(self.wires.iter().cloned())
    }

    /// Keeps once what repeats; few will come after that.
    pub fn shrink_to_fit(&mut self) {
        if self.packed.len() == 0 {
            self.packed = Packed::new(&self.wires);
            self.wires = Vec::new();
        }
    }
}

impl From<Vec<Wire>> for Wires {
    fn from(wires: Vec<Wire>) -> Self {
        Wires { wires, ..Wires::default() }
    }
}

impl Repeat for Wire {
    fn numbers(&self) -> Numbers {
        let from = match &self.from {
            Sources::One(port) => port.copy,
            Sources::Sum(_) => 0,
        };
        [self.to.copy, from, 0]
    }

    fn shifted(&self, [to, from, _]: Numbers) -> Self {
        let port = |port: Port, by: u32| Port { copy: port.copy.wrapping_add(by), ..port };
        Wire {
            to: port(self.to, to),
            from: match &self.from {
                Sources::One(one) => Sources::One(port(*one, from)),
                sum @ Sources::Sum(_) => sum.clone(),
            },
            span: self.span,
        }
    }

    fn look(&self, hasher: &mut FxHasher) {
        (self.to.member, self.to.variable).hash(hasher);
        if let Sources::One(port) = &self.from {
            (port.member, port.variable).hash(hasher);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::class::VariableId;

    #[test]
    fn connections_of_copies_stand_once() {
        let port = |copy| Port { member: Some(0), copy, variable: VariableId(1) };
        let mut wires = Wires::default();
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
        let text = format!("{wires:?}");
        assert!(text.len() < 10_000, "what repeats stands once: {} letters", text.len());
    }
}
