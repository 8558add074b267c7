//! The floor: QSS2 written by hand in plain Rust for one model each, to show what generality costs.
//!
//! Every floor does what the engine does, in the same order and with the same formulas, so that both give the
//! same bits: the records and the band (`state`), the rates with their exact derivatives, the watches located
//! on x. What a person who writes for one model leaves out is left out: programs, incidence lists, checks for
//! values that are not finite, bounds on repetition. The closed form of a crossing is that of `sophy-segment`.

pub mod hopper;
pub mod line;
pub mod oscillator;
mod state;
