use sophy_field::{Fault, StateIndex, TransitionIndex};

/// Why an instant cannot be completed. The run so far stays readable.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum HybridError {
    /// The engine cannot go on.
    #[error(transparent)]
    Engine(#[from] Fault),
    /// Two transitions of one micro-step give a state different values.
    #[error("a state is assigned twice at t = {time} s")]
    AssignedTwice {
        /// The instant, s.
        time: f64,
        /// The state.
        state: StateIndex,
        /// Both transitions.
        transitions: [TransitionIndex; 2],
        /// What they give it.
        values: [f64; 2],
    },
    /// Transitions go round at one instant without end.
    #[error("a livelock at t = {time} s")]
    Livelock {
        /// The instant, s.
        time: f64,
        /// Micro-steps taken.
        steps: u32,
        /// The transitions of one round, in order; the last ones taken if no round closed.
        cycle: Vec<TransitionIndex>,
        /// Whether the state after the round is exactly that before it.
        exact: bool,
    },
}
