//! What a run leaves behind: rows for people and files, the event log, and the exact trajectory.
//!
//! - [`Schema`] names the columns; a [`Sink`] takes [`Row`]s as they are computed; [`Table`] is the sink in
//!   memory.
//! - [`EventRecord`] is one transition taken.
//! - [`Trajectory`] keeps the segments themselves, so that a state can be read at any time.
//!
//! Nothing here opens a file.

mod events;
mod schema;
mod table;
mod trajectory;

pub use events::EventRecord;
pub use schema::{Column, ColumnKind, Metadata, Row, Schema, Sink, SinkError};
pub use table::Table;
pub use trajectory::{Side, Trajectory};
