use super::bend::Bend;
use super::group::MOST;
use super::implicit::Ahead;
use super::own::{Own, Quanta};
use super::record::{Place, Record, RecordMut};
use super::settings::Settings;
use super::watches::WatchRecord;
use sophy_field::{
    Agenda, AutomatonIndex, Ball, Changes, Engine, Equations, Fault, Formula, Jet, Journal, LocationIndex,
    Memory, NOW, SourceIndex, Start, StateIndex, Statistics, Stop, Turn, WatchIndex, sources_of, turns_of,
};
use sophy_segment::{Interval, Sign};
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// Explicit, of the first order.
pub type Qss1 = Qss<1, false>;
/// Explicit, of the second order.
pub type Qss2 = Qss<2, false>;
/// Explicit, of the third order.
pub type Qss3 = Qss<3, false>;
/// Linearly implicit, of the first order.
pub type Liqss1 = Qss<1, true>;
/// Linearly implicit, of the second order.
pub type Liqss2 = Qss<2, true>;
/// Linearly implicit, of the third order.
pub type Liqss3 = Qss<3, true>;

/// The quantised-state engine of order `ORDER`, with linearly implicit quantisation (LIQSS) if `IMPLICIT`.
///
/// Equations must have been compiled for the same order. Slots of the agenda: the states (change of q, or
/// evaluation of a rate that bends), then the watches.
#[derive(Clone, Debug)]
pub struct Qss<const ORDER: usize, const IMPLICIT: bool> {
    pub(super) settings: Settings,
    /// Per state.
    pub(super) own: Vec<Own>,
    pub(super) quanta: Quanta,
    /// Of the states that may bend.
    pub(super) bends: Vec<Bend>,
    /// Per state, if quantisation is implicit.
    pub(super) ahead: Vec<Ahead>,
    /// The state whose rate is being evaluated only because it bends; `usize::MAX` if none.
    pub(super) refreshed: usize,
    /// See [`Qss::still_for`], of the block evaluated last.
    pub(super) still: f64,
    /// Why the run cannot go on.
    fault: Option<Fault>,
    pub(super) watches: Vec<WatchRecord>,
    pub(super) locations: Vec<LocationIndex>,
    pub(super) agenda: Agenda,
    /// Memory of the programs, with the records of states, inputs and time.
    pub(super) memory: Memory,
    /// What stands behind the records, enclosed by intervals and by balls; empty if all watches are affine.
    pub(super) enclosed: Vec<Interval>,
    pub(super) bounded: Vec<Ball>,
    /// What a record held of q; empty in between.
    pub(super) kept: Vec<([f64; 3], f64)>,
    /// What records held of x while a crossing is doubted, and since when; empty in between.
    pub(super) doubting: Vec<(usize, [f64; 4], f64)>,
    /// How often a location, a truth or a stair has changed: what is affine in its sources has kept its slopes since.
    pub(super) switchings: u64,
    /// States put at rest with the one that steps; empty in between.
    pub(super) joined: Vec<StateIndex>,
    /// Watches to look at again before time goes on; while they are settled, the next of them in order.
    pub(super) dirty: Vec<WatchIndex>,
    pub(super) settling: BinaryHeap<Reverse<WatchIndex>>,
    /// Watches of guards whose sign changed, for the hybrid logic.
    pub(super) changed: Vec<WatchIndex>,
    /// Blocks to evaluate in a change, states that start afresh there, and their slopes; empty in between.
    pub(super) turns: Vec<Turn>,
    pub(super) fresh: Vec<StateIndex>,
    /// Automata that enter a location in a change: each, and which.
    pub(super) entered: Vec<bool>,
    pub(super) entering: Vec<AutomatonIndex>,
    pub(super) slopes: Vec<(usize, f64)>,
    pub(super) statistics: Statistics,
}

/// The run cannot go on; why stands in [`Qss::fault`].
#[derive(Clone, Copy, Debug)]
pub(super) struct Failed;

/// Room for so many things to do is kept from one change to the next.
const KEPT: usize = 4096;
/// So many enclosures count as a step of the budget.
const ENCLOSURES_PER_STEP: u64 = 4;

impl<const ORDER: usize, const IMPLICIT: bool> Qss<ORDER, IMPLICIT> {
    /// An engine that has not been started.
    pub fn new(equations: &Equations, mut settings: Settings) -> Self {
        let layout = equations.layout;
        let (states, watches) = (layout.states as usize, equations.watches.len());
        let searched = equations.watch_codes.iter().any(|watch| !watch.affine);
        let rest = if searched { &equations.image[..] } else { &[] };
        let (mut own, quanta) = Own::of(&std::mem::take(&mut settings.quanta));
        Qss {
            ahead: vec![Ahead::NEW; if IMPLICIT { states } else { 0 }],
            bends: Own::find_bends(&mut own, equations),
            own,
            quanta,
            settings,
            refreshed: usize::MAX,
            still: 0.0,
            fault: None,
            watches: vec![WatchRecord::default(); watches],
            locations: vec![LocationIndex(0); equations.automata.len()],
            agenda: Agenda::new(states + watches),
            memory: equations.memory(),
            enclosed: rest.iter().map(|&value| Interval::point(value)).collect(),
            bounded: rest.iter().map(|&value| [value, 0.0]).collect(),
            kept: Vec::new(),
            doubting: Vec::new(),
            switchings: 0,
            joined: Vec::with_capacity(MOST),
            dirty: Vec::new(),
            settling: BinaryHeap::new(),
            changed: Vec::new(),
            turns: Vec::new(),
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
        let at = source + 1;
        Record(match Place::<ORDER>::LINES {
            1 => self.memory.lines::<1>(at).as_flattened(),
            _ => self.memory.lines::<2>(at).as_flattened(),
        })
    }

    #[inline]
    pub(super) fn record_mut(&mut self, source: usize) -> RecordMut<'_, ORDER> {
        let at = source + 1;
        RecordMut(match Place::<ORDER>::LINES {
            1 => self.memory.lines_mut::<1>(at).as_flattened_mut(),
            _ => self.memory.lines_mut::<2>(at).as_flattened_mut(),
        })
    }

    #[cold]
    pub(super) fn fail(&mut self, fault: Fault) -> Failed {
        self.fault = Some(fault);
        Failed
    }

    /// Why the run cannot go on; a run that can is taken for one out of time.
    #[cold]
    pub(super) fn why(&mut self, _: Failed) -> Fault {
        let nothing = Fault::Resolution { state: StateIndex(0), time: self.memory[NOW] };
        self.fault.take().unwrap_or(nothing)
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
}

impl<const ORDER: usize, const IMPLICIT: bool> Engine for Qss<ORDER, IMPLICIT> {
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
        for (automaton, location) in start.locations.iter().enumerate() {
            let (code, copy) = e.automaton(AutomatonIndex::new(automaton));
            for watch in &code.armed[location.position()] {
                self.arm(WatchIndex(watch.of(copy)));
            }
        }
        self.guess_truths(e, t);
        self.evaluate_afresh(e, t, journal)?;
        // Never again is all of a large system evaluated at once.
        self.turns.shrink_to(KEPT);
        self.fresh.shrink_to(KEPT);
        self.slopes.shrink_to(KEPT);
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
            if slot < states {
                self.state_due(e, slot as usize, t, journal).map_err(|failed| self.why(failed))?;
                if self.dirty.is_empty() {
                    continue;
                }
            }
            let enclosures = self.statistics.enclosures;
            if slot >= states {
                self.watch_due(e, WatchIndex(slot - states), t, journal)?;
            }
            self.predict_dirty(e, t)?;
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
            let (influence, copy) = e.influence(source.position());
            self.turns.extend(influence.iter().map(|evaluation| evaluation.of(copy)));
            self.touch(e, source);
            if journal.wanted {
                journal.push(sophy_field::Record::Input { time: at, input, value: line[0], slope: line[1] });
            }
        }
        for &(automaton, location) in &changes.locations {
            self.enter(e, automaton.position(), location);
            let (code, copy) = e.automaton(automaton);
            self.turns.extend(turns_of(&code.on_change, copy));
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

    fn formula(&mut self, e: &Equations, formula: (&Formula, u32), time: f64) -> f64 {
        self.memory[NOW] = time;
        e.value(formula, &self.locations, &mut self.memory)
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
        // Along x, where everything stands still but one.
        let still = |memory: &mut Memory, source: usize, slope: f64| {
            let source = SourceIndex(source as u32);
            e.layout.set_quantised(memory, source, &[self.value(source, time), slope], time);
        };
        (0..e.layout.sources()).for_each(|source| still(&mut memory, source, 0.0));
        let mut entries = Vec::new();
        let mut sources = Vec::new();
        for state in 0..e.layout.states as usize {
            sources.clear();
            for (block, copy) in e.own_blocks(state, &self.locations) {
                sources.extend(sources_of(&block.reads, copy).map(SourceIndex::position));
            }
            sources.sort_unstable();
            sources.dedup();
            for &source in &sources {
                still(&mut memory, source, 1.0);
                let mut slope = 0.0;
                for (block, copy) in e.own_blocks(state, &self.locations) {
                    e.execute(&block.call, copy, &mut memory, 2);
                    let own = block.rows.iter().find(|row| row.state.of(copy) as usize == state);
                    slope = own.map_or(slope, |row| e.rate(row, copy, &memory)[1]);
                }
                still(&mut memory, source, 0.0);
                entries.push((StateIndex::new(state), SourceIndex(source as u32), slope));
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
