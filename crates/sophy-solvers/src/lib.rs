//! Engines: derivatives → segments, crossings located on them.
//!
//! - [`Qss`]: the quantised-state methods QSS1 and QSS2 (thesis ch. 3): each state is integrated by itself,
//!   events are predicted and never stepped back over.
//!
//! No language, no file, no terminal here; what a crossing means is the business of the hybrid logic.

mod qss;

pub use qss::{Qss, Quantum, Settings};
