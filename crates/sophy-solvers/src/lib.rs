//! Engines: derivatives → segments, crossings located on them.
//!
//! - [`Qss`]: the quantised-state methods QSS1 to QSS3 (thesis ch. 3) and, linearly implicit, LIQSS1 to LIQSS3: each
//!   state is integrated by itself, events are predicted and never stepped back over.
//!
//! No language, no file, no terminal here; what a crossing means is the business of the hybrid logic.

mod qss;

pub use qss::{Liqss1, Liqss2, Liqss3, Qss, Qss1, Qss2, Qss3, Quantum, Settings};
