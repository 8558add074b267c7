use crate::experiment::{Experiment, ExperimentError};
use crate::failure::Failure;
use crate::recorder::Recorder;
use crate::recording::{Recording, Rows};
use crate::run::{Pause, Run, RunStatistics, StartError};
use sophy_field::{Record, WatchIndex};
use sophy_hybrid::{Accumulation, Taken};
use sophy_record::{EventRecord, Sink, SinkError};
use sophy_segment::Sign;
use std::ops::ControlFlow;
use std::thread::Scope;
use std::time::{Duration, Instant};

/// How a run ended. None of these is an error.
#[derive(Clone, Debug, PartialEq)]
pub enum Outcome {
    /// The stop time was reached.
    Reached,
    /// The observer asked to stop.
    Interrupted,
    /// Transitions accumulate before the stop time.
    Zeno(Accumulation),
}

/// What a run has come to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Progress {
    /// Simulated time, s.
    pub time: f64,
    /// Wall time since the start of the run.
    pub elapsed: Duration,
    /// Work done.
    pub statistics: RunStatistics,
}

/// Looks on while a run goes on; nothing it does changes a number.
pub trait Observer {
    /// Called every few milliseconds; `Break` ends the run with complete files.
    fn progress(&mut self, progress: &Progress) -> ControlFlow<()>;

    /// Transitions in the order they were taken.
    ///
    /// # Errors
    /// What keeps them from being written; the run stops.
    fn events(&mut self, events: &[EventRecord]) -> Result<(), SinkError>;

    /// Called at least twice a second of wall time, when sinks have been flushed.
    ///
    /// # Errors
    /// As [`Observer::events`].
    fn flush(&mut self) -> Result<(), SinkError> {
        Ok(())
    }
}

/// An observer that only lets the run go on.
impl Observer for () {
    fn progress(&mut self, _: &Progress) -> ControlFlow<()> {
        ControlFlow::Continue(())
    }

    fn events(&mut self, _: &[EventRecord]) -> Result<(), SinkError> {
        Ok(())
    }
}

/// An observer that keeps the events.
impl Observer for Vec<EventRecord> {
    fn progress(&mut self, _: &Progress) -> ControlFlow<()> {
        ControlFlow::Continue(())
    }

    fn events(&mut self, events: &[EventRecord]) -> Result<(), SinkError> {
        self.extend_from_slice(events);
        Ok(())
    }
}

/// What there is to say of a run that ended.
#[derive(Clone, Debug, PartialEq)]
pub struct Report {
    /// How it ended.
    pub outcome: Outcome,
    /// Simulated time reached, s.
    pub time: f64,
    /// Wall time of the run itself.
    pub elapsed: Duration,
    /// Work done.
    pub statistics: RunStatistics,
    /// Whether equations were evaluated by native code at the end.
    pub native: bool,
    /// Rows recorded.
    pub rows: u64,
}

/// A run did not end well.
#[derive(Debug, thiserror::Error)]
pub enum SimulateError {
    /// The experiment does not fit the model.
    #[error("{}", .0.iter().map(ToString::to_string).collect::<Vec<_>>().join("\n"))]
    Experiment(Vec<ExperimentError>),
    /// The run cannot go on. Sinks hold everything until then.
    #[error(transparent)]
    Failure(Box<Failure>),
    /// A result cannot be written.
    #[error(transparent)]
    Sink(#[from] SinkError),
}

impl From<StartError> for SimulateError {
    fn from(error: StartError) -> Self {
        match error {
            StartError::Experiment(errors) => SimulateError::Experiment(errors),
            StartError::Failure(failure) => SimulateError::Failure(failure),
        }
    }
}

/// Engine steps between two looks at the clock, at most and at first; fewer if they take long.
const BURST: u64 = 16_384;
/// Lines of the journal between two looks, about at most: what is written and soon read should stay in the cache.
const BLOCK: usize = 16_384;
/// Wall time that steps between two looks should take.
const GLANCE: Duration = Duration::from_millis(50);
/// Wall time between two flushes.
const FLUSH_EVERY: Duration = Duration::from_millis(400);

/// Runs `run` to the experiment's stop, recording into `sinks`. The sinks are not finished: their owner adds
/// the outcome.
///
/// Of a run of some length rows are made by a second thread, which is over when this returns. The run waits for it
/// where sinks are slow.
///
/// # Errors
/// [`SimulateError`]; the sinks have then been given everything up to the failure.
pub fn simulate(
    run: &mut Run,
    recorder: &mut Recorder,
    experiment: &Experiment,
    sinks: &mut [&mut dyn Sink],
    observer: &mut dyn Observer,
) -> Result<Report, SimulateError> {
    let sinks = sinks.iter_mut().map(|sink| &mut **sink as &mut dyn Sink).collect();
    let rows = Rows { recorder, sinks };
    std::thread::scope(|scope| go(run, experiment, scope, rows, observer))
}

fn go<'scope, 'a: 'scope>(
    run: &mut Run,
    experiment: &Experiment,
    scope: &'scope Scope<'scope, '_>,
    rows: Rows<'a>,
    observer: &mut dyn Observer,
) -> Result<Report, SimulateError> {
    let begin = Instant::now();
    let mut flushed = begin;
    let mut burst = BURST;
    let mut recording = Recording::Here(rows);
    let outcome = loop {
        let glance = Instant::now();
        let pause = run.advance(experiment.stop, burst);
        // How often it pauses does not change a bit of the run.
        let long = glance.elapsed() > GLANCE || run.journal.len() > BLOCK;
        burst = if long { (burst / 2).max(1) } else { (burst * 2).min(BURST) };
        if matches!(pause, Ok(Pause::Budget)) {
            recording = recording.beside(scope);
        }
        let events = events(run, experiment);
        recording = recording.consume(&mut run.journal)?;
        observer.events(&events)?;
        let finished = match pause {
            Ok(Pause::Budget) => None,
            Ok(Pause::Reached) => Some(Outcome::Reached),
            Ok(Pause::Zeno(accumulation)) => Some(Outcome::Zeno(accumulation)),
            Err(failure) => {
                recording.finish(run.time())?;
                return Err(SimulateError::Failure(failure));
            }
        };
        if let Some(outcome) = finished {
            break outcome;
        }
        if flushed.elapsed() >= FLUSH_EVERY {
            recording = recording.flush()?;
            observer.flush()?;
            flushed = Instant::now();
        }
        let progress = Progress { time: run.time(), elapsed: begin.elapsed(), statistics: run.statistics() };
        if observer.progress(&progress).is_break() {
            break Outcome::Interrupted;
        }
    };
    let rows = recording.finish(run.time())?;
    Ok(Report {
        outcome,
        time: run.time(),
        elapsed: begin.elapsed(),
        statistics: run.statistics(),
        native: run.is_native(),
        rows,
    })
}

/// What happened since the last burst, in the order of time; of one time kinks come first.
fn events(run: &mut Run, experiment: &Experiment) -> Vec<EventRecord> {
    let mut events = Vec::new();
    if experiment.all_events {
        events.extend(run.journal.lines().iter().filter_map(|line| match *line {
            Record::Switch { time, watch, sign } => Some(switch(run, time, watch, sign)),
            _ => None,
        }));
    }
    events.extend(run.taken.iter().map(|taken| event(run, taken)));
    events.sort_by(|a, b| a.time.total_cmp(&b.time));
    run.taken.clear();
    events
}

/// A kink as a transition of the small automaton that it is: `x - 1 < 0`, from false to true.
fn switch(run: &Run, time: f64, watch: WatchIndex, sign: Sign) -> EventRecord {
    let system = run.system();
    let below = sign == Sign::Negative;
    EventRecord {
        time,
        step: 0,
        component: String::new(),
        transition: format!("{} < 0", system.text(system.watches.at(watch.position()).difference)),
        from: (!below).to_string(),
        to: below.to_string(),
    }
}

fn event(run: &Run, taken: &Taken) -> EventRecord {
    let system = run.system();
    let transition = system.transitions.at(taken.transition.position());
    let automaton = system.automata.at(transition.automaton.position());
    EventRecord {
        time: taken.time,
        step: taken.step,
        component: automaton.name(system),
        transition: transition.name.to_string(),
        from: automaton.kind.locations[transition.source.position()].name.clone(),
        to: automaton.kind.locations[transition.destination.position()].name.clone(),
    }
}
