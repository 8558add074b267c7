//! `System` → callable [`sophy_field::Equations`] and [`sophy_field::Logic`].
//!
//! - [`compile`] is the whole path: parameters are evaluated, rows become programs, programs are gathered
//!   into blocks by influence.
//! - One program serves every use: [`interpret`](interpreter) runs it on `f64` jets to any order (so that
//!   derivatives along the motion are exact), on balls for quick bounds, and on intervals for enclosures.

mod automata;
mod ball;
mod blocks;
mod compile;
mod incidence;
mod interpreter;
mod jet;
mod logic;
mod memory;
mod native;
mod patterns;
mod programs;
mod repeats;
mod scalar;
mod shapes;
mod watches;

pub use compile::{CompileError, Compiled, Parameters, compile, compile_sharing};
pub use interpreter::{bound, enclose, run};
pub use native::{NoNativeCode, native};
pub use shapes::Sharing;
