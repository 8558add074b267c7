//! Systems that engines are known to hang on, at quanta that become ten times smaller from row to row.

use crate::accuracy::models::{PAIR, ROBERTSON};
use sophy::{Backend, Experiment, FileWorld, Loaded, MemoryWorld, Method, Model, Quantum, QuantumRule};
use sophy::{load_experiment, load_model, simulate};
use sophy_testkit::stiff::{AdvectionReaction, LcLine, Smooth, stiff_pair};
use sophy_testkit::{Reference, repository};
use std::path::Path;

/// A system, and what is known of its runs.
pub(crate) struct Ladder {
    pub(crate) name: &'static str,
    model: Model,
    experiment: Experiment,
    /// The quantum of a state, as a multiple of that of the row, by name; 1 for the others.
    scales: &'static [(&'static str, f64)],
    /// Transitions.
    pub(crate) events: usize,
    /// Whether explicit methods follow its stiff states in steps of their time constants.
    pub(crate) stiff: bool,
}

fn written(text: &str) -> Loaded {
    let world = MemoryWorld::default().with("model.hsml", text);
    load_model(&world, Path::new("model.hsml"))
}

fn example(experiment: &str) -> Loaded {
    load_experiment(&FileWorld, &repository().join("examples").join(experiment))
}

pub(crate) fn ladders() -> Vec<Ladder> {
    let ladder = |name, model, stop, stiff| {
        let experiment = Experiment { stop, ..Experiment::default() };
        Ladder { name, model, experiment, scales: &[], events: 0, stiff }
    };
    let loaded = |name, loaded: Loaded, stop, stiff| Ladder {
        experiment: Experiment { stop, ..loaded.setup.experiment },
        ..ladder(name, loaded.model.expect("a model"), stop, stiff)
    };
    // What is 1e-5 or 0.06 in size passes singularities with a quantum of 0.1.
    let robertson =
        Ladder { scales: &[("y2", 1e-4)], ..loaded("Robertson", written(ROBERTSON), 1000.0, true) };
    let hopper = loaded("hopper", example("hopper/hopper.toml"), 20.0, false);
    let hopper = Ladder { scales: &[("Position", 0.1)], events: count("hopper/tau40_events.csv"), ..hopper };
    let buck = loaded("buck", example("buck/buck.toml"), 0.01, true);
    let buck = Ladder { events: count("buck/events.csv"), ..buck };
    vec![
        ladder("stiff pair", stiff_pair(), 500.0, true),
        loaded("pair that is stiff together", written(PAIR), 1.0, true),
        loaded("pair that swings and is stiff", written(&PAIR.replace("c : 2", "c : 10")), 1.0, true),
        loaded("ring of 8", written(&ring(8)), 1.0, true),
        loaded("heat in a rod of 20 cells", written(&rod(20)), 0.3, true),
        robertson,
        buck,
        hopper,
        ladder("LC line", LcLine(20).model(), 20.0, false),
        ladder("front", AdvectionReaction(50).model(), 0.3, false),
    ]
}

/// Each state follows the one before it, the first the opposite of the last: they swing, stiff in themselves.
fn ring(count: usize) -> String {
    let before = |i| if i == 1 { format!("1 - x{count}") } else { format!("x{}", i - 1) };
    flat(count, |i| format!("1e4*({} - x{i})", before(i)))
}

/// Warm at one end, cold at the other.
fn rod(count: usize) -> String {
    let cell = |i| {
        if i == 0 {
            "1".to_owned()
        } else if i > count {
            "0".to_owned()
        } else {
            format!("x{i}")
        }
    };
    flat(count, |i| format!("{}*({} - 2*x{i} + {})", count * count, cell(i - 1), cell(i + 1)))
}

fn flat(count: usize, rate: impl Fn(usize) -> String) -> String {
    let states: String = (1..=count).map(|i| format!("state x{i} := 0;\n")).collect();
    let rates: String = (1..=count).map(|i| format!("der(x{i}) = {};\n", rate(i))).collect();
    format!(
        "CTC Flat is\nbody\ndeclarations\n{states}end declarations;\ndynamics\n{rates}end dynamics;\nend body;\nend Flat;\n"
    )
}

fn count(events: &str) -> usize {
    Reference::read(events).numbers("t").len()
}

/// Steps and transitions of a run.
pub(crate) fn climb(ladder: &Ladder, method: Method, quantum: f64) -> (u64, usize) {
    let rule = |&(pattern, scale): &(&str, f64)| QuantumRule {
        pattern: pattern.to_owned(),
        quantum: Quantum::absolute(scale * quantum),
    };
    let experiment = Experiment {
        every: Some(ladder.experiment.stop),
        method,
        backend: Backend::Native,
        quanta: [("*", 1.0)].iter().chain(ladder.scales).map(rule).collect(),
        ..ladder.experiment.clone()
    };
    let run = simulate(&ladder.model, &experiment)
        .unwrap_or_else(|error| panic!("{} by {method:?} at {quantum:e}: {error}", ladder.name));
    (run.report.statistics.engine.steps, run.events.len())
}
