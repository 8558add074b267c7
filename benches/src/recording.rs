//! `recording`: what it costs to record ten variables of the hopper, beside the same run with nothing recorded.

use crate::language::model;
use crate::measure::{Time, median, medians, timed};
use cpu_time::ProcessTime;
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
    /// CPU time of the run in all threads, ms.
    pub all_ms: f64,
    /// Medians of the ratios to the run of the same round of which nothing was recorded: of the thread that runs the
    /// engine, of all threads, and by the clock.
    pub cpu_ratio: f64,
    pub all_ratio: f64,
    pub wall_ratio: f64,
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
    let mut taken: Vec<Vec<Taken>> = vec![Vec::new(); kinds.len()];
    let mut rows = vec![0; kinds.len()];
    for repetition in 0..=REPETITIONS {
        for (kind, (_, into)) in kinds.iter().enumerate() {
            let (of_round, count) = record(begin(), &experiment, *into);
            rows[kind] = count;
            // The first round does not count.
            if repetition > 0 {
                taken[kind].push(of_round);
            }
        }
    }
    let ratio = |kind: usize, of: fn(&Taken) -> f64| {
        median(taken[kind].iter().zip(&taken[0]).map(|(time, base)| of(time) / of(base)))
    };
    let row = |(kind, (into, _)): (usize, &(&'static str, Into))| {
        let runs: Vec<Time> = taken[kind].iter().map(|taken| taken.run).collect();
        let finishes: Vec<Time> = taken[kind].iter().map(|taken| taken.finish).collect();
        Recorded {
            into,
            rows: rows[kind],
            run: medians(&runs),
            finish: medians(&finishes),
            all_ms: median(taken[kind].iter().map(|taken| taken.all_ms)),
            cpu_ratio: ratio(kind, |taken| taken.run.cpu_ms),
            all_ratio: ratio(kind, |taken| taken.all_ms),
            wall_ratio: ratio(kind, |taken| taken.run.wall_ms),
        }
    };
    kinds.iter().enumerate().map(row).collect()
}

/// What one run took.
#[derive(Clone, Copy)]
struct Taken {
    run: Time,
    all_ms: f64,
    finish: Time,
}

/// What it took, and the rows.
fn record(mut run: Run, experiment: &Experiment, into: Into) -> (Taken, u64) {
    if into == Into::Nothing {
        run.journal.stop();
        let begin = ProcessTime::now();
        let (pause, time) = timed(&mut || run.advance(STOP, u64::MAX).expect("it goes on"));
        let all_ms = 1e3 * begin.elapsed().as_secs_f64();
        assert_eq!(pause, Pause::Reached);
        return (Taken { run: time, all_ms, finish: Time { wall_ms: 0.0, cpu_ms: 0.0 } }, 0);
    }
    let mut recorder = Recorder::new(&run, experiment).expect("all names are known");
    assert_eq!(recorder.schema().columns.len(), COLUMNS);
    let (schema, metadata) = (recorder.schema().clone(), Metadata::default());
    let mut sink: Box<dyn Sink> = match into {
        Into::File(extension) => open_sink(&file(extension), &schema, &metadata).expect("it opens"),
        _ => Box::new(Table::new(schema, metadata)),
    };
    let begin = ProcessTime::now();
    let (report, time) = timed(&mut || {
        simulate(&mut run, &mut recorder, experiment, &mut [sink.as_mut()], &mut ()).expect("it goes on")
    });
    let all_ms = 1e3 * begin.elapsed().as_secs_f64();
    let (finished, finish) = timed(&mut || sink.finish(&Metadata::default()));
    finished.expect("it is written");
    (Taken { run: time, all_ms, finish }, report.rows)
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
