//! The models of `tests/suite`: `good` has no messages, `bad` exactly those written in it, `run` the numbers.
//!
//! What is expected stands in comments, `%! …` in HSML and `<!--! … -->` in XML:
//!
//! - `%! error HS0101 part of the message` on the line of the message; severity, code, and, if wanted, a part of
//!   the message or of a way out. `%!^` is about the line above.
//! - `%! root NAME` names the component that is meant, `%! root implied` asks for the only one.
//! - `%! stop 2`, `%! quantum 1e-5`, `%! knob k = 3`, `%! input u = 1`: the run.
//! - `%! final x = 1.5 +- 1e-6`: a value at the end, of a truth value 0 or 1. `%! final location = Off`: a location, a
//!   text, or `true` and `false`.
//! - `%! event 0.5 NAME +- 1e-6`: a transition, `component.transition` in a composition; if one is given, all are,
//!   in order. `%! no events` where there are none.

#![allow(
    clippy::unwrap_used,
    clippy::panic,
    clippy::expect_used,
    reason = "a test stops at the first surprise"
)]

mod suite {
    pub(crate) mod expectations;
    pub(crate) mod mutations;
}

use sophy::{
    Diagnostic, Experiment, FileWorld, Loaded, Method, Quantum, QuantumRule, Root, Signal, load_as, simulate,
};
use sophy_testkit::repository;
use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use suite::expectations::{Expectations, Message};

/// Codes that no file of the suite can have, and why.
const WITHOUT_A_FILE: &[&str] = &["HS0081"]; // a file of more than 64 MiB

#[test]
fn good_models_have_no_messages() {
    let files = files("good");
    assert!(files.len() >= 60, "{}", files.len());
    let with_messages = files.iter().filter_map(|path| {
        let found = messages(&load(path, &Expectations::of(path)));
        (!found.is_empty()).then(|| format!("{}: {found:#?}", path.display()))
    });
    let wrong: Vec<String> = with_messages.collect();
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn bad_models_have_the_messages_that_stand_in_them() {
    let mut wrong = Vec::new();
    for path in files("bad") {
        let expected = Expectations::of(&path);
        assert!(!expected.messages.is_empty(), "{}: no messages are expected", path.display());
        let found = messages(&load(&path, &expected));
        let agree = found.len() == expected.messages.len()
            && expected.messages.iter().all(|message| found.iter().any(|found| message.describes(found)));
        if !agree {
            wrong.push(format!(
                "{}\n  expected {:#?}\n  found {found:#?}",
                path.display(),
                expected.messages
            ));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn every_code_of_the_language_has_a_file() {
    let mut shown: BTreeSet<String> =
        files("bad").iter().flat_map(|path| Expectations::of(path).messages).map(|m| m.code).collect();
    shown.extend(WITHOUT_A_FILE.iter().map(|&code| code.to_owned()));
    let codes = sophy::pages().map(|page| page.code).filter(|code| code.starts_with("HS"));
    let missing: Vec<&str> = codes.filter(|code| !shown.contains(*code)).collect();
    assert!(missing.is_empty(), "no file of tests/suite/bad shows {missing:?}");
}

#[test]
fn models_give_the_numbers_that_stand_in_them() {
    let files = files("run");
    assert!(files.len() >= 30, "{}", files.len());
    let wrong: Vec<String> = files.iter().filter_map(|path| run(path).err()).collect();
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// Deletes, doubles or swaps a token of a good model: there is never a panic, and few messages. A part of all
/// mutations; `SOPHY_ALL_MUTATIONS=1` tries every one.
#[test]
fn a_wrong_token_costs_few_messages() {
    let every = if std::env::var_os("SOPHY_ALL_MUTATIONS").is_some() { 1 } else { 37 };
    let good = files("good").into_iter().filter(|path| path.extension().is_some_and(|e| e == "hsml"));
    let mut counts = suite::mutations::message_counts(good, every);
    counts.sort_by_key(|(count, _)| *count);
    let at = |share: f64| counts[((counts.len() - 1) as f64 * share) as usize].0;
    eprintln!("{} mutations: median {}, 95 % {}, most {}", counts.len(), at(0.5), at(0.95), at(1.0));
    eprintln!(
        "the worst:\n{}",
        counts.iter().rev().take(8).map(|(_, t)| t.as_str()).collect::<Vec<_>>().join("\n")
    );
    assert!(counts.len() > 200);
    assert!(at(0.5) <= 3, "half of the mistakes cost {} messages or more", at(0.5));
}

/// Loads and checks a file as far as it goes without a run.
fn load(path: &Path, expected: &Expectations) -> Loaded {
    let root = match expected.root.as_deref() {
        None => Root::IfClear,
        Some("implied") => Root::Implied,
        Some(name) => Root::Named(name),
    };
    let mut loaded = load_as(&FileWorld, path, root);
    let found = sophy::check(&loaded);
    loaded.diagnostics.extend(found);
    loaded
}

fn messages(loaded: &Loaded) -> Vec<Message> {
    loaded.messages().iter().map(|message| shown(message, loaded)).collect()
}

fn shown(message: &Diagnostic, loaded: &Loaded) -> Message {
    let line = message.span().map_or(0, |span| loaded.sources.line_column(span.source, span.start).line);
    Message {
        line: line as usize,
        severity: message.severity.name().to_owned(),
        code: message.code.0.to_owned(),
        text: [&[message.message.clone()][..], &message.helps, &message.notes].concat().join("\n"),
    }
}

/// Runs a model and compares.
fn run(path: &Path) -> Result<(), String> {
    let expected = Expectations::of(path);
    let wrong = |what: String| Err(format!("{}: {what}", path.display()));
    let loaded = load(path, &expected);
    let found = messages(&loaded);
    let Some(model) = loaded.model.filter(|_| found.is_empty()) else { return wrong(format!("{found:#?}")) };
    let quantum = QuantumRule { pattern: "*".to_owned(), quantum: Quantum::absolute(expected.quantum) };
    let experiment = Experiment {
        stop: expected.stop,
        method: Method::Qss2,
        quanta: vec![quantum],
        knobs: expected.knobs.clone(),
        inputs: expected.inputs.iter().map(|(name, u)| (name.clone(), Signal::constant(*u))).collect(),
        record: Some(vec!["*".to_owned()]),
        ..Experiment::default()
    };
    let simulation = match simulate(&model, &experiment) {
        Ok(simulation) => simulation,
        Err(error) => return wrong(error.to_string()),
    };
    for (name, value, tolerance) in &expected.finals {
        let real = simulation.table.real(name).map(|values| values.last().copied());
        let label = || simulation.table.label(name).map(|(labels, _)| labels.last().map(|&l| f64::from(l)));
        let Some(last) = real.or_else(label) else {
            return wrong(format!("no `{name}` in the result"));
        };
        let last = last.unwrap_or(f64::NAN);
        let error = (last - value).abs();
        if error.is_nan() || error > *tolerance {
            return wrong(format!("{name} is {last:.17} at the end, not {value} +- {tolerance}"));
        }
    }
    for (name, location) in &expected.final_labels {
        let Some((positions, names)) = simulation.table.label(name) else {
            return wrong(format!("no `{name}` in the result"));
        };
        let last = positions.last().and_then(|&position| names.get(position as usize));
        if last != Some(location) {
            return wrong(format!("`{name}` is {last:?} at the end, not {location}"));
        }
    }
    if expected.events.is_empty() && !expected.no_events {
        return Ok(());
    }
    let taken: Vec<(f64, String)> = simulation
        .events
        .iter()
        .map(|event| {
            let dot = if event.component.is_empty() { "" } else { "." };
            (event.time, format!("{}{dot}{}", event.component, event.transition))
        })
        .collect();
    let agree = taken.len() == expected.events.len()
        && taken.iter().zip(&expected.events).all(|((time, name), (expected, transition, tolerance))| {
            name == transition && (time - expected).abs() <= *tolerance
        });
    if agree { Ok(()) } else { wrong(format!("expected {:#?}\ntaken {taken:#?}", expected.events)) }
}

/// The models in a folder of the suite, sorted.
fn files(folder: &str) -> Vec<PathBuf> {
    let entries = fs::read_dir(repository().join("tests/suite").join(folder)).unwrap();
    let mut files: Vec<PathBuf> = entries.map(|entry| entry.unwrap().path()).collect();
    files.retain(|path| path.extension().is_some_and(|extension| extension == "hsml" || extension == "xml"));
    files.sort();
    files
}
