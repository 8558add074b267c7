use sophy_field::{Fault, TransitionIndex};

/// Why an instant cannot be completed. The run so far stays readable.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum HybridError {
    /// The engine cannot go on.
    #[error(transparent)]
    Engine(#[from] Fault),
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
