//! Housekeeping: `cargo xtask ci` runs every check, `cargo xtask bench` measures.
//!
//! The rules of the house are ordinary tests of this package: `arrows` compares the manifests with
//! ARCHITECTURE.md, `tidy` reads the sources.

#[cfg(test)]
mod arrows;
mod steps;
#[cfg(test)]
mod tidy;

use std::process::ExitCode;

fn main() -> ExitCode {
    let command = std::env::args().nth(1);
    let done = match command.as_deref() {
        Some("ci") => steps::ci(),
        Some("bench") => steps::bench(),
        _ => Err("cargo xtask ci      formatting, lints and all tests\n\
                  cargo xtask bench   speed beside hand-written loops, in release mode"
            .to_owned()),
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            steps::say(&message);
            ExitCode::FAILURE
        }
    }
}
