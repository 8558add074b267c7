use crate::arguments::{After, Interpolate, Run};
use crate::command_line::CommandLine;
use sophy::{
    AtEnd, Backend, Code, Diagnostic, Diagnostics, Interpolation, Method, Quantum, QuantumRule, Setup, Signal,
};
use std::path::Path;

/// Puts the flags of `sophy run` over what the experiment file says, and remembers where they stand.
pub(super) fn apply(run: &Run, line: &CommandLine, setup: &mut Setup) -> Diagnostics {
    let mut diagnostics = Diagnostics::default();
    times_and_engine(run, line, setup);
    model(run, line, setup);
    inputs(run, line, setup, &mut diagnostics);
    results(run, line, setup);
    diagnostics
}

fn times_and_engine(run: &Run, line: &CommandLine, setup: &mut Setup) {
    let experiment = &mut setup.experiment;
    experiment.start = run.start.unwrap_or(experiment.start);
    experiment.stop = run.stop.unwrap_or(experiment.stop);
    experiment.seed = run.seed.unwrap_or(experiment.seed);
    experiment.tolerance = run.tolerance.unwrap_or(experiment.tolerance);
    experiment.method = run.method.as_deref().and_then(Method::named).unwrap_or(experiment.method);
    experiment.backend = Backend::named(&run.backend).unwrap_or(experiment.backend);
    // What holds for all goes first: the last rule that matches counts.
    let (all, named): (Vec<_>, Vec<_>) = run.quantum.iter().partition(|(pattern, _)| pattern == "*");
    for (pattern, value) in all.into_iter().chain(named) {
        let quantum = Quantum::absolute(*value);
        experiment.quanta.push(QuantumRule { pattern: pattern.clone(), quantum });
    }
    for (given, item, flag) in [
        (run.start.or(run.stop).is_some(), "run.stop", if run.stop.is_some() { "--stop" } else { "--start" }),
        (run.tolerance.is_some(), "engine.tolerance", "--tolerance"),
    ] {
        if given {
            setup.said_at(item, line.flag(flag));
        }
    }
    for (pattern, _) in &run.quantum {
        setup.said_at(format!("engine.quantum.{pattern}"), line.flag_with("--quantum", pattern));
    }
}

fn model(run: &Run, line: &CommandLine, setup: &mut Setup) {
    for (name, value) in &run.set {
        setup.experiment.knobs.push((name.clone(), *value));
        setup.said_at(format!("knobs.{name}"), line.flag_with("--set", name));
    }
    for (name, value) in &run.initial {
        setup.experiment.initial.push((name.clone(), *value));
        setup.said_at(format!("initial.{name}"), line.flag_with("--initial", name));
    }
    for text in &run.initial_location {
        let (component, location) = text.split_once('=').unwrap_or(("", text));
        setup.experiment.initial_locations.push((component.to_owned(), location.to_owned()));
        let span = line.flag_with("--initial-location", text);
        setup.said_at(format!("initial_location.{component}"), span);
        setup.said_at(format!("initial_location.{location}"), span);
    }
}

fn inputs(run: &Run, line: &CommandLine, setup: &mut Setup, diagnostics: &mut Diagnostics) {
    for (name, text) in &run.input {
        let span = line.flag_with("--input", name);
        setup.said_at(format!("inputs.{name}"), span);
        // An input whose file is wrong is given all the same: one mistake, one message.
        let signal = signal(name, text).unwrap_or_else(|message| {
            diagnostics.push(Diagnostic::error(INPUT_FILE, span, message));
            Signal::constant(0.0)
        });
        setup.experiment.inputs.push((name.clone(), signal));
    }
    match run.interpolate {
        Some(Interpolate::Hold) => setup.interpolate(Interpolation::Hold),
        Some(Interpolate::Linear) => setup.interpolate(Interpolation::Linear),
        None => {}
    }
    match run.after {
        Some(After::Error) => setup.after_the_end(AtEnd::Error),
        Some(After::Hold) => setup.after_the_end(AtEnd::Hold),
        None => {}
    }
    if let Some(path) = &run.input_events {
        let span = line.flag("--input-events");
        setup.said_at("input_events", span);
        match sophy::read_event_labels(path) {
            Ok(events) => setup.experiment.events = events,
            Err(error) => diagnostics.push(Diagnostic::error(INPUT_FILE, span, error.to_string())),
        }
    }
}

const INPUT_FILE: Code = Code("EX0106");

/// `FILE.csv`, `FILE.csv:COLUMN` or a number.
fn signal(input: &str, text: &str) -> Result<Signal, String> {
    if let Ok(value) = text.parse::<f64>() {
        return if value.is_finite() {
            Ok(Signal::constant(value))
        } else {
            Err(format!("input `{input}` is {text}"))
        };
    }
    let (file, column) = match text.rsplit_once(':') {
        Some((file, column)) if !Path::new(text).exists() => (file, Some(column)),
        _ => (text, None),
    };
    sophy::read_signal(Path::new(file), input, column).map_err(|error| error.to_string())
}

fn results(run: &Run, line: &CommandLine, setup: &mut Setup) {
    if !run.record.is_empty() {
        setup.experiment.record = Some(run.record.clone());
        for name in &run.record {
            setup.said_at(format!("record.{name}"), line.flag_with("--record", name));
        }
    }
    if let Some(step) = run.every {
        setup.experiment.every = Some(step);
        setup.said_at("record.every", line.flag("--every"));
    }
    setup.experiment.microsteps |= run.microsteps;
    setup.experiment.all_events |= run.events_all;
    if !run.output.is_empty() {
        setup.outputs.results.clone_from(&run.output);
    }
    if !run.plot.is_empty() {
        setup.outputs.plots.clone_from(&run.plot);
        setup.said_at("record.plot", line.flag("--plot"));
    }
    if let Some(phase) = &run.phase {
        setup.outputs.phase = Some(phase.clone());
        setup.said_at("record.phase", line.flag("--phase"));
    }
    if let Some(events) = &run.events {
        setup.outputs.events = Some(events.clone());
    }
}
