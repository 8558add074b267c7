//! From journal to rows: what was recorded is evaluated after the fact, on the segments themselves.

use crate::columns::{Label, Real, Shown, available, chosen};
use crate::experiment::{Experiment, ExperimentError};
use crate::grid::Grid;
use crate::run::Run;
use sophy_codegen::Compiled;
use sophy_field::{AlgebraicIndex, Jet, LocationIndex, Memory, NOW, Record, SourceIndex, Turn, sources_of};
use sophy_ir::{Leaf, Linearity, NodeId, System};
use sophy_record::{Column, Row, Schema, Sink, SinkError, Trajectory};
use std::sync::Arc;

/// Turns the journal of a run into rows for sinks, and into a trajectory if one is wanted.
///
/// Rows are given at every event, or on a grid. At a jump there is one row with the values before micro-step
/// 0 and one after the last; with `microsteps` one after each. An output that is not a straight line between events has
/// rows in between, at least every 500th of the run.
#[derive(Debug)]
pub struct Recorder {
    compiled: Arc<Compiled>,
    schema: Schema,
    reals: Vec<Real>,
    labels: Vec<Label>,
    /// Present segment of every source: start and coefficients.
    segments: Vec<(f64, Jet)>,
    locations: Vec<LocationIndex>,
    /// Number of states; inputs follow them.
    states: usize,
    /// What the programs of outputs read: the same segments.
    memory: Memory,
    /// Whether an output reads a source.
    read: Vec<bool>,
    grid: Option<Grid>,
    microsteps: bool,
    /// An instant whose values are complete only when something later comes.
    pending: Option<(f64, u32)>,
    last_row: f64,
    stop: f64,
    /// How long the run is, s.
    span: f64,
    /// The longest time between two rows, s.
    longest: f64,
    /// Whether states may curve between two rows by more than their quanta: q of the third order follows a parabola.
    curved_states: bool,
    /// Whether a kink is crossed at the pending instant: a column may jump there.
    kink: bool,
    /// The row just before it, and the one just behind.
    before_kink: (Vec<f64>, Vec<u32>),
    behind_kink: (Vec<f64>, Vec<u32>),
    values: Vec<f64>,
    label_values: Vec<u32>,
    /// The exact trajectory, if wanted.
    pub trajectory: Option<Trajectory>,
    rows: u64,
}

impl Recorder {
    /// A recorder of what the experiment asks for.
    ///
    /// # Errors
    /// An [`ExperimentError`] for every name that does not exist.
    pub fn new(run: &Run, experiment: &Experiment) -> Result<Self, Vec<ExperimentError>> {
        let system = run.system();
        let layout = run.compiled().equations.layout;
        let mut segments = vec![(experiment.start, Jet::default()); layout.sources()];
        for (input, line) in run.start_inputs().iter().enumerate() {
            segments[layout.states as usize + input] = (experiment.start, [line[0], line[1], 0.0, 0.0]);
        }
        segments[layout.time().position()] = (0.0, [0.0, 1.0, 0.0, 0.0]);
        let mut recorder = Recorder {
            compiled: Arc::clone(run.compiled()),
            read: vec![false; segments.len()],
            schema: Schema { columns: Vec::new(), with_step: experiment.microsteps },
            reals: Vec::new(),
            labels: Vec::new(),
            segments,
            locations: run.start_locations().to_vec(),
            states: layout.states as usize,
            memory: run.compiled().equations.memory(),
            grid: experiment.every.map(|step| Grid::new(experiment.start, step)),
            microsteps: experiment.microsteps,
            // The start is a row even if nothing happens there.
            pending: Some((experiment.start, 0)),
            last_row: f64::NEG_INFINITY,
            stop: experiment.stop,
            span: experiment.stop - experiment.start,
            longest: f64::INFINITY,
            curved_states: experiment.method.order() > 2,
            kink: false,
            before_kink: Default::default(),
            behind_kink: Default::default(),
            values: Vec::new(),
            label_values: Vec::new(),
            trajectory: None,
            rows: 0,
        };
        let available = available(system, layout.states);
        for column in chosen(&available, experiment.record.as_deref())? {
            match column.shown {
                Shown::Real(real) => recorder.reals.push(real),
                Shown::Label(label) => recorder.labels.push(label),
            }
            recorder.schema.columns.push(Column {
                name: column.name.clone(),
                unit: column.unit.clone(),
                kind: column.kind.clone(),
            });
        }
        if recorder.shows_curves(system) {
            recorder.longest = recorder.span / LEAST_ROWS;
        }
        recorder.find_read(system);
        for source in 0..recorder.segments.len() {
            let (start, coefficients) = recorder.segments[source];
            recorder.follow(source, start, coefficients);
        }
        Ok(recorder)
    }

    /// Marks the sources that a recorded output reads, in any location.
    fn find_read(&mut self, system: &System) {
        let e = &self.compiled.equations;
        for shown in shown_of(&self.reals, &self.labels) {
            let Real::Output(index) = shown else { continue };
            let Turn { first, copy, .. } = e.outputs[index];
            let formulas =
                &e.formulas[first as usize..][..system.nodes(system.outputs.at(index).value).len()];
            for source in formulas.iter().flat_map(|formula| sources_of(&formula.reads, copy)) {
                self.read[source.position()] = true;
            }
        }
    }

    /// Whether a column can move by more than the steps of states tell.
    fn shows_curves(&self, system: &System) -> bool {
        let mut linearity = Linearity::default();
        for (z, algebraic) in system.algebraics.iter().enumerate() {
            linearity.algebraic(&system.graph, AlgebraicIndex::new(z), system.nodes(algebraic.value));
        }
        let mut outputs = shown_of(&self.reals, &self.labels).filter_map(|shown| match shown {
            Real::Output(index) => system.outputs.get(index),
            Real::Source(_) => None,
        });
        outputs.any(|y| {
            let curved = |&node: &NodeId| !linearity.is_affine(&system.graph, node);
            let moves = |leaf: Leaf| match leaf {
                Leaf::State(state) => {
                    let rate = system.states.at(state.position()).rate;
                    system.nodes(rate).iter().any(|&node| system.graph.as_number(node) != Some(0.0))
                }
                Leaf::Input(_) | Leaf::Time => true,
                _ => false,
            };
            system.nodes(y.value).iter().any(curved) && system.row_sources(y.value).into_iter().any(moves)
        })
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

    /// Takes lines of the run's journal, in their order.
    ///
    /// # Errors
    /// That of a sink.
    pub fn consume(&mut self, lines: &[Record], sinks: &mut [&mut dyn Sink]) -> Result<(), SinkError> {
        let compiled = Arc::clone(&self.compiled);
        for &record in lines {
            self.before(&compiled, record, sinks)?;
            self.apply(record);
        }
        Ok(())
    }

    /// Gives the rows that complete the result at `end`, the time the run has reached (s).
    ///
    /// # Errors
    /// That of a sink.
    pub fn finish(&mut self, end: f64, sinks: &mut [&mut dyn Sink]) -> Result<(), SinkError> {
        let compiled = Arc::clone(&self.compiled);
        self.complete(&compiled, sinks)?;
        match self.grid {
            Some(_) => self.grid_before(&compiled, end.next_up(), sinks),
            None => {
                self.fill_before(&compiled, end, sinks)?;
                if self.last_row < end { self.row(&compiled, end, 0, sinks) } else { Ok(()) }
            }
        }
    }

    /// Rows that are due before a record is applied.
    fn before(
        &mut self,
        compiled: &Compiled,
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
        self.fill_before(compiled, time, sinks)?;
        match record {
            Record::Switch { .. } if self.pending.is_none_or(|(pending, _)| pending < time) => {
                self.evaluate(compiled, time.next_down());
                self.kink = self.last_row > f64::NEG_INFINITY;
                std::mem::swap(&mut self.before_kink.0, &mut self.values);
                std::mem::swap(&mut self.before_kink.1, &mut self.label_values);
                self.pending = Some((time, 0));
            }
            // Before micro-step 0: the limit from the left. Before a later one: only if all are wanted.
            Record::Jump { step, .. } => {
                self.kink = false;
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
                self.follow(state.position(), time, coefficients);
                if let Some(trajectory) = &mut self.trajectory {
                    trajectory.push_segment(state.position(), time, coefficients);
                }
            }
            Record::Input { time, input, value, slope } => {
                self.follow(self.states + input.position(), time, [value, slope, 0.0, 0.0]);
            }
            Record::Location { time, automaton, location } => {
                self.locations[automaton.position()] = location;
                if let Some(trajectory) = &mut self.trajectory {
                    trajectory.push_location(automaton.position(), time, location.0);
                }
            }
            Record::Jump { .. } | Record::Step { .. } | Record::Switch { .. } => {}
        }
    }

    /// A source goes on along a segment. Programs read it themselves, so nothing is evaluated for them row by row.
    #[inline]
    fn follow(&mut self, source: usize, start: f64, coefficients: Jet) {
        self.segments[source] = (start, coefficients);
        if self.read[source] {
            let [c0, c1, c2, c3] = coefficients;
            // Outputs know no −0 at the beginning of a segment: what they show must not depend on the sign of nothing.
            let jet = [c0 + 0.0, c1, c2, c3];
            let source = SourceIndex(source as u32);
            self.compiled.equations.layout.set_integrated(&mut self.memory, source, &jet, start);
        }
    }

    fn complete(&mut self, compiled: &Compiled, sinks: &mut [&mut dyn Sink]) -> Result<(), SinkError> {
        match self.pending.take() {
            Some((time, step)) if self.grid.is_none() => {
                let step = if self.microsteps { step } else { 0 };
                if std::mem::take(&mut self.kink) {
                    return self.rows_at_kink(compiled, time, step, sinks);
                }
                self.row(compiled, time, step, sinks)
            }
            _ => Ok(()),
        }
    }

    /// Two rows where a column jumps, else one. What is on the edge of a condition at the instant itself is beyond it an
    /// instant later.
    fn rows_at_kink(
        &mut self,
        compiled: &Compiled,
        time: f64,
        step: u32,
        sinks: &mut [&mut dyn Sink],
    ) -> Result<(), SinkError> {
        self.evaluate(compiled, time + INSTANT * time.abs().max(self.span));
        std::mem::swap(&mut self.behind_kink.0, &mut self.values);
        std::mem::swap(&mut self.behind_kink.1, &mut self.label_values);
        self.evaluate(compiled, time);
        let ((before, labels), (behind, labels_behind)) = (&self.before_kink, &self.behind_kink);
        let mut jumps = labels != labels_behind;
        for ((value, before), behind) in self.values.iter_mut().zip(before).zip(behind) {
            if (before - behind).abs() > SAME * before.abs().max(behind.abs()) {
                *value = *behind;
                jumps = true;
            }
        }
        self.label_values.clone_from(labels_behind);
        if jumps {
            for sink in sinks.iter_mut() {
                sink.row(Row { time, step, reals: before, labels })?;
            }
            self.rows += 1;
        }
        self.give(time, step, sinks)
    }

    /// Rows between events.
    fn fill_before(
        &mut self,
        compiled: &Compiled,
        time: f64,
        sinks: &mut [&mut dyn Sink],
    ) -> Result<(), SinkError> {
        let part = if self.curved_states { (time - self.last_row) / PARTS_OF_CURVES } else { f64::INFINITY };
        while self.pending.is_none() && self.last_row.is_finite() {
            let next = self.last_row + self.longest.min(part);
            if next >= time || next <= self.last_row {
                break;
            }
            self.row(compiled, next, 0, sinks)?;
        }
        Ok(())
    }

    fn grid_before(
        &mut self,
        compiled: &Compiled,
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
        compiled: &Compiled,
        time: f64,
        step: u32,
        sinks: &mut [&mut dyn Sink],
    ) -> Result<(), SinkError> {
        self.evaluate(compiled, time);
        self.give(time, step, sinks)
    }

    /// The values of all columns.
    fn evaluate(&mut self, compiled: &Compiled, time: f64) {
        self.values.clear();
        for position in 0..self.reals.len() {
            let value = self.value(compiled, self.reals[position], time);
            self.values.push(value);
        }
        self.label_values.clear();
        for position in 0..self.labels.len() {
            let label = match self.labels[position] {
                Label::Location(automaton) => self.locations[automaton].0,
                // Where nothing is known (NaN) the first name stands, as 0 does.
                Label::Value { value, last } => ((self.value(compiled, value, time) + 0.5) as u32).min(last),
            };
            self.label_values.push(label);
        }
    }

    fn give(&mut self, time: f64, step: u32, sinks: &mut [&mut dyn Sink]) -> Result<(), SinkError> {
        let row = Row { time, step, reals: &self.values, labels: &self.label_values };
        for sink in sinks.iter_mut() {
            sink.row(row)?;
        }
        self.last_row = time;
        self.rows += 1;
        Ok(())
    }

    fn value(&mut self, compiled: &Compiled, real: Real, time: f64) -> f64 {
        let e = &compiled.equations;
        match real {
            Real::Source(source) => at(self.segments[source.position()], time),
            Real::Output(index) => {
                let formula = e.output(index, &self.locations);
                self.memory[NOW] = time;
                e.value(formula, &self.locations, &mut self.memory)
            }
        }
    }
}

/// What all columns but locations show.
fn shown_of(reals: &[Real], labels: &[Label]) -> impl Iterator<Item = Real> {
    let labels = labels.iter().filter_map(|label| match label {
        Label::Value { value, .. } => Some(*value),
        Label::Location(_) => None,
    });
    reals.iter().copied().chain(labels)
}

/// Into how many parts rows divide a segment of the third order.
const PARTS_OF_CURVES: f64 = 8.0;
/// How many rows a run has at least if an output is curved.
const LEAST_ROWS: f64 = 500.0;
/// How long an instant is, as a part of time.
const INSTANT: f64 = 1e-12;
/// Values that differ by no more than this part of them do not jump.
const SAME: f64 = 1e-6;

fn at((start, [c0, c1, c2, c3]): (f64, Jet), time: f64) -> f64 {
    let s = time - start;
    c0 + s * (c1 + s * (c2 + s * c3))
}
