//! Sophy beside hand-written loops of the same algorithm, in one process, alternating.
//!
//! `cargo xtask bench` builds and runs this; the table goes to the terminal and to `results/latest.{md,json}`. With
//! the word `language` it measures the language alone (`language copies`: one kind of text), with `engine` the engines
//! alone, with `recording` what recording costs, and writes no file.
//! Machines are noisy: read the ratios, which compare neighbours in time, and never a speed without the error
//! that stands beside it.

mod build;
mod case;
mod floor;
mod hopper;
mod language;
mod measure;
mod memory;
mod oscillator;
mod recording;
mod report;
mod systems;

fn main() -> std::io::Result<()> {
    let engines = || [hopper::bench(), oscillator::bench(), systems::bench()].concat();
    let mut words = std::env::args().skip(1);
    match words.next().as_deref() {
        Some("language") => {
            print!("{}", report::told_markdown(&language::bench(words.next().as_deref())));
            return Ok(());
        }
        Some("engine") => {
            print!("{}", report::markdown(&engines()));
            return Ok(());
        }
        Some("recording") => {
            print!("{}", report::recorded_markdown(&recording::bench()));
            return Ok(());
        }
        _ => {}
    }
    let results = engines();
    let built = build::bench();
    let told = language::bench(None);
    let tables = [report::markdown(&results), report::built_markdown(&built), report::told_markdown(&told)];
    let markdown = tables.join("\n");
    print!("{markdown}");
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("results");
    std::fs::create_dir_all(&folder)?;
    std::fs::write(folder.join("latest.md"), markdown)?;
    std::fs::write(folder.join("latest.json"), report::json(&results, &built, &told))
}
