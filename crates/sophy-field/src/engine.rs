use crate::{
    AutomatonIndex, Equations, Formula, InputIndex, Jet, Journal, LocationIndex, SourceIndex, StateIndex,
    WatchIndex,
};
use sophy_segment::Sign;
use std::fmt::Debug;

/// An engine turns derivatives into segments and locates crossings on them. It knows no model, no file, no
/// transition; what a crossing means is the business of the hybrid logic.
///
/// Object-safe: one call per burst. Engines can be exchanged during a run.
pub trait Engine: Debug + Send {
    /// Sets the run to `start` and decides every watch there.
    ///
    /// # Errors
    /// [`Fault`] if a rate is not finite or a watch cannot be decided.
    fn start(&mut self, equations: &Equations, start: &Start<'_>, journal: &mut Journal)
    -> Result<(), Fault>;

    /// Advances until something happens: at the latest to `until` (s, inclusive), or for `budget` steps.
    ///
    /// Pausing (`Horizon`, `Budget`) leaves no trace in the numbers that follow.
    ///
    /// # Errors
    /// [`Fault`] when the run cannot go on.
    fn advance(
        &mut self,
        equations: &Equations,
        until: f64,
        budget: u64,
        journal: &mut Journal,
    ) -> Result<Stop, Fault>;

    /// Applies a batch of changes at `at` (s), which must not lie before what was advanced to; watches are
    /// decided again as on entry.
    ///
    /// # Errors
    /// [`Fault`] if a rate is not finite afterwards or a watch cannot be decided.
    fn change(
        &mut self,
        equations: &Equations,
        at: f64,
        changes: &Changes,
        journal: &mut Journal,
    ) -> Result<(), Fault>;

    /// x of a state, or the value of an input, or time itself, at `time` (s) on the present segment.
    fn value(&self, source: SourceIndex, time: f64) -> f64;

    /// Value and derivatives of a source at `time` (s), as Taylor coefficients.
    fn jet(&self, source: SourceIndex, time: f64) -> Jet;

    /// Quantised value q of a state at `time` (s); engines without quantisation give x.
    fn quantised(&self, state: StateIndex, time: f64) -> f64;

    /// The value of a formula over x at `time` (s), of a copy.
    fn formula(&mut self, equations: &Equations, formula: (&Formula, u32), time: f64) -> f64;

    /// The decided sign of a watch; meaningful while the watch is armed.
    fn sign(&self, watch: WatchIndex) -> Sign;

    /// Moves the watches whose sign changed since the last call into `into`.
    fn take_changed(&mut self, into: &mut Vec<WatchIndex>);

    /// Present location of each automaton.
    fn locations(&self) -> &[LocationIndex];

    /// ∂f/∂z at `time` (s) along x, row by row: state, source, value; structural zeros left out.
    fn jacobian(&self, equations: &Equations, time: f64) -> Vec<(StateIndex, SourceIndex, f64)>;

    /// Counts since the start.
    fn statistics(&self) -> Statistics;

    /// The whole state of the run so far, to go on from later.
    fn snapshot(&self) -> Box<dyn Engine>;
}

/// Where a run starts.
#[derive(Clone, Copy, Debug)]
pub struct Start<'a> {
    /// Simulated time, s.
    pub time: f64,
    /// x of every state.
    pub states: &'a [f64],
    /// Value and slope (per s) of every input.
    pub inputs: &'a [[f64; 2]],
    /// Location of every automaton.
    pub locations: &'a [LocationIndex],
}

/// Why a burst ended.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Stop {
    /// The horizon is reached; nothing happens up to and including it.
    Horizon,
    /// Watches read by guards changed sign at this time, s; ask [`Engine::take_changed`].
    Crossed(f64),
    /// The budget of steps is used up; call again. The time reached, s.
    Budget(f64),
}

/// What may be changed from outside: by transitions, inputs, estimators. One door for all.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Changes {
    /// New values of states.
    pub states: Vec<(StateIndex, f64)>,
    /// New value and slope (per s) of inputs.
    pub inputs: Vec<(InputIndex, [f64; 2])>,
    /// New locations.
    pub locations: Vec<(AutomatonIndex, LocationIndex)>,
}

impl Changes {
    /// Whether nothing changes.
    pub fn is_empty(&self) -> bool {
        self.states.is_empty() && self.inputs.is_empty() && self.locations.is_empty()
    }

    /// Forgets everything, keeps the memory.
    pub fn clear(&mut self) {
        self.states.clear();
        self.inputs.clear();
        self.locations.clear();
    }
}

/// Why an engine cannot go on. The run so far stays readable.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum Fault {
    /// The right-hand side of a state is NaN or infinite.
    #[error("the rate of {state} is {value} at t = {time} s")]
    NotFinite {
        /// The state.
        state: StateIndex,
        /// When, s.
        time: f64,
        /// What came out.
        value: f64,
    },
    /// A state was set to, or has grown to, NaN or infinity.
    #[error("{state} is {value} at t = {time} s")]
    StateNotFinite {
        /// The state.
        state: StateIndex,
        /// When, s.
        time: f64,
        /// Its value.
        value: f64,
    },
    /// A watch is NaN.
    #[error("{watch} is {value} at t = {time} s")]
    WatchNotFinite {
        /// The watch.
        watch: WatchIndex,
        /// When, s.
        time: f64,
        /// Its value.
        value: f64,
    },
    /// The argument of a table is outside of the range of its knots.
    #[error("a table is left through {watch} at t = {time} s")]
    OutsideTable {
        /// The watch of the stair that has no edge on this side.
        watch: WatchIndex,
        /// When, s.
        time: f64,
        /// The argument there.
        value: f64,
    },
    /// The sign of a non-linear watch cannot be decided to rounding.
    #[error("the sign of {watch} cannot be decided at t = {time} s")]
    Undecided {
        /// The watch.
        watch: WatchIndex,
        /// Where, s.
        time: f64,
    },
    /// A state is scheduled at its own instant again and again: its quantum is below the resolution of time.
    #[error("the time resolution is exhausted by {state} at t = {time} s")]
    Resolution {
        /// The state.
        state: StateIndex,
        /// When, s.
        time: f64,
    },
    /// A watch changes its sign again and again at one instant: the fields on both sides point at it.
    #[error("{watch} changes sign again and again at t = {time} s")]
    Chattering {
        /// The watch.
        watch: WatchIndex,
        /// When, s.
        time: f64,
    },
}

/// Counts of work done.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Statistics {
    /// Changes of a quantised state (integrator outputs).
    pub steps: u64,
    /// Right-hand sides evaluated, row by row.
    pub rates: u64,
    /// Right-hand sides evaluated again only because they bend.
    pub refreshes: u64,
    /// Predictions of crossings.
    pub predictions: u64,
    /// Sign changes located.
    pub crossings: u64,
    /// Enclosures of conditions that are not affine, over stretches of time.
    pub enclosures: u64,
}
