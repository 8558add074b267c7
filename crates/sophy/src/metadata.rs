//! What every result file says of where it comes from.

use crate::error::Error;
use crate::load::Provenance;
use sophy_record::Metadata;
use sophy_run::{Experiment, Interpolation, Outcome, Report, Run};
use std::fmt::Write;

/// Known before the run.
pub(crate) fn at_start(run: &Run, experiment: &Experiment, provenance: &Provenance) -> Metadata {
    let states = run.system().states.iter().zip(run.quanta());
    let quanta: Vec<String> = states
        .map(|(state, quantum)| match quantum.relative {
            0.0 => format!("{} = {:?}", state.name(run.system()), quantum.absolute),
            relative => {
                let size = if quantum.largest { "largest |x| so far" } else { "|x|" };
                format!("{} = max({:?}, {relative:?}·{size})", state.name(run.system()), quantum.absolute)
            }
        })
        .collect();
    entries([
        ("model", run.system().name.clone()),
        ("model_file", provenance.model_file.display().to_string()),
        ("model_hash", format!("sha256:{}", provenance.model_hash)),
        ("experiment", text(experiment)),
        ("version", format!("sophy {}", env!("CARGO_PKG_VERSION"))),
        ("seed", experiment.seed.to_string()),
        ("method", experiment.method.name().to_owned()),
        ("quanta", quanta.join(", ")),
    ])
}

/// Known only at the end.
pub(crate) fn at_end(run: &Run, result: &Result<Report, Error>) -> Metadata {
    let outcome = match result {
        Ok(report) => match &report.outcome {
            Outcome::Reached => "reached the stop time".to_owned(),
            Outcome::Interrupted => "interrupted".to_owned(),
            Outcome::Zeno(accumulation) => format!("transitions accumulate at {} s", accumulation.limit),
        },
        Err(error) => format!("failed: {error}"),
    };
    entries([("outcome", outcome), ("time_reached", format!("{:?}", run.time()))])
}

fn entries<const N: usize>(entries: [(&str, String); N]) -> Metadata {
    Metadata { entries: entries.into_iter().map(|(key, value)| (key.to_owned(), value)).collect() }
}

/// The experiment as it was run, flags included, with the keys of an experiment file. Samples of inputs are named,
/// not listed.
fn text(experiment: &Experiment) -> String {
    let mut out = String::new();
    let e = experiment;
    // Writing into a string does not fail.
    let _ = writeln!(out, "[run]\nstart = {:?}\nstop = {:?}\nseed = {}", e.start, e.stop, e.seed);
    for (component, location) in &e.initial_locations {
        let key = if component.is_empty() { String::new() } else { format!(".{component:?}") };
        let _ = writeln!(out, "initial_location{key} = {location:?}");
    }
    let _ = writeln!(out, "\n[engine]\nmethod = {:?}\ntolerance = {:?}", e.method.name(), e.tolerance);
    for rule in &e.quanta {
        let (pattern, quantum) = (&rule.pattern, rule.quantum);
        let _ = match quantum.relative {
            0.0 => writeln!(out, "quantum.{pattern:?} = {:?}", quantum.absolute),
            relative => {
                let largest = if quantum.largest { ", largest = true" } else { "" };
                writeln!(
                    out,
                    "quantum.{pattern:?} = {{ absolute = {:?}, relative = {relative:?}{largest} }}",
                    quantum.absolute
                )
            }
        };
    }
    for (section, values) in [("knobs", &e.knobs), ("initial", &e.initial)] {
        if !values.is_empty() {
            let _ = writeln!(out, "\n[{section}]");
        }
        for (name, value) in values {
            let _ = writeln!(out, "{name:?} = {value:?}");
        }
    }
    if !e.inputs.is_empty() {
        let _ = writeln!(out, "\n[inputs]");
    }
    for (name, signal) in &e.inputs {
        let _ = match (signal.times.first(), signal.values.first()) {
            (Some(first), Some(value)) if first.is_infinite() => writeln!(out, "{name:?} = {value:?}"),
            _ => {
                let how = match signal.interpolation {
                    Interpolation::Hold => "held",
                    Interpolation::Linear => "linear",
                };
                writeln!(out, "# {name}: {} ({how})", signal.origin)
            }
        };
    }
    out
}
