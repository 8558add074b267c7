//! What a run had flushed is there after its process was killed at any moment.

#![cfg(unix)]
#![allow(clippy::unwrap_used, reason = "a test stops at the first surprise")]

use std::io::{BufRead, BufReader, Read, Write};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::Duration;

use sophy_files::{EventLog, open_sink, read_events, read_table};
use sophy_record::{Column, ColumnKind, EventRecord, Metadata, Row, Schema};

const TARGET: &str = "SOPHY_FILES_TEST_KILLED";
const ROUNDS: u64 = 12;

fn schema() -> Schema {
    let column = |name: &str, kind| Column { name: name.to_owned(), unit: Some("m".to_owned()), kind };
    let names = vec!["even".to_owned(), "odd".to_owned()];
    Schema {
        columns: vec![
            column("x", ColumnKind::Real),
            column("y", ColumnKind::Real),
            column("mode", ColumnKind::Label(names)),
        ],
        with_step: false,
    }
}

/// The `i`-th row, with cells of many digits.
fn row(i: u32) -> (f64, [f64; 2], [u32; 1]) {
    let t = f64::from(i) / 7.0;
    (t, [libm::sin(t), 1e10 * libm::cos(t)], [i % 2])
}

fn event(i: u32) -> EventRecord {
    let (time, _, [mode]) = row(i);
    let name = |n: u32| if n.is_multiple_of(2) { "even" } else { "odd" }.to_owned();
    let (from, to) = (name(mode), name(mode + 1));
    EventRecord { time, step: 0, component: "c".to_owned(), transition: "t".to_owned(), from, to }
}

/// The part of the test that is killed: writes rows for ever and says after each flush how many are safe.
#[test]
fn child() {
    let Some(path) = std::env::var_os(TARGET).map(PathBuf::from) else { return };
    let mut sink = open_sink(&path, &schema(), &Metadata::default()).unwrap();
    let mut log = EventLog::create(&events_path(&path), &Metadata::default()).unwrap();
    let mut out = std::io::stdout();
    for i in 0..u32::MAX {
        let (time, reals, labels) = row(i);
        sink.row(Row { time, step: 0, reals: &reals, labels: &labels }).unwrap();
        log.append(&event(i)).unwrap();
        // Steps of many sizes, so that flushes fall inside and between full buffers.
        if u64::from(i) * u64::from(i) % 1777 == 1 {
            sink.flush().unwrap();
            log.flush().unwrap();
            writeln!(out, "safe {}", i + 1).unwrap();
        }
    }
}

fn events_path(path: &Path) -> PathBuf {
    let mut name = path.as_os_str().to_owned();
    name.push(".events.csv");
    PathBuf::from(name)
}

fn kill_and_read(extension: &str) {
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR"));
    let mut most = 0;
    for round in 0..ROUNDS {
        let path = folder.join(format!("killed.{extension}"));
        let mut child = Command::new(std::env::current_exe().unwrap())
            .args(["--exact", "child", "--nocapture", "--test-threads=1"])
            .env(TARGET, &path)
            .stdout(Stdio::piped())
            .spawn()
            .unwrap();
        let mut lines = BufReader::new(child.stdout.take().unwrap());
        let mut line = String::new();
        while !line.contains("safe") {
            line.clear();
            assert!(lines.read_line(&mut line).unwrap() > 0, "the child ended");
        }
        // Reading goes on in another thread, so that the child never waits for us.
        let reading = std::thread::spawn(move || {
            let mut rest = Vec::new();
            lines.read_to_end(&mut rest).unwrap();
            line + &String::from_utf8(rest).unwrap()
        });
        // Moments spread over 0 to 60 ms by the golden ratio.
        let share = f64::from(u32::try_from(round).unwrap()) * 0.618_033_988_749_895;
        std::thread::sleep(Duration::from_secs_f64(0.06 * (share - libm::floor(share))));
        child.kill().unwrap();
        child.wait().unwrap();
        let said = reading.join().unwrap();
        // The last line may itself be torn.
        let whole = &said[..said.rfind('\n').map_or(0, |end| end + 1)];
        let safe =
            whole.lines().filter_map(|line| line.split_once("safe ")?.1.parse::<usize>().ok()).next_back();
        let safe = safe.unwrap();

        let table = read_table(&path).unwrap();
        assert!(table.len() >= safe, "{extension}: {} of {safe} rows", table.len());
        for i in 0..table.len() {
            let (time, reals, labels) = row(u32::try_from(i).unwrap());
            assert_eq!((table.time[i], table.reals[0][i], table.reals[1][i]), (time, reals[0], reals[1]));
            assert_eq!(table.labels[0][i], labels[0]);
        }
        assert_eq!(table.schema, schema());
        let events = read_events(&events_path(&path)).unwrap();
        assert!(events.len() >= safe);
        assert!((0..).zip(&events).all(|(i, e)| *e == event(i)));
        most = most.max(safe);
    }
    assert!(most > 1000, "the child hardly wrote: {most}");
}

#[test]
fn csv_survives() {
    kill_and_read("csv");
}

#[test]
fn arrow_survives() {
    kill_and_read("arrow");
}

#[test]
fn parquet_survives_as_its_journal() {
    kill_and_read("parquet");
}
