//! Housekeeping: `cargo xtask ci` runs every check, `cargo xtask bench` measures, `cargo xtask fuzz`
//! throws broken models at the readers.
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
    let mut arguments = std::env::args().skip(1);
    let command = arguments.next();
    let further: Vec<String> = arguments.collect();
    let done = match command.as_deref() {
        Some("ci") => steps::ci(),
        Some("bench") => steps::bench(&further),
        Some("fuzz") => steps::fuzz(&further),
        _ => Err("cargo xtask ci      formatting, lints, all tests and a short fuzzing campaign\n\
                  cargo xtask bench   speed beside hand-written loops and other software, in release mode: [--name NAME]\n\
                  \x20                   [engine|peers|figures|build|language]\n\
                  cargo xtask fuzz    broken models thrown at the readers, in release mode: [--inputs N]\n\
                  \x20                   [--seconds S] [--seed K] [hsml|xml|hsml-model|xml-model]"
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
