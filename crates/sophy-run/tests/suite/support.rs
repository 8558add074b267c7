use sophy_ir::Model;
use sophy_record::{EventRecord, Table, Trajectory};
use sophy_run::{Experiment, Method, Quantum, QuantumRule, Recorder, Report, Run, SimulateError, simulate};
use std::sync::Arc;

/// All quantised engines.
pub(crate) const METHODS: [Method; 6] =
    [Method::Qss1, Method::Qss2, Method::Qss3, Method::Liqss1, Method::Liqss2, Method::Liqss3];

/// Whether segments are lines.
pub(crate) fn is_first_order(method: Method) -> bool {
    matches!(method, Method::Qss1 | Method::Liqss1)
}

/// What a run of a model gave.
pub(crate) struct Result {
    pub(crate) report: Report,
    pub(crate) events: Vec<EventRecord>,
    pub(crate) table: Table,
    pub(crate) trajectory: Trajectory,
}

/// Runs a model and keeps everything.
pub(crate) fn run(model: &Model, experiment: &Experiment) -> Result {
    try_run(model, experiment).unwrap_or_else(|error| panic!("{error}"))
}

pub(crate) fn try_run(model: &Model, experiment: &Experiment) -> std::result::Result<Result, SimulateError> {
    let system = Arc::new(sophy_passes::lower(model).expect("lowers"));
    let mut run = Run::new(system, experiment)?;
    let mut recorder = Recorder::new(&run, experiment).expect("records").with_trajectory(&run);
    let mut table = Table::new(recorder.schema().clone(), Default::default());
    let mut events = Vec::new();
    let report = simulate(&mut run, &mut recorder, experiment, &mut [&mut table], &mut events)?;
    let trajectory = recorder.trajectory.take().expect("kept");
    Ok(Result { report, events, table, trajectory })
}

/// An experiment with one quantum for all states.
pub(crate) fn to(stop: f64, quantum: f64) -> Experiment {
    Experiment {
        stop,
        quanta: vec![QuantumRule { pattern: "*".to_owned(), quantum: Quantum::absolute(quantum) }],
        ..Experiment::default()
    }
}

/// Slope of log(error) over log(quantum), by least squares: the order of convergence.
pub(crate) fn order(points: &[(f64, f64)]) -> f64 {
    let logs: Vec<(f64, f64)> = points.iter().map(|(q, e)| (libm::log(*q), libm::log(*e))).collect();
    let n = logs.len() as f64;
    let (mx, my) = logs.iter().fold((0.0, 0.0), |(a, b), (x, y)| (a + x / n, b + y / n));
    let (mut sxy, mut sxx) = (0.0, 0.0);
    for (x, y) in logs {
        sxy += (x - mx) * (y - my);
        sxx += (x - mx) * (x - mx);
    }
    sxy / sxx
}

/// The same experiment by another method.
pub(crate) fn by(method: Method, experiment: Experiment) -> Experiment {
    Experiment { method, ..experiment }
}
