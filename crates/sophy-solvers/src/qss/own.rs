//! What belongs to a state beside its record, as little as there can be of it: large systems have millions.

use super::bend::{Bend, STRAIGHT};
use super::engine::Qss;
use super::settings::Quantum;
use rustc_hash::FxHashMap;
use sophy_field::{Equations, StateIndex};

/// What belongs to a state beside its record.
#[derive(Clone, Copy, Debug)]
pub(super) struct Own {
    /// [`Quantum::absolute`].
    absolute: f64,
    /// Of its quantum: which of the rules.
    rule: u32,
    /// Which of the bends is its own; `NEVER` if its rate never bends.
    bend: u32,
    /// How often it was scheduled at its own instant.
    pub(super) repeats: u32,
}

/// What states have in common: [`Quantum::relative`] and [`Quantum::largest`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Rule {
    relative: f64,
    largest: bool,
}

/// No state has so many others before it that bend.
const NEVER: u32 = u32::MAX;

impl Own {
    /// Of all states, with the rules of their quanta.
    pub(super) fn of(quanta: Vec<Quantum>) -> (Vec<Own>, Vec<Rule>) {
        let mut rules: Vec<Rule> = Vec::new();
        let mut known = FxHashMap::default();
        let own = |Quantum { absolute, relative, largest }| {
            let rule = *known.entry((relative.to_bits(), largest)).or_insert_with(|| {
                rules.push(Rule { relative, largest });
                rules.len() as u32 - 1
            });
            Own { absolute, rule, bend: NEVER, repeats: 0 }
        };
        (quanta.into_iter().map(own).collect(), rules)
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

impl<const ORDER: usize> Qss<ORDER> {
    /// ΔQ of a state at x, the next value of its q.
    #[inline]
    pub(super) fn next_quantum(&mut self, i: usize, x: f64) -> f64 {
        let own = &mut self.own[i];
        let Rule { relative, largest } = self.rules[own.rule as usize];
        let mut quantum = Quantum { absolute: own.absolute, relative, largest };
        let next = quantum.next(x);
        own.absolute = quantum.absolute;
        next
    }

    /// How the rate of a state bends, if it can.
    #[inline]
    pub(super) fn bend_of(&mut self, i: usize) -> Option<&mut Bend> {
        let bend = self.own[i].bend;
        if bend == NEVER { None } else { self.bends.get_mut(bend as usize) }
    }
}
