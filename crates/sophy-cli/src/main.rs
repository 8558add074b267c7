//! The `sophy` command: what the library does, for a terminal.
//!
//! `arguments` says what can be asked for, `commands` answers, one file per command. `terminal` is the way of
//! all output for people and scripts.

mod arguments;
mod command_line;
mod commands;
mod exit;
mod interrupt;
mod numbers;
mod progress;
mod replace;
mod terminal;

use clap::Parser;

fn main() -> std::process::ExitCode {
    commands::execute(arguments::Arguments::parse()).into()
}
