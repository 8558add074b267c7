//! What a run of some length leaves in files, whose rows are made beside it.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)] // a test may panic

use sophy::{
    EventRecord, FileWorld, Loaded, Observer, Outcome, Outputs, Progress, SinkError, Table, load_experiment,
    read_events, read_table, run, simulate,
};
use sophy_testkit::repository;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

/// The hopper for so long that it takes some ten blocks.
fn long_hopper() -> Loaded {
    let mut loaded = load_experiment(&FileWorld, &repository().join("examples/hopper/hopper.toml"));
    loaded.setup.experiment.stop = 1000.0;
    loaded
}

fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    std::fs::create_dir_all(&folder).unwrap();
    folder
}

fn files(folder: &Path) -> Outputs {
    let results = ["a.csv", "a.arrow", "a.parquet"].map(|name| folder.join(name));
    Outputs { results: results.into(), events: Some(folder.join("events.csv")), ..Outputs::default() }
}

/// What counts of a result in a file: texts may have been numbered anew.
fn content(table: &Table) -> (&[f64], &[Vec<f64>], Vec<&str>) {
    let (positions, names) = table.label("location").unwrap();
    let locations = positions.iter().map(|&position| names[position as usize].as_str()).collect();
    (&table.time, &table.reals, locations)
}

#[test]
fn files_of_all_formats_hold_what_memory_holds() {
    let Loaded { model, mut setup, provenance, .. } = long_hopper();
    let model = model.unwrap();
    let simulation = simulate(&model, &setup.experiment).unwrap();
    setup.outputs = files(&folder("long"));
    let finished = run(&model, &setup, &provenance, &mut ()).unwrap();
    assert_eq!(finished.report.rows, simulation.table.len() as u64);
    for path in &setup.outputs.results {
        let table = read_table(path).unwrap();
        assert!(content(&table) == content(&simulation.table), "{}", path.display());
    }
    assert_eq!(read_events(&folder("long").join("events.csv")).unwrap(), simulation.events);
}

/// Stops a run at its third look.
struct Interrupt(usize);

impl Observer for Interrupt {
    fn progress(&mut self, _: &Progress) -> ControlFlow<()> {
        self.0 += 1;
        if self.0 == 3 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }

    fn events(&mut self, _: &[EventRecord]) -> Result<(), SinkError> {
        Ok(())
    }
}

#[test]
fn a_run_that_is_interrupted_leaves_whole_files() {
    let Loaded { model, mut setup, provenance, .. } = long_hopper();
    setup.outputs = files(&folder("interrupted"));
    let finished = run(&model.unwrap(), &setup, &provenance, &mut Interrupt(0)).unwrap();
    assert_eq!(finished.report.outcome, Outcome::Interrupted);
    assert!(finished.report.time < setup.experiment.stop);
    for path in &setup.outputs.results {
        let table = read_table(path).unwrap();
        assert_eq!(table.len() as u64, finished.report.rows, "{}", path.display());
        assert_eq!(*table.time.last().unwrap(), finished.report.time, "{}", path.display());
        assert_eq!(table.metadata.entries["outcome"], "interrupted", "{}", path.display());
    }
}
