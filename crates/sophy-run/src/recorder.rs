//! From journal to rows: what was recorded is evaluated after the fact, on the segments themselves.

use crate::configure::{names, unknown};
use crate::experiment::{Experiment, ExperimentError, matches};
use crate::grid::Grid;
use crate::run::Run;
use rustc_hash::FxHashSet;
use sophy_field::{AlgebraicIndex, Jet, LocationIndex, NOW, Record, SourceIndex, WatchIndex};
use sophy_ir::{Leaf, Linearity, NodeId, Quantity, System};
use sophy_record::{Column, ColumnKind, Row, Schema, Sink, SinkError, Trajectory};
use sophy_segment::Sign;

/// Turns the journal of a run into rows for sinks, and into a trajectory if one is wanted.
///
/// Rows are given at every event, or on a grid. At a jump there is one row with the values before micro-step
/// 0 and one after the last; with `microsteps` one after each. An output that is not a straight line between events has
/// rows in between, at least every 500th of the run.
#[derive(Debug)]
pub struct Recorder {
    schema: Schema,
    reals: Vec<Real>,
    labels: Vec<Label>,
    /// Present segment of every source: start and coefficients.
    segments: Vec<(f64, Jet)>,
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

/// What a label column shows.
#[derive(Clone, Copy, Debug)]
enum Label {
    /// The location of an automaton.
    Location(usize),
    /// A truth value or the number of a text, at most `last`.
    Value { value: Real, last: u32 },
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
            schema: Schema { columns: Vec::new(), with_step: experiment.microsteps },
            reals: Vec::new(),
            labels: Vec::new(),
            segments,
            locations: run.start_locations().to_vec(),
            states: layout.states as usize,
            memory: run.compiled().equations.image.clone(),
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
            switches: Vec::new(),
            keep_switches: experiment.all_events,
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
        Ok(recorder)
    }

    /// Whether a column can move by more than the steps of states tell.
    fn shows_curves(&self, system: &System) -> bool {
        let mut linearity = Linearity::default();
        for (z, algebraic) in system.algebraics.iter().enumerate() {
            linearity.algebraic(&system.graph, AlgebraicIndex::new(z), system.nodes(algebraic.value));
        }
        let labels = self.labels.iter().filter_map(|label| match label {
            Label::Value { value, .. } => Some(*value),
            Label::Location(_) => None,
        });
        let mut outputs = self.reals.iter().copied().chain(labels).filter_map(|shown| match shown {
            Real::Output(index) => system.outputs.get(index),
            Real::Source(_) => None,
        });
        outputs.any(|y| {
            let curved = |&node: &NodeId| !linearity.is_affine(&system.graph, node);
            let moves = |leaf: Leaf| match leaf {
                Leaf::State(state) => {
                    let rate = system.states[state.position()].rate;
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
            None => {
                self.fill_before(&compiled, end, sinks)?;
                if self.last_row < end { self.row(&compiled, end, 0, sinks) } else { Ok(()) }
            }
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
                self.segments[state.position()] = (time, coefficients);
                if let Some(trajectory) = &mut self.trajectory {
                    trajectory.push_segment(state.position(), time, coefficients);
                }
            }
            Record::Input { time, input, value, slope } => {
                let at = self.states + input.position();
                self.segments[at] = (time, [value, slope, 0.0, 0.0]);
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
        compiled: &sophy_codegen::Compiled,
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
        compiled: &sophy_codegen::Compiled,
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
        self.evaluate(compiled, time);
        self.give(time, step, sinks)
    }

    /// The values of all columns.
    fn evaluate(&mut self, compiled: &sophy_codegen::Compiled, time: f64) {
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

    fn value(&mut self, compiled: &sophy_codegen::Compiled, real: Real, time: f64) -> f64 {
        let e = &compiled.equations;
        match real {
            Real::Source(source) => at(self.segments[source.position()], time),
            Real::Output(index) => {
                let formula = e.selected(e.outputs[index], &self.locations);
                self.memory[NOW] = time;
                for &source in e.sources(&formula.sources) {
                    let value = at(self.segments[source.position()], time);
                    e.layout.set_integrated(&mut self.memory, source, &[value], time);
                }
                e.formula(formula, &self.locations, &mut self.memory, 1)[0]
            }
        }
    }
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

/// A column that could be recorded.
struct Available {
    name: String,
    unit: Option<String>,
    kind: ColumnKind,
    shown: Shown,
    by_default: bool,
    is_state: bool,
}

enum Shown {
    Real(Real),
    Label(Label),
}

/// The columns asked for, in the order in which the patterns ask for them; by default outputs and locations.
fn chosen<'a>(
    available: &'a [Available],
    patterns: Option<&[String]>,
) -> Result<Vec<&'a Available>, Vec<ExperimentError>> {
    let Some(patterns) = patterns else {
        // A model without outputs shows its states.
        let no_outputs = !available.iter().any(Available::is_output);
        let wanted = |column: &&Available| column.by_default || (no_outputs && column.is_state);
        return Ok(available.iter().filter(wanted).collect());
    };
    let (mut columns, mut errors) = (Vec::new(), Vec::new());
    let mut taken = vec![false; available.len()];
    for pattern in patterns {
        let mut any = false;
        for (column, taken) in available.iter().zip(&mut taken) {
            if matches(pattern, &column.name) {
                any = true;
                if !std::mem::replace(taken, true) {
                    columns.push(column);
                }
            }
        }
        if !any {
            errors.push(unknown("record", "variable", pattern, &names(available, |c| c.name.clone())));
        }
    }
    if errors.is_empty() { Ok(columns) } else { Err(errors) }
}

impl Available {
    fn is_output(&self) -> bool {
        let value = match self.shown {
            Shown::Real(value) | Shown::Label(Label::Value { value, .. }) => Some(value),
            Shown::Label(Label::Location(_)) => None,
        };
        matches!(value, Some(Real::Output(_)))
    }
}

/// Outputs, then states and inputs that are not outputs of the same name, then locations.
fn available(system: &System, states: u32) -> Vec<Available> {
    let mut columns: Vec<Available> = Vec::new();
    let mut taken: FxHashSet<String> = FxHashSet::default();
    let mut add = |name: String, unit: &Option<String>, (kind, shown), by_default: bool, is_state: bool| {
        if taken.insert(name.clone()) {
            columns.push(Available { name, unit: unit.clone(), kind, shown, by_default, is_state });
        }
    };
    let shown = |quantity: Quantity, value: Real| shown(quantity, value, &system.texts);
    for (index, y) in system.outputs.iter().enumerate() {
        add(y.name(system), &y.declared.unit, shown(y.declared.quantity, Real::Output(index)), true, false);
    }
    for (index, x) in system.states.iter().enumerate() {
        let source = Real::Source(SourceIndex(index as u32));
        add(x.name(system), &x.declared.unit, shown(x.declared.quantity, source), false, true);
    }
    for (index, u) in system.inputs.iter().enumerate() {
        let source = Real::Source(SourceIndex(states + index as u32));
        add(u.name(system), &u.declared.unit, shown(u.declared.quantity, source), false, false);
    }
    for (index, automaton) in system.automata.iter().enumerate() {
        // A component that was written without locations has one without a name.
        let kind = &automaton.kind;
        let written = kind.locations.iter().any(|location| !location.name.is_empty());
        if kind.role != sophy_ir::Role::Component || !written {
            continue;
        }
        let name = match automaton.name(system).as_str() {
            "" => "location".to_owned(),
            component => format!("{component}.location"),
        };
        columns.push(Available {
            name,
            unit: None,
            kind: ColumnKind::Label(kind.locations.iter().map(|l| l.name.clone()).collect()),
            shown: Shown::Label(Label::Location(index)),
            by_default: kind.locations.len() > 1,
            is_state: false,
        });
    }
    columns
}

/// A value as people read it: truth values and texts by their names.
fn shown(quantity: Quantity, value: Real, texts: &[String]) -> (ColumnKind, Shown) {
    let names = match quantity {
        Quantity::Boolean => vec!["false".to_owned(), "true".to_owned()],
        Quantity::Text => texts.to_vec(),
        Quantity::Real | Quantity::Integer => Vec::new(),
    };
    match names.len().checked_sub(1) {
        Some(last) => {
            let label = Label::Value { value, last: u32::try_from(last).unwrap_or(u32::MAX) };
            (ColumnKind::Label(names), Shown::Label(label))
        }
        None => (ColumnKind::Real, Shown::Real(value)),
    }
}
