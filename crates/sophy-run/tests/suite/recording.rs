//! Rows are made beside the run: they are those of a run that waits for each, and nothing of a sink is lost.

use crate::support::{by, to};
use sophy_record::{EventRecord, Metadata, Row, Sink, SinkError, Table};
use sophy_run::{Experiment, Method, Observer, Outcome, Progress, Recorder, Run, SimulateError, simulate};
use sophy_testkit::problems::Hopper;
use std::ops::ControlFlow;
use std::sync::Arc;

/// Steps of a run that is long enough to have a thread for its rows.
const LONG: u64 = 40_000;

fn long(method: Method) -> Experiment {
    let quantum = match method {
        Method::Qss1 => 2e-3,
        Method::Liqss2 => 1e-5,
        _ => 1e-4,
    };
    by(method, to(90.0, quantum))
}

fn start(experiment: &Experiment) -> (Run, Recorder) {
    let system = sophy_passes::lower(&Hopper::TAU40.model()).expect("lowers");
    let run = Run::new(Arc::new(system), experiment).expect("starts");
    let recorder = Recorder::new(&run, experiment).expect("records").with_trajectory(&run);
    (run, recorder)
}

/// Rows made line by line by the thread of the run.
fn in_turn(experiment: &Experiment) -> (Table, Recorder, Run) {
    let (mut run, mut recorder) = start(experiment);
    let mut table = Table::new(recorder.schema().clone(), Metadata::default());
    run.advance(experiment.stop, u64::MAX).expect("goes on");
    for line in run.journal.lines() {
        recorder.consume(&[*line], &mut [&mut table]).expect("a table takes all");
    }
    recorder.finish(run.time(), &mut [&mut table]).expect("a table takes all");
    (table, recorder, run)
}

#[test]
fn rows_are_the_same_wherever_they_are_made() {
    for method in [Method::Qss1, Method::Qss2, Method::Liqss2] {
        for every in [None, Some(0.01)] {
            let experiment = Experiment { every, ..long(method) };
            let (expected, by_hand, run) = in_turn(&experiment);
            assert!(run.statistics().engine.steps > LONG, "{method:?}: {:?}", run.statistics());
            let (mut run, mut recorder) = start(&experiment);
            let mut table = Table::new(recorder.schema().clone(), Metadata::default());
            let report =
                simulate(&mut run, &mut recorder, &experiment, &mut [&mut table], &mut ()).expect("runs");
            assert!(table == expected, "{method:?}");
            assert!(recorder.trajectory == by_hand.trajectory, "{method:?}");
            assert_eq!(report.rows, table.len() as u64);
        }
    }
}

/// Takes so many rows and refuses the next one.
struct Short {
    left: usize,
    taken: Table,
}

impl Sink for Short {
    fn row(&mut self, row: Row<'_>) -> Result<(), SinkError> {
        let Some(left) = self.left.checked_sub(1) else {
            return Err(SinkError { sink: "short.csv".to_owned(), source: "no space left on device".into() });
        };
        self.left = left;
        self.taken.row(row)
    }

    fn flush(&mut self) -> Result<(), SinkError> {
        Ok(())
    }

    fn finish(&mut self, _: &Metadata) -> Result<(), SinkError> {
        Ok(())
    }
}

#[test]
fn an_error_of_a_sink_ends_the_run_with_its_message() {
    let experiment = long(Method::Qss2);
    let (expected, ..) = in_turn(&experiment);
    // In the first block, in a later one, and when the run is over.
    for rows in [100, expected.len() / 2, expected.len() - 1] {
        let (mut run, mut recorder) = start(&experiment);
        let mut sink =
            Short { left: rows, taken: Table::new(recorder.schema().clone(), Metadata::default()) };
        let error = simulate(&mut run, &mut recorder, &experiment, &mut [&mut sink], &mut ()).unwrap_err();
        assert!(matches!(error, SimulateError::Sink(_)));
        assert_eq!(error.to_string(), "cannot write short.csv: no space left on device");
        assert_eq!(sink.taken.time, expected.time[..rows]);
    }
}

/// Stops the run at its `left`-th look.
struct Stopper {
    left: usize,
}

impl Observer for Stopper {
    fn progress(&mut self, _: &Progress) -> ControlFlow<()> {
        self.left -= 1;
        if self.left == 0 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }

    fn events(&mut self, _: &[EventRecord]) -> Result<(), SinkError> {
        Ok(())
    }
}

#[test]
fn a_run_that_is_stopped_has_all_rows_until_then() {
    let experiment = long(Method::Qss2);
    let (expected, ..) = in_turn(&experiment);
    for left in [1, 3] {
        let (mut run, mut recorder) = start(&experiment);
        let mut table = Table::new(recorder.schema().clone(), Metadata::default());
        let mut observer = Stopper { left };
        let report =
            simulate(&mut run, &mut recorder, &experiment, &mut [&mut table], &mut observer).expect("stops");
        assert_eq!(report.outcome, Outcome::Interrupted);
        assert!(report.time < experiment.stop);
        assert_eq!(table.time.last(), Some(&report.time));
        // The last row may be one of its own: where the run was stopped.
        let common = table.len() - 1;
        assert_eq!(table.time[..common], expected.time[..common]);
        assert!(expected.time[common] >= report.time);
    }
}

/// As a sink that has lost its head.
struct Broken;

impl Sink for Broken {
    fn row(&mut self, row: Row<'_>) -> Result<(), SinkError> {
        assert!(row.time < 30.0, "beyond 30 s");
        Ok(())
    }

    fn flush(&mut self) -> Result<(), SinkError> {
        Ok(())
    }

    fn finish(&mut self, _: &Metadata) -> Result<(), SinkError> {
        Ok(())
    }
}

#[test]
#[should_panic(expected = "beyond 30 s")]
fn a_panic_of_a_sink_is_that_of_the_run() {
    let experiment = long(Method::Qss2);
    let (mut run, mut recorder) = start(&experiment);
    let _ = simulate(&mut run, &mut recorder, &experiment, &mut [&mut Broken], &mut ());
}
