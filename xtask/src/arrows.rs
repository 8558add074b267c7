//! The arrows between crates are those of the table in ARCHITECTURE.md, neither more nor fewer.

use crate::steps::root;
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use toml::{Table, Value};

/// Crate → crates of this repository it depends on.
type Arrows = BTreeMap<String, BTreeSet<String>>;

/// Text becomes equations here.
const LANGUAGE: [&str; 6] =
    ["sophy-syntax", "sophy-ir", "sophy-analysis", "sophy-xml", "sophy-passes", "sophy-codegen"];
/// Time passes here.
const ENGINES: [&str; 4] = ["sophy-solvers", "sophy-hybrid", "sophy-record", "sophy-field"];

#[test]
fn the_manifests_have_the_arrows_of_the_table() {
    let (table, manifests) = (table(), manifests("dependencies"));
    assert_eq!(
        manifests.keys().collect::<Vec<_>>(),
        table.keys().collect::<Vec<_>>(),
        "crates (left) and rows of the table in ARCHITECTURE.md (right)"
    );
    for (name, arrows) in &manifests {
        let written = &table[name];
        let more: Vec<_> = arrows.difference(written).collect();
        let fewer: Vec<_> = written.difference(arrows).collect();
        assert!(
            more.is_empty() && fewer.is_empty(),
            "{name}: {more:?} are not in the table of ARCHITECTURE.md, {fewer:?} are only there; \
             before you add an arrow, ask which item is in the wrong room"
        );
    }
}

#[test]
fn engines_and_hybrid_logic_do_not_know_each_other() {
    let all = closure(&manifests("dependencies"));
    assert!(!all["sophy-solvers"].contains("sophy-hybrid"));
    assert!(!all["sophy-hybrid"].contains("sophy-solvers"));
}

#[test]
fn engines_know_no_language_and_the_language_no_engine() {
    let all = closure(&manifests("dependencies"));
    for engine in ENGINES {
        for language in LANGUAGE {
            assert!(!all[engine].contains(language), "{engine} reaches {language}");
            let vocabulary = engine == "sophy-field";
            assert!(vocabulary || !all[language].contains(engine), "{language} reaches {engine}");
        }
    }
}

/// Tests may use the testkit, and rooms that stand above theirs in the table; nothing else uses the testkit.
#[test]
fn tests_look_up_the_walk_only() {
    for (name, arrows) in manifests("dependencies") {
        assert!(!arrows.contains("sophy-testkit"), "{name}");
    }
    let rooms: Vec<String> = rows().map(|(name, _)| name).collect();
    let place = |name: &String| rooms.iter().position(|room| room == name);
    for (name, arrows) in manifests("dev-dependencies") {
        let stray: Vec<_> =
            arrows.iter().filter(|a| *a != "sophy-testkit" && place(a) >= place(&name)).collect();
        assert!(stray.is_empty(), "the tests of {name} use {stray:?}");
    }
    assert!(manifests("build-dependencies").values().all(BTreeSet::is_empty));
}

#[test]
fn dependencies_from_outside_have_a_version_and_stand_in_one_list() {
    let list = manifest("Cargo.toml");
    let list = list["workspace"]["dependencies"].as_table().unwrap();
    for (name, dependency) in list {
        match dependency {
            Value::String(_) => {}
            Value::Table(entry) if name.starts_with("sophy-") => {
                assert!(entry["path"].as_str().unwrap().starts_with("crates/"), "{name}");
            }
            Value::Table(entry) => {
                let elsewhere = ["git", "path", "registry"].iter().any(|key| entry.contains_key(*key));
                assert!(entry.contains_key("version") && !elsewhere, "{name}");
            }
            other => panic!("{name} = {other}"),
        }
    }
    for folder in crates().into_iter().chain(["xtask".to_owned()]) {
        let manifest = manifest(&format!("{folder}/Cargo.toml"));
        for kind in ["dependencies", "dev-dependencies", "build-dependencies"] {
            for (name, dependency) in manifest.get(kind).and_then(Value::as_table).into_iter().flatten() {
                let shared = dependency.get("workspace").and_then(Value::as_bool);
                assert_eq!(shared, Some(true), "{folder}: {name} is not taken from the workspace's list");
            }
        }
    }
}

fn table() -> Arrows {
    rows().collect()
}

/// The rows `| crate | … | may use |` of ARCHITECTURE.md, in order.
fn rows() -> impl Iterator<Item = (String, BTreeSet<String>)> {
    let text = fs::read_to_string(root().join("ARCHITECTURE.md")).unwrap();
    let rows: Vec<String> =
        text.lines().filter(|line| line.starts_with("| `sophy-")).map(str::to_owned).collect();
    rows.into_iter().map(|row| {
        let cells: Vec<&str> = row.trim_matches('|').split('|').map(str::trim).collect();
        let [name, _, uses] = cells[..] else { panic!("three cells expected: {row}") };
        let uses = uses.split(',').map(|word| word.trim().trim_matches('`'));
        let uses = uses.filter(|word| *word != "–").map(|word| format!("sophy-{word}"));
        (name.trim_matches('`').to_owned(), uses.collect())
    })
}

/// The arrows of all crates, of one kind.
fn manifests(kind: &str) -> Arrows {
    let arrows = crates().into_iter().map(|folder| {
        let manifest = manifest(&format!("{folder}/Cargo.toml"));
        let name = manifest["package"]["name"].as_str().unwrap().to_owned();
        let dependencies = manifest.get(kind).and_then(Value::as_table).into_iter().flatten();
        let ours = dependencies.map(|(name, _)| name.clone()).filter(|name| name.starts_with("sophy-"));
        (name, ours.collect())
    });
    arrows.collect()
}

/// Everything a crate reaches.
fn closure(arrows: &Arrows) -> Arrows {
    let reach = |name: &String| {
        let mut reached = BTreeSet::new();
        let mut pending: Vec<&String> = arrows[name].iter().collect();
        while let Some(next) = pending.pop() {
            if reached.insert(next.clone()) {
                pending.extend(&arrows[next]);
            }
        }
        (name.clone(), reached)
    };
    arrows.keys().map(reach).collect()
}

fn manifest(path: &str) -> Table {
    fs::read_to_string(root().join(path)).unwrap().parse().unwrap()
}

fn crates() -> Vec<String> {
    let folders = fs::read_dir(root().join("crates")).unwrap();
    folders.map(|entry| format!("crates/{}", entry.unwrap().file_name().to_string_lossy())).collect()
}
