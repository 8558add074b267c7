//! Rules that a reader relies on and no lint knows.

use crate::steps::root;
use std::fs;
use std::path::{Path, PathBuf};

/// Crates that reach the world through their arguments only: no file, no environment, no terminal.
const SEALED: [&str; 13] = [
    "diagnostics",
    "segment",
    "field",
    "syntax",
    "ir",
    "analysis",
    "xml",
    "passes",
    "codegen",
    "solvers",
    "hybrid",
    "record",
    "run",
];

const MOST_LINES: usize = 800;

#[test]
fn language_and_engines_open_no_file_and_know_no_terminal() {
    for name in SEALED {
        for path in rust_files(&root().join(format!("crates/sophy-{name}/src"))) {
            let text = fs::read_to_string(&path).unwrap();
            if is_test_module(&path) {
                continue;
            }
            for line in without_tests(&text).map(without_comment) {
                assert!(!reaches_out(line), "{}: {line}", path.display());
            }
        }
    }
}

/// Whether a line of code uses files, the environment, the network, processes or the terminal.
fn reaches_out(line: &str) -> bool {
    let words: Vec<&str> = line.split(|c: char| !(c.is_alphanumeric() || c == '_')).collect();
    let outside = ["fs", "env", "net", "process", "stdin", "stdout", "stderr"];
    let module = line.contains("std::") && outside.iter().any(|module| words.contains(module));
    let printing = ["print!", "println!", "eprint!", "eprintln!", "dbg!"];
    module || printing.iter().any(|name| line.contains(name))
}

#[test]
fn reaching_out_is_recognised() {
    for (line, expected) in [
        ("let text = std::fs::read(path);", true),
        ("use std::{env, fmt};", true),
        ("    println!(\"here\");", true),
        ("use std::io::stdout;", true),
        ("use std::fmt;", false),
        ("writeln!(f, \"{x}\")?;", false),
        ("let environment = fs();", false),
    ] {
        assert_eq!(reaches_out(line), expected, "{line}");
    }
}

#[test]
fn files_are_named_after_an_idea() {
    for path in all_rust_files() {
        let name = path.file_stem().unwrap().to_string_lossy();
        let empty = ["util", "utils", "helper", "helpers", "misc", "common"];
        assert!(!empty.contains(&name.as_ref()), "{}", path.display());
    }
}

#[test]
fn files_stay_within_one_idea() {
    for path in all_rust_files() {
        let lines = fs::read_to_string(&path).unwrap().lines().count();
        assert!(lines <= MOST_LINES, "{} has {lines} lines: which two ideas meet in it?", path.display());
    }
}

/// A room's door: what it is, what is in it, what may be used.
#[test]
fn lib_rs_is_a_doc_modules_and_what_is_public() {
    for entry in fs::read_dir(root().join("crates")).unwrap() {
        let path = entry.unwrap().path().join("src/lib.rs");
        let Ok(text) = fs::read_to_string(&path) else { continue };
        assert!(text.starts_with("//! "), "{} does not say what the crate is", path.display());
        let mut inside_use = false;
        for line in text.lines().map(str::trim) {
            let opens = line.starts_with("pub use ");
            let module = line.trim_start_matches("pub ");
            let module = module.starts_with("mod ") && module.ends_with(';');
            let plain = line.is_empty() || line.starts_with("//") || line.starts_with('#');
            assert!(plain || module || opens || inside_use, "{}: {line}", path.display());
            inside_use = (opens || inside_use) && !line.ends_with(';');
        }
    }
}

#[test]
fn unsafe_code_says_why_it_is_sound() {
    for path in all_rust_files() {
        let text = fs::read_to_string(&path).unwrap();
        let lines: Vec<&str> = text.lines().collect();
        for (number, line) in lines.iter().enumerate() {
            if without_comment(line).split_whitespace().any(|word| word == "unsafe") {
                let before = &lines[number.saturating_sub(4)..number];
                // A block says why it is sound; a function or its type, what it asks of its caller.
                let why = ["// SAFETY:", "/// # Safety"];
                let said = before.iter().any(|line| why.iter().any(|why| line.trim_start().starts_with(why)));
                assert!(said, "{}:{}: {line}", path.display(), number + 1);
            }
        }
    }
}

#[test]
fn the_changelog_has_a_place_for_the_next_change() {
    let text = fs::read_to_string(root().join("CHANGELOG.md")).unwrap();
    assert!(text.lines().any(|line| line == "## [Unreleased]"));
}

/// Two commands: one shows something, the other tests everything and is what `.ci/run` calls.
#[test]
fn the_readme_gives_the_commands_that_are_checked() {
    let text = fs::read_to_string(root().join("README.md")).unwrap();
    let mut inside = false;
    let mut commands = Vec::new();
    for line in text.lines() {
        inside ^= line.starts_with("```");
        let code = line.trim().trim_start_matches("$ ");
        if (inside || line.starts_with("    "))
            && let Some(command) = code.strip_prefix("cargo ")
        {
            commands.push(command.split(" #").next().unwrap_or(command).trim());
        }
    }
    assert_eq!(commands.first(), Some(&"run -p sophy-cli -- run examples/hopper/hopper.toml"));
    assert!(root().join("examples/hopper/hopper.toml").exists());
    let run = fs::read_to_string(root().join(".ci/run")).unwrap();
    let tests = run.lines().find_map(|line| line.strip_prefix("exec cargo ")).unwrap();
    assert_eq!(commands.get(1), Some(&tests));
}

/// The lines before a module of tests that closes a file.
fn without_tests(text: &str) -> impl Iterator<Item = &str> {
    let lines: Vec<&str> = text.lines().collect();
    let end = lines
        .windows(2)
        .position(|pair| pair[0] == "#[cfg(test)]" && pair[1].starts_with("mod ") && pair[1].ends_with('{'));
    let end = end.unwrap_or(lines.len());
    lines.into_iter().take(end)
}

/// Files of modules that a `#[cfg(test)] mod tests;` or `mod testing;` brings in.
fn is_test_module(path: &Path) -> bool {
    let path = path.strip_prefix(root()).unwrap_or(path);
    path.iter().any(|part| ["tests", "tests.rs", "testing.rs"].iter().any(|name| part == *name))
}

fn without_comment(line: &str) -> &str {
    line.split("//").next().unwrap_or(line)
}

fn all_rust_files() -> Vec<PathBuf> {
    let folders = ["crates", "fuzz/src", "xtask/src", "benches/src"];
    folders.iter().flat_map(|folder| rust_files(&root().join(folder))).collect()
}

fn rust_files(folder: &Path) -> Vec<PathBuf> {
    let mut files = Vec::new();
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() && path.file_name().is_some_and(|name| name != "target") {
            files.extend(rust_files(&path));
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            files.push(path);
        }
    }
    files
}
