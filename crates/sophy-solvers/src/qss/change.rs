//! Changes from outside: what they concern is evaluated afresh.

use super::engine::Qss;
use super::implicit::Ahead;
use super::record::Place;
use sophy_field::{AutomatonIndex, Entry, Equations, Fault, Journal, LocationIndex, SourceIndex, StateIndex};

impl<const ORDER: usize> Qss<ORDER> {
    /// Evaluates what a change concerns: the entries collected, and what fresh states influence. Twice, for
    /// values first, so that the quantised trajectories of fresh states start with their slopes.
    pub(super) fn evaluate_afresh(
        &mut self,
        e: &Equations,
        t: f64,
        journal: &mut Journal,
    ) -> Result<(), Fault> {
        let mut entries = std::mem::take(&mut self.entries);
        let mut fresh = std::mem::take(&mut self.fresh);
        fresh.sort_unstable();
        fresh.dedup();
        for &state in &fresh {
            self.synchronise(state.position(), t);
            for range in [&e.influence[state.position()], &e.own[state.position()]] {
                for &entry in e.entries(range) {
                    // An automaton that was entered has all its rates evaluated already.
                    let rates = !e.block(entry, &self.locations).rows.is_empty();
                    if !(rates && self.entered[entry.owner.position()]) {
                        entries.push(entry);
                    }
                }
            }
        }
        entries.sort_unstable();
        entries.dedup();
        for known in 1..ORDER {
            self.start_derivatives(e, t, known, &entries, &fresh);
        }
        for &entry in &entries {
            self.evaluate_entry(e, entry, t, journal).map_err(|failed| self.why(failed))?;
        }
        for &state in &fresh {
            self.schedule(state.position(), t);
        }
        entries.clear();
        fresh.clear();
        for automaton in self.entering.drain(..) {
            self.entered[automaton.position()] = false;
        }
        (self.entries, self.fresh) = (entries, fresh);
        Ok(())
    }

    /// The next derivative of q of fresh states becomes that of x, where the coefficients before it are `known`.
    fn start_derivatives(
        &mut self,
        e: &Equations,
        t: f64,
        known: usize,
        entries: &[Entry],
        fresh: &[StateIndex],
    ) {
        for &entry in entries {
            let block = e.block(entry, &self.locations);
            self.run_block(e, block, t, known);
            for row in &e.rows[block.rows.start as usize..block.rows.end as usize] {
                if fresh.binary_search(&row.state).is_ok() {
                    self.slopes
                        .push((row.state.position(), e.result(row.result, &self.memory, known)[known - 1]));
                }
            }
        }
        let mut slopes = std::mem::take(&mut self.slopes);
        for (i, slope) in slopes.drain(..) {
            self.record_mut(i).0[Place::<ORDER>::Q + known] = slope / known as f64;
        }
        self.slopes = slopes;
    }

    /// q of a state starts on x.
    fn synchronise(&mut self, i: usize, t: f64) {
        let x = self.record(i).x_at(t);
        let quantum = self.own[i].quantum.next(x);
        let mut record = self.record_mut(i);
        record.set_q([x, 0.0, 0.0], t);
        record.set_quantum(quantum);
        self.own[i].repeats = 0;
        if self.settings.implicit {
            self.ahead[i] = Ahead::NEW;
        }
    }

    pub(super) fn set_state(&mut self, state: StateIndex, value: f64, t: f64) -> Result<(), Fault> {
        if !value.is_finite() {
            return Err(Fault::StateNotFinite { state, time: t, value });
        }
        self.record_mut(state.position()).set_x([value, 0.0, 0.0, 0.0], t);
        Ok(())
    }

    pub(super) fn set_input(&mut self, e: &Equations, input: usize, line: [f64; 2], t: f64) -> SourceIndex {
        let source = SourceIndex(e.layout.states + input as u32);
        self.record_mut(source.position()).set_line(line[0], line[1], t);
        source
    }

    /// Enters a location: arms its watches, disarms those left, and gives the states whose right-hand side is
    /// another one.
    pub(super) fn enter(&mut self, e: &Equations, automaton: usize, location: LocationIndex) {
        let code = &e.automata[automaton];
        let (from, to) = (self.locations[automaton].position(), location.position());
        for &watch in &code.armed[to] {
            self.arm(watch);
        }
        for &watch in &code.armed[from] {
            self.disarm(e, watch);
        }
        self.switchings += 1;
        self.locations[automaton] = location;
        self.note_entered(AutomatonIndex::new(automaton));
        self.decide_again(&code.readers);
        let changed = code.row_of[from].iter().zip(&code.row_of[to]).map(|(a, b)| a != b);
        self.fresh.extend(code.states.iter().zip(changed).filter_map(|(&s, changed)| changed.then_some(s)));
    }

    pub(super) fn note_entered(&mut self, automaton: AutomatonIndex) {
        self.entered[automaton.position()] = true;
        self.entering.push(automaton);
    }
}
