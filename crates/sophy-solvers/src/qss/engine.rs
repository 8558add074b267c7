use super::record::{Place, Record, RecordMut};
use super::settings::Settings;
use super::watches::WatchRecord;
use sophy_field::{
    Agenda, AutomatonIndex, Block, Changes, Engine, Entry, Equations, Fault, Jet, Journal, LocationIndex,
    Memory, NOW, RowResult, SourceIndex, Start, StateIndex, Statistics, Stop, WatchIndex,
};
use sophy_segment::{Interval, Sign, cubic_leaves};
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// QSS1 and LIQSS1.
pub type Qss1 = Qss<1>;
/// QSS2 and LIQSS2.
pub type Qss2 = Qss<2>;
/// QSS3 and LIQSS3.
pub type Qss3 = Qss<3>;

/// The quantised-state engine of order `ORDER`; which quantisation is a setting.
///
/// Equations must have been compiled for the same order. Slots of the agenda: the states (change of q, or
/// evaluation of a rate that bends), then the watches.
#[derive(Clone, Debug)]
pub struct Qss<const ORDER: usize> {
    pub(super) settings: Settings,
    /// How the rates bend.
    bends: Vec<Bend>,
    /// The state whose rate is being evaluated only because it bends; `usize::MAX` if none.
    refreshed: usize,
    /// See [`Qss::still_for`], of the block evaluated last.
    still: f64,
    /// How often a state was scheduled at its own instant.
    repeats: Vec<u32>,
    pub(super) watches: Vec<WatchRecord>,
    pub(super) locations: Vec<LocationIndex>,
    pub(super) agenda: Agenda,
    /// Memory of the programs, with the records of states, inputs and time.
    pub(super) memory: Memory,
    /// What stands behind the records, enclosed.
    pub(super) enclosed: Vec<Interval>,
    /// What a record held of q; empty in between.
    pub(super) kept: Vec<([f64; 3], f64)>,
    /// Watches to look at again before time goes on; while they are settled, the next of them in order.
    pub(super) dirty: Vec<WatchIndex>,
    pub(super) settling: BinaryHeap<Reverse<WatchIndex>>,
    /// Watches of guards whose sign changed, for the hybrid logic.
    pub(super) changed: Vec<WatchIndex>,
    /// Entries to evaluate in a change, states that start afresh there, and their slopes; empty in between.
    pub(super) entries: Vec<Entry>,
    fresh: Vec<StateIndex>,
    /// Automata that enter a location in a change: each, and which.
    entered: Vec<bool>,
    entering: Vec<AutomatonIndex>,
    slopes: Vec<(usize, f64)>,
    pub(super) statistics: Statistics,
}

/// What a rate does that its segment leaves out.
#[derive(Clone, Copy, Debug)]
struct Bend {
    /// A quantum over the coefficient of what is left out: QSS1 leaves out ∫ḟs = ḟ·s²/2, QSS2 ∫½f̈s² = ½f̈·s³/3, QSS3
    /// the like of the fourth order. Infinite where nothing is left out.
    room: f64,
    /// Whether the rate bends at all; then it is trusted for a bounded time even if its room is infinite.
    bends: bool,
    /// That time, s.
    trust: f64,
    /// Since when the rate was evaluated only because it bends, s.
    coasting: f64,
    /// Whether the agenda's time is that of evaluating the rate again, not the edge of the band.
    due: bool,
}

const STRAIGHT: Bend =
    Bend { room: f64::INFINITY, bends: false, trust: f64::INFINITY, coasting: f64::NEG_INFINITY, due: false };

/// How often a slot may be scheduled at its own instant.
pub(super) const MOST_REPEATS: u32 = 100;

/// So many enclosures count as a step of the budget.
const ENCLOSURES_PER_STEP: u64 = 4;

impl<const ORDER: usize> Qss<ORDER> {
    /// An engine that has not been started.
    pub fn new(equations: &Equations, settings: Settings) -> Self {
        let layout = equations.layout;
        let (states, watches) = (layout.states as usize, equations.watches.len());
        let rest = &equations.image[layout.rest as usize..];
        Qss {
            settings,
            bends: vec![STRAIGHT; states],
            refreshed: usize::MAX,
            still: 0.0,
            repeats: vec![0; states],
            watches: vec![WatchRecord::default(); watches],
            locations: vec![LocationIndex(0); equations.automata.len()],
            agenda: Agenda::new(states + watches),
            memory: Memory::from(equations.image.as_slice()),
            enclosed: rest.iter().map(|&value| Interval::point(value)).collect(),
            kept: Vec::new(),
            dirty: Vec::new(),
            settling: BinaryHeap::new(),
            changed: Vec::new(),
            entries: Vec::new(),
            fresh: Vec::new(),
            entered: vec![false; equations.automata.len()],
            entering: Vec::new(),
            slopes: Vec::new(),
            statistics: Statistics::default(),
        }
    }

    /// The record of a source.
    #[inline]
    pub(super) fn record(&self, source: usize) -> Record<'_, ORDER> {
        let stride = Place::<ORDER>::STRIDE;
        Record(&self.memory[(source + 1) * stride..][..stride])
    }

    #[inline]
    pub(super) fn record_mut(&mut self, source: usize) -> RecordMut<'_, ORDER> {
        let stride = Place::<ORDER>::STRIDE;
        RecordMut(&mut self.memory[(source + 1) * stride..][..stride])
    }

    /// A state's quantised trajectory has come to the edge of its band (algorithm 3.1).
    #[inline]
    fn step(&mut self, e: &Equations, i: usize, t: f64, journal: &mut Journal) -> Result<(), Fault> {
        let record = self.record(i);
        let (before, x) = (record.tq(), record.x_from(t));
        self.count_repeats(i, before, t)?;
        // δ_int: the quantised trajectory takes value and slope of the integrated one, eq. (3.7)
        let mut q = [x[0], if ORDER > 1 { x[1] } else { 0.0 }, if ORDER > 2 { x[2] } else { 0.0 }];
        let quantum = self.settings.quanta[i].at(x[0]);
        if self.settings.implicit {
            q = self.quantise_ahead(e, i, t, quantum).unwrap_or(q);
        }
        // Implicit quantisation begins at the edge of the band and moves inward, but for rounding.
        let slack =
            if self.settings.implicit { 1e-9 * quantum + 4.0 * f64::EPSILON * x[0].abs() } else { 0.0 };
        let mut record = self.record_mut(i);
        record.set_q(q, t);
        record.set_quantum(quantum + slack);
        self.statistics.steps += 1;
        if journal.wanted {
            journal.push(sophy_field::Record::Step { time: t, state: StateIndex::new(i) });
        }
        // λ: what depends on it is evaluated, eq. (3.2.2)
        for &entry in e.entries(&e.influence[i]) {
            self.evaluate(e, e.block(entry, &self.locations), t, journal)?;
        }
        // Its own rate, if it was among them, has scheduled it already.
        if self.agenda.time(i as u32) <= t {
            self.schedule(i, t);
        }
        Ok(())
    }

    /// A state may be scheduled again at the instant `before` of its last turn, but not for ever.
    #[inline]
    fn count_repeats(&mut self, i: usize, before: f64, t: f64) -> Result<(), Fault> {
        if before < t {
            self.repeats[i] = 0;
            return Ok(());
        }
        self.repeats[i] += 1;
        if self.repeats[i] > MOST_REPEATS {
            return Err(Fault::Resolution { state: StateIndex::new(i), time: t });
        }
        Ok(())
    }

    /// Evaluates the rates of a block at `t` (algorithm 3.2).
    #[inline]
    fn evaluate(&mut self, e: &Equations, block: &Block, t: f64, journal: &mut Journal) -> Result<(), Fault> {
        let orders = if block.bends { ORDER + 1 } else { ORDER };
        self.run_block(e, block, t, orders);
        if block.bends {
            self.still = self.still_for(e, block);
        }
        for row in &e.rows[block.rows.start as usize..block.rows.end as usize] {
            self.set_rate(e, *row, t, e.result(row.result, &self.memory, orders), journal)?;
        }
        Ok(())
    }

    /// Evaluates the block of an entry.
    pub(super) fn evaluate_entry(
        &mut self,
        e: &Equations,
        entry: Entry,
        t: f64,
        journal: &mut Journal,
    ) -> Result<(), Fault> {
        self.evaluate(e, e.block(entry, &self.locations), t, journal)
    }

    /// Runs the program of a block at `t`.
    #[inline]
    pub(super) fn run_block(&mut self, e: &Equations, block: &Block, t: f64, orders: usize) {
        self.memory[NOW] = t;
        e.execute(&block.call, &mut self.memory, orders);
    }

    /// How long, s, no source of a block moves by a quantum: until then its rates are those of the present place, as
    /// far as they are known at all.
    fn still_for(&self, e: &Equations, block: &Block) -> f64 {
        let still = |source: &SourceIndex| {
            let record = self.record(source.position());
            let ([_, q1, q2], quantum) = (record.q(), record.quantum());
            match (q1 == 0.0 && q2 == 0.0, quantum.is_finite()) {
                (true, _) => f64::INFINITY,
                // Inputs and time have no quantum.
                (false, false) => 0.0,
                (false, true) if q2 == 0.0 => quantum / q1.abs(),
                (false, true) => cubic_leaves([0.0, q1, q2, 0.0], quantum),
            }
        };
        e.sources(&block.sources).iter().map(still).fold(f64::INFINITY, f64::min)
    }

    /// δ_ext: a new rate arrives (algorithm 3.1). `rate` holds f, ḟ, ½f̈ along q.
    #[inline]
    fn set_rate(
        &mut self,
        e: &Equations,
        row: RowResult,
        t: f64,
        rate: Jet,
        journal: &mut Journal,
    ) -> Result<(), Fault> {
        let [f, f1, f2, f3] = rate;
        let i = row.state.position();
        let x = self.record(i).x_at(t);
        // What does not count for this order may be anything.
        let counts = [f, if ORDER > 1 { f1 } else { 0.0 }, if ORDER > 2 { f2 } else { 0.0 }];
        if !(x.is_finite() && counts.iter().all(|f| f.is_finite())) {
            return Err(not_finite(row.state, t, x, &counts));
        }
        let jet = [x, f, if ORDER > 1 { 0.5 * f1 } else { 0.0 }, if ORDER > 2 { f2 / 3.0 } else { 0.0 }];
        self.record_mut(i).set_x(jet, t);
        self.statistics.rates += 1;
        if row.bends {
            let quantum = self.record(i).quantum();
            let bend = &mut self.bends[i];
            bend.bends = true;
            // Evaluated only because it bends it coasts on; anything else ends the coasting.
            if self.refreshed != i {
                bend.coasting = t;
            }
            let left_out = match ORDER {
                1 => f1 / 2.0,
                2 => f2 / 3.0,
                _ => f3 / 4.0,
            };
            bend.room = quantum / left_out.abs();
            bend.trust = self.settings.trust.max(self.still);
        } else {
            self.bends[i] = STRAIGHT;
        }
        if journal.wanted {
            journal.push(sophy_field::Record::Segment { time: t, state: row.state, coefficients: jet });
        }
        self.schedule(i, t);
        for &watch in e.watches_of_source.row(i) {
            self.mark(watch);
        }
        Ok(())
    }

    /// ta: when a state next needs attention (algorithm 3.1, eq. 3.6), or its rate because it bends.
    #[inline]
    fn schedule(&mut self, i: usize, t: f64) {
        let record = self.record(i);
        let (mut next, evaluated) = (t + record.band_delay(t), record.tx());
        let bend = self.bends[i];
        if bend.bends {
            let trusted = evaluated + self.trusted_for(bend, evaluated, next - evaluated);
            self.bends[i].due = trusted < next;
            next = next.min(trusted);
        }
        // Rounding must not lead back; what is not a number is due at once and counted.
        self.agenda.set(i as u32, if next > t { next } else { t });
    }

    /// How long a rate evaluated at `t` may be trusted, exactly if that is less than `enough`: until what its
    /// segment leaves out has moved x by a quantum.
    ///
    /// A rate that coasts for τ, evaluated again and again without any change of a quantised variable, is
    /// allowed only s/τ of a quantum per evaluation, so that what adds up stays of the order of the quantum
    /// and the error converges with it at first order, as that of the method does.
    #[inline]
    fn trusted_for(&self, bend: Bend, t: f64, enough: f64) -> f64 {
        let Bend { room, coasting, trust, .. } = bend;
        let coasted = t - coasting;
        // Roots cost more than the question whether they matter.
        let power = match ORDER {
            1 => enough,
            2 => enough * enough,
            _ => enough * enough * enough,
        };
        if room >= power * enough && room >= power * coasted {
            return trust;
        }
        let (alone, shared) = match ORDER {
            1 => (room.sqrt(), room / coasted),
            2 => (libm::cbrt(room), (room / coasted).sqrt()),
            _ => (room.sqrt().sqrt(), libm::cbrt(room / coasted)),
        };
        alone.min(shared).min(trust)
    }

    /// Has a watch looked at before time goes on.
    #[inline]
    pub(super) fn mark(&mut self, watch: WatchIndex) {
        let record = &mut self.watches[watch.position()];
        if record.armed > 0 && !record.dirty {
            record.dirty = true;
            self.dirty.push(watch);
        }
    }

    /// A state whose time has come: the edge of its band, or only a rate that bends.
    #[inline]
    fn state_due(&mut self, e: &Equations, i: usize, t: f64, journal: &mut Journal) -> Result<(), Fault> {
        if !self.bends[i].due {
            return self.step(e, i, t, journal);
        }
        self.count_repeats(i, self.record(i).tx(), t)?;
        self.statistics.refreshes += 1;
        self.refreshed = i;
        for &entry in e.entries(&e.own[i]) {
            self.evaluate(e, e.block(entry, &self.locations), t, journal)?;
        }
        self.refreshed = usize::MAX;
        Ok(())
    }

    /// Evaluates what a change concerns: the entries collected, and what fresh states influence. Twice, for
    /// values first, so that the quantised trajectories of fresh states start with their slopes.
    fn evaluate_afresh(&mut self, e: &Equations, t: f64, journal: &mut Journal) -> Result<(), Fault> {
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
            self.evaluate(e, e.block(entry, &self.locations), t, journal)?;
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
        let quantum = self.settings.quanta[i].at(x);
        let mut record = self.record_mut(i);
        record.set_q([x, 0.0, 0.0], t);
        record.set_quantum(quantum);
        self.repeats[i] = 0;
    }

    fn set_state(&mut self, state: StateIndex, value: f64, t: f64) -> Result<(), Fault> {
        if !value.is_finite() {
            return Err(Fault::StateNotFinite { state, time: t, value });
        }
        self.record_mut(state.position()).set_x([value, 0.0, 0.0, 0.0], t);
        Ok(())
    }

    fn set_input(&mut self, e: &Equations, input: usize, line: [f64; 2], t: f64) -> SourceIndex {
        let source = SourceIndex(e.layout.states + input as u32);
        self.record_mut(source.position()).set_line(line[0], line[1], t);
        source
    }

    /// Enters a location: arms its watches, disarms those left, and gives the states whose right-hand side is
    /// another one.
    fn enter(&mut self, e: &Equations, automaton: usize, location: LocationIndex) {
        let code = &e.automata[automaton];
        let (from, to) = (self.locations[automaton].position(), location.position());
        for &watch in &code.armed[to] {
            self.arm(watch);
        }
        for &watch in &code.armed[from] {
            self.disarm(e, watch);
        }
        self.locations[automaton] = location;
        self.note_entered(AutomatonIndex::new(automaton));
        self.decide_again(&code.readers);
        let changed = code.row_of[from].iter().zip(&code.row_of[to]).map(|(a, b)| a != b);
        self.fresh.extend(code.states.iter().zip(changed).filter_map(|(&s, changed)| changed.then_some(s)));
    }

    fn note_entered(&mut self, automaton: AutomatonIndex) {
        self.entered[automaton.position()] = true;
        self.entering.push(automaton);
    }
}

fn not_finite(state: StateIndex, time: f64, x: f64, rate: &[f64]) -> Fault {
    if x.is_finite() {
        let value = rate.iter().copied().find(|f| !f.is_finite()).unwrap_or(f64::NAN);
        Fault::NotFinite { state, time, value }
    } else {
        Fault::StateNotFinite { state, time, value: x }
    }
}

impl<const ORDER: usize> Engine for Qss<ORDER> {
    fn start(&mut self, e: &Equations, start: &Start<'_>, journal: &mut Journal) -> Result<(), Fault> {
        let t = start.time;
        for (i, &value) in start.states.iter().enumerate() {
            self.set_state(StateIndex::new(i), value, t)?;
            self.fresh.push(StateIndex::new(i));
        }
        for (input, &line) in start.inputs.iter().enumerate() {
            self.set_input(e, input, line, t);
        }
        self.record_mut(e.layout.time().position()).set_line(0.0, 1.0, 0.0);
        self.locations.copy_from_slice(start.locations);
        for (code, location) in e.automata.iter().zip(start.locations) {
            for &watch in &code.armed[location.position()] {
                self.arm(watch);
            }
        }
        self.guess_truths(e, t);
        for (automaton, range) in e.on_location.iter().enumerate() {
            self.note_entered(AutomatonIndex::new(automaton));
            self.entries.extend_from_slice(e.entries(range));
        }
        self.evaluate_afresh(e, t, journal)?;
        self.settle(e, t, journal)
    }

    fn advance(
        &mut self,
        e: &Equations,
        until: f64,
        budget: u64,
        journal: &mut Journal,
    ) -> Result<Stop, Fault> {
        let states = e.layout.states;
        let mut left = budget;
        let mut crossed = false;
        let mut now = f64::NEG_INFINITY;
        while let Some((t, slot)) = self.agenda.first() {
            if crossed && t > now {
                return Ok(Stop::Crossed(now));
            }
            if t > until {
                break;
            }
            if left == 0 && t > now {
                return Ok(Stop::Budget(now));
            }
            left = left.saturating_sub(1);
            now = t;
            let enclosures = self.statistics.enclosures;
            if slot < states {
                self.state_due(e, slot as usize, t, journal)?;
            } else {
                let watch = WatchIndex(slot - states);
                self.watch_due(e, watch, t, journal)?;
            }
            if !self.dirty.is_empty() {
                self.predict_dirty(e, t)?;
            }
            left = left.saturating_sub((self.statistics.enclosures - enclosures) / ENCLOSURES_PER_STEP);
            crossed |= !self.changed.is_empty();
        }
        Ok(if crossed { Stop::Crossed(now) } else { Stop::Horizon })
    }

    fn change(
        &mut self,
        e: &Equations,
        at: f64,
        changes: &Changes,
        journal: &mut Journal,
    ) -> Result<(), Fault> {
        for &(state, value) in &changes.states {
            self.set_state(state, value, at)?;
            self.fresh.push(state);
            self.touch(e, SourceIndex(state.0));
        }
        for &(input, line) in &changes.inputs {
            let source = self.set_input(e, input.position(), line, at);
            self.entries.extend_from_slice(e.entries(&e.influence[source.position()]));
            self.touch(e, source);
            if journal.wanted {
                journal.push(sophy_field::Record::Input { time: at, input, value: line[0], slope: line[1] });
            }
        }
        for &(automaton, location) in &changes.locations {
            self.enter(e, automaton.position(), location);
            let range = &e.on_location[automaton.position()];
            self.entries.extend_from_slice(e.entries(range));
            if journal.wanted {
                journal.push(sophy_field::Record::Location { time: at, automaton, location });
            }
        }
        self.guess_truths(e, at);
        self.evaluate_afresh(e, at, journal)?;
        self.settle(e, at, journal)
    }

    fn value(&self, source: SourceIndex, time: f64) -> f64 {
        self.record(source.position()).x_at(time)
    }

    fn jet(&self, source: SourceIndex, time: f64) -> Jet {
        self.record(source.position()).x_from(time)
    }

    fn quantised(&self, state: StateIndex, time: f64) -> f64 {
        self.record(state.position()).q_at(time)
    }

    fn sign(&self, watch: WatchIndex) -> Sign {
        self.watches[watch.position()].sign
    }

    fn take_changed(&mut self, into: &mut Vec<WatchIndex>) {
        into.append(&mut self.changed);
    }

    fn locations(&self) -> &[LocationIndex] {
        &self.locations
    }

    fn jacobian(&self, e: &Equations, time: f64) -> Vec<(StateIndex, SourceIndex, f64)> {
        let mut memory = self.memory.clone();
        memory[NOW] = time;
        let mut entries = Vec::new();
        for (i, rate) in e.rates.iter().enumerate() {
            let formula = e.selected(*rate, &self.locations);
            let sources = e.sources(&formula.sources);
            for &source in sources {
                for &other in sources {
                    let slope = if other == source { 1.0 } else { 0.0 };
                    e.layout.set_integrated(&mut memory, other, &[self.value(other, time), slope], time);
                }
                let [_, slope, ..] = e.formula(formula, &self.locations, &mut memory, 2);
                entries.push((StateIndex::new(i), source, slope));
            }
        }
        entries
    }

    fn statistics(&self) -> Statistics {
        self.statistics
    }

    fn snapshot(&self) -> Box<dyn Engine> {
        Box::new(self.clone())
    }
}
