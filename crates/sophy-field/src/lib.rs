//! What equations, engines and hybrid logic say to one another.
//!
//! - Typed indices ([`StateIndex`] …): after the passes no name is looked up.
//! - [`Equations`]: callable equations and their incidence, filled by the code generator, read by engines.
//! - [`Engine`]: advances in bursts, answers [`Stop`]; takes [`Changes`]; writes a [`Journal`].
//! - [`Logic`]: compiled transitions, read by the hybrid logic.
//! - [`Agenda`]: the queue of what happens next.

mod agenda;
mod copies;
mod engine;
mod equations;
mod index;
mod journal;
mod layout;
mod logic;
mod memory;
mod program;
mod table;

pub use agenda::Agenda;
pub use copies::{Affine, Site};
pub use engine::{Changes, Engine, Fault, Start, Statistics, Stop};
pub use equations::{
    AutomatonCode, Block, Equations, Evaluation, Formula, Influence, RowResult, SourceIndex, StairCode, Turn,
    WatchCode, sources_of, turns_of,
};
pub use index::{
    AlgebraicIndex, AutomatonIndex, ColumnIndex, EventIndex, InputIndex, LocationIndex, OutputIndex,
    ParameterIndex, StairIndex, StateIndex, TransitionIndex, TruthIndex, WatchIndex,
};
pub use journal::{Journal, Record};
pub use layout::{Layout, NOW, RecordLayout};
pub use logic::{
    AutomatonLogic, EmissionCode, Guard, GuardStep, Logic, TransitionCode, TriggerCode, sign_bit,
};
pub use memory::Memory;
pub use program::{
    Ball, Bound, BoundKernel, Call, Code, Enclose, Enclosing, Instruction, Jet, Kernel, Kernels, Program,
    Reads, Run,
};
pub use table::Table;
