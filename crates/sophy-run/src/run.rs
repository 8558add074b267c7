use crate::backend::Evaluation;
use crate::configure::configure;
use crate::experiment::{Experiment, ExperimentError, Method};
use crate::failure::Failure;
use crate::initial::{initial_states, moved};
use crate::inputs::Inputs;
use crate::ranges::{Ranges, watch};
use sophy_codegen::{Compiled, compile};
use sophy_field::{
    AutomatonIndex, Changes, Engine, InputIndex, Journal, LocationIndex, SourceIndex, Start, StateIndex,
    Statistics, Stop,
};
use sophy_hybrid::{Accumulation, Control, Counts, HybridError, Taken};
use sophy_ir::System;
use sophy_solvers::{Liqss1, Liqss2, Liqss3, Qss1, Qss2, Qss3, Quantum, Settings};
use std::sync::Arc;

/// One run of a system under an experiment.
///
/// [`Run::advance`] goes on to a time; stopping there and going on later gives the same bits as not stopping.
/// [`Run::journal`] collects what happened until someone drains it.
#[derive(Debug)]
pub struct Run {
    system: Arc<System>,
    compiled: Arc<Compiled>,
    evaluation: Evaluation,
    engine: Box<dyn Engine>,
    control: Control,
    inputs: Inputs,
    ranges: Ranges,
    changes: Changes,
    /// What happened since it was last drained.
    pub journal: Journal,
    /// Transitions taken since they were last drained.
    pub taken: Vec<Taken>,
    /// The quanta in the order of states: each, and how many states in a row have it.
    quanta: Vec<(usize, Quantum)>,
    time: f64,
    /// Values at the start, for recorders.
    start_inputs: Vec<[f64; 2]>,
    start_locations: Vec<LocationIndex>,
}

/// Why [`Run::advance`] came back.
#[derive(Clone, Debug, PartialEq)]
pub enum Pause {
    /// The time asked for is reached.
    Reached,
    /// The budget of steps is used up; call again.
    Budget,
    /// Transitions accumulate: time cannot go beyond the limit.
    Zeno(Accumulation),
}

/// Work done since the start.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct RunStatistics {
    /// The engine's.
    pub engine: Statistics,
    /// The hybrid logic's.
    pub hybrid: Counts,
}

/// The whole state of a run at one time, to go on from later.
#[derive(Debug)]
pub struct Snapshot {
    engine: Box<dyn Engine>,
    control: Control,
    inputs: Inputs,
    time: f64,
}

impl Run {
    /// Configures a run and takes the micro-steps of its start.
    ///
    /// # Errors
    /// All [`ExperimentError`]s at once, or the [`Failure`] of the start; a system that awaits something this
    /// version cannot run does not start.
    pub fn new(system: Arc<System>, experiment: &Experiment) -> Result<Self, StartError> {
        if let Some(failure) = Failure::of_awaited(&system, experiment.start) {
            return Err(StartError::Failure(Box::new(failure)));
        }
        let configured = configure(&system, experiment)?;
        let mut compiled = compile(&system, &configured.knobs, configured.order)
            .map_err(|error| vec![ExperimentError::new("knobs", error.to_string())])?;
        let ranges = Ranges::new(&system, &compiled.parameters)?;
        let mut inputs = Inputs::new(configured.signals, configured.events);
        let lines = inputs.begin(experiment.start);
        let locations = &configured.locations;
        let states = initial_states(&system, experiment, &compiled.parameters, &lines, locations, &ranges)?;
        let Compiled { equations, parameters, .. } = &mut compiled;
        let moved = moved(&system, experiment.start, parameters, &lines, locations, &states);
        watch(&system, equations, parameters, &configured.quanta, moved);
        let equations = &compiled.equations;
        let quanta = runs(&configured.quanta);
        let settings = Settings::for_span(configured.quanta, experiment.stop - experiment.start);
        let engine: Box<dyn Engine> = match experiment.method {
            Method::Qss1 => Box::new(Qss1::new(equations, settings)),
            Method::Auto | Method::Qss2 => Box::new(Qss2::new(equations, settings)),
            Method::Qss3 => Box::new(Qss3::new(equations, settings)),
            Method::Liqss1 => Box::new(Liqss1::new(equations, settings)),
            Method::Liqss2 => Box::new(Liqss2::new(equations, settings)),
            Method::Liqss3 => Box::new(Liqss3::new(equations, settings)),
        };
        let control = Control::new(&compiled.logic);
        let mut run = Run {
            system,
            evaluation: Evaluation::new(experiment.backend, &compiled),
            engine,
            control,
            inputs,
            ranges,
            changes: Changes::default(),
            journal: Journal::wanted(),
            taken: Vec::new(),
            quanta,
            time: experiment.start,
            start_inputs: lines,
            start_locations: configured.locations,
            compiled: Arc::new(compiled),
        };
        let start = Start {
            time: experiment.start,
            states: &states,
            inputs: &run.start_inputs,
            locations: &run.start_locations,
        };
        let compiled = Arc::clone(&run.compiled);
        let started = run.engine.start(&compiled.equations, &start, &mut run.journal);
        let begun = started.map_err(HybridError::from).and_then(|()| {
            let engine = run.engine.as_mut();
            run.control.begin(
                engine,
                &compiled.equations,
                &compiled.logic,
                experiment.start,
                &mut run.journal,
            )
        });
        begun.map_err(|error| StartError::Failure(Box::new(run.failure(&error))))?;
        run.react(experiment.start).map_err(StartError::Failure)?;
        run.journal.shrink_to_fit();
        Ok(run)
    }

    /// Goes on to `until` (s, inclusive), at most for about `budget` steps.
    ///
    /// # Errors
    /// [`Failure`] when the run cannot go on; what is in the journal stays valid.
    pub fn advance(&mut self, until: f64, budget: u64) -> Result<Pause, Box<Failure>> {
        match self.go_on(until.max(self.time), budget.max(1)) {
            Ok(pause) => Ok(pause),
            Err(failure) => {
                // What is in the journal reaches to the failure; what follows does not exist.
                self.time = failure.time;
                Err(failure)
            }
        }
    }

    fn go_on(&mut self, until: f64, mut budget: u64) -> Result<Pause, Box<Failure>> {
        let compiled = Arc::clone(&self.compiled);
        loop {
            let scheduled = self.inputs.next_time();
            let horizon = if scheduled < until { scheduled } else { until };
            self.evaluation.consider(self.engine.statistics().steps, &compiled);
            let burst = self.evaluation.burst(budget);
            let stop = self
                .engine
                .advance(&compiled.equations, horizon, burst, &mut self.journal)
                .map_err(|fault| Box::new(self.failure(&fault.into())))?;
            let instant = match stop {
                Stop::Crossed(time) => time,
                Stop::Horizon if scheduled <= until => scheduled,
                Stop::Horizon => {
                    self.time = until;
                    return Ok(Pause::Reached);
                }
                Stop::Budget(_) if burst < budget => {
                    budget -= burst;
                    continue;
                }
                Stop::Budget(time) => {
                    self.time = time;
                    return Ok(Pause::Budget);
                }
            };
            self.time = instant;
            if let Some(accumulation) = self.react(instant)? {
                return Ok(Pause::Zeno(accumulation));
            }
            if self.journal.len() as u64 >= budget {
                return Ok(Pause::Budget);
            }
        }
    }

    /// Takes the micro-steps of an instant, inputs due first.
    fn react(&mut self, instant: f64) -> Result<Option<Accumulation>, Box<Failure>> {
        let compiled = Arc::clone(&self.compiled);
        self.changes.clear();
        for event in self.inputs.due(instant, &mut self.changes) {
            self.control.post(&compiled.logic, event);
        }
        self.react_to(instant, &compiled)
    }

    fn react_to(&mut self, instant: f64, compiled: &Compiled) -> Result<Option<Accumulation>, Box<Failure>> {
        let before = self.taken.len();
        let answer = self.control.react(
            self.engine.as_mut(),
            &compiled.equations,
            &compiled.logic,
            instant,
            &self.changes,
            &mut self.journal,
            &mut self.taken,
        );
        let answer = answer.map_err(|error| Box::new(self.failure(&error)))?;
        match self.range_left(instant, before) {
            Some(failure) => Err(Box::new(failure)),
            None => Ok(answer),
        }
    }

    /// Whether a state that was assigned by the transitions taken since `before` is outside of its range.
    fn range_left(&self, time: f64, before: usize) -> Option<Failure> {
        self.taken.iter().skip(before).find_map(|taken| {
            let (code, copy) = self.compiled.logic.transition(taken.transition);
            code.resets.iter().find_map(|(state, _)| {
                let state = StateIndex(state.of(copy));
                let value = self.engine.value(SourceIndex(state.0), time);
                let sentence = self.ranges.refuse(&self.system, state, value)?;
                Some(Failure::of_range(&self.system, taken.transition, time, &sentence))
            })
        })
    }

    /// Changes states from outside at the present time (an estimator's update), as one micro-step: guards are
    /// decided again, and transitions enabled now are taken at once (thesis §8.3.3).
    ///
    /// # Errors
    /// [`Failure`] when a value is not finite or the run cannot go on.
    pub fn reset_states(
        &mut self,
        values: &[(StateIndex, f64)],
    ) -> Result<Option<Accumulation>, Box<Failure>> {
        let compiled = Arc::clone(&self.compiled);
        self.changes.clear();
        self.changes.states.extend_from_slice(values);
        let time = self.time;
        self.react_to(time, &compiled)
    }

    /// The state of the run at the present time, as a value to return to.
    pub fn snapshot(&self) -> Snapshot {
        Snapshot {
            engine: self.engine.snapshot(),
            control: self.control.clone(),
            inputs: self.inputs.clone(),
            time: self.time,
        }
    }

    /// Goes back to a snapshot of the same run; journal and log start empty.
    pub fn restore(&mut self, snapshot: &Snapshot) {
        self.engine = snapshot.engine.snapshot();
        self.control = snapshot.control.clone();
        self.inputs = snapshot.inputs.clone();
        self.time = snapshot.time;
        self.journal.clear();
        self.taken.clear();
    }

    fn failure(&self, error: &HybridError) -> Failure {
        Failure::new(error, &self.system, &self.compiled.parameters, self.engine.as_ref())
    }

    /// Time reached, s.
    pub fn time(&self) -> f64 {
        self.time
    }

    /// The system that runs.
    pub fn system(&self) -> &Arc<System> {
        &self.system
    }

    /// Its callable equations.
    pub fn compiled(&self) -> &Arc<Compiled> {
        &self.compiled
    }

    /// Whether equations are evaluated by native code by now.
    pub fn is_native(&self) -> bool {
        self.compiled.equations.kernels.get().is_some()
    }

    /// x of a state at the present time.
    pub fn state(&self, state: StateIndex) -> f64 {
        self.engine.value(SourceIndex(state.0), self.time)
    }

    /// q of a state at `time` on its present quantised trajectory, and x there.
    pub fn quantised(&self, state: StateIndex, time: f64) -> (f64, f64) {
        (self.engine.quantised(state, time), self.engine.value(SourceIndex(state.0), time))
    }

    /// Value of an input at the present time.
    pub fn input(&self, input: InputIndex) -> f64 {
        let source = SourceIndex(self.compiled.equations.layout.states + input.0);
        self.engine.value(source, self.time)
    }

    /// Present location of an automaton.
    pub fn location(&self, automaton: AutomatonIndex) -> LocationIndex {
        self.engine.locations()[automaton.position()]
    }

    /// ∂f/∂z at the present time: state, source, value.
    pub fn jacobian(&self) -> Vec<(StateIndex, SourceIndex, f64)> {
        self.engine.jacobian(&self.compiled.equations, self.time)
    }

    /// The quanta in use, in the order of states.
    pub fn quanta(&self) -> impl Iterator<Item = Quantum> {
        self.quanta.iter().flat_map(|&(states, quantum)| std::iter::repeat_n(quantum, states))
    }

    /// Value and slope of every input at the start.
    pub fn start_inputs(&self) -> &[[f64; 2]] {
        &self.start_inputs
    }

    /// Locations at the start, before its micro-steps.
    pub fn start_locations(&self) -> &[LocationIndex] {
        &self.start_locations
    }

    /// Work done so far.
    pub fn statistics(&self) -> RunStatistics {
        RunStatistics { engine: self.engine.statistics(), hybrid: self.control.counts() }
    }
}

/// Quanta, equal ones in a row as one.
fn runs(quanta: &[Quantum]) -> Vec<(usize, Quantum)> {
    quanta.chunk_by(|a, b| a == b).map(|run| (run.len(), run[0])).collect()
}

/// A run cannot start.
#[derive(Debug, thiserror::Error)]
pub enum StartError {
    /// The experiment does not fit the model.
    #[error("{}", .0.iter().map(ToString::to_string).collect::<Vec<_>>().join("\n"))]
    Experiment(Vec<ExperimentError>),
    /// The first instant fails.
    #[error(transparent)]
    Failure(Box<Failure>),
}

impl From<Vec<ExperimentError>> for StartError {
    fn from(errors: Vec<ExperimentError>) -> Self {
        StartError::Experiment(errors)
    }
}
