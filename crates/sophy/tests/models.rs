//! The examples in HSML: they are the models of the XML files, bit for bit, and what can run gives its numbers.

#![allow(
    clippy::unwrap_used,
    clippy::panic,
    clippy::expect_used,
    reason = "a test stops at the first surprise"
)]

use sophy::{
    Experiment, FileWorld, Model, Root, Setup, Simulation, load_as, load_experiment, load_model, simulate,
};
use sophy_testkit::repository;
use std::path::{Path, PathBuf};

fn example(path: &str) -> PathBuf {
    repository().join("examples").join(path)
}

fn model(path: &Path) -> Model {
    let loaded = load_model(&FileWorld, path);
    let messages = loaded.messages();
    assert!(messages.is_empty(), "{}: {messages:#?}", path.display());
    loaded.model.expect("a model")
}

fn setup(experiment: &str) -> Setup {
    load_experiment(&FileWorld, &example(experiment)).setup
}

/// The bits of all rows, and the event log.
fn bits(simulation: &Simulation) -> (Vec<Vec<u64>>, Vec<Vec<u32>>, Vec<String>) {
    let table = &simulation.table;
    let numbers = std::iter::once(&table.time).chain(&table.reals);
    let numbers = numbers.map(|column| column.iter().map(|value| value.to_bits()).collect()).collect();
    let events = simulation.events.iter();
    let events =
        events.map(|e| format!("{:x} {} {} {} {}", e.time.to_bits(), e.step, e.transition, e.from, e.to));
    (numbers, table.labels.clone(), events.collect())
}

#[test]
fn hsml_and_xml_of_one_model_give_the_same_bits() {
    for (xml, hsml, experiment) in [
        ("hopper/hopper.xml", "hopper/hopper.hsml", "hopper/hopper.toml"),
        ("battery/battery.xml", "battery/battery.hsml", "battery/battery.toml"),
        ("oscillator/oscillator.xml", "oscillator/oscillator.hsml", "oscillator/oscillator.toml"),
        (
            "two-timescale/two-timescale.xml",
            "two-timescale/two-timescale.hsml",
            "two-timescale/two-timescale.toml",
        ),
    ] {
        let experiment = setup(experiment).experiment;
        let first = simulate(&model(&example(xml)), &experiment).unwrap();
        let second = simulate(&model(&example(hsml)), &experiment).unwrap();
        assert_eq!(first.table.schema, second.table.schema, "{hsml}");
        assert!(first.table.len() > 10, "{hsml}");
        assert!(bits(&first) == bits(&second), "{hsml}: the runs differ");
    }
}

#[test]
fn every_example_in_hsml_passes_the_checks() {
    let mut checked = 0;
    for folder in std::fs::read_dir(repository().join("examples")).unwrap() {
        for file in std::fs::read_dir(folder.unwrap().path()).unwrap() {
            let path = file.unwrap().path();
            let is = |wanted: &str| path.extension().is_some_and(|extension| extension == wanted);
            let root = if is("hsml") { Root::IfClear } else { Root::Implied };
            if is("hsml") || is("toml") && path.with_extension("hsml").exists() {
                let mut loaded = load_as(&FileWorld, &path, root);
                let found = sophy::check(&loaded);
                loaded.diagnostics.extend(found);
                // What waits for a later version is checked, and said to be so.
                let mut messages = loaded.messages();
                messages.retain(|message| message.code.0 != "SR0008");
                assert!(messages.is_empty(), "{}: {messages:#?}", path.display());
                checked += 1;
            }
        }
    }
    assert!(checked >= 20, "{checked}");
}

fn run(experiment: &str) -> Simulation {
    let loaded = load_experiment(&FileWorld, &example(experiment));
    assert!(loaded.messages().is_empty(), "{experiment}: {:#?}", loaded.messages());
    simulate(&loaded.model.expect("a model"), &loaded.setup.experiment)
        .unwrap_or_else(|e| panic!("{experiment}: {e}"))
}

/// The last value of a column.
fn last(simulation: &Simulation, name: &str) -> f64 {
    *simulation.table.real(name).unwrap_or_else(|| panic!("no {name}")).last().unwrap()
}

/// The value of a column at a time that is a row.
fn at(simulation: &Simulation, name: &str, time: f64) -> f64 {
    let row = simulation.table.time.iter().position(|&t| (t - time).abs() < 1e-9).unwrap();
    simulation.table.real(name).unwrap_or_else(|| panic!("no {name}"))[row]
}

#[test]
fn the_ball_bounces_38_times_and_rests() {
    let simulation = run("bouncing-ball/bouncing-ball.toml");
    let (g, e): (f64, f64) = (9.81, 0.8);
    let mut expected = vec![(2.0 / g).sqrt()];
    let mut speed = (2.0 * g).sqrt();
    for _ in 1..38 {
        speed *= e;
        expected.push(expected.last().unwrap() + 2.0 * speed / g);
    }
    let times: Vec<f64> = simulation.events.iter().map(|event| event.time).collect();
    assert_eq!(times.len(), expected.len(), "{times:?}");
    let error = times.iter().zip(&expected).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    assert!(error < 1e-6, "{error:e}");
    assert_eq!((last(&simulation, "y"), last(&simulation, "v")), (0.0, 0.0));
}

#[test]
fn the_missile_rolls_in_its_limit_cycle() {
    let simulation = run("missile-roll/analog.toml");
    let times: Vec<f64> = simulation.events.iter().map(|event| event.time).collect();
    let half = 0.135_928_302_706_694_84; // s, the exact limit cycle
    let (before, after) = (times[times.len() - 3], times[times.len() - 1]);
    assert!((after - before - 2.0 * half).abs() < 1e-4, "{}", after - before);
    let angles = simulation.table.real("airframe.phi").unwrap();
    let late = simulation.table.time.iter().zip(angles).filter(|(t, _)| **t > 2.0);
    let amplitude = late.map(|(_, phi)| phi.abs()).fold(0.0, f64::max);
    assert!((amplitude - 0.130_994).abs() < 1e-4, "{amplitude}");
}

#[test]
fn the_probe_turns_as_the_reference_does() {
    let simulation = run("deep-space-probe/sliding-mode.toml");
    let reference = [
        (5.0, [0.233_626_13, 0.078_064_22, 0.806_377_26]),
        (10.0, [0.100_993_39, 0.065_740_27, 0.158_583_24]),
        (20.0, [0.033_713_96, 0.018_460_42, -0.069_320_24]),
    ];
    for (time, angles) in reference {
        for (k, angle) in (1..).zip(angles) {
            let found = at(&simulation, &format!("probe.theta[{k}]"), time);
            assert!((found - angle).abs() < 1e-3, "theta[{k}] at {time}: {found}");
        }
    }
}

#[test]
fn the_vehicle_turns_slowly() {
    let simulation = run("auv/open-loop.toml");
    for (name, expected, tolerance) in [
        ("vehicle.position[1]", 45.231_329, 0.15),
        ("vehicle.position[2]", -16.110_442, 0.15),
        ("vehicle.position[3]", 0.326_882, 0.15),
        ("vehicle.v[1]", 0.487_685, 1e-3),
        ("vehicle.theta[3]", -0.882_507, 1e-2),
    ] {
        let found = last(&simulation, name);
        assert!((found - expected).abs() < tolerance, "{name}: {found}");
    }
}

#[test]
fn the_first_hovercraft_avoid_one_another() {
    let loaded = load_experiment(&FileWorld, &example("hovercraft/hovercraft.toml"));
    let experiment = Experiment { stop: 4.0, ..loaded.setup.experiment };
    let simulation = simulate(&loaded.model.expect("a model"), &experiment).unwrap();
    let [first, second, third] = [0, 1, 2].map(|k| &simulation.events[k]);
    assert!((first.time - 2.195_038_103_550_28).abs() < 1e-4, "{first:?}");
    assert!((second.time - 2.195_038_103_550_28).abs() < 1e-4, "{second:?}");
    assert!((third.time - 3.125_321_756_098_07).abs() < 1e-4, "{third:?}");
    assert_eq!((first.to.as_str(), third.to.as_str()), ("Avoid", "Nominal"));
}
