use super::check::{counts, verdict};
use super::flags::apply;
use super::root;
use crate::arguments::{Run, Stage};
use crate::command_line::CommandLine;
use crate::exit::Exit;
use crate::numbers::{brief, count, plural};
use crate::progress::Watcher;
use crate::terminal::Terminal;
use serde_json::{Value, json};
use sophy::{Error, FileWorld, Finished, Loaded, Model, Outcome};
use std::error::Error as _;

/// Runs a model or an experiment.
pub(crate) fn run(arguments: &Run, terminal: &Terminal) -> Exit {
    if terminal.json && arguments.output.iter().any(|path| path.as_os_str() == "-") {
        terminal
            .error("`--format json` and `--output -` both want stdout", Some("write the result to a file"));
        return Exit::WrongUse;
    }
    // File to model and experiment.
    let mut loaded = sophy::load_as(&FileWorld, &arguments.file, root(arguments.system.as_deref()));
    // Flags win over the file.
    let line = CommandLine::of_process(&mut loaded.sources);
    let mistakes = apply(arguments, &line, &mut loaded.setup);
    loaded.diagnostics.extend(mistakes);
    terminal.diagnostics(&loaded.messages(), &loaded.sources);
    if let Some(stage) = arguments.emit {
        return emit(stage, &loaded, terminal);
    }
    let Some(model) = loaded.model.as_ref().filter(|_| !loaded.diagnostics.has_errors()) else {
        return refuse(arguments, &loaded, terminal);
    };
    // The run.
    let experiment = &loaded.setup.experiment;
    let mut watcher = Watcher::new(experiment.start, experiment.stop, terminal.json);
    let result = sophy::run(model, &loaded.setup, &loaded.provenance, &mut watcher);
    drop(watcher);
    match result {
        Ok(finished) => report(arguments, model, &loaded, &finished, terminal),
        Err(error) => fail(&error, &loaded, terminal),
    }
}

fn refuse(arguments: &Run, loaded: &Loaded, terminal: &Terminal) -> Exit {
    let (errors, warnings) = counts(&loaded.diagnostics);
    let file = arguments.file.display();
    terminal.remark(
        &format!("{file}: {}; nothing was run", verdict(errors, warnings)),
        &json!({ "kind": "check", "file": arguments.file, "errors": errors, "warnings": warnings }),
    );
    if loaded.unreadable { Exit::FileFailed } else { Exit::Mistakes }
}

fn report(arguments: &Run, model: &Model, loaded: &Loaded, finished: &Finished, terminal: &Terminal) -> Exit {
    terminal.diagnostics(finished.zeno.as_slice(), &loaded.sources);
    let start = loaded.setup.experiment.start;
    let mut text = summary(model, start, finished);
    if arguments.stats {
        text.push_str(&statistics(finished));
    }
    terminal.remark(&text, &answer(model, start, finished));
    match finished.report.outcome {
        Outcome::Reached => Exit::Done,
        Outcome::Interrupted => Exit::Interrupted,
        Outcome::Zeno(_) => Exit::RunFailed,
    }
}

/// Locations at the end that a few lines have room for.
const MOST_PLACES: usize = 6;

/// A few lines for people.
fn summary(model: &Model, start: f64, finished: &Finished) -> String {
    let report = &finished.report;
    let how = match report.outcome {
        Outcome::Reached => "reached",
        Outcome::Interrupted => "interrupted at",
        Outcome::Zeno(_) => "stopped at",
    };
    let many = finished.locations.len();
    let shown = if many > MOST_PLACES + 1 { MOST_PLACES } else { many };
    let mut places: Vec<String> = finished.locations[..shown]
        .iter()
        .map(|(component, location)| match component.as_str() {
            "" => location.clone(),
            component => format!("{component} in {location}"),
        })
        .collect();
    if many > shown {
        places.push(format!("and {} more", count((many - shown) as u64)));
    }
    let place = if places.is_empty() { String::new() } else { format!(", in {}", places.join(", ")) };
    let transitions = plural(report.statistics.hybrid.transitions, "transition");
    let mut text = format!("{}: {how} t = {} s after {transitions}{place}\n", model.name(), report.time);
    text.push_str(&format!(
        "  {} in {:.2?}, {} × real time",
        plural(report.rows, "row"),
        report.elapsed,
        brief(factor(start, finished)),
    ));
    let files: Vec<String> = finished.files.iter().map(|path| path.display().to_string()).collect();
    if files.is_empty() {
        text.push_str("\n  nothing was written; add `--output FILE.csv` or `--plot FILE.png`");
    } else {
        text.push_str(&format!("\n  wrote {}", files.join(", ")));
    }
    if let Some(names) = &finished.not_drawn {
        text.push_str(&format!("\n  not shown in the picture: {names}; `--record NAME,…` chooses"));
    }
    text
}

/// Simulated time over wall time.
fn factor(start: f64, finished: &Finished) -> f64 {
    (finished.report.time - start) / finished.report.elapsed.as_secs_f64().max(1e-9)
}

fn statistics(finished: &Finished) -> String {
    let (engine, hybrid) = (&finished.report.statistics.engine, &finished.report.statistics.hybrid);
    // A quantised engine never takes a step back: what it does in vain is to look for crossings.
    let in_vain = engine.predictions.saturating_sub(engine.crossings);
    let lines = [
        ("steps", engine.steps),
        ("evaluations of rates", engine.rates),
        ("  because they bend", engine.refreshes),
        ("events (transitions)", hybrid.transitions),
        ("  instants of events", hybrid.instants),
        ("  heard by nobody", hybrid.unused_events),
        ("rejected steps", 0),
        ("crossings located", engine.crossings),
        ("  predicted", engine.predictions),
        ("  rejected predictions", in_vain),
        ("  enclosures for these", engine.enclosures),
    ];
    let lines: String =
        lines.iter().map(|(name, value)| format!("\n  {name:<26}{:>14}", count(*value))).collect();
    let lines = format!("{lines}\n  {:<26}{:>14}", "back end", backend(finished));
    match per_step(finished) {
        Some(ns) => format!("{lines}\n  {:<26}{ns:>11.0} ns, recording included", "time per step"),
        None => lines,
    }
}

/// Time of the whole run over its steps, ns.
fn per_step(finished: &Finished) -> Option<f64> {
    let steps = finished.report.statistics.engine.steps;
    (steps > 0).then(|| 1e9 * finished.report.elapsed.as_secs_f64() / steps as f64)
}

fn backend(finished: &Finished) -> &'static str {
    if finished.report.native { "native" } else { "interpreter" }
}

/// One object for scripts.
fn answer(model: &Model, start: f64, finished: &Finished) -> Value {
    let report = &finished.report;
    let (engine, hybrid) = (&report.statistics.engine, &report.statistics.hybrid);
    let locations: Vec<Value> = finished
        .locations
        .iter()
        .map(|(component, location)| json!({ "component": component, "location": location }))
        .collect();
    json!({
        "kind": "summary",
        "model": model.name(),
        "outcome": match report.outcome {
            Outcome::Reached => "reached",
            Outcome::Interrupted => "interrupted",
            Outcome::Zeno(_) => "zeno",
        },
        "time": report.time,
        "transitions": hybrid.transitions,
        "locations": locations,
        "rows": report.rows,
        "wall_time_s": report.elapsed.as_secs_f64(),
        "real_time_factor": factor(start, finished),
        "files": finished.files,
        "not_drawn": finished.not_drawn,
        "statistics": {
            "steps": engine.steps,
            "rates": engine.rates,
            "refreshes": engine.refreshes,
            "predictions": engine.predictions,
            "crossings": engine.crossings,
            "enclosures": engine.enclosures,
            "instants": hybrid.instants,
            "unused_events": hybrid.unused_events,
            "backend": backend(finished),
            "ns_per_step": per_step(finished),
        },
    })
}

fn fail(error: &Error, loaded: &Loaded, terminal: &Terminal) -> Exit {
    // Whoever reads our stdout has had enough.
    if is_broken_pipe(error) {
        return Exit::FileFailed;
    }
    terminal.diagnostics(&sophy::explain(error, &loaded.setup), &loaded.sources);
    let exit = match error {
        Error::Composition(_) | Error::Experiment(_) => Exit::Mistakes,
        Error::Failure(_) => Exit::RunFailed,
        Error::Sink(_) => Exit::FileFailed,
        Error::File(error) => Exit::from(error),
    };
    let files = loaded.setup.outputs.results.iter().chain(&loaded.setup.outputs.events);
    let kept: Vec<String> =
        files.filter(|path| path.exists()).map(|path| path.display().to_string()).collect();
    if let (Error::Failure(failure), false, false) = (error, kept.is_empty(), terminal.json) {
        let text = format!("results until t = {} s are in {}", failure.time, kept.join(", "));
        terminal.remark(&text, &Value::Null);
    }
    exit
}

fn is_broken_pipe(error: &Error) -> bool {
    let mut cause = error.source();
    while let Some(inner) = cause {
        if inner.downcast_ref::<std::io::Error>().is_some_and(|e| e.kind() == std::io::ErrorKind::BrokenPipe)
        {
            return true;
        }
        cause = inner.source();
    }
    false
}

fn emit(stage: Stage, loaded: &Loaded, terminal: &Terminal) -> Exit {
    let text = match (stage, &loaded.declarations, &loaded.model) {
        (Stage::Tree, Some(declarations), _) => Some(sophy::declarations_text(declarations)),
        (Stage::Model, _, Some(model)) => Some(sophy::model_text(model)),
        (Stage::System, _, Some(model)) => match sophy::system_text(model) {
            Ok(text) => Some(text),
            Err(error) => return fail(&error, loaded, terminal),
        },
        _ => None,
    };
    if let Some(text) = &text {
        terminal.answer(text, &json!({ "kind": "emit", "text": text }));
    }
    match (loaded.unreadable, loaded.diagnostics.has_errors() || text.is_none()) {
        (true, _) => Exit::FileFailed,
        (_, true) => Exit::Mistakes,
        _ => Exit::Done,
    }
}
