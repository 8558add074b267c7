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
    /// At `time` (s) a quantised state took its value; x goes on.
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

    /// Writes a line, if they are wanted.
    #[inline]
    pub fn push(&mut self, record: Record) {
        if self.wanted {
            self.entries.push(record);
        }
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

    /// The lines in order; the journal is empty afterwards and keeps its memory.
    pub fn drain(&mut self) -> impl Iterator<Item = Record> {
        self.entries.drain(..)
    }
}
