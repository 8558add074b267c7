//! From journal to rows: what was recorded is evaluated after the fact, on the segments themselves.

use crate::configure::{names, unknown};
use crate::experiment::{Experiment, ExperimentError, matches};
use crate::grid::Grid;
use crate::run::Run;
use rustc_hash::FxHashSet;
use sophy_field::{LocationIndex, Record, SourceIndex, WatchIndex};
use sophy_record::{Column, ColumnKind, Row, Schema, Sink, SinkError, Trajectory};
use sophy_segment::Sign;

/// Turns the journal of a run into rows for sinks, and into a trajectory if one is wanted.
///
/// Rows are given at every event, or on a grid. At a jump there is one row with the values before micro-step
/// 0 and one after the last; with `microsteps` one after each.
#[derive(Debug)]
pub struct Recorder {
    schema: Schema,
    reals: Vec<Real>,
    labels: Vec<usize>,
    /// Present segment of every source: start and coefficients.
    segments: Vec<(f64, [f64; 3])>,
    locations: Vec<LocationIndex>,
    /// Number of states; inputs follow them.
    states: usize,
    memory: Vec<f64>,
    grid: Option<Grid>,
    microsteps: bool,
    /// An instant whose values are complete only when something later comes.
    pending: Option<(f64, u32)>,
    last_row: f64,
    stop: f64,
    values: Vec<f64>,
    label_values: Vec<u32>,
    /// The exact trajectory, if wanted.
    pub trajectory: Option<Trajectory>,
    /// Kinks crossed since they were last drained, if the experiment asks for them.
    pub(crate) switches: Vec<(f64, WatchIndex, Sign)>,
    keep_switches: bool,
    rows: u64,
}

/// What a real column shows.
#[derive(Clone, Copy, Debug)]
enum Real {
    Source(SourceIndex),
    Output(usize),
}

impl Recorder {
    /// A recorder of what the experiment asks for.
    ///
    /// # Errors
    /// An [`ExperimentError`] for every name that does not exist.
    pub fn new(run: &Run, experiment: &Experiment) -> Result<Self, Vec<ExperimentError>> {
        let system = run.system();
        let layout = run.compiled().equations.layout;
        let mut segments = vec![(experiment.start, [0.0; 3]); layout.sources()];
        for (input, line) in run.start_inputs().iter().enumerate() {
            segments[layout.states as usize + input] = (experiment.start, [line[0], line[1], 0.0]);
        }
        segments[layout.time().position()] = (0.0, [0.0, 1.0, 0.0]);
        let mut recorder = Recorder {
            schema: Schema { columns: Vec::new(), with_step: experiment.microsteps },
            reals: Vec::new(),
            labels: Vec::new(),
            segments,
            locations: run.start_locations().to_vec(),
            states: layout.states as usize,
            memory: run.compiled().equations.image.clone(),
            grid: experiment.every.map(|step| Grid::new(experiment.start, step)),
            microsteps: experiment.microsteps,
            pending: None,
            last_row: f64::NEG_INFINITY,
            stop: experiment.stop,
            values: Vec::new(),
            label_values: Vec::new(),
            trajectory: None,
            switches: Vec::new(),
            keep_switches: experiment.all_events,
            rows: 0,
        };
        let available = available(system, layout.states);
        let mut errors = Vec::new();
        let mut chosen = vec![false; available.len()];
        match &experiment.record {
            None => {
                for (wanted, column) in chosen.iter_mut().zip(&available) {
                    *wanted = column.by_default;
                }
                // A model without outputs shows its states.
                if !available.iter().any(|c| matches!(c.real, Some(Real::Output(_)))) {
                    for (wanted, column) in chosen.iter_mut().zip(&available) {
                        *wanted |= column.is_state;
                    }
                }
            }
            Some(patterns) => {
                for pattern in patterns {
                    let mut any = false;
                    for (wanted, column) in chosen.iter_mut().zip(&available) {
                        if matches(pattern, &column.name) {
                            *wanted = true;
                            any = true;
                        }
                    }
                    if !any {
                        let known = names(&available, |c| &c.name);
                        errors.push(unknown("record", "variable", pattern, &known));
                    }
                }
            }
        }
        if !errors.is_empty() {
            return Err(errors);
        }
        let wanted = available.iter().zip(&chosen).filter(|(_, chosen)| **chosen);
        for (column, _) in wanted {
            match column.real {
                Some(real) => recorder.reals.push(real),
                None => recorder.labels.push(column.automaton),
            }
            recorder.schema.columns.push(Column {
                name: column.name.clone(),
                unit: column.unit.clone(),
                kind: column.kind.clone(),
            });
        }
        Ok(recorder)
    }

    /// Also keeps the exact trajectory of all states.
    #[must_use]
    pub fn with_trajectory(mut self, run: &Run) -> Self {
        let system = run.system();
        let mut trajectory = Trajectory::new(system.states.len(), system.automata.len());
        for (automaton, location) in self.locations.iter().enumerate() {
            trajectory.push_location(automaton, run.time(), location.0);
        }
        self.trajectory = Some(trajectory);
        self
    }

    /// The columns.
    pub fn schema(&self) -> &Schema {
        &self.schema
    }

    /// Number of rows given so far.
    pub fn rows(&self) -> u64 {
        self.rows
    }

    /// Takes what the run has written since the last call.
    ///
    /// # Errors
    /// That of a sink.
    pub fn consume(&mut self, run: &mut Run, sinks: &mut [&mut dyn Sink]) -> Result<(), SinkError> {
        let compiled = std::sync::Arc::clone(run.compiled());
        let records: Vec<Record> = run.journal.drain().collect();
        for record in records {
            self.before(&compiled, record, sinks)?;
            self.apply(record);
        }
        Ok(())
    }

    /// Gives the rows that complete the result at the run's present time.
    ///
    /// # Errors
    /// That of a sink.
    pub fn finish(&mut self, run: &Run, sinks: &mut [&mut dyn Sink]) -> Result<(), SinkError> {
        let compiled = std::sync::Arc::clone(run.compiled());
        let end = run.time();
        self.complete(&compiled, sinks)?;
        match self.grid {
            Some(_) => self.grid_before(&compiled, end.next_up(), sinks),
            None if self.last_row < end => self.row(&compiled, end, 0, sinks),
            None => Ok(()),
        }
    }

    /// Rows that are due before a record is applied.
    fn before(
        &mut self,
        compiled: &sophy_codegen::Compiled,
        record: Record,
        sinks: &mut [&mut dyn Sink],
    ) -> Result<(), SinkError> {
        let time = record.time();
        if self.grid.is_some() {
            return self.grid_before(compiled, time, sinks);
        }
        if self.pending.is_some_and(|(pending, _)| pending < time) {
            self.complete(compiled, sinks)?;
        }
        match record {
            // Before micro-step 0: the limit from the left. Before a later one: only if all are wanted.
            Record::Jump { step, .. } => {
                if step == 0 || self.microsteps {
                    self.row(compiled, time, step, sinks)?;
                }
                self.pending = Some((time, step + 1));
            }
            _ => {
                let step = self.pending.map_or(0, |(_, step)| step);
                self.pending = Some((time, step));
            }
        }
        Ok(())
    }

    fn apply(&mut self, record: Record) {
        match record {
            Record::Segment { time, state, coefficients } => {
                self.segments[state.position()] = (time, coefficients);
                if let Some(trajectory) = &mut self.trajectory {
                    trajectory.push_segment(state.position(), time, coefficients);
                }
            }
            Record::Input { time, input, value, slope } => {
                let at = self.states + input.position();
                self.segments[at] = (time, [value, slope, 0.0]);
            }
            Record::Location { time, automaton, location } => {
                self.locations[automaton.position()] = location;
                if let Some(trajectory) = &mut self.trajectory {
                    trajectory.push_location(automaton.position(), time, location.0);
                }
            }
            Record::Switch { time, watch, sign } => {
                if self.keep_switches {
                    self.switches.push((time, watch, sign));
                }
            }
            Record::Jump { .. } | Record::Step { .. } => {}
        }
    }

    fn complete(
        &mut self,
        compiled: &sophy_codegen::Compiled,
        sinks: &mut [&mut dyn Sink],
    ) -> Result<(), SinkError> {
        match self.pending.take() {
            Some((time, step)) if self.grid.is_none() => {
                self.row(compiled, time, if self.microsteps { step } else { 0 }, sinks)
            }
            _ => Ok(()),
        }
    }

    fn grid_before(
        &mut self,
        compiled: &sophy_codegen::Compiled,
        time: f64,
        sinks: &mut [&mut dyn Sink],
    ) -> Result<(), SinkError> {
        while let Some(mut grid) = self.grid {
            let next = grid.peek();
            if next >= time || next > self.stop {
                break;
            }
            self.row(compiled, next, 0, sinks)?;
            grid.advance();
            self.grid = Some(grid);
        }
        Ok(())
    }

    fn row(
        &mut self,
        compiled: &sophy_codegen::Compiled,
        time: f64,
        step: u32,
        sinks: &mut [&mut dyn Sink],
    ) -> Result<(), SinkError> {
        let e = &compiled.equations;
        self.values.clear();
        for &real in &self.reals {
            let value = match real {
                Real::Source(source) => at(self.segments[source.position()], time),
                Real::Output(index) => {
                    let formula = e.selected(e.outputs[index], &self.locations);
                    for &source in e.sources(&formula.sources) {
                        self.memory[e.layout.series_of(source)] = at(self.segments[source.position()], time);
                    }
                    e.formula(formula, &self.locations, &mut self.memory, 1)[0]
                }
            };
            self.values.push(value);
        }
        self.label_values.clear();
        self.label_values.extend(self.labels.iter().map(|&automaton| self.locations[automaton].0));
        let row = Row { time, step, reals: &self.values, labels: &self.label_values };
        for sink in sinks.iter_mut() {
            sink.row(row)?;
        }
        self.last_row = time;
        self.rows += 1;
        Ok(())
    }
}

fn at((start, [c0, c1, c2]): (f64, [f64; 3]), time: f64) -> f64 {
    let s = time - start;
    c0 + s * (c1 + s * c2)
}

/// A column that could be recorded.
struct Available {
    name: String,
    unit: Option<String>,
    kind: ColumnKind,
    real: Option<Real>,
    automaton: usize,
    by_default: bool,
    is_state: bool,
}

/// Outputs, then states and inputs that are not outputs of the same name, then locations.
fn available<'a>(system: &'a sophy_ir::System, states: u32) -> Vec<Available> {
    let mut columns: Vec<Available> = Vec::new();
    let mut taken: FxHashSet<&str> = FxHashSet::default();
    let mut add = |name: &'a str, unit: &Option<String>, real: Real, by_default: bool, is_state: bool| {
        if taken.insert(name) {
            columns.push(Available {
                name: name.to_owned(),
                unit: unit.clone(),
                kind: ColumnKind::Real,
                real: Some(real),
                automaton: 0,
                by_default,
                is_state,
            });
        }
    };
    for (index, y) in system.outputs.iter().enumerate() {
        add(&y.name, &y.unit, Real::Output(index), true, false);
    }
    for (index, x) in system.states.iter().enumerate() {
        add(&x.name, &x.unit, Real::Source(SourceIndex(index as u32)), false, true);
    }
    for (index, u) in system.inputs.iter().enumerate() {
        add(&u.name, &u.unit, Real::Source(SourceIndex(states + index as u32)), false, false);
    }
    for (index, automaton) in system.automata.iter().enumerate() {
        if automaton.role != sophy_ir::Role::Component {
            continue;
        }
        let name = match automaton.name.as_str() {
            "" => "location".to_owned(),
            component => format!("{component}.location"),
        };
        columns.push(Available {
            name,
            unit: None,
            kind: ColumnKind::Label(automaton.locations.iter().map(|l| l.name.clone()).collect()),
            real: None,
            automaton: index,
            by_default: automaton.locations.len() > 1,
            is_state: false,
        });
    }
    columns
}
