use crate::{AutomatonIndex, InputIndex, Jet, LocationIndex, StateIndex, WatchIndex};
use sophy_segment::Sign;

/// What an engine and the hybrid logic write down as a run goes on, in the order it happens. The recorder
/// turns it into rows; nothing reads it back to decide anything.
#[derive(Clone, Debug, Default)]
pub struct Journal {
    entries: Vec<Record>,
    /// Whether segments are wanted at all.
    pub wanted: bool,
}

/// One line of a [`Journal`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Record {
    /// From `time` (s) on a state follows `c₀ + c₁ s + c₂ s² + c₃ s³`.
    Segment {
        /// Start, s.
        time: f64,
        /// The state.
        state: StateIndex,
        /// In unit, unit/s, unit/s², unit/s³.
        coefficients: Jet,
    },
    /// From `time` (s) on an input follows `value + slope·s`.
    Input {
        /// Start, s.
        time: f64,
        /// The input.
        input: InputIndex,
        /// Value at the start, in the input's unit.
        value: f64,
        /// Unit/s.
        slope: f64,
    },
    /// At `time` (s) a quantised state took its value; x goes on. Left out where another line has that instant.
    Step {
        /// The instant, s.
        time: f64,
        /// The state.
        state: StateIndex,
    },
    /// A watch that decides switches (kinks) changed its sign.
    Switch {
        /// The instant, s.
        time: f64,
        /// The watch.
        watch: WatchIndex,
        /// Its sign now.
        sign: Sign,
    },
    /// Micro-step `step` at `time` begins; what was written before holds up to it.
    Jump {
        /// The instant, s.
        time: f64,
        /// Micro-step, from 0.
        step: u32,
    },
    /// An automaton enters a location.
    Location {
        /// The instant, s.
        time: f64,
        /// The automaton.
        automaton: AutomatonIndex,
        /// The location entered.
        location: LocationIndex,
    },
}

impl Record {
    /// When.
    #[inline]
    pub fn time(&self) -> f64 {
        match *self {
            Record::Segment { time, .. }
            | Record::Input { time, .. }
            | Record::Step { time, .. }
            | Record::Switch { time, .. }
            | Record::Jump { time, .. }
            | Record::Location { time, .. } => time,
        }
    }
}

impl Journal {
    /// A journal that keeps segments.
    pub fn wanted() -> Self {
        Journal { entries: Vec::new(), wanted: true }
    }

    /// Writes a line, if they are wanted. A [`Record::Step`] only says that something happens at an instant, so it is
    /// kept only where no other line says so: a step that begins a segment would give the recorder two lines to read.
    #[inline]
    pub fn push(&mut self, record: Record) {
        if !self.wanted {
            return;
        }
        match (self.entries.last_mut(), record) {
            (Some(last), Record::Step { time, .. }) if last.time() == time => {}
            (Some(last @ Record::Step { .. }), Record::Segment { time, .. }) if last.time() == time => {
                *last = record;
            }
            _ => self.entries.push(record),
        }
    }

    /// Nothing is wanted from now on; what was written is forgotten.
    pub fn stop(&mut self) {
        *self = Journal::default();
    }

    /// Gives back what it took to grow.
    pub fn shrink_to_fit(&mut self) {
        self.entries.shrink_to_fit();
    }

    /// Number of lines.
    #[inline]
    pub fn len(&self) -> usize {
        self.entries.len()
    }

    /// Whether nothing was written.
    pub fn is_empty(&self) -> bool {
        self.entries.is_empty()
    }

    /// The lines in order.
    pub fn lines(&self) -> &[Record] {
        &self.entries
    }

    /// Forgets all lines and keeps their memory.
    pub fn clear(&mut self) {
        self.entries.clear();
    }

    /// Gives the lines away and goes on in the memory of `empty`.
    pub fn exchange(&mut self, mut empty: Vec<Record>) -> Vec<Record> {
        empty.clear();
        std::mem::replace(&mut self.entries, empty)
    }
}

#[cfg(test)]
mod tests {
    use super::{Journal, Record};
    use crate::StateIndex;

    #[test]
    fn a_step_is_kept_only_where_no_other_line_has_its_instant() {
        let step = |time, state| Record::Step { time, state: StateIndex(state) };
        let segment = |time| Record::Segment { time, state: StateIndex(0), coefficients: [0.0; 4] };
        let mut journal = Journal::wanted();
        let lines = [
            step(1.0, 0),
            step(1.0, 1),
            segment(1.0),
            segment(1.0),
            step(1.0, 2),
            step(2.0, 0),
            segment(3.0),
        ];
        for line in lines {
            journal.push(line);
        }
        assert_eq!(journal.lines(), [segment(1.0), segment(1.0), step(2.0, 0), segment(3.0)]);
    }

    #[test]
    fn the_right_limit_of_a_jump_is_marked_by_the_jump() {
        let jump = Record::Jump { time: 1.0, step: 0 };
        let mut journal = Journal::wanted();
        journal.push(Record::Step { time: 1.0, state: StateIndex(0) });
        journal.push(jump);
        journal.push(Record::Step { time: 1.0, state: StateIndex(0) });
        assert_eq!(journal.lines(), [Record::Step { time: 1.0, state: StateIndex(0) }, jump]);
    }
}
