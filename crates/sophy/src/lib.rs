//! Simulation, observation and planning in hybrid systems: states that flow, locations that change the flow.
//!
//! # From a file to a trajectory
//!
//! A model is loaded, an experiment says what to do with it, [`simulate`] does it:
//!
//! ```
//! use sophy::{Experiment, MemoryWorld, Quantum, QuantumRule, Side, load_model, simulate};
//! use std::path::Path;
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! // A ball that is caught. `FileWorld` reads files; here the text is at hand.
//! let world = MemoryWorld::default().with(
//!     "ball.xml",
//!     r#"<SophySystem>
//!       <name>Ball</name>
//!       <hints><hint hintname="initial height">5</hint><hint hintname="initial speed">0</hint></hints>
//!       <constants><constant symbol="G">10</constant></constants>
//!       <states><state>height</state><state>speed</state></states>
//!       <inputs/>
//!       <outputs/>
//!       <locations>
//!         <location>
//!           <name>Falling</name>
//!           <diffequation state="height">speed</diffequation>
//!           <diffequation state="speed">-G</diffequation>
//!           <transitions>
//!             <transition>
//!               <name>caught</name>
//!               <domain>height &lt; 0</domain>
//!               <reset><destination>Caught</destination><statereset state="speed">0</statereset></reset>
//!             </transition>
//!           </transitions>
//!         </location>
//!         <location>
//!           <name>Caught</name>
//!           <diffequation state="height">0</diffequation>
//!           <diffequation state="speed">0</diffequation>
//!         </location>
//!       </locations>
//!     </SophySystem>"#,
//! );
//!
//! // Loading finds all mistakes; `render` draws one with its place in the file.
//! let loaded = load_model(&world, Path::new("ball.xml"));
//! let model = loaded.model.as_ref().ok_or("the model has errors")?;
//!
//! // The experiment: 2 s with quanta of 1 mm and 1 mm/s.
//! let experiment = Experiment {
//!     stop: 2.0,
//!     quanta: vec![QuantumRule { pattern: "*".to_owned(), quantum: Quantum::absolute(1e-3) }],
//!     ..Experiment::default()
//! };
//! let simulation = simulate(model, &experiment)?;
//!
//! // One transition, at √(2·5/10) s = 1 s.
//! let [caught] = simulation.events.as_slice() else { return Err("one transition was expected".into()) };
//! assert_eq!((caught.transition.as_str(), caught.to.as_str()), ("caught", "Caught"));
//! assert!((caught.time - 1.0).abs() < 1e-3);
//!
//! // The trajectory can be read at any time, at a jump from both sides.
//! assert!((simulation.trajectory.value(0, 0.5, Side::Right) - 3.75).abs() < 1e-2);
//! assert!((simulation.trajectory.value(1, caught.time, Side::Left) + 10.0).abs() < 1e-2);
//! assert_eq!(simulation.trajectory.value(1, caught.time, Side::Right), 0.0);
//! # Ok(())
//! # }
//! ```
//!
//! # With files
//!
//! [`load_experiment`] reads an experiment (`.toml`) with its model, [`run`] writes the results, the log of
//! transitions and the pictures it asks for and lets an [`Observer`] look on; [`explain`] turns what went wrong
//! into messages at the places they are about. [`check`] finds mistakes without running, [`describe`] says what
//! a model consists of. [`format()`] lays out HSML, [`to_hsml`] and [`to_xml`] say a model in the other language,
//! [`page`] explains the code of a message. The command `sophy` does nothing else.

mod convert;
mod describe;
mod digest;
mod draw;
mod emit;
mod error;
mod format;
mod load;
mod metadata;
mod pages;
mod run;
mod setup;
mod simulate;
mod world;

pub use convert::{Conversion, to_hsml, to_xml};
pub use describe::{
    AutomatonDescription, ClockDescription, ComponentDescription, Dependency, Description, Knot,
    LocationDescription, Quantity, Reaction, Sizes, Sparsity, TransitionDescription, WatchDescription,
    describe,
};
pub use draw::{UnknownComponent, diagram};
pub use emit::{declarations_text, model_text, system_text};
pub use error::Error;
pub use format::{Formatted, format};
pub use load::{Loaded, Provenance, load, load_as, load_experiment, load_model};
pub use pages::{Page, page, pages};
pub use run::{Finished, check, explain, explain_composition, run};
pub use setup::{Outputs, Setup, SignalError, read_signal};
pub use simulate::{Simulation, simulate};
pub use world::FileWorld;

pub use sophy_analysis::{Declarations, Root};
pub use sophy_diagnostics::{
    Code, Diagnostic, Diagnostics, Label, MemoryWorld, Severity, SourceId, Sources, Span, Style, World,
    WorldError, closest, render,
};
pub use sophy_files::{
    Diagram, FileError, PlotOptions, draw, plot, read_columns, read_event_labels, read_events, read_table,
    write_table,
};
pub use sophy_ir::Model;
pub use sophy_record::{
    Column, ColumnKind, EventRecord, Metadata, Row, Schema, Side, Sink, SinkError, Table, Trajectory,
};
pub use sophy_run::{
    AtEnd, Backend, Experiment, ExperimentError, Failure, Interpolation, Method, Observer, Outcome, Progress,
    Quantum, QuantumRule, Report, Signal,
};
