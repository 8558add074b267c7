//! What belongs to a state beside its record, as little as there can be of it: large systems have millions.

use super::bend::{Bend, STRAIGHT};
use super::engine::Qss;
use super::settings::Quantum;
use rustc_hash::FxHashMap;
use sophy_field::{Equations, StateIndex};

/// What belongs to a state beside its record.
#[derive(Clone, Copy, Debug)]
pub(super) struct Own {
    /// Its quantum: which of those in use.
    quantum: u32,
    /// Which of the bends is its own; `NEVER` if its rate never bends.
    bend: u32,
    /// How often it was scheduled at its own instant.
    pub(super) repeats: u32,
}

/// The quanta in use, which states share.
#[derive(Clone, Debug, Default)]
pub(super) struct Quanta {
    distinct: Vec<Quantum>,
    /// Per state: [`Quantum::absolute`] by now; of none if no quantum grows with the largest |x|.
    absolute: Vec<f64>,
}

/// No state has so many others before it that bend.
const NEVER: u32 = u32::MAX;

impl Own {
    /// Of all states, with their quanta.
    pub(super) fn of(given: &[Quantum]) -> (Vec<Own>, Quanta) {
        let mut quanta = Quanta::default();
        let mut known = FxHashMap::default();
        let own = |&quantum: &Quantum| {
            let key = (quantum.absolute.to_bits(), quantum.relative.to_bits(), quantum.largest);
            let quantum = *known.entry(key).or_insert_with(|| {
                quanta.distinct.push(quantum);
                quanta.distinct.len() as u32 - 1
            });
            Own { quantum, bend: NEVER, repeats: 0 }
        };
        let own = given.iter().map(own).collect();
        if quanta.distinct.iter().any(|quantum| quantum.largest) {
            quanta.absolute = given.iter().map(|quantum| quantum.absolute).collect();
        }
        (own, quanta)
    }

    /// Gives every state that may bend a place to keep it.
    pub(super) fn find_bends(own: &mut [Own], e: &Equations) -> Vec<Bend> {
        let mut bends = Vec::new();
        for (i, own) in own.iter_mut().enumerate() {
            if e.may_bend(StateIndex::new(i)) {
                own.bend = bends.len() as u32;
                bends.push(STRAIGHT);
            }
        }
        bends
    }
}

impl Quanta {
    /// ΔQ of a state at x, the next value of its q.
    #[inline]
    fn next(&mut self, own: Own, state: usize, x: f64) -> f64 {
        let mut quantum = self.distinct[own.quantum as usize];
        if !quantum.largest {
            return quantum.at(x);
        }
        let absolute = &mut self.absolute[state];
        quantum.absolute = *absolute;
        *absolute = quantum.at(x);
        *absolute
    }
}

impl<const ORDER: usize, const IMPLICIT: bool> Qss<ORDER, IMPLICIT> {
    /// ΔQ of a state at x, the next value of its q.
    #[inline]
    pub(super) fn next_quantum(&mut self, i: usize, x: f64) -> f64 {
        self.quanta.next(self.own[i], i, x)
    }

    /// How the rate of a state bends, if it can.
    #[inline]
    pub(super) fn bend_of(&mut self, i: usize) -> Option<&mut Bend> {
        let bend = self.own[i].bend;
        if bend == NEVER { None } else { self.bends.get_mut(bend as usize) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// ΔQ of the second of two states at places it comes to.
    fn quanta(quantum: Quantum, places: &[f64]) -> Vec<f64> {
        let (own, mut quanta) = Own::of(&[Quantum::absolute(1.0), quantum]);
        places.iter().map(|&x| quanta.next(own[1], 1, x)).collect()
    }

    #[test]
    fn a_quantum_of_a_tolerance_never_shrinks() {
        let found = quanta(Quantum::from_tolerance(1e-2), &[0.0, 2.0, -1.0, 0.0, -4.0, 3.0]);
        let expected = [1e-12, 2e-3, 2e-3, 2e-3, 4e-3, 4e-3];
        assert!(found.iter().zip(expected).all(|(found, expected)| (found / expected - 1.0).abs() < 1e-12));
    }

    #[test]
    fn another_relative_quantum_follows_the_value() {
        let quantum = Quantum { absolute: 1e-3, relative: 0.1, largest: false };
        assert_eq!(quanta(quantum, &[0.0, 2.0, 1.0, -1e-3]), [1e-3, 0.2, 0.1, 1e-3]);
    }
}
