//! What belongs to each automaton.

use crate::blocks::Gather;
use crate::repeats::{Draft, Reading};
use crate::watches::Watching;
use sophy_field::{AlgebraicIndex, AutomatonCode, LocationIndex, StateIndex, Table, WatchIndex};
use sophy_ir::{Leaf, System};
use std::ops::Range;

/// The rows that each automaton selects.
pub(crate) struct Owned {
    states: Table<StateIndex>,
    algebraics: Table<AlgebraicIndex>,
    /// Among [`System::guarded`].
    guarded: Table<u32>,
}

impl Owned {
    pub(crate) fn new(system: &System) -> Self {
        let automata = system.automata.len();
        let states = system.states.iter().enumerate();
        let states: Vec<_> = states.map(|(i, s)| (s.rate.owner.0, StateIndex::new(i))).collect();
        let algebraics = system.algebraics.iter().enumerate();
        let algebraics: Vec<_> = algebraics.map(|(i, z)| (z.value.owner.0, AlgebraicIndex::new(i))).collect();
        let guarded: Vec<_> = (0..).zip(&system.guarded).map(|(i, row)| (row.owner.0, i)).collect();
        Owned {
            guarded: Table::from_pairs(automata, &guarded),
            states: Table::from_pairs(automata, &states),
            algebraics: Table::from_pairs(automata, &algebraics),
        }
    }

    /// What to evaluate when an automaton changes its location: its own rates, and those of others that read
    /// its algebraic variables.
    pub(crate) fn entries(&self, gather: &mut Gather<'_>, automaton: usize) -> Range<u32> {
        // One that is entered at the start only is evaluated with all.
        if !changes(gather.system, automaton) {
            return 0..0;
        }
        let mut states = self.states.row(automaton).to_vec();
        for &z in self.algebraics.row(automaton) {
            states.extend(gather.readers(Leaf::Algebraic(z)).iter().map(|reader| reader.state));
        }
        gather.all_of(states)
    }

    pub(crate) fn automata(&self, gather: &mut Gather<'_>, watching: &Watching) -> Vec<Selects> {
        let automata = gather.system.automata.iter().enumerate();
        let readers = watching.of_automata();
        automata
            .map(|(a, automaton)| {
                let locations = 0..automaton.kind.locations.len();
                Selects {
                    states: if changes(gather.system, a) {
                        self.states.row(a).into()
                    } else {
                        Box::default()
                    },
                    readers: if changes(gather.system, a) { readers.row(a).into() } else { Box::default() },
                    armed: locations.clone().map(|l| self.armed(gather, a, l).into()).collect(),
                    row_of: locations.map(|l| self.right_hand_sides(gather.system, a, l)).collect(),
                }
            })
            .collect()
    }

    /// Which right-hand side each state has in a location; where it does not change, nobody asks.
    fn right_hand_sides(&self, system: &System, automaton: usize, location: usize) -> Box<[u32]> {
        if !changes(system, automaton) {
            return Box::default();
        }
        // The first location with the same: other copies count the same.
        let first = |s: &StateIndex| {
            let rate = system.states.at(s.position()).rate;
            let here = system.at(rate, LocationIndex::new(location));
            system.nodes(rate).iter().position(|&node| node == here).unwrap_or(location) as u32
        };
        self.states.row(automaton).iter().map(first).collect()
    }

    /// Watches that a location needs: those of its guards and of the switches in the rows it selects.
    fn armed(
        &self,
        gather: &mut Gather<'_>,
        automaton: usize,
        location: usize,
    ) -> Vec<sophy_field::WatchIndex> {
        let (system, location) = (gather.system, LocationIndex::new(location));
        let states = self.states.row(automaton).iter().map(|s| system.states.at(s.position()).rate);
        let algebraics = self.algebraics.row(automaton).iter();
        let algebraics = algebraics.map(|z| system.algebraics.at(z.position()).value);
        let guarded = self.guarded.row(automaton).iter().map(|&row| system.guarded[row as usize]);
        let rows = states.chain(algebraics).chain(guarded).map(|row| system.at(row, location));
        let automaton = system.automata.at(automaton);
        let outgoing = automaton.outgoing(location);
        let guards = outgoing.filter_map(|t| system.transitions.at(t.position()).trigger.guard());
        gather.incidence.watches_below(rows.chain(guards))
    }
}

/// What belongs to one automaton, as [`AutomatonCode`] has it.
#[derive(Clone, Debug)]
pub(crate) struct Selects {
    states: Box<[StateIndex]>,
    readers: Box<[WatchIndex]>,
    armed: Box<[Box<[WatchIndex]>]>,
    row_of: Box<[Box<[u32]>]>,
}

impl Selects {
    /// Writes down all but what is evaluated when its location changes.
    pub(crate) fn write(&self, draft: &mut Draft) {
        draft.numbers(self.states.iter().map(|state| state.0));
        draft.numbers(self.readers.iter().map(|watch| watch.0));
        draft.count(self.armed.len());
        for armed in &self.armed {
            draft.numbers(armed.iter().map(|watch| watch.0));
        }
        draft.count(self.row_of.len());
        for rows in &self.row_of {
            draft.count(rows.len());
            rows.iter().for_each(|&row| draft.form(row));
        }
    }
}

/// What [`Selects::write`] wrote.
pub(crate) fn read_automaton(reading: &mut Reading<'_>) -> AutomatonCode {
    AutomatonCode {
        on_change: Box::default(),
        states: reading.numbers().collect(),
        readers: reading.numbers().collect(),
        armed: reading.several(|reading| reading.numbers().collect()).into(),
        row_of: reading.several(|reading| reading.several(Reading::form).into()).into(),
    }
}

/// Whether an automaton can change its location.
fn changes(system: &System, automaton: usize) -> bool {
    system.automata.at(automaton).kind.locations.iter().any(|location| !location.transitions.is_empty())
}
