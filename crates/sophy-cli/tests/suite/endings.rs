//! Runs that end before their time: killed, interrupted.

use crate::support::Folder;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

/// A run that would take hours.
fn start(folder: &Folder, outputs: &[&str]) -> Child {
    let mut arguments = vec!["run", "oscillator.xml", "--stop", "1e9", "--quantum", "1e-3", "--every", "1"];
    outputs.iter().for_each(|file| arguments.extend(["-o", file]));
    arguments.extend(["--events", "events.csv"]);
    let mut command = folder.command(&arguments);
    command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().expect("starts")
}

/// Waits for rows behind the head of a file.
fn wait_for(file: &str, folder: &Folder) {
    let begin = Instant::now();
    while std::fs::metadata(folder.0.join(file)).map_or(0, |data| data.len()) < 100_000 {
        assert!(begin.elapsed() < Duration::from_secs(60), "{file} does not grow");
        std::thread::sleep(Duration::from_millis(20));
    }
}

#[test]
fn what_was_written_before_a_kill_can_be_read() {
    for (round, wait) in [0, 130, 390, 710].into_iter().enumerate() {
        let folder = Folder::with_oscillator(&format!("killed_{round}"));
        let mut child = start(&folder, &["a.csv", "a.arrow", "a.parquet"]);
        wait_for("a.csv", &folder);
        wait_for("a.arrow", &folder);
        wait_for("a.parquet.journal", &folder);
        std::thread::sleep(Duration::from_millis(wait));
        child.kill().expect("killed");
        child.wait().expect("gone");
        for (file, copy) in
            [("a.csv", "b.csv"), ("a.arrow", "c.csv"), ("a.parquet.journal", "d.csv"), ("a.parquet", "e.csv")]
        {
            folder.sophy(&["convert", file, copy]).ends(0, &[]);
            let text = folder.read(copy);
            let rows = text.lines().count();
            assert!(rows > 10, "{file}: {rows} rows");
            let last: f64 =
                text.lines().last().and_then(|l| l.split(',').next()).expect("row").parse().expect("time");
            assert_eq!(last, rows as f64 - 2.0, "{file}: rows are missing");
        }
        folder.sophy(&["plot", "a.parquet.journal", "-o", "a.svg"]).ends(0, &[]);
    }
}

#[test]
fn an_interrupted_run_leaves_complete_files() {
    let folder = Folder::with_oscillator("interrupted");
    let child = start(&folder, &["a.csv", "a.parquet"]);
    wait_for("a.csv", &folder);
    let pid = child.id().to_string();
    assert!(Command::new("kill").args(["-INT", &pid]).status().expect("kill").success());
    let output = child.wait_with_output().expect("ends");
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(130), "{said}");
    assert!(said.contains("interrupted at t = "), "{said}");
    assert!(folder.read("a.csv.meta.json").contains("interrupted"));
    assert!(folder.has("a.parquet") && !folder.has("a.parquet.journal"));
    folder.sophy(&["convert", "a.parquet", "b.csv"]).ends(0, &[]);
    assert_eq!(folder.read("a.csv"), folder.read("b.csv"));
}
