//! Throws broken models at the readers, which must survive them all.
//!
//! `cargo xtask fuzz` builds and runs this in release mode, `cargo xtask ci` for a minute as it is. An input is a
//! function of corpus, seed and index ([`mutate`]), tried in a [`worker`] process with a small stack and a counting
//! allocator. What a [`target`] must hold: no panic, the text kept, places inside it, layout that changes nothing,
//! and time and memory in proportion to the input. What breaks is made smaller ([`minimise`]) and put to the corpus
//! in `tests/fuzz`, with which every later campaign starts.

mod campaign;
mod corpus;
mod minimise;
mod mutate;
mod random;
mod tally;
mod target;
mod worker;

use campaign::Campaign;
use std::io::{self, Write};
use std::process::ExitCode;
use std::time::Duration;
use target::Target;

const USAGE: &str =
    "cargo xtask fuzz [--inputs N] [--seconds S] [--seed K] [--from I] [hsml|xml|hsml-model|xml-model]…
cargo xtask fuzz --check TARGET FILE
cargo xtask fuzz --print TARGET SEED INDEX";

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let words: Vec<&str> = arguments.iter().map(String::as_str).collect();
    let done = match words.as_slice() {
        ["--worker", target, numbers @ ..] => work(target, numbers),
        ["--check", target, file] => check(target, file),
        ["--print", target, seed, index] => print(target, seed, index),
        _ => run(&words),
    };
    match done {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::FAILURE,
        Err(error) => {
            say(&format!("{error}"));
            ExitCode::FAILURE
        }
    }
}

/// A campaign against each target that is named, or all; true if all was survived.
fn run(words: &[&str]) -> io::Result<bool> {
    let (mut inputs, mut seconds, mut seed, mut from) = (None, None, 1, 0);
    let mut targets = Vec::new();
    let mut words = words.iter();
    while let Some(&word) = words.next() {
        let mut number = || words.next().and_then(|word| word.parse::<u64>().ok()).ok_or_else(usage);
        match word {
            "--inputs" => inputs = Some(number()?),
            "--seconds" => seconds = Some(number()?),
            "--seed" => seed = number()?,
            "--from" => from = number()?,
            _ => targets.push(Target::named(word).ok_or_else(usage)?),
        }
    }
    if targets.is_empty() {
        targets = Target::ALL.to_vec();
    }
    // Without a number of inputs, a minute; with one, as long as they take.
    let seconds =
        seconds.or(inputs.is_none().then_some(60)).map(|seconds| seconds as f64 / targets.len() as f64);
    let time = seconds.map_or(Duration::from_secs(u64::from(u32::MAX)), Duration::from_secs_f64);
    let campaign =
        Campaign { seed, indices: from..inputs.map_or(u64::MAX, |inputs| from.saturating_add(inputs)), time };
    let mut survived = true;
    for target in targets {
        let name = target.name();
        let (tally, finds) = campaign::run(target, &campaign)?;
        say(&format!("{name}, seed {seed}: {}", tally.summary()));
        for find in &finds {
            let file = find.file.display();
            say(&format!(
                "{name}: input {} of seed {seed}: {} ({} times)",
                find.index, find.cause, find.times
            ));
            say(&format!("  made smaller: {file}\n  cargo xtask fuzz --check {name} {file}"));
        }
        survived &= finds.is_empty();
    }
    Ok(survived)
}

/// The inputs of one worker: seed, first, end, seconds, trace.
fn work(target: &str, numbers: &[&str]) -> io::Result<bool> {
    let target = Target::named(target).ok_or_else(usage)?;
    let numbers: Vec<u64> = numbers.iter().filter_map(|word| word.parse().ok()).collect();
    let &[seed, start, end, seconds, trace] = numbers.as_slice() else { return Err(usage()) };
    let time = Duration::from_secs(seconds);
    worker::work(worker::Task { target, seed, indices: start..end, time, trace: trace == 1 })
}

/// One file.
fn check(target: &str, file: &str) -> io::Result<bool> {
    let target = Target::named(target).ok_or_else(usage)?;
    worker::check_one(target, std::fs::read(file)?)
}

/// One input of a campaign, as it is.
fn print(target: &str, seed: &str, index: &str) -> io::Result<bool> {
    let target = Target::named(target).ok_or_else(usage)?;
    let (Ok(seed), Ok(index)) = (seed.parse(), index.parse()) else { return Err(usage()) };
    let input = mutate::input(&corpus::Corpus::read(target.notation())?, seed, index);
    io::stdout().write_all(&input).map(|()| true)
}

fn usage() -> io::Error {
    io::Error::new(io::ErrorKind::InvalidInput, USAGE)
}

/// Tells the person at the terminal.
fn say(message: &str) {
    // Nobody is left to tell if this fails.
    let _ = writeln!(io::stderr(), "{message}");
}
