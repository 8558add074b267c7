//! Results, inputs and pictures in files.
//!
//! - [`open_sink`] writes a run as it goes: CSV, Arrow, Parquet; [`read_table`] and [`write_table`] read and
//!   write whole results.
//! - [`EventLog`] writes the transitions taken, [`read_events`] reads them.
//! - [`read_columns`] and [`read_event_labels`] read what a run is fed with.
//! - [`plot`] draws a result as SVG, PNG or a self-contained HTML page, [`draw`] a diagram of boxes and arrows.
//!
//! What a sink has flushed survives the death of the process: a reader takes every whole line or message and
//! leaves a torn last one out. No other crate knows a file format of results.

mod arrow;
mod columns;
mod csv;
mod description;
mod draw;
mod error;
mod event_log;
mod input;
mod number;
mod parquet;
mod path;
mod plot;
mod results;

pub use draw::{Arrow, ArrowEnd, BoxKind, Diagram, DiagramBox, DiagramKind, DiagramPort, Line, Symbol, draw};
pub use error::FileError;
pub use event_log::{EventLog, read_events};
pub use input::{InputColumns, read_columns, read_event_labels};
pub use plot::{PlotOptions, plot};
pub use results::{open_sink, read_table, write_table};
