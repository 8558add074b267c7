//! The examples in HSML: they are the models of the XML files, bit for bit, and what can run gives its numbers.

#![allow(clippy::unwrap_used, clippy::panic, clippy::expect_used, reason = "a test stops at the first surprise")]

use sophy::{FileWorld, Model, Setup, Simulation, load_experiment, load_model, simulate};
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
fn bits(simulation: &Simulation) -> (Vec<u64>, Vec<Vec<u64>>, Vec<Vec<u32>>, Vec<String>) {
    let of = |values: &[f64]| values.iter().map(|value| value.to_bits()).collect::<Vec<u64>>();
    let table = &simulation.table;
    let events = simulation.events.iter();
    let events =
        events.map(|e| format!("{:x} {} {} {} {}", e.time.to_bits(), e.step, e.transition, e.from, e.to));
    (of(&table.time), table.reals.iter().map(|column| of(column)).collect(), table.labels.clone(), events.collect())
}

#[test]
fn hsml_and_xml_of_one_model_give_the_same_bits() {
    for (xml, hsml, experiment) in [
        ("hopper/hopper.xml", "hopper/hopper.hsml", "hopper/hopper.toml"),
        ("battery/battery.xml", "battery/battery.hsml", "battery/battery.toml"),
        ("oscillator/oscillator.xml", "oscillator/oscillator.hsml", "oscillator/oscillator.toml"),
        ("two-timescale/two-timescale.xml", "two-timescale/two-timescale.hsml", "two-timescale/two-timescale.toml"),
    ] {
        let experiment = setup(experiment).experiment;
        let first = simulate(&model(&example(xml)), &experiment).unwrap();
        let second = simulate(&model(&example(hsml)), &experiment).unwrap();
        assert_eq!(first.table.schema, second.table.schema, "{hsml}");
        assert!(first.table.len() > 10, "{hsml}");
        assert!(bits(&first) == bits(&second), "{hsml}: the runs differ");
    }
}
