//! Simulation, observation and planning in hybrid systems.
//!
//! (tutorial follows)

mod describe;
mod emit;
mod error;
mod load;
mod metadata;
mod run;
mod setup;
mod simulate;
mod world;

pub use describe::{
    AutomatonDescription, Dependency, Description, LocationDescription, Quantity, TransitionDescription,
    WatchDescription, describe,
};
pub use emit::{declarations_text, model_text, system_text};
pub use error::Error;
pub use load::{Loaded, Provenance, load, load_experiment, load_model};
pub use run::{Finished, check, explain, run};
pub use setup::{Outputs, Setup, SignalError, read_signal};
pub use simulate::{Simulation, simulate};
pub use world::FileWorld;

pub use sophy_analysis::Declarations;
pub use sophy_diagnostics::{
    Code, Diagnostic, Diagnostics, Label, MemoryWorld, Severity, SourceId, Sources, Span, Style, World,
    WorldError, closest, render,
};
pub use sophy_files::{
    FileError, PlotOptions, plot, read_columns, read_event_labels, read_events, read_table, write_table,
};
pub use sophy_ir::Model;
pub use sophy_record::{
    Column, ColumnKind, EventRecord, Metadata, Row, Schema, Side, Sink, SinkError, Table, Trajectory,
};
pub use sophy_run::{
    AtEnd, Experiment, ExperimentError, Failure, Interpolation, Method, Observer, Outcome, Progress, Quantum,
    QuantumRule, Report, Signal,
};
pub use sophy_xml::{read as read_xml, write as write_xml};
