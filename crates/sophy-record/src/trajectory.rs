//! The exact trajectory of the states: their segments, and the locations over time.

/// Which value at a jump.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// Before micro-step 0.
    Left,
    /// After the last micro-step.
    Right,
}

/// Segments of every state and the locations of every automaton over a run.
///
/// Each state's segment holds until the next one; segments of one start time supersede each other, the last
/// one being the limit from the right.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Trajectory {
    states: Vec<Vec<Piece>>,
    locations: Vec<Vec<(f64, u32)>>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct Piece {
    start: f64,
    coefficients: [f64; 4],
}

impl Trajectory {
    /// An empty trajectory of `states` states and `automata` automata.
    pub fn new(states: usize, automata: usize) -> Self {
        Trajectory { states: vec![Vec::new(); states], locations: vec![Vec::new(); automata] }
    }

    /// State `state` follows `c₀ + c₁ s + c₂ s² + c₃ s³`, s = t − start (s), from `start` on.
    pub fn push_segment(&mut self, state: usize, start: f64, coefficients: [f64; 4]) {
        self.states[state].push(Piece { start, coefficients });
    }

    /// Automaton `automaton` is in `location` from `time` on.
    pub fn push_location(&mut self, automaton: usize, time: f64, location: u32) {
        self.locations[automaton].push((time, location));
    }

    /// Value of a state at `time`; before the first segment it is the first segment's start.
    pub fn value(&self, state: usize, time: f64, side: Side) -> f64 {
        let pieces = &self.states[state];
        let after = match side {
            Side::Right => pieces.partition_point(|piece| piece.start <= time),
            Side::Left => pieces.partition_point(|piece| piece.start < time),
        };
        let Some(piece) = pieces.get(after.max(1) - 1) else { return f64::NAN };
        let s = (time - piece.start).max(0.0);
        let [c0, c1, c2, c3] = piece.coefficients;
        c0 + s * (c1 + s * (c2 + s * c3))
    }

    /// Location of an automaton at `time`.
    pub fn location(&self, automaton: usize, time: f64, side: Side) -> Option<u32> {
        let history = &self.locations[automaton];
        let after = match side {
            Side::Right => history.partition_point(|entry| entry.0 <= time),
            Side::Left => history.partition_point(|entry| entry.0 < time),
        };
        history.get(after.max(1) - 1).map(|entry| entry.1)
    }

    /// Number of segments of a state.
    pub fn segments(&self, state: usize) -> usize {
        self.states[state].len()
    }

    /// Starts of a state's segments, s.
    pub fn starts(&self, state: usize) -> impl Iterator<Item = f64> {
        self.states[state].iter().map(|piece| piece.start)
    }
}
