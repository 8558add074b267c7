//! The keys of an experiment file, section by section.

use super::Setup;
use super::signal::read_signal;
use super::values::{INPUT_FILE, Key, MISSING_KEY, SYNTAX, Value, Values, WRONG_VALUE};
use sophy_diagnostics::{Diagnostic, Diagnostics, SourceId, Span};
use sophy_files::read_event_labels;
use sophy_run::{AtEnd, Interpolation, Method, Quantum, QuantumRule, Signal};
use std::path::{Path, PathBuf};
use toml::de::DeTable;

const SECTIONS: &[&str] = &["model", "system", "run", "engine", "knobs", "initial", "inputs", "record"];
const RUN: &[&str] = &["start", "stop", "seed", "input_events", "initial_location"];
const ENGINE: &[&str] = &["method", "quantum", "tolerance"];
const QUANTUM: &[&str] = &["absolute", "relative", "largest"];
const INPUT: &[&str] = &["file", "column", "interpolate", "after"];
const RECORD: &[&str] =
    &["variables", "every", "microsteps", "events_all", "output", "events", "plot", "phase"];

/// What an experiment file says.
pub(crate) struct SetupReading {
    /// The setup as far as it is right.
    pub(crate) setup: Setup,
    /// Path of the model.
    pub(crate) model: Option<PathBuf>,
    /// The component of the model that is run, where it is said.
    pub(crate) system: Option<String>,
    /// All mistakes.
    pub(crate) diagnostics: Diagnostics,
}

/// Reads the text of an experiment whose paths are relative to `folder`.
pub(crate) fn read_setup(source: SourceId, text: &str, folder: &Path) -> SetupReading {
    let mut reader = Reader {
        values: Values { source, diagnostics: Diagnostics::default() },
        setup: Setup::default(),
        model: None,
        system: None,
        folder,
    };
    let (root, mistakes) = DeTable::parse_recoverable(text);
    for mistake in &mistakes {
        let span = Span::new(source, mistake.span().unwrap_or(0..0));
        reader.values.diagnostics.push(Diagnostic::error(SYNTAX, span, mistake.message()));
    }
    reader.experiment(root.get_ref());
    if reader.model.is_none() && mistakes.is_empty() && !root.get_ref().contains_key("model") {
        reader.values.diagnostics.push(
            Diagnostic::error(MISSING_KEY, Span::new(source, 0..0), "the experiment names no model")
                .help("begin with `model = \"FILE.hsml\"`, a path relative to this file"),
        );
    }
    let Reader { values, setup, model, system, .. } = reader;
    SetupReading { setup, model, system, diagnostics: values.diagnostics }
}

struct Reader<'a> {
    values: Values,
    setup: Setup,
    model: Option<PathBuf>,
    system: Option<String>,
    folder: &'a Path,
}

impl Reader<'_> {
    fn experiment(&mut self, root: &DeTable<'_>) {
        for (key, value) in root {
            match key.get_ref().as_ref() {
                "model" => self.model = self.values.text(value).map(|path| self.folder.join(path)),
                "system" => self.system = self.values.text(value),
                "run" => self.section(value, Self::run),
                "engine" => self.section(value, Self::engine),
                "knobs" => self.section_at("knobs", key, value, Self::knob),
                "initial" => self.section_at("initial", key, value, Self::initial),
                "inputs" => self.section_at("inputs", key, value, Self::input),
                "record" => self.section(value, Self::record),
                _ => self.values.unknown_key("", key, SECTIONS),
            }
        }
    }

    fn section(&mut self, value: &Value<'_>, each: impl Fn(&mut Self, &Key<'_>, &Value<'_>)) {
        if let Some(table) = self.values.table(value) {
            table.iter().for_each(|(key, value)| each(self, key, value));
        }
    }

    /// A section of names that the model defines.
    fn section_at(
        &mut self,
        item: &str,
        key: &Key<'_>,
        value: &Value<'_>,
        each: impl Fn(&mut Self, &Key<'_>, &Value<'_>),
    ) {
        self.setup.said_at(item, self.values.span(key));
        self.section(value, each);
    }

    fn run(&mut self, key: &Key<'_>, value: &Value<'_>) {
        let name = key.get_ref().as_ref();
        self.setup.said_at(format!("run.{name}"), self.values.span(value));
        let experiment = &mut self.setup.experiment;
        match name {
            "start" => set(&mut experiment.start, self.values.number(value)),
            "stop" => set(&mut experiment.stop, self.values.number(value)),
            "seed" => set(&mut experiment.seed, self.values.whole_number(value)),
            "input_events" => self.input_events(value),
            "initial_location" if value.get_ref().is_table() => self.section(value, Self::initial_location),
            "initial_location" => {
                if let Some(location) = self.values.text(value) {
                    self.start_in("", location, self.values.span(value));
                }
            }
            _ => self.values.unknown_key("run", key, RUN),
        }
    }

    fn input_events(&mut self, value: &Value<'_>) {
        let span = self.values.span(value);
        self.setup.said_at("input_events", span);
        let Some(path) = self.values.text(value) else { return };
        match read_event_labels(&self.folder.join(path)) {
            Ok(events) => self.setup.experiment.events = events,
            Err(error) => self.report(span, error.to_string()),
        }
    }

    fn initial_location(&mut self, key: &Key<'_>, value: &Value<'_>) {
        if let Some(location) = self.values.text(value) {
            self.setup.said_at(format!("initial_location.{}", key.get_ref()), self.values.span(key));
            self.start_in(key.get_ref(), location, self.values.span(value));
        }
    }

    fn start_in(&mut self, component: &str, location: String, span: Span) {
        self.setup.said_at(format!("initial_location.{location}"), span);
        self.setup.experiment.initial_locations.push((component.to_owned(), location));
    }

    fn engine(&mut self, key: &Key<'_>, value: &Value<'_>) {
        let name = key.get_ref().as_ref();
        self.setup.said_at(format!("engine.{name}"), self.values.span(value));
        match name {
            "method" => {
                let method = self.values.word(value, Method::NAMES, Method::named);
                set(&mut self.setup.experiment.method, method);
            }
            "tolerance" => set(&mut self.setup.experiment.tolerance, self.values.number(value)),
            "quantum" if value.get_ref().is_table() && !is_quantum(value) => {
                // The default first: the last rule that matches counts.
                let Some(table) = self.values.table(value) else { return };
                let (default, named): (Vec<_>, Vec<_>) =
                    table.iter().partition(|(key, _)| key.get_ref().as_ref() == "default");
                for (key, value) in default.into_iter().chain(named) {
                    let pattern = key.get_ref().as_ref();
                    self.quantum(if pattern == "default" { "*" } else { pattern }, value);
                }
            }
            "quantum" => self.quantum("*", value),
            _ => self.values.unknown_key("engine", key, ENGINE),
        }
    }

    fn quantum(&mut self, pattern: &str, value: &Value<'_>) {
        self.setup.said_at(format!("engine.quantum.{pattern}"), self.values.span(value));
        let mut quantum = Quantum::absolute(0.0);
        if value.get_ref().is_table() {
            let Some(table) = self.values.table(value) else { return };
            for (key, value) in table {
                match key.get_ref().as_ref() {
                    "absolute" => set(&mut quantum.absolute, self.values.number(value)),
                    "relative" => set(&mut quantum.relative, self.values.number(value)),
                    "largest" => set(&mut quantum.largest, self.values.truth(value)),
                    _ => self.values.unknown_key("engine.quantum", key, QUANTUM),
                }
            }
        } else {
            let Some(absolute) = self.values.number(value) else { return };
            quantum.absolute = absolute;
        }
        self.setup.experiment.quanta.push(QuantumRule { pattern: pattern.to_owned(), quantum });
    }

    fn knob(&mut self, key: &Key<'_>, value: &Value<'_>) {
        self.setup.said_at(format!("knobs.{}", key.get_ref()), self.values.span(key));
        if let Some(number) = self.values.number(value) {
            self.setup.experiment.knobs.push((key.get_ref().to_string(), number));
        }
    }

    fn initial(&mut self, key: &Key<'_>, value: &Value<'_>) {
        self.setup.said_at(format!("initial.{}", key.get_ref()), self.values.span(key));
        if let Some(number) = self.values.number(value) {
            self.setup.experiment.initial.push((key.get_ref().to_string(), number));
        }
    }

    fn input(&mut self, key: &Key<'_>, value: &Value<'_>) {
        let name = key.get_ref().as_ref();
        self.setup.said_at(format!("inputs.{name}"), self.values.span(key));
        let signal = match value.get_ref() {
            toml::de::DeValue::String(file) => self.signal(name, file, None, self.values.span(value)),
            toml::de::DeValue::Integer(_) | toml::de::DeValue::Float(_) => {
                self.values.number(value).map(Signal::constant)
            }
            toml::de::DeValue::Table(table) => self.input_table(name, table, self.values.span(value)),
            _ => {
                self.values.wrong_type(value, "a number, a file name, or { file = \"FILE.csv\" }");
                None
            }
        };
        // An input whose samples are in a wrong file is given all the same: one mistake, one message.
        let signal = signal.unwrap_or_else(|| Signal::constant(0.0));
        self.setup.experiment.inputs.push((name.to_owned(), signal));
    }

    fn input_table(&mut self, name: &str, table: &DeTable<'_>, span: Span) -> Option<Signal> {
        let (mut file, mut column) = (None, None);
        let (mut interpolation, mut at_end) = (Interpolation::default(), AtEnd::default());
        for (key, value) in table {
            match key.get_ref().as_ref() {
                "file" => file = self.values.text(value).map(|file| (file, self.values.span(value))),
                "column" => column = self.values.text(value),
                "interpolate" => {
                    let meant = self.values.word(value, &["hold", "linear"], |word| match word {
                        "hold" => Some(Interpolation::Hold),
                        "linear" => Some(Interpolation::Linear),
                        _ => None,
                    });
                    set(&mut interpolation, meant);
                }
                "after" => {
                    let meant = self.values.word(value, &["error", "hold"], |word| match word {
                        "error" => Some(AtEnd::Error),
                        "hold" => Some(AtEnd::Hold),
                        _ => None,
                    });
                    set(&mut at_end, meant);
                }
                _ => self.values.unknown_key(&format!("inputs.{name}"), key, INPUT),
            }
        }
        let Some((file, span)) = file else {
            let message = format!("input `{name}` names no file");
            let diagnostic = Diagnostic::error(MISSING_KEY, span, message);
            self.values.diagnostics.push(diagnostic.help("add `file = \"FILE.csv\"`"));
            return None;
        };
        let signal = self.signal(name, &file, column.as_deref(), span)?;
        Some(Signal { interpolation, at_end, ..signal })
    }

    fn signal(&mut self, input: &str, file: &str, column: Option<&str>, span: Span) -> Option<Signal> {
        match read_signal(&self.folder.join(file), input, column) {
            Ok(signal) => Some(signal),
            Err(error) => {
                self.report(span, error.to_string());
                None
            }
        }
    }

    fn record(&mut self, key: &Key<'_>, value: &Value<'_>) {
        let name = key.get_ref().as_ref();
        self.setup.said_at(format!("record.{name}"), self.values.span(value));
        match name {
            "variables" => {
                let names = self.values.texts(value);
                for (name, span) in &names {
                    self.setup.said_at(format!("record.{name}"), *span);
                }
                self.setup.experiment.record = Some(names.into_iter().map(|(name, _)| name).collect());
            }
            "every" => self.setup.experiment.every = self.values.number(value),
            "microsteps" => set(&mut self.setup.experiment.microsteps, self.values.truth(value)),
            "events_all" => set(&mut self.setup.experiment.all_events, self.values.truth(value)),
            "output" => self.setup.outputs.results = self.paths(value),
            "plot" => self.setup.outputs.plots = self.paths(value),
            "events" => {
                self.setup.outputs.events = self.values.text(value).map(|path| self.folder.join(path));
            }
            "phase" => {
                let names = self.values.texts(value);
                match names.as_slice() {
                    [(x, _), (y, _)] => self.setup.outputs.phase = Some((x.clone(), y.clone())),
                    _ => {
                        let span = self.values.span(value);
                        let message = "a phase portrait has two variables";
                        let diagnostic = Diagnostic::error(WRONG_VALUE, span, message)
                            .help("write `phase = [\"X\", \"Y\"]`");
                        self.values.diagnostics.push(diagnostic);
                    }
                }
            }
            _ => self.values.unknown_key("record", key, RECORD),
        }
    }

    fn paths(&mut self, value: &Value<'_>) -> Vec<PathBuf> {
        let texts = self.values.texts(value);
        let stdout = |text: &str| text == "-";
        texts
            .into_iter()
            .map(|(text, _)| if stdout(&text) { PathBuf::from(text) } else { self.folder.join(text) })
            .collect()
    }

    fn report(&mut self, span: Span, message: String) {
        self.values.diagnostics.push(Diagnostic::error(INPUT_FILE, span, message));
    }
}

/// Whether a table is one quantum, not quanta by name.
fn is_quantum(value: &Value<'_>) -> bool {
    let table = value.get_ref().as_table();
    table.is_some_and(|table| ["absolute", "relative"].iter().any(|key| table.contains_key(*key)))
}

fn set<T>(target: &mut T, value: Option<T>) {
    if let Some(value) = value {
        *target = value;
    }
}
