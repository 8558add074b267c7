//! The pages of messages are true: every example has the message it is about.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test stops at the first surprise")]

use sophy::{
    Diagnostic, Error, Experiment, FileWorld, Loaded, MemoryWorld, Page, check, load_experiment, load_model,
    pages, simulate, to_xml,
};
use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

/// Messages that a few lines cannot show: about bytes, sizes and files, and failures of arithmetic.
const WITHOUT_EXAMPLE: &[&str] = &[
    "HS0081", "HS0082", "HS0083", "SX0001", "SX0002", "SX0003", "SX0005", "SX0199", "EX0202", "FI0001",
    "FI0002", "FI0003", "FI0004", "SR0002", "SR0003", "SR0009",
];

#[test]
fn every_page_explains_and_has_an_example_that_it_is_about() {
    let mut seen = BTreeSet::new();
    for page in pages() {
        let Page { code, title, text } = page;
        assert!(seen.insert(code), "{code} stands twice");
        assert!(!title.is_empty() && !title.ends_with('.'), "{code}: {title}");
        let mut parts = text.split("\n```");
        // What it means comes first, the way out last.
        assert!(parts.next().is_some_and(|meaning| meaning.len() > 20), "{code}: what does it mean?");
        assert!(text.lines().next_back().is_some_and(|last| last != "```"), "{code}: what is the way out?");
        let examples: Vec<(&str, &str)> =
            parts.step_by(2).map(|block| block.split_once('\n').unwrap()).collect();
        assert_eq!(examples.is_empty(), WITHOUT_EXAMPLE.contains(&code), "{code}: an example?");
        for (language, example) in examples {
            let found = messages(code, language, &format!("{example}\n"));
            let codes: Vec<&str> = found.iter().map(|message| message.code.0).collect();
            assert!(codes.contains(&code), "the example of {code} gives {codes:?}");
        }
    }
}

/// Examples are laid out, as far as mistakes of grammar allow it.
#[test]
fn examples_are_laid_out() {
    for Page { code, text, .. } in pages() {
        for block in text.split("\n```hsml\n").skip(1) {
            let example = format!("{}\n", block.split("\n```").next().unwrap());
            if let Some(laid_out) = sophy::format(code, example.as_bytes()).text {
                assert_eq!(example, laid_out, "{code}");
            }
        }
    }
}

fn messages(code: &str, language: &str, example: &str) -> Vec<Diagnostic> {
    if language == "toml" {
        return all(experiment(example));
    }
    let name = format!("example.{language}");
    let mut loaded = load_model(&MemoryWorld::default().with(&name, example), Path::new(&name));
    if code.starts_with("SX04") {
        loaded.diagnostics.extend(to_xml(&loaded).diagnostics);
    }
    let ended = loaded.model.as_ref().map(|model| {
        let experiment = Experiment { stop: 5.0, ..Experiment::default() };
        simulate(model, &experiment)
    });
    let mut found = all(loaded);
    if code.starts_with("SR") {
        match ended {
            Some(Err(Error::Failure(failure))) => found.push(failure.diagnostic()),
            Some(Ok(simulation)) if matches!(simulation.report.outcome, sophy::Outcome::Zeno(_)) => {
                assert_eq!(code, "SR0101");
                return zeno(example);
            }
            other => panic!("{code}: {other:?}"),
        }
    }
    found
}

/// What is said beside the report of a run whose transitions accumulate.
fn zeno(example: &str) -> Vec<Diagnostic> {
    let world = MemoryWorld::default().with("example.hsml", example);
    let mut loaded = load_model(&world, Path::new("example.hsml"));
    loaded.setup.experiment.stop = 5.0;
    let model = loaded.model.as_ref().unwrap();
    let finished = sophy::run(model, &loaded.setup, &loaded.provenance, &mut Vec::new()).unwrap();
    finished.zeno.into_iter().collect()
}

/// An experiment beside the example `hopper`.
fn experiment(text: &str) -> Loaded {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("pages");
    fs::create_dir_all(&folder).unwrap();
    let hopper = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples/hopper/hopper.xml");
    fs::copy(hopper, folder.join("hopper.xml")).unwrap();
    fs::write(folder.join("experiment.toml"), text).unwrap();
    load_experiment(&FileWorld, &folder.join("experiment.toml"))
}

fn all(mut loaded: Loaded) -> Vec<Diagnostic> {
    let found = check(&loaded);
    loaded.diagnostics.extend(found);
    loaded.messages()
}
