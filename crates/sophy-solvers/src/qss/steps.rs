//! The loop of the method: a state quantises itself, what reads it is evaluated, integrators are told (algorithms 3.1,
//! 3.2). Nothing here allocates, and what cannot go on is kept in [`Qss::fault`], out of the way of what can.

use super::bend::STRAIGHT;
use super::engine::{Failed, Qss};
use super::implicit::explicit;
use super::record::{leaves, leaves_from_middle};
use sophy_field::{Block, Equations, Fault, Jet, Journal, NOW, StateIndex, Turn};

/// How often a slot may be scheduled at its own instant.
pub(super) const MOST_REPEATS: u32 = 100;

impl<const ORDER: usize, const IMPLICIT: bool> Qss<ORDER, IMPLICIT> {
    /// A state whose time has come: the edge of its band, or only a rate that bends.
    #[inline]
    pub(super) fn state_due(
        &mut self,
        e: &Equations,
        i: usize,
        t: f64,
        journal: &mut Journal,
    ) -> Result<(), Failed> {
        let bends = self.bend_of(i).is_some_and(|bend| bend.due);
        if bends { self.refresh(e, i, t, journal) } else { self.step(e, i, t, journal) }
    }

    /// A state's quantised trajectory has come to the edge of its band (algorithm 3.1).
    #[inline]
    fn step(&mut self, e: &Equations, i: usize, t: f64, journal: &mut Journal) -> Result<(), Failed> {
        let record = self.record(i);
        let (before, x) = (record.tq(), record.x_from(t));
        self.count_repeats(i, before, t)?;
        let quantum = self.next_quantum(i, x[0]);
        let q = if IMPLICIT { self.quantise_ahead(e, i, t, quantum) } else { explicit::<ORDER>(x) };
        self.step_to(e, i, t, q, quantum, journal)?;
        // Its own rate, if it was among them, has scheduled it already.
        let evaluated = self.record(i).tx();
        if evaluated < t && !IMPLICIT {
            // q is x now, up to the highest coefficient.
            self.due_in(i, t, evaluated, leaves_from_middle::<ORDER>(x, quantum));
        } else if self.agenda.time(i as u32) <= t {
            self.schedule(i, t);
        }
        Ok(())
    }

    /// A state steps although its band is not left: it begins anew with q = x.
    #[cold]
    pub(super) fn step_from_x(
        &mut self,
        e: &Equations,
        i: usize,
        t: f64,
        journal: &mut Journal,
    ) -> Result<(), Failed> {
        let x = self.record(i).x_at(t);
        let quantum = self.next_quantum(i, x);
        let linear = self.linear(e, i, t);
        self.ahead[i].arrive(x);
        let q = self.go_to_rest(i, t, linear, quantum);
        self.step_to(e, i, t, q, quantum, journal)
    }

    /// q of a state follows these coefficients from now on, and what depends on it is evaluated.
    #[inline(always)]
    fn step_to(
        &mut self,
        e: &Equations,
        i: usize,
        t: f64,
        q: [f64; 3],
        quantum: f64,
        journal: &mut Journal,
    ) -> Result<(), Failed> {
        self.take_quantised(i, t, q, quantum);
        self.tell_step(i, t, journal);
        // λ: what depends on it is evaluated, eq. (3.2.2)
        let (influence, copy) = e.influence(i);
        for evaluation in influence {
            self.evaluate(e, evaluation.of(copy), t, journal)?;
        }
        if self.joined.is_empty() { Ok(()) } else { self.tell_joined(e, t, journal) }
    }

    /// States that were put at rest with the one that steps have stepped, too.
    #[cold]
    fn tell_joined(&mut self, e: &Equations, t: f64, journal: &mut Journal) -> Result<(), Failed> {
        while let Some(state) = self.joined.pop() {
            self.tell_step(state.position(), t, journal);
            let (influence, copy) = e.influence(state.position());
            for evaluation in influence {
                self.evaluate_turn(e, evaluation.of(copy), t, journal)?;
            }
        }
        Ok(())
    }

    /// q of a state follows these coefficients from now on.
    #[inline]
    pub(super) fn take_quantised(&mut self, i: usize, t: f64, q: [f64; 3], quantum: f64) {
        // Ahead, it begins at the edge of the band and moves inward, but for rounding.
        let slack = if IMPLICIT { 1e-9 * quantum + 4.0 * f64::EPSILON * q[0].abs() } else { 0.0 };
        let mut record = self.record_mut(i);
        record.set_q(q, t);
        record.set_quantum(quantum + slack);
    }

    #[inline]
    fn tell_step(&mut self, i: usize, t: f64, journal: &mut Journal) {
        self.statistics.steps += 1;
        if journal.wanted {
            journal.push(sophy_field::Record::Step { time: t, state: StateIndex::new(i) });
        }
    }

    /// A rate is evaluated again because it bends.
    fn refresh(&mut self, e: &Equations, i: usize, t: f64, journal: &mut Journal) -> Result<(), Failed> {
        self.count_repeats(i, self.record(i).tx(), t)?;
        self.statistics.refreshes += 1;
        self.refreshed = i;
        let (own, copy) = e.own(i);
        for evaluation in own {
            self.evaluate_turn(e, evaluation.of(copy), t, journal)?;
        }
        self.refreshed = usize::MAX;
        Ok(())
    }

    /// A state may be scheduled again at the instant `before` of its last turn, but not for ever.
    #[inline]
    fn count_repeats(&mut self, i: usize, before: f64, t: f64) -> Result<(), Failed> {
        let repeats = &mut self.own[i].repeats;
        *repeats = if before < t { 0 } else { *repeats + 1 };
        if *repeats > MOST_REPEATS {
            return Err(self.fail(Fault::Resolution { state: StateIndex::new(i), time: t }));
        }
        Ok(())
    }

    /// Evaluates the rates of a block at `t` (algorithm 3.2).
    #[inline(always)]
    fn evaluate(&mut self, e: &Equations, turn: Turn, t: f64, journal: &mut Journal) -> Result<(), Failed> {
        let (block, copy) = (e.block(turn, &self.locations), turn.copy);
        let orders = if block.bends { ORDER + 1 } else { ORDER };
        self.run_block(e, (block, copy), t, orders);
        if block.bends {
            self.still = self.still_for(block, copy);
        }
        for row in &block.rows {
            let state = StateIndex(row.state.of(copy));
            self.set_rate(e, state, t, (e.rate(row, copy, &self.memory), row.bends), journal)?;
        }
        Ok(())
    }

    /// [`Qss::evaluate`], away from the loop.
    #[inline(never)]
    pub(super) fn evaluate_turn(
        &mut self,
        e: &Equations,
        turn: Turn,
        t: f64,
        journal: &mut Journal,
    ) -> Result<(), Failed> {
        self.evaluate(e, turn, t, journal)
    }

    /// Runs the program of a copy of a block at `t`.
    #[inline]
    pub(super) fn run_block(&mut self, e: &Equations, (block, copy): (&Block, u32), t: f64, orders: usize) {
        self.memory[NOW] = t;
        e.execute(&block.call, copy, &mut self.memory, orders);
    }

    /// δ_ext: a new rate arrives (algorithm 3.1): f, ḟ, ½f̈ along q, as far as they count, and whether it bends.
    #[inline(always)]
    fn set_rate(
        &mut self,
        e: &Equations,
        state: StateIndex,
        t: f64,
        (rate, bends): (Jet, bool),
        journal: &mut Journal,
    ) -> Result<(), Failed> {
        let i = state.position();
        let [f, f1, f2, _] = rate;
        let (f1, f2) = (if ORDER > 1 { f1 } else { 0.0 }, if ORDER > 2 { f2 } else { 0.0 });
        let mut record = self.record_mut(i);
        let x = record.as_read().x_at(t);
        let jet = [x, f, 0.5 * f1, f2 / 3.0];
        let delay = leaves::<ORDER>(jet, record.as_read().q_from(t), record.as_read().quantum());
        // Up to the second order what is not finite leaves no delay.
        let is_suspect = ORDER > 2 || delay.is_nan() || delay <= 0.0;
        if is_suspect && !((x.abs() + f.abs()) + (f1.abs() + f2.abs())).is_finite() {
            return Err(self.not_finite(state, t, [x, f, f1, f2]));
        }
        record.set_x(jet, t);
        self.statistics.rates += 1;
        if bends {
            self.bend(i, t, rate);
        } else if let Some(bend) = self.bend_of(i) {
            *bend = STRAIGHT;
        }
        if journal.wanted {
            journal.push(sophy_field::Record::Segment { time: t, state, coefficients: jet });
        }
        self.due_in(i, t, t, delay);
        for &watch in e.watches_of_source.row(i) {
            self.mark(watch);
        }
        Ok(())
    }

    /// ta: when a state next needs attention (algorithm 3.1, eq. 3.6), or its rate because it bends.
    #[inline]
    pub(super) fn schedule(&mut self, i: usize, t: f64) {
        let record = self.record(i);
        let (delay, evaluated) = (record.band_delay(t), record.tx());
        self.due_in(i, t, evaluated, delay);
    }

    /// x, whose rate was evaluated at `evaluated`, leaves the band after `delay`.
    #[inline(always)]
    fn due_in(&mut self, i: usize, t: f64, evaluated: f64, delay: f64) {
        let mut next = t + delay;
        if IMPLICIT {
            next = next.min(self.ahead[i].settles);
        }
        if let Some(bend) = self.bend_of(i).filter(|bend| bend.bends) {
            let trusted = evaluated + bend.trusted_for::<ORDER>(evaluated, next - evaluated);
            bend.due = trusted < next;
            next = next.min(trusted);
        }
        // Rounding must not lead back; what is not a number is due at once and counted.
        self.agenda.set(i as u32, if next > t { next } else { t });
    }

    #[cold]
    fn not_finite(&mut self, state: StateIndex, time: f64, [x, f, f1, f2]: [f64; 4]) -> Failed {
        let value = [f, f1, f2].into_iter().find(|f| !f.is_finite()).unwrap_or(f64::INFINITY);
        self.fail(if x.is_finite() {
            Fault::NotFinite { state, time, value }
        } else {
            Fault::StateNotFinite { state, time, value: x }
        })
    }
}
