//! Every example runs as it stands and gives what its README promises, compared with reference data.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)] // a test may panic

use sophy::{Backend, Experiment, FileWorld, Loaded, Simulation, load_experiment, simulate};
use sophy_testkit::{Reference, repository};

fn run(experiment: &str) -> Simulation {
    let path = repository().join("examples").join(experiment);
    let loaded: Loaded = load_experiment(&FileWorld, &path);
    let messages = loaded.messages();
    assert!(messages.is_empty(), "{experiment}: {messages:?}");
    let model = loaded.model.expect("a model");
    simulate(&model, &loaded.setup.experiment).unwrap_or_else(|error| panic!("{experiment}: {error:?}"))
}

fn worst(times: &[f64], expected: &[f64]) -> f64 {
    assert_eq!(times.len(), expected.len());
    times.iter().zip(expected).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

#[test]
fn the_hopper_hops_and_with_half_the_thrust_does_not() {
    for (experiment, data) in
        [("hopper/hopper.toml", "hopper/tau40_events.csv"), ("hopper/tau20.toml", "hopper/tau20_events.csv")]
    {
        let simulation = run(experiment);
        let times: Vec<f64> = simulation.events.iter().map(|e| e.time).collect();
        assert!(worst(&times, &Reference::read(data).numbers("t")) < 1e-3, "{experiment}");
    }
    assert_eq!(run("hopper/tau20.toml").events.last().unwrap().to, "Decompression");
}

/// A circuit that is stiff and not in turn: every switching at its time, no voltage a quantum too high.
#[test]
fn the_buck_converter_switches_in_time() {
    let simulation = run("buck/buck.toml");
    let reference = Reference::read("buck/events.csv");
    let names: Vec<&str> = simulation
        .events
        .iter()
        .map(|event| event.transition.split(' ').next().unwrap_or_default())
        .collect();
    let expected = reference.text("event");
    let expected: Vec<&str> = expected
        .into_iter()
        .map(|name| match name {
            "tick" => "period_ends",
            "off" => "pulse_ends",
            name => name,
        })
        .collect();
    assert_eq!(names, expected);
    let times: Vec<f64> = simulation.events.iter().map(|e| e.time).collect();
    assert!(worst(&times, &reference.numbers("t")) < 2e-9);
    let reference = Reference::read("buck/states.csv");
    for (state, (name, bound)) in [("iL", 2e-4), ("uC", 2e-4)].into_iter().enumerate() {
        let value = |t: &f64| simulation.trajectory.value(state, *t, sophy::Side::Right);
        let values: Vec<f64> = reference.numbers("t").iter().map(value).collect();
        let error = worst(&values, &reference.numbers(name));
        assert!(error < bound, "{name}: {error:e}");
    }
}

#[test]
fn the_battery_visits_its_locations_in_time() {
    let simulation = run("battery/battery.toml");
    let reference = Reference::read("power-system/text_events.csv");
    let to: Vec<&str> = simulation.events.iter().map(|e| e.to.as_str()).collect();
    assert_eq!(to, reference.text("to"));
    let times: Vec<f64> = simulation.events.iter().map(|e| e.time).collect();
    assert!(worst(&times, &reference.numbers("t")) < 0.02);
    let volts = simulation.table.real("V").unwrap();
    assert!((volts[0] - 23.83).abs() < 1e-12);
}

#[test]
fn the_two_systems_of_chapter_3_follow_their_closed_solutions() {
    for (experiment, data, bound) in [
        ("oscillator/oscillator.toml", "oscillator/reference.csv", 0.4),
        ("two-timescale/two-timescale.toml", "two-timescale/reference.csv", 3e-3),
    ] {
        let simulation = run(experiment);
        let reference = Reference::read(data);
        let (times, x1) = (reference.numbers("t"), reference.numbers("x1"));
        let value = |t: f64| simulation.trajectory.value(0, t, sophy::Side::Right);
        let error = times.iter().zip(x1).map(|(t, x)| (value(*t) - x).abs()).fold(0.0, f64::max);
        assert!(error < bound, "{experiment}: {error:e}");
        assert!(simulation.events.is_empty());
    }
}

/// What runs in this version, and its bits in native code against those of the interpreter.
#[test]
fn native_code_gives_the_same_bits() {
    let examples = repository().join("examples");
    let folders = std::fs::read_dir(examples).unwrap().map(|entry| entry.unwrap().path());
    let files =
        folders.flat_map(|folder| std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()));
    let mut compared = 0;
    for path in files.filter(|path| path.extension().is_some_and(|extension| extension == "toml")) {
        let loaded: Loaded = load_experiment(&FileWorld, &path);
        let Some(model) = loaded.model else { continue };
        let simulated = [Backend::Interpreter, Backend::Native].map(|backend| {
            // A short part of each is enough: every equation is used.
            let Experiment { start, stop, .. } = loaded.setup.experiment;
            let experiment = Experiment {
                backend,
                stop: start + 0.02 * (stop - start),
                record: Some(vec!["*".to_owned()]),
                ..loaded.setup.experiment.clone()
            };
            simulate(&model, &experiment)
        });
        let [Ok(interpreted), Ok(native)] = simulated else { continue };
        assert!(native.report.native && !interpreted.report.native);
        assert_eq!(interpreted.events, native.events, "{}", path.display());
        assert_eq!(interpreted.report.statistics, native.report.statistics, "{}", path.display());
        for name in interpreted.table.schema.columns.iter().map(|column| column.name.clone()) {
            let bits = |simulation: &Simulation| -> Vec<u64> {
                simulation.table.real(&name).unwrap_or_default().iter().map(|x| x.to_bits()).collect()
            };
            assert_eq!(bits(&interpreted), bits(&native), "{name} of {}", path.display());
        }
        compared += 1;
    }
    assert!(compared >= 8, "{compared}");
}
