//! Hybrid location control: what a crossing means.
//!
//! [`Control::react`] takes the micro-steps of one instant: it asks the engine which watches changed, finds
//! the transitions whose trigger holds, evaluates their resets on the values before, hands the engine one
//! batch of changes, and delivers events, until nothing is enabled. [`Zeno`] recognises transitions that
//! accumulate. Automata stay side by side; locations are never multiplied.
//!
//! Knows no solver, no model text and no file.

mod control;
mod error;
mod livelock;
mod queues;
mod worklist;
mod zeno;

pub use control::{Control, Counts, Taken};
pub use error::HybridError;
pub use zeno::{Accumulation, Zeno};
