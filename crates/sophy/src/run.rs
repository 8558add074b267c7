use crate::error::Error;
use crate::load::{Loaded, Provenance, nowhere};
use crate::metadata;
use crate::setup::{Outputs, Setup};
use crate::simulate::begin;
use sophy_analysis::algebraic_loop;
use sophy_diagnostics::{Diagnostic, Diagnostics};
use sophy_files::{EventLog, FileError, PlotOptions, open_sink, plot};
use sophy_hybrid::Accumulation;
use sophy_ir::{Model, Role, System};
use sophy_passes::{FlattenError, PassError};
use sophy_record::{EventRecord, Metadata, Schema, Sink, SinkError, Table};
use sophy_run::{ExperimentError, Observer, Outcome, Progress, Recorder, Report, Run};
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

/// What a run with files came to.
#[derive(Clone, Debug, PartialEq)]
pub struct Finished {
    /// How it ended, and what it took.
    pub report: Report,
    /// Component (empty for a model of one nameless component) and location at the end of each automaton that has several.
    pub locations: Vec<(String, String)>,
    /// The files written, in the order asked for.
    pub files: Vec<PathBuf>,
    /// The variables that pictures have no room for, in a few words, if there are any.
    pub not_drawn: Option<String>,
    /// What is to be said if transitions accumulated.
    pub zeno: Option<Diagnostic>,
}

/// Finds the mistakes that show only when the components of a model are put together, and when a model and its
/// experiment are.
///
/// Adds nothing if the model has errors. With an experiment the first instant of the run is computed; no file is
/// written.
pub fn check(loaded: &Loaded) -> Diagnostics {
    let mut found = Diagnostics::default();
    let Some(model) = &loaded.model else { return found };
    if loaded.provenance.experiment.is_empty() {
        if let Err(error) = sophy_passes::lower(model) {
            found.push(explain_composition(&error));
        }
        return found;
    }
    match begin(model, &loaded.setup.experiment) {
        Ok((_, recorder)) => {
            let mistakes = output_mistakes(&loaded.setup.outputs, recorder.schema());
            mistakes.iter().for_each(|error| found.push(loaded.setup.explain(error)));
        }
        Err(error) => explain(&error, &loaded.setup).into_iter().for_each(|d| found.push(d)),
    }
    found
}

/// An error of [`run`] as messages at the places they are about.
pub fn explain(error: &Error, setup: &Setup) -> Vec<Diagnostic> {
    match error {
        Error::Experiment(errors) => errors.iter().map(|error| setup.explain(error)).collect(),
        Error::Failure(failure) => vec![failure.diagnostic()],
        Error::Composition(error) => vec![explain_composition(error)],
        Error::Sink(error) => vec![nowhere("FI0003", error.to_string())],
        Error::File(error) => vec![nowhere("FI0003", error.to_string())],
    }
}

/// Why components do not make a system; an algebraic loop equation by equation.
pub fn explain_composition(error: &PassError) -> Diagnostic {
    if let PassError::Flatten(FlattenError::AlgebraicLoop(equations)) = error
        && let Some(first) = equations.iter().find_map(|equation| equation.span)
    {
        let right = |text: &str| text.split_once(" = ").map_or(text, |(_, right)| right).to_owned();
        let equations: Vec<_> = equations.iter().map(|e| (e.name.clone(), right(&e.text), e.span)).collect();
        return algebraic_loop(&equations, first);
    }
    nowhere("EX0202", error.to_string())
}

/// Runs a model and writes what the setup asks for; `observer` may watch and stop it.
///
/// However the run ends, its files are complete and say in their metadata how it ended.
///
/// # Errors
/// [`Error`]; mistakes of the experiment and files that cannot be made are found before the run starts.
pub fn run(
    model: &Model,
    setup: &Setup,
    provenance: &Provenance,
    observer: &mut dyn Observer,
) -> Result<Finished, Error> {
    let experiment = &setup.experiment;
    let (mut run, mut recorder) = begin(model, experiment)?;
    let mistakes = output_mistakes(&setup.outputs, recorder.schema());
    if !mistakes.is_empty() {
        return Err(Error::Experiment(mistakes));
    }
    let metadata = metadata::at_start(&run, experiment, provenance);
    let mut files = Files::open(&setup.outputs, recorder.schema(), &metadata)?;
    let result = files.record(&mut run, &mut recorder, setup, observer);
    // Whatever happened, the files become whole.
    let finished = files.finish(&metadata::at_end(&run, &result));
    let report = result?;
    finished?;
    let not_drawn = files.plot(&setup.outputs)?;
    Ok(Finished {
        not_drawn,
        locations: locations(&run),
        files: setup.outputs.paths(),
        zeno: match &report.outcome {
            Outcome::Zeno(accumulation) => Some(zeno(accumulation, run.system())),
            _ => None,
        },
        report,
    })
}

/// Files being written.
struct Files {
    sinks: Vec<Box<dyn Sink>>,
    log: Option<EventLog>,
    /// For pictures.
    table: Option<Table>,
    events: Vec<EventRecord>,
}

impl Files {
    fn open(outputs: &Outputs, schema: &Schema, metadata: &Metadata) -> Result<Self, FileError> {
        let sinks =
            outputs.results.iter().map(|path| open_sink(path, schema, metadata)).collect::<Result<_, _>>()?;
        let log = outputs.events.as_deref().map(|path| EventLog::create(path, metadata)).transpose()?;
        let table = (!outputs.plots.is_empty()).then(|| Table::new(schema.clone(), metadata.clone()));
        Ok(Files { sinks, log, table, events: Vec::new() })
    }

    fn record(
        &mut self,
        run: &mut Run,
        recorder: &mut Recorder,
        setup: &Setup,
        observer: &mut dyn Observer,
    ) -> Result<Report, Error> {
        let Files { sinks, log, table, events } = self;
        let mut sinks: Vec<&mut dyn Sink> =
            sinks.iter_mut().map(|sink| &mut **sink as &mut dyn Sink).collect();
        sinks.extend(table.as_mut().map(|table| table as &mut dyn Sink));
        let kept = (!setup.outputs.plots.is_empty()).then_some(events);
        let mut listener = Listener { observer, log: log.as_mut(), kept, failed: None };
        let result = sophy_run::simulate(run, recorder, &setup.experiment, &mut sinks, &mut listener);
        match listener.failed {
            Some(error) => Err(error.into()),
            None => Ok(result?),
        }
    }

    fn finish(&mut self, metadata: &Metadata) -> Result<(), Error> {
        let mut first = Ok(());
        for sink in &mut self.sinks {
            first = first.and(sink.finish(metadata).map_err(Error::Sink));
        }
        if let Some(log) = &mut self.log {
            first = first.and(log.finish(metadata).map_err(Error::File));
        }
        first
    }

    fn plot(&self, outputs: &Outputs) -> Result<Option<String>, FileError> {
        let Some(table) = &self.table else { return Ok(None) };
        let options = PlotOptions { phase: outputs.phase.clone(), ..PlotOptions::default() };
        let drawn = outputs.plots.iter().map(|path| plot(path, table, &self.events, &options));
        Ok(drawn.collect::<Result<Vec<_>, _>>()?.into_iter().flatten().next())
    }
}

/// Writes the log of transitions and passes on to the observer.
struct Listener<'a> {
    observer: &'a mut dyn Observer,
    log: Option<&'a mut EventLog>,
    kept: Option<&'a mut Vec<EventRecord>>,
    /// Why the log cannot be written.
    failed: Option<FileError>,
}

impl Listener<'_> {
    fn log(&mut self, write: impl FnOnce(&mut EventLog) -> Result<(), FileError>) -> Result<(), SinkError> {
        let Some(log) = &mut self.log else { return Ok(()) };
        write(log).map_err(|error| {
            let stop =
                SinkError { sink: "the log of transitions".to_owned(), source: error.to_string().into() };
            self.failed = Some(error);
            stop
        })
    }
}

impl Observer for Listener<'_> {
    fn progress(&mut self, progress: &Progress) -> ControlFlow<()> {
        self.observer.progress(progress)
    }

    fn events(&mut self, events: &[EventRecord]) -> Result<(), SinkError> {
        self.log(|log| events.iter().try_for_each(|event| log.append(event)))?;
        if let Some(kept) = &mut self.kept {
            kept.extend_from_slice(events);
        }
        self.observer.events(events)
    }

    fn flush(&mut self) -> Result<(), SinkError> {
        self.log(EventLog::flush)?;
        self.observer.flush()
    }
}

/// Mistakes of what is to be written that would show only after the run.
fn output_mistakes(outputs: &Outputs, schema: &Schema) -> Vec<ExperimentError> {
    let mistake = |item: &str, message: String, help: String| ExperimentError {
        item: item.to_owned(),
        message,
        help: Some(help),
    };
    let mut mistakes = Vec::new();
    for path in outputs.plots.iter().filter(|path| !is_picture(path)) {
        let message = format!("cannot tell what picture {} should be by its extension", path.display());
        mistakes.push(mistake("record.plot", message, "known are .png, .svg and .html".to_owned()));
    }
    let phase = outputs.phase.iter().flat_map(|(x, y)| [x, y]);
    for name in phase.filter(|name| !schema.columns.iter().any(|column| column.name == **name)) {
        let recorded: Vec<String> =
            schema.columns.iter().map(|column| format!("`{}`", column.name)).collect();
        let message = format!("the phase portrait shows `{name}`, which is not recorded");
        mistakes.push(mistake("record.phase", message, format!("recorded are {}", recorded.join(", "))));
    }
    mistakes
}

fn is_picture(path: &Path) -> bool {
    let extension = path.extension().and_then(|extension| extension.to_str()).unwrap_or_default();
    ["png", "svg", "html"].iter().any(|known| extension.eq_ignore_ascii_case(known))
}

fn locations(run: &Run) -> Vec<(String, String)> {
    let automata = run.system().automata.iter().enumerate();
    automata
        .filter(|(_, automaton)| automaton.kind.role == Role::Component && automaton.kind.locations.len() > 1)
        .map(|(position, automaton)| {
            let location = run.location(sophy_field::AutomatonIndex::new(position));
            (automaton.name(run.system()), automaton.kind.locations[location.position()].name.clone())
        })
        .collect()
}

/// Transitions accumulate: where, which, and the way out.
fn zeno(accumulation: &Accumulation, system: &System) -> Diagnostic {
    let Accumulation { limit, last, ratio, cycle } = accumulation;
    let message = format!("transitions accumulate at t = {limit} s: infinitely many before it (Zeno)");
    let mut diagnostic = nowhere("SR0101", message);
    let transitions = || cycle.iter().map(|transition| system.transitions.at(transition.position()));
    diagnostic.labels = transitions()
        .next()
        .and_then(|transition| transition.span)
        .map(|span| sophy_diagnostics::Label {
            span,
            message: "this transition belongs to the cycle".to_owned(),
        })
        .into_iter()
        .collect();
    let names: Vec<String> = transitions().map(|transition| format!("`{}`", transition.name)).collect();
    diagnostic
        .notes
        .push(format!("the cycle is {}; the last one was taken at t = {last} s", names.join(", ")));
    if *ratio > 0.0 {
        diagnostic.notes.push(format!("each round takes {ratio:.6} of the time of the one before"));
    }
    diagnostic.helps.push(
        "give the model a location in which it rests, and a transition to it when what is left of the \
         motion is too small to matter"
            .to_owned(),
    );
    diagnostic
}
