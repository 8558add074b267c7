use crate::error::Error;
use sophy_ir::Model;
use sophy_record::{EventRecord, Metadata, Table, Trajectory};
use sophy_run::{Experiment, Recorder, Report, Run};
use std::sync::Arc;

/// What a run gave, all in memory.
#[derive(Clone, Debug, PartialEq)]
pub struct Simulation {
    /// The recorded variables, row by row.
    pub table: Table,
    /// The transitions taken, in order.
    pub events: Vec<EventRecord>,
    /// The states at any time: the segments the engine computed.
    pub trajectory: Trajectory,
    /// How the run ended, and what it took.
    pub report: Report,
}

/// Runs a model and keeps everything in memory.
///
/// # Errors
/// [`Error::Experiment`] with every mistake of the experiment at once; [`Error::Failure`] if the run cannot go
/// on. Reaching the stop time and accumulating transitions (Zeno) are outcomes, see [`Report::outcome`].
pub fn simulate(model: &Model, experiment: &Experiment) -> Result<Simulation, Error> {
    let (mut run, recorder) = begin(model, experiment)?;
    let mut recorder = recorder.with_trajectory(&run);
    let mut table = Table::new(recorder.schema().clone(), Metadata::default());
    let mut events = Vec::new();
    let report = sophy_run::simulate(&mut run, &mut recorder, experiment, &mut [&mut table], &mut events)?;
    let trajectory = recorder.trajectory.take().unwrap_or_default();
    Ok(Simulation { table, events, trajectory, report })
}

/// Model to system, system to a run at its start, and what is to be recorded of it.
pub(crate) fn begin(model: &Model, experiment: &Experiment) -> Result<(Run, Recorder), Error> {
    let system = Arc::new(sophy_passes::lower(model)?);
    let run = Run::new(system, experiment)?;
    let recorder = Recorder::new(&run, experiment).map_err(Error::Experiment)?;
    Ok((run, recorder))
}
