//! The commands of `docs/book` and of the README work, and the table of flags is complete.

#![allow(clippy::unwrap_used, clippy::expect_used, reason = "a test stops at the first surprise")]

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Every line `$ sophy …` of a page is run, in the order of the page, in a copy of the examples. The word after
/// `console` is the exit code, if it is not 0.
#[test]
fn the_commands_of_the_book_work() {
    let mut run = 0;
    for page in pages() {
        let folder = copy_of_examples(&page);
        let text = fs::read_to_string(&page).unwrap();
        let mut expected = None;
        for line in text.lines() {
            if let Some(fence) = line.strip_prefix("```") {
                let mut words = fence.split_whitespace();
                let console = words.next() == Some("console");
                expected = console.then(|| words.next().map_or(0, |code| code.parse().unwrap()));
            } else if let (Some(code), Some(command)) = (expected, line.strip_prefix("$ sophy ")) {
                let output = sophy()
                    .args(arguments(command))
                    .current_dir(&folder)
                    .output()
                    .expect("the command starts");
                let answer = String::from_utf8_lossy(&output.stderr);
                assert_eq!(output.status.code(), Some(code), "{}: {line}\n{answer}", page.display());
                run += 1;
            }
        }
    }
    assert!(run >= 8, "only {run} commands were found");
}

/// The long flags in the tables of `experiments.md` are those of `sophy run`.
#[test]
fn the_flags_of_run_are_those_of_the_book() {
    let page = fs::read_to_string(root().join("docs/book/experiments.md")).unwrap();
    let rows = page.lines().filter(|line| line.starts_with("| "));
    let described: BTreeSet<String> = rows.flat_map(flags).collect();
    let output = sophy().args(["run", "--help"]).output().unwrap();
    let help = String::from_utf8(output.stdout).unwrap();
    let heads = help.lines().filter(|line| line.trim_start().starts_with('-'));
    let mut known: BTreeSet<String> = heads.filter_map(|line| flags(line).into_iter().next()).collect();
    known.remove("--help");
    known.remove("--version");
    assert_eq!(described, known, "flags of experiments.md (left) and of `sophy run --help` (right)");
}

/// The words of a line that begin with `--`.
fn flags(line: &str) -> Vec<String> {
    let is_flag = |c: char| c.is_ascii_lowercase() || c == '-';
    let words = line.split(|c: char| !is_flag(c));
    words.filter(|word| word.starts_with("--") && !word.ends_with('-')).map(str::to_owned).collect()
}

/// The words of a command; quotes keep blanks and stars.
fn arguments(command: &str) -> Vec<String> {
    let mut words = vec![String::new()];
    let mut quoted = false;
    for c in command.chars() {
        match c {
            '\'' => quoted = !quoted,
            ' ' if !quoted => words.push(String::new()),
            c => words.last_mut().unwrap().push(c),
        }
    }
    words.retain(|word| !word.is_empty());
    words
}

fn copy_of_examples(page: &Path) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("book").join(page.file_stem().unwrap());
    let _ = fs::remove_dir_all(&folder);
    copy(&root().join("examples"), &folder.join("examples"));
    folder
}

fn copy(from: &Path, to: &Path) {
    fs::create_dir_all(to).unwrap();
    for entry in fs::read_dir(from).unwrap() {
        let path = entry.unwrap().path();
        let target = to.join(path.file_name().unwrap());
        if path.is_dir() {
            copy(&path, &target);
        } else {
            fs::copy(&path, &target).unwrap();
        }
    }
}

fn pages() -> Vec<PathBuf> {
    let folder = fs::read_dir(root().join("docs/book")).unwrap();
    let mut pages: Vec<PathBuf> = folder.map(|entry| entry.unwrap().path()).collect();
    pages.retain(|path| path.extension().is_some_and(|extension| extension == "md"));
    pages.sort();
    pages
}

fn sophy() -> Command {
    Command::new(env!("CARGO_BIN_EXE_sophy"))
}

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}
