//! What can be asked for on the command line.

use clap::{Args, Parser, Subcommand, ValueEnum};
use std::path::PathBuf;

/// Simulates hybrid systems: continuous dynamics with discrete transitions.
#[derive(Debug, Parser)]
#[command(name = "sophy", version, propagate_version = true, max_term_width = 100)]
#[command(after_help = "\
Examples:
  sophy new hybrid Ball -o ball.hsml                              a model to begin with
  sophy check ball.hsml                                           its mistakes, if there are any
  sophy run ball.hsml --stop 10 --output ball.csv --plot ball.png

Exit codes: 0 done, 1 the model or experiment has errors, 2 wrong use of the command line,
3 the run failed, 4 a file could not be read or written, 130 interrupted (files are complete).")]
pub(crate) struct Arguments {
    #[command(subcommand)]
    pub(crate) command: Command,
    #[command(flatten)]
    pub(crate) output: Output,
}

/// How answers look.
#[derive(Debug, Args)]
#[command(next_help_heading = "Answers")]
pub(crate) struct Output {
    /// Answers as text for people, or as JSON lines on stdout for scripts
    #[arg(long, global = true, value_enum, default_value_t = Format::Text)]
    pub(crate) format: Format,
    /// When to use colours
    #[arg(long, global = true, value_enum, default_value_t = Colour::Auto, value_name = "WHEN")]
    pub(crate) color: Colour,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Format {
    Text,
    Json,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Colour {
    Auto,
    Always,
    Never,
}

#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    /// Run a model (.hsml, .xml) or an experiment (.toml)
    #[command(after_help = RUN_EXAMPLES)]
    Run(Box<Run>),
    /// Find all mistakes of models and experiments without running them
    #[command(after_help = CHECK_EXAMPLES)]
    Check(Check),
    /// Show what a model consists of
    #[command(after_help = "\
Examples:
  sophy info hopper.hsml                        states, locations, dependencies …
  sophy info hopper.hsml --draw hopper.svg      its hybrid automaton
  sophy info missile.hsml --draw missile.svg    its members and connections
  sophy info missile.hsml --draw relay.svg --component relay")]
    Info(Info),
    /// Write a model to begin with: a template of a component, a system or an experiment
    #[command(after_help = NEW_EXAMPLES)]
    New(New),
    /// Explain the code of a message; without a code, list all
    #[command(after_help = "Example: sophy explain HS0303")]
    Explain(Explain),
    /// Lay out HSML files in place; comments stay, models stay what they are
    #[command(after_help = "\
Examples:
  sophy fmt *.hsml            lays out the files
  sophy fmt --check *.hsml    says which are not laid out, and changes nothing
  sophy fmt - < a.hsml        prints the layout")]
    Fmt(Fmt),
    /// Write a model in the other language, or a result in another format
    #[command(after_help = "\
Examples:
  sophy convert hopper.xml hopper.hsml         SOPHY XML to HSML, and back
  sophy convert draft.xml tidy.xml             a model in canonical form
  sophy convert hopper.parquet hopper.csv      a result in another format
  sophy convert hopper.parquet.journal a.csv   what a killed run has left")]
    Convert(Convert),
    /// Draw result files
    #[command(after_help = "\
Examples:
  sophy plot hopper.csv                                    draws hopper.png
  sophy plot hopper.csv --events events.csv -o hopper.svg  with marks at the transitions
  sophy plot hopper.csv --phase Position,Speed -o phase.png")]
    Plot(Plot),
}

const CHECK_EXAMPLES: &str = "\
Examples:
  sophy check battery.hsml battery.toml
  sophy check parts.hsml             a file of several components: each is checked
  sophy check parts.hsml --system Pump";

const NEW_EXAMPLES: &str = "\
Examples:
  sophy new hybrid Ball                     prints it
  sophy new system Heating -o heating.hsml  writes a file
  sophy new experiment heating -o heating.toml   for the model heating.hsml";

const RUN_EXAMPLES: &str = "\
Examples:
  sophy run hopper.toml                                    an experiment, with all its settings
  sophy run hopper.hsml --stop 20 --quantum 1e-3 --output hopper.csv --plot hopper.png
  sophy run hopper.toml --set TAU=20 --plot tau20.html     the experiment with another constant
  sophy run battery.xml --stop 6000 --input Pin=pin.csv --output - | head
  sophy run oscillator.xml --stop 200 --every 0.1 --record 'x*' --output oscillator.parquet

Flags win over the experiment file. NAME may hold `*` for any characters where it says so.
A CSV result has one row at every event, and two rows of one time at a jump.";

#[derive(Debug, Args)]
pub(crate) struct Run {
    /// The model (.hsml, .xml) or the experiment (.toml)
    pub(crate) file: PathBuf,

    /// Stop at this simulated time, s [default: 10]
    #[arg(long, visible_alias = "stop-time", value_name = "T", value_parser = number, allow_hyphen_values = true, help_heading = "Time")]
    pub(crate) stop: Option<f64>,
    /// Start at this simulated time, s [default: 0]
    #[arg(long, visible_alias = "start-time", value_name = "T", value_parser = number, allow_hyphen_values = true, help_heading = "Time")]
    pub(crate) start: Option<f64>,

    /// The engine
    #[arg(long, visible_alias = "solver", value_name = "NAME", value_parser = method_names(), help_heading = "Engine")]
    pub(crate) method: Option<String>,
    /// Quantum of all states, or of the states that NAME (with `*`) matches, in their units; smaller is more accurate
    #[arg(long, value_name = "[NAME=]V", value_parser = named_or_all, help_heading = "Engine")]
    pub(crate) quantum: Vec<(String, f64)>,
    /// Relative accuracy of states without a quantum [default: 1e-4]
    #[arg(long, value_name = "V", value_parser = number, help_heading = "Engine")]
    pub(crate) tolerance: Option<f64>,
    /// How equations are evaluated; the numbers do not depend on it. `auto` changes to native code in a long run
    #[arg(long, value_name = "NAME", value_parser = sophy::Backend::NAMES, default_value = "auto", help_heading = "Engine")]
    pub(crate) backend: String,
    /// Seed of everything random [default: 0]
    #[arg(long, value_name = "N", help_heading = "Engine")]
    pub(crate) seed: Option<u64>,

    /// The component to run [default: the SYSTEM of the file, or the component that contains the others]
    #[arg(long, value_name = "NAME", help_heading = "Model")]
    pub(crate) system: Option<String>,
    /// Set a parameter of the model, a knob or another one that does not decide its structure
    #[arg(long, value_name = "NAME=VALUE", value_parser = assignment, help_heading = "Model")]
    pub(crate) set: Vec<(String, f64)>,
    /// Initial value of a state
    #[arg(long, visible_alias = "start-value", value_name = "STATE=VALUE", value_parser = assignment, help_heading = "Model")]
    pub(crate) initial: Vec<(String, f64)>,
    /// Initial location (of a component)
    #[arg(long, value_name = "[COMPONENT=]NAME", help_heading = "Model")]
    pub(crate) initial_location: Vec<String>,

    /// An input: a column of a CSV file whose first column is `time` in s, or a constant
    #[arg(long, visible_alias = "input-file", value_name = "NAME=FILE.csv[:COLUMN]|NUMBER", value_parser = pair, help_heading = "Inputs")]
    pub(crate) input: Vec<(String, String)>,
    /// Between the rows of input files, hold the value or go straight [default: hold]
    #[arg(long, value_enum, value_name = "HOW", help_heading = "Inputs")]
    pub(crate) interpolate: Option<Interpolate>,
    /// After the last row of an input file, report an error or hold the value [default: error]
    #[arg(long, value_enum, value_name = "WHAT", help_heading = "Inputs")]
    pub(crate) after: Option<After>,
    /// Events from outside: a CSV of time in s and label
    #[arg(long, value_name = "FILE.csv", help_heading = "Inputs")]
    pub(crate) input_events: Option<PathBuf>,

    /// Variables to record, `*` for any characters [default: outputs and views (or states), locations]
    #[arg(
        long,
        visible_alias = "output-variable",
        value_name = "NAME,…",
        value_delimiter = ',',
        help_heading = "Results"
    )]
    pub(crate) record: Vec<String>,
    /// Record on a grid of this step, s, instead of at every event
    #[arg(long, visible_alias = "output-interval", value_name = "DT", value_parser = number, help_heading = "Results")]
    pub(crate) every: Option<f64>,
    /// Record every micro-step of an instant, with a column `step`
    #[arg(long, help_heading = "Results")]
    pub(crate) microsteps: bool,
    /// Also log the kinks crossed by `abs`, `min`, `if`, … in equations
    #[arg(long, help_heading = "Results")]
    pub(crate) events_all: bool,
    /// Write the result: .csv, .arrow or .parquet; `-` is CSV on stdout (repeatable)
    #[arg(long, short, visible_alias = "output-file", value_name = "FILE", help_heading = "Results")]
    pub(crate) output: Vec<PathBuf>,
    /// Draw the result: .png, .svg or .html (repeatable)
    #[arg(long, value_name = "FILE", help_heading = "Results")]
    pub(crate) plot: Vec<PathBuf>,
    /// Draw Y over X instead of curves over time
    #[arg(long, value_name = "X,Y", value_parser = phase, help_heading = "Results")]
    pub(crate) phase: Option<(String, String)>,
    /// Write the log of transitions
    #[arg(long, value_name = "FILE.csv", help_heading = "Results")]
    pub(crate) events: Option<PathBuf>,
    /// Say how much work the run was
    #[arg(long, help_heading = "Results")]
    pub(crate) stats: bool,

    /// Print what a stage makes of the model instead of running it
    #[arg(long, value_enum, value_name = "STAGE", help_heading = "Inspection")]
    pub(crate) emit: Option<Stage>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Interpolate {
    Hold,
    Linear,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum After {
    Error,
    Hold,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Stage {
    /// What the file and its imports declare, as HSML
    Tree,
    /// The model with its names resolved
    Model,
    /// The flat system that runs
    System,
}

#[derive(Debug, Args)]
pub(crate) struct Check {
    /// Models (.hsml, .xml) and experiments (.toml)
    #[arg(required = true, value_name = "FILE")]
    pub(crate) files: Vec<PathBuf>,
    /// The component that is to run [default: the SYSTEM of a file, or the component that contains the others]
    #[arg(long, value_name = "NAME")]
    pub(crate) system: Option<String>,
}

#[derive(Debug, Args)]
pub(crate) struct Info {
    /// The model (.hsml, .xml), or an experiment (.toml) that names it
    pub(crate) file: PathBuf,
    /// The component that is to run [default: the SYSTEM of the file, or the component that contains the others]
    #[arg(long, value_name = "NAME")]
    pub(crate) system: Option<String>,
    /// Print long lists in full
    #[arg(long)]
    pub(crate) all: bool,
    /// Draw it instead: .svg, .png, or .dot for Graphviz (repeatable)
    #[arg(long, value_name = "FILE")]
    pub(crate) draw: Vec<PathBuf>,
    /// Draw this component, such as relay or left.pump
    #[arg(long, value_name = "NAME", requires = "draw")]
    pub(crate) component: Option<String>,
}

#[derive(Debug, Args)]
pub(crate) struct New {
    /// What to begin with
    #[arg(value_enum)]
    pub(crate) kind: Kind,
    /// Its name, such as Pump; of an experiment, the name of the model's file without `.hsml`
    pub(crate) name: String,
    /// Write this file instead of printing
    #[arg(long, short, value_name = "FILE")]
    pub(crate) output: Option<PathBuf>,
    /// Write the file even if there is one
    #[arg(long, requires = "output")]
    pub(crate) force: bool,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Kind {
    /// A continuous-time component: equations that always hold
    Ctc,
    /// A discrete-time component: it executes at instants
    Dtc,
    /// A logic-based component: modes and rules
    Lbc,
    /// A composite: components and connections
    Cc,
    /// A composite without inputs, which a run is started on
    System,
    /// A hybrid automaton: locations with their equations, and transitions
    Hybrid,
    /// An experiment: what is done with a model
    Experiment,
}

#[derive(Debug, Args)]
pub(crate) struct Explain {
    /// The code, such as HS0303, in any letters
    pub(crate) code: Option<String>,
}

#[derive(Debug, Args)]
pub(crate) struct Fmt {
    /// HSML files; `-` goes from stdin to stdout
    #[arg(required = true, value_name = "FILE")]
    pub(crate) files: Vec<PathBuf>,
    /// Only say what is not laid out (exit code 1)
    #[arg(long)]
    pub(crate) check: bool,
}

#[derive(Debug, Args)]
pub(crate) struct Convert {
    /// A model (.hsml, .xml) or a result (.csv, .arrow, .parquet, .journal)
    #[arg(value_name = "IN")]
    pub(crate) input: PathBuf,
    /// What to write; the extension tells the format
    #[arg(value_name = "OUT")]
    pub(crate) output: PathBuf,
    /// The component that becomes SOPHY XML [default: the SYSTEM of the file, or the component that contains the others]
    #[arg(long, value_name = "NAME")]
    pub(crate) system: Option<String>,
}

#[derive(Debug, Args)]
pub(crate) struct Plot {
    /// Result files (.csv, .arrow, .parquet, .journal)
    #[arg(required = true, value_name = "RESULT")]
    pub(crate) results: Vec<PathBuf>,
    /// The picture: .png, .svg or .html [default: RESULT with .png]
    #[arg(long, short, value_name = "FILE")]
    pub(crate) output: Option<PathBuf>,
    /// Variables to show, in this order [default: all]
    #[arg(long, value_name = "NAME,…", value_delimiter = ',')]
    pub(crate) variables: Vec<String>,
    /// Draw Y over X instead of curves over time
    #[arg(long, value_name = "X,Y", value_parser = phase)]
    pub(crate) phase: Option<(String, String)>,
    /// The log of transitions, for marks
    #[arg(long, value_name = "EVENTS.csv")]
    pub(crate) events: Option<PathBuf>,
    /// Heading
    #[arg(long, value_name = "TEXT")]
    pub(crate) title: Option<String>,
}

fn method_names() -> clap::builder::PossibleValuesParser {
    clap::builder::PossibleValuesParser::new(sophy::Method::NAMES)
}

fn number(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(value) if value.is_finite() => Ok(value),
        _ => Err("expected a number, such as 20 or 1e-3".to_owned()),
    }
}

fn pair(text: &str) -> Result<(String, String), String> {
    match text.split_once('=') {
        Some((name, value)) if !name.is_empty() && !value.is_empty() => {
            Ok((name.to_owned(), value.to_owned()))
        }
        _ => Err("expected NAME=VALUE".to_owned()),
    }
}

fn assignment(text: &str) -> Result<(String, f64), String> {
    let (name, value) = pair(text)?;
    Ok((name, number(&value)?))
}

/// `V` is `*=V`.
fn named_or_all(text: &str) -> Result<(String, f64), String> {
    if text.contains('=') { assignment(text) } else { Ok(("*".to_owned(), number(text)?)) }
}

fn phase(text: &str) -> Result<(String, String), String> {
    match text.split_once(',') {
        Some((x, y)) if !x.is_empty() && !y.is_empty() => Ok((x.to_owned(), y.to_owned())),
        _ => Err("expected two variables, such as Position,Speed".to_owned()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_definition_is_consistent() {
        <Arguments as clap::CommandFactory>::command().debug_assert();
    }
}
