//! Changes from outside: what they concern is evaluated afresh.

use super::engine::Qss;
use super::implicit::Ahead;
use super::record::Place;
use sophy_field::{
    AutomatonIndex, Equations, Fault, Journal, LocationIndex, SourceIndex, StateIndex, Turn, WatchIndex,
};

impl<const ORDER: usize, const IMPLICIT: bool> Qss<ORDER, IMPLICIT> {
    /// Evaluates what a change concerns: the turns collected, and what fresh states influence. Twice, for
    /// values first, so that the quantised trajectories of fresh states start with their slopes.
    pub(super) fn evaluate_afresh(
        &mut self,
        e: &Equations,
        t: f64,
        journal: &mut Journal,
    ) -> Result<(), Fault> {
        let mut turns = std::mem::take(&mut self.turns);
        let mut fresh = std::mem::take(&mut self.fresh);
        fresh.sort_unstable();
        fresh.dedup();
        // All rates are among those that evaluate themselves.
        let all = fresh.len() == e.layout.states as usize;
        for &state in &fresh {
            self.synchronise(state.position(), t);
            let influence = if all { (&[][..], 0) } else { e.influence(state.position()) };
            for (evaluations, copy) in [influence, e.own(state.position())] {
                for turn in evaluations.iter().map(|evaluation| evaluation.of(copy)) {
                    // An automaton that was entered has all its rates evaluated already.
                    let rates = !e.block(turn, &self.locations).rows.is_empty();
                    if !(rates && self.entered[turn.owner.position()]) {
                        turns.push(turn);
                    }
                }
            }
        }
        turns.sort_unstable_by_key(|&turn| e.rank(turn));
        turns.dedup();
        for known in 1..ORDER {
            self.start_derivatives(e, t, known, &turns, &fresh);
        }
        for &turn in &turns {
            self.evaluate_turn(e, turn, t, journal).map_err(|failed| self.why(failed))?;
        }
        for &state in &fresh {
            self.schedule(state.position(), t);
        }
        turns.clear();
        fresh.clear();
        for automaton in self.entering.drain(..) {
            self.entered[automaton.position()] = false;
        }
        (self.turns, self.fresh) = (turns, fresh);
        Ok(())
    }

    /// The next derivative of q of fresh states becomes that of x, where the coefficients before it are `known`.
    fn start_derivatives(
        &mut self,
        e: &Equations,
        t: f64,
        known: usize,
        turns: &[Turn],
        fresh: &[StateIndex],
    ) {
        for &turn in turns {
            let (block, copy) = (e.block(turn, &self.locations), turn.copy);
            self.run_block(e, (block, copy), t, known);
            for row in &block.rows {
                let state = StateIndex(row.state.of(copy));
                if fresh.binary_search(&state).is_ok() {
                    let rate = e.rate(row, copy, &self.memory);
                    self.slopes.push((state.position(), rate[known - 1]));
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
        let quantum = self.next_quantum(i, x);
        let mut record = self.record_mut(i);
        record.set_q([x, 0.0, 0.0], t);
        record.set_quantum(quantum);
        self.own[i].repeats = 0;
        if IMPLICIT {
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
        let (code, copy) = e.automaton(AutomatonIndex::new(automaton));
        let (from, to) = (self.locations[automaton].position(), location.position());
        for watch in &code.armed[to] {
            self.arm(WatchIndex(watch.of(copy)));
        }
        for watch in &code.armed[from] {
            self.disarm(e, WatchIndex(watch.of(copy)));
        }
        self.switchings += 1;
        self.locations[automaton] = location;
        self.note_entered(AutomatonIndex::new(automaton));
        self.decide_again(code.readers.iter().map(|watch| WatchIndex(watch.of(copy))));
        let changed = code.row_of[from].iter().zip(&code.row_of[to]).map(|(a, b)| a != b);
        let changed = code.states.iter().zip(changed).filter(|(_, changed)| *changed);
        self.fresh.extend(changed.map(|(state, _)| StateIndex(state.of(copy))));
    }

    pub(super) fn note_entered(&mut self, automaton: AutomatonIndex) {
        self.entered[automaton.position()] = true;
        self.entering.push(automaton);
    }
}
