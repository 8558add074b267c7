//! What the commands do: one call of cargo after the other.

use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::{Duration, Instant};

/// Formatting, lints, all tests and a short campaign of fuzzing; ends with the time of each part.
pub(crate) fn ci() -> Result<(), String> {
    cargo(&["fmt", "--all", "--check"])?;
    cargo(&["fmt", "--manifest-path", "benches/Cargo.toml", "--check"])?;
    let lints = cargo(&["clippy", "--workspace", "--all-targets", "--", "-D", "warnings"])?;
    // The benches, a workspace of their own, must not rot.
    let benches = ["clippy", "--manifest-path", "benches/Cargo.toml", "--", "-D", "warnings"];
    let lints = lints + cargo(&benches)?;
    let build = cargo(&["test", "--workspace", "--no-run"])?;
    let tests = cargo(&["test", "--workspace"])?;
    // So many inputs take about half a minute each; a number of them, not a time, so that every run is the same.
    let campaign = |inputs: &str, target: &str| {
        cargo(&["run", "--package", "sophy-fuzz", "--", "--inputs", inputs, target])
    };
    let fuzz = campaign("40000", "hsml")? + campaign("300000", "xml")?;
    let [build, lints, tests, fuzz] = [build, lints, tests, fuzz].map(|part| part.as_secs());
    say(&format!("all checks passed: clippy {lints} s, build {build} s, tests {tests} s, fuzzing {fuzz} s"));
    Ok(())
}

/// Builds the benches in release mode and runs them.
pub(crate) fn bench(arguments: &[String]) -> Result<(), String> {
    run(&["run", "--release", "--manifest-path", "benches/Cargo.toml", "--"], arguments)
}

/// Builds the fuzzer in release mode and runs it.
pub(crate) fn fuzz(arguments: &[String]) -> Result<(), String> {
    run(&["run", "--release", "--package", "sophy-fuzz", "--"], arguments)
}

fn run(program: &[&str], arguments: &[String]) -> Result<(), String> {
    let all: Vec<&str> = program.iter().copied().chain(arguments.iter().map(String::as_str)).collect();
    cargo(&all).map(drop)
}

/// Tells the person at the terminal.
pub(crate) fn say(message: &str) {
    // Nobody is left to tell if this fails.
    let _ = writeln!(std::io::stderr(), "{message}");
}

/// Runs cargo in the root of the repository; the benches share its target folder.
fn cargo(arguments: &[&str]) -> Result<Duration, String> {
    let line = format!("cargo {}", arguments.join(" "));
    say(&format!("$ {line}"));
    let begin = Instant::now();
    let program = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let target = std::env::var_os("CARGO_TARGET_DIR").unwrap_or_else(|| "target".into());
    let mut command = Command::new(program);
    command.args(arguments).current_dir(root()).env("CARGO_TARGET_DIR", target);
    match command.status() {
        Ok(status) if status.success() => Ok(begin.elapsed()),
        Ok(_) => Err(format!("`{line}` failed")),
        Err(error) => Err(format!("`{line}` cannot be run: {error}")),
    }
}

/// The root of the repository.
pub(crate) fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}
