//! The error of one run.

use crate::accuracy::cases::Case;
use sophy::{Experiment, Method, Outcome, Side, Simulation, simulate};

/// How far a run is from the solution; errors of states are fractions of the largest value of the state.
#[derive(Debug)]
pub(crate) struct Measured {
    /// The largest error of a state, where time is counted from transition to transition.
    pub(crate) states: f64,
    /// The state with it, and when.
    pub(crate) worst: (String, f64),
    /// The largest error of a state at one instant of both, where as many transitions have been taken.
    pub(crate) instants: f64,
    /// The largest error of the time of a transition, as a fraction of the run.
    pub(crate) times: f64,
    pub(crate) steps: u64,
    /// Transitions of the run, if they are not as many as there should be or accumulate.
    pub(crate) other: Option<usize>,
}

impl Measured {
    /// What is compared with the tolerance.
    pub(crate) fn error(&self) -> f64 {
        if self.other.is_some() { f64::INFINITY } else { self.states.max(self.times) }
    }
}

pub(crate) fn measure(case: &Case, method: Method, tolerance: f64) -> Measured {
    let experiment = Experiment { method, tolerance, ..case.experiment.clone() };
    let simulation =
        simulate(&case.model, &experiment).unwrap_or_else(|error| panic!("{}: {error}", case.name));
    compare(case, &simulation)
}

fn compare(case: &Case, simulation: &Simulation) -> Measured {
    let is_meant = |component: &str| case.component.is_empty() || component == case.component;
    let events = simulation.events.iter().filter(|event| is_meant(&event.component));
    let events: Vec<f64> = events.map(|event| event.time).collect();
    let system = sophy_passes::lower(&case.model).expect("a system");
    let position =
        |name: &str| system.states.iter().position(|state| state.name(&system) == name).expect("a state");
    let (stop, count) = (case.experiment.stop, events.len());
    let reached = simulation.report.outcome == Outcome::Reached;
    let pairs = events.iter().zip(&case.events);
    let mut measured = Measured {
        states: 0.0,
        worst: (String::new(), 0.0),
        instants: 0.0,
        times: pairs.map(|(found, expected)| (found - expected).abs() / stop).fold(0.0, f64::max),
        steps: simulation.report.statistics.engine.steps,
        other: (count != case.events.len() || !reached).then_some(count),
    };
    for (name, values) in &case.states {
        let state = position(name);
        let size = values.iter().fold(0.0, |size: f64, value| size.max(value.abs()));
        let error =
            |t: f64, value: f64| (simulation.trajectory.value(state, t, Side::Right) - value).abs() / size;
        for (&t, &value) in case.times.iter().zip(values) {
            let found = error(like(t, &case.events, &events, stop), value);
            if found > measured.states {
                (measured.states, measured.worst) = (found, (name.clone(), t));
            }
            if taken(&events, t) == taken(&case.events, t) {
                measured.instants = measured.instants.max(error(t, value));
            }
        }
    }
    measured
}

/// Transitions until `t`.
fn taken(events: &[f64], t: f64) -> usize {
    events.partition_point(|&event| event <= t)
}

/// The time of the run that is like `t`: transitions are like their counterparts, time in between runs evenly. An error
/// of a jump is an error of its time, which is measured by itself.
fn like(t: f64, expected: &[f64], found: &[f64], stop: f64) -> f64 {
    let common = expected.len().min(found.len());
    let before = taken(&expected[..common], t);
    let ends = |events: &[f64]| {
        let end = if before < common { events[before] } else { stop };
        (if before > 0 { events[before - 1] } else { 0.0 }, end)
    };
    let ((from, to), (begin, end)) = (ends(expected), ends(found));
    if to > from { begin + (end - begin) * (t - from) / (to - from) } else { begin }
}
