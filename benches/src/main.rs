//! Sophy beside hand-written loops of the same algorithm and beside other software, in one process, alternating.
//!
//! `cargo xtask bench` builds and runs this, and the tables go to the terminal and to `results/latest.{md,json}`. Words
//! choose what is measured: `engine` the engines beside the floors, `peers` beside other software (`peers hopper`: one
//! problem), `language` from text to a run that is ready (`language copies`: one kind of text), `build` the part of it
//! after the model, `recording` what it costs to record, `figures` the pictures of the book, which are drawn anew.
//! `--name NAME` names the files of results.
//! Machines are noisy: read the ratios, which compare neighbours in time, and never a speed without the error
//! that stands beside it.

mod build;
mod case;
mod contest;
mod figures;
mod floor;
mod hopper;
mod language;
mod measure;
mod memory;
mod oscillator;
mod peers;
mod precision;
mod problem;
mod recording;
mod report;
mod rows;
mod scale;
mod stamp;
mod systems;

use report::Results;
use std::path::Path;

fn main() -> std::io::Result<()> {
    let mut words: Vec<String> = std::env::args().skip(1).collect();
    let name = named(&mut words);
    let chosen = words.first().map(String::as_str);
    let wants = |part: &str| chosen.is_none_or(|chosen| chosen == part);
    let here = Path::new(env!("CARGO_MANIFEST_DIR"));

    let mut results = Results::default();
    if wants("engine") {
        results.runs.extend([hopper::bench(), oscillator::bench(), systems::bench()].concat());
    }
    if wants("peers") {
        results.runs.extend(contest::bench(words.get(1).map(String::as_str)));
    }
    if wants("figures") {
        let (points, sizes, activity) = figures::measure();
        figures::draw_all(&here.join("../docs/book/figures"), &points, &sizes, &activity)?;
        results.points = points;
        results.scaled = [sizes, activity].concat();
    }
    if wants("build") {
        results.built = build::bench();
    }
    if wants("recording") {
        results.recorded = recording::bench();
    }
    if wants("language") {
        results.told = language::bench(words.get(1).map(String::as_str));
    }

    let stamp = stamp::Stamp::now();
    let markdown = report::markdown(&stamp, &results);
    print!("{markdown}");
    let folder = here.join("results");
    std::fs::create_dir_all(&folder)?;
    std::fs::write(folder.join(format!("{name}.md")), markdown)?;
    std::fs::write(folder.join(format!("{name}.json")), rows::json(&stamp, &results))
}

/// Takes `--name NAME` out of the words.
fn named(words: &mut Vec<String>) -> String {
    match words.iter().position(|word| word == "--name") {
        Some(at) if at + 1 < words.len() => words.drain(at..at + 2).nth(1).unwrap_or_default(),
        _ => "latest".to_owned(),
    }
}
