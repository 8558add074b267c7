//! `recording`: what it costs to record ten variables of the hopper, beside the same run with nothing recorded.

use crate::language::model;
use crate::measure::{Time, median, medians, timed};
use sophy_files::open_sink;
use sophy_passes::lower;
use sophy_record::{Metadata, Sink, Table};
use sophy_run::{Backend, Experiment, Method, Pause, Quantum, QuantumRule, Recorder, Run, simulate};
use std::path::PathBuf;
use std::sync::Arc;

const HOPPER: &str = include_str!("../../examples/hopper/hopper.hsml");
const STOP: f64 = 1000.0;
const QUANTUM: f64 = 1e-3;
const REPETITIONS: usize = 7;
const COLUMNS: usize = 10;

/// One row of the table.
#[derive(Clone, Debug)]
pub struct Recorded {
    /// Where the rows went.
    pub into: &'static str,
    /// Rows recorded.
    pub rows: u64,
    /// The run, until the last row was taken: by the clock on the wall, and of the thread that runs the engine.
    pub run: Time,
    /// What the sink needs to complete the result after it.
    pub finish: Time,
    /// Medians of the ratios to the run just before of which nothing was recorded, by the clock and in CPU time of the
    /// thread.
    pub wall_ratio: f64,
    pub cpu_ratio: f64,
}

/// Where rows go.
#[derive(Clone, Copy, PartialEq)]
enum Into {
    Nothing,
    Memory,
    File(&'static str),
}

/// Nothing, a table in memory, CSV and Parquet, in turn.
pub fn bench() -> Vec<Recorded> {
    let kinds = [
        ("nothing", Into::Nothing),
        ("memory", Into::Memory),
        ("CSV", Into::File("csv")),
        ("Parquet", Into::File("parquet")),
    ];
    let system = Arc::new(lower(&model(&with_outputs(), &mut Vec::new())).expect("it is sound"));
    let experiment = Experiment {
        stop: STOP,
        method: Method::Qss2,
        backend: Backend::Native,
        quanta: vec![QuantumRule { pattern: "*".to_owned(), quantum: Quantum::absolute(QUANTUM) }],
        record: Some(vec!["*".to_owned()]),
        ..Experiment::default()
    };
    let begin = || Run::new(Arc::clone(&system), &experiment).expect("it starts");
    let mut taken: Vec<Vec<(Time, Time)>> = vec![Vec::new(); kinds.len()];
    let mut rows = vec![0; kinds.len()];
    for repetition in 0..=REPETITIONS {
        for (kind, (_, into)) in kinds.iter().enumerate() {
            let (run, finish, count) = record(begin(), &experiment, *into);
            rows[kind] = count;
            // The first round does not count.
            if repetition > 0 {
                taken[kind].push((run, finish));
            }
        }
    }
    let ratio = |kind: usize, of: fn(&Time) -> f64| {
        median(taken[kind].iter().zip(&taken[0]).map(|((time, _), (base, _))| of(time) / of(base)))
    };
    kinds
        .iter()
        .enumerate()
        .map(|(kind, (into, _))| {
            let (runs, finishes): (Vec<Time>, Vec<Time>) = taken[kind].iter().copied().unzip();
            Recorded {
                into,
                rows: rows[kind],
                run: medians(&runs),
                finish: medians(&finishes),
                wall_ratio: ratio(kind, |time| time.wall_ms),
                cpu_ratio: ratio(kind, |time| time.cpu_ms),
            }
        })
        .collect()
}

/// The run, the completion of the result, and the rows.
fn record(mut run: Run, experiment: &Experiment, into: Into) -> (Time, Time, u64) {
    if into == Into::Nothing {
        run.journal.wanted = false;
        let (pause, time) = timed(&mut || run.advance(STOP, u64::MAX).expect("it goes on"));
        assert_eq!(pause, Pause::Reached);
        return (time, Time { wall_ms: 0.0, cpu_ms: 0.0 }, 0);
    }
    let mut recorder = Recorder::new(&run, experiment).expect("all names are known");
    assert_eq!(recorder.schema().columns.len(), COLUMNS);
    let (schema, metadata) = (recorder.schema().clone(), Metadata::default());
    let mut sink: Box<dyn Sink> = match into {
        Into::File(extension) => open_sink(&file(extension), &schema, &metadata).expect("it opens"),
        _ => Box::new(Table::new(schema, metadata)),
    };
    let (report, time) = timed(&mut || {
        simulate(&mut run, &mut recorder, experiment, &mut [sink.as_mut()], &mut ()).expect("it goes on")
    });
    let (finished, finish) = timed(&mut || sink.finish(&Metadata::default()));
    finished.expect("it is written");
    (time, finish, report.rows)
}

fn file(extension: &str) -> PathBuf {
    std::env::temp_dir().join(format!("sophy-bench-recording.{extension}"))
}

/// The hopper of the examples with outputs of several kinds, so that with states and location there are ten columns.
fn with_outputs() -> String {
    let speed = "  output(Speed, signal, \"m/s\");\n";
    let declared = "  output(Height, signal, \"m\");\n  output(Falling, signal, \"m/s\");\n  \
                    output(Kinetic, signal, \"m2/s2\");\n  output(Potential, signal, \"m2/s2\");\n  \
                    output(Energy, signal, \"m2/s2\");\n";
    let body = "  %% In every location the height";
    let computed = "  output\n    Height = Position - L;\n    Falling = -Speed;\n    Kinetic = Speed^2/2;\n    \
                    Potential = G*Position;\n    Energy = Speed^2/2 + G*Position;\n  end output;\n\n";
    let text = HOPPER.replace(speed, &format!("{speed}{declared}"));
    text.replace(body, &format!("{computed}{body}"))
}
