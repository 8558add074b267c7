//! A run that cannot go on says what, where, why, and with which values.

use crate::ranges::{self, watched};
use crate::tables::{outside, range_text};
use sophy_diagnostics::{Code, Diagnostic, Severity, Span};
use sophy_field::{
    Engine, Fault, LocationIndex, SourceIndex, StairIndex, StateIndex, TransitionIndex, WatchIndex,
};
use sophy_hybrid::HybridError;
use sophy_ir::{Leaf, NodeId, Ranged, Stair, System, Value};

/// How many of the things that cannot be run are listed.
const SHOWN: usize = 20;

/// Why a run stopped before its end. What was recorded until then is complete.
#[derive(Clone, Debug, PartialEq)]
pub struct Failure {
    /// Simulated time reached, s.
    pub time: f64,
    /// One sentence.
    pub message: String,
    /// Kind of failure.
    pub code: Code,
    /// The equation or guard, where it stands.
    pub span: Option<Span>,
    /// Facts: the equation, values.
    pub notes: Vec<String>,
    /// Ways out.
    pub helps: Vec<String>,
}

impl std::fmt::Display for Failure {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.message)
    }
}

impl std::error::Error for Failure {}

impl Failure {
    /// As a message with its source excerpt, where the model has one.
    pub fn diagnostic(&self) -> Diagnostic {
        Diagnostic {
            code: self.code,
            severity: Severity::Error,
            message: self.message.clone(),
            labels: self
                .span
                .map(|span| sophy_diagnostics::Label { span, message: String::new() })
                .into_iter()
                .collect(),
            notes: self.notes.clone(),
            helps: self.helps.clone(),
        }
    }

    /// What a system needs and this version does not have, if there is any.
    pub(crate) fn of_awaited(system: &System, time: f64) -> Option<Self> {
        let first = system.awaits.first()?;
        let others = &system.awaits[1..];
        let mut notes: Vec<String> = others.iter().take(SHOWN).map(ToString::to_string).collect();
        if others.len() > SHOWN {
            notes.push(format!("and {} more", others.len() - SHOWN));
        }
        Some(Failure {
            time,
            message: format!("{first}: this version checks it but cannot run it"),
            code: Code("SR0008"),
            span: first.span,
            notes,
            helps: vec!["what can be run: continuous components with locations, transitions, event sections and modes, composed".to_owned()],
        })
    }

    /// A transition gave a state a value that it cannot have.
    pub(crate) fn of_range(system: &System, transition: TransitionIndex, time: f64, sentence: &str) -> Self {
        let by = system.transitions.at(transition.position());
        Failure {
            time,
            message: format!("{sentence}, at t = {time} s"),
            code: Code("SR0011"),
            span: by.span,
            notes: vec![format!("{} gives it this value", transition_text(system, transition))],
            helps: vec!["limit the value, `sat(x, lo, hi)`, or change the range".to_owned()],
        }
    }

    pub(crate) fn new(error: &HybridError, system: &System, parameters: &[f64], engine: &dyn Engine) -> Self {
        let reporter = Reporter { system, parameters, engine };
        match error {
            HybridError::Engine(fault) => reporter.fault(*fault),
            HybridError::AssignedTwice { time, state, transitions, values } => {
                reporter.assigned_twice(*time, *state, transitions, values)
            }
            HybridError::Livelock { time, steps, cycle, exact } => {
                reporter.livelock(*time, *steps, cycle, *exact)
            }
        }
    }
}

fn transition_text(system: &System, transition: TransitionIndex) -> String {
    let t = system.transitions.at(transition.position());
    let automaton = system.automata.at(t.automaton.position());
    let name = |l: LocationIndex| &automaton.kind.locations[l.position()].name;
    format!("`{}` ({} → {})", t.name, name(t.source), name(t.destination))
}

struct Reporter<'a> {
    system: &'a System,
    parameters: &'a [f64],
    engine: &'a dyn Engine,
}

impl Reporter<'_> {
    fn fault(&self, fault: Fault) -> Failure {
        match fault {
            Fault::NotFinite { state, time, value } => self.rate(state, time, value),
            Fault::StateNotFinite { state, time, value } => {
                let name = self.system.states.at(state.position()).name(self.system);
                let mut failure =
                    self.failure("SR0002", time, format!("state `{name}` is {value} at t = {time} s"));
                let resets = self.system.transitions.iter().flat_map(|t| t.resets);
                for reset in resets.filter(|reset| reset.state == state) {
                    failure.notes.extend(self.outside(reset.value, time));
                }
                failure
            }
            Fault::WatchNotFinite { watch, time, value } => {
                let text = self.watch_text(watch);
                let mut failure = self.failure(
                    "SR0003",
                    time,
                    format!("`{text}` of a condition is {value} at t = {time} s"),
                );
                failure.span = self.watch_span(watch);
                failure.notes.push(self.values(self.watch_sources(watch), time));
                failure
            }
            Fault::OutsideTable { watch, time, value } => self.table(watch, time, value),
            Fault::Undecided { watch, time } => {
                let text = self.watch_text(watch);
                let mut failure = self.failure(
                    "SR0004",
                    time,
                    format!("it cannot be decided whether `{text}` crosses zero at t = {time} s"),
                );
                failure.span = self.watch_span(watch);
                failure
                    .notes
                    .push("large numbers cancel in it: what is left is less than their rounding".to_owned());
                failure.notes.push(self.values(self.watch_sources(watch), time));
                failure.helps.push(
                    "write it so that nothing cancels, or with a margin (`> 1e-9` instead of `> 0`)"
                        .to_owned(),
                );
                failure
            }
            Fault::Resolution { state, time } => {
                let name = self.system.states.at(state.position()).name(self.system);
                let mut failure = self.failure(
                    "SR0005",
                    time,
                    format!("the resolution of time is exhausted by state `{name}` at t = {time} s"),
                );
                failure.span = self.rate_span(state);
                failure.notes.push(self.equation(state));
                failure.notes.push(self.values(self.rate_sources(state), time));
                failure.helps.push(format!(
                    "if `{name}` should not grow without bound here, give it a smaller quantum; if it does not, and \
                     its quantum is near the last digits of its value, a larger one"
                ));
                failure
            }
            Fault::Chattering { watch, time } => {
                let text = self.watch_text(watch);
                let mut failure = self.failure(
                    "SR0006",
                    time,
                    format!("`{text}` changes its sign again and again at t = {time} s"),
                );
                failure.span = self.watch_span(watch);
                failure.notes.push(
                    "on both sides of the surface the motion points at it: sliding motion, which this \
                     version does not continue"
                        .to_owned(),
                );
                failure.helps.push(
                    "give the switch a hysteresis, or smooth it (a steep `tanh` instead of `sign`)"
                        .to_owned(),
                );
                failure
            }
        }
    }

    fn rate(&self, state: StateIndex, time: f64, value: f64) -> Failure {
        let name = self.system.states.at(state.position()).name(self.system);
        let mut failure =
            self.failure("SR0001", time, format!("the derivative of `{name}` is {value} at t = {time} s"));
        failure.span = self.rate_span(state);
        failure.notes.push(self.equation(state));
        failure.notes.push(self.values(self.rate_sources(state), time));
        failure.notes.extend(self.outside(
            self.system.at(self.system.states.at(state.position()).rate, self.location_of(state)),
            time,
        ));
        failure
    }

    fn assigned_twice(
        &self,
        time: f64,
        state: StateIndex,
        transitions: &[TransitionIndex; 2],
        values: &[f64; 2],
    ) -> Failure {
        let name = self.system.states.at(state.position()).name(self.system);
        let mut failure = self.failure("SR0010", time, format!("`{name}` is assigned twice at t = {time} s"));
        failure.span = self.system.transitions.at(transitions[0].position()).span;
        for (transition, value) in transitions.iter().zip(values) {
            failure.notes.push(format!("{} gives it {value}", self.transition(*transition)));
        }
        failure.helps.push(
            "give one of the two a `priority`: a smaller number goes first, the other one a micro-step later"
                .to_owned(),
        );
        failure
    }

    /// What moves has left its range.
    fn range(&self, stair: StairIndex, time: f64, value: f64) -> Option<Failure> {
        let (range, name, unit, bounds) = watched(self.system, self.parameters, stair)?;
        let sentence = ranges::outside(&name, value, bounds, unit);
        let mut failure = self.failure("SR0011", time, format!("{sentence}, at t = {time} s"));
        failure.span = range.span;
        let leaves = match &range.of {
            Ranged::State(state) => {
                failure.notes.push(self.equation(*state));
                self.rate_sources(*state)
            }
            Ranged::Value { value, .. } => self.system.row_sources(*value),
            Ranged::Parameter(_) => Vec::new(),
        };
        failure.notes.push(self.values(leaves, time));
        failure.helps.push(
            "limit the motion, by a transition at the bound or in its equation, or change the range"
                .to_owned(),
        );
        Some(failure)
    }

    fn table(&self, watch: WatchIndex, time: f64, value: f64) -> Failure {
        let decides = |stair: &Stair| stair.lower == watch || stair.upper == watch;
        let position = self.system.stairs.iter().position(decides);
        if let Some(failure) = position.and_then(|stair| self.range(StairIndex::new(stair), time, value)) {
            return failure;
        }
        let stair = position.and_then(|stair| self.system.stairs.get(stair));
        let argument = stair.map_or("?".to_owned(), |stair| self.system.text(stair.argument));
        let knots = stair.and_then(|stair| self.system.graph.columns().get(stair.knots?.position()));
        let (name, range) = knots.map_or(("?", String::new()), |knots| (&knots.name, range_text(knots)));
        let ends = knots.and_then(|knots| knots.numbers.first().zip(knots.numbers.last()));
        let near = |end: f64| (value - end).abs() <= 1e-9 * end.abs().max(1.0);
        let goes =
            if ends.is_some_and(|(&first, &last)| near(first) || near(last)) { " and goes on" } else { "" };
        let mut failure = self.failure(
            "SR0009",
            time,
            format!(
                "table `{name}` is read outside of its range, {range}: `{argument}` is {value}{goes} at t = {time} s"
            ),
        );
        failure.span = self.watch_span(watch);
        failure.notes.push(self.values(self.watch_sources(watch), time));
        failure.helps.push(match argument.as_str() {
            "time" => "run within the times of the file; after its last line the option `last` holds the last value",
            _ => "extend the file, or limit the argument: `sat(x, lo, hi)`",
        }.to_owned());
        failure
    }

    /// Tables below an expression whose argument is outside of their range.
    fn outside(&self, node: NodeId, time: f64) -> Vec<String> {
        let states = self.system.states.len() as u32;
        let source = |index: u32| Value::Real(self.engine.value(SourceIndex(index), time));
        outside(&self.system.graph, node, &mut |leaf| match leaf {
            Leaf::State(i) => source(i.0),
            Leaf::Input(i) => source(states + i.0),
            Leaf::Time => Value::Real(time),
            Leaf::Parameter(i) => Value::Real(self.parameters.get(i.position()).copied().unwrap_or(f64::NAN)),
            _ => Value::Real(f64::NAN),
        })
    }

    fn livelock(&self, time: f64, steps: u32, cycle: &[TransitionIndex], exact: bool) -> Failure {
        let names: Vec<String> = cycle.iter().map(|&t| self.transition(t)).collect();
        let mut failure = self.failure(
            "SR0007",
            time,
            format!("livelock at t = {time} s: {steps} micro-steps were taken and time stands still"),
        );
        failure.span = cycle.first().and_then(|t| self.system.transitions.at(t.position()).span);
        let how = if exact { "this round returns exactly to where it began" } else { "the last transitions" };
        failure.notes.push(format!("{how}: {}", names.join(", ")));
        failure.helps.push(
            "a transition is taken as long as its condition holds: let a reset end the condition, or \
             separate the thresholds of the two ways (hysteresis)"
                .to_owned(),
        );
        failure
    }

    fn failure(&self, code: &'static str, time: f64, message: String) -> Failure {
        Failure { time, message, code: Code(code), span: None, notes: Vec::new(), helps: Vec::new() }
    }

    fn transition(&self, transition: TransitionIndex) -> String {
        transition_text(self.system, transition)
    }

    fn location_of(&self, state: StateIndex) -> LocationIndex {
        let owner = self.system.states.at(state.position()).rate.owner;
        self.engine.locations()[owner.position()]
    }

    fn rate_span(&self, state: StateIndex) -> Option<Span> {
        self.system.span(self.system.states.at(state.position()).rate, self.location_of(state))
    }

    fn equation(&self, state: StateIndex) -> String {
        let (s, location) = (self.system.states.at(state.position()), self.location_of(state));
        let owner = self.system.automata.at(s.rate.owner.position());
        let place = match owner.kind.locations.len() {
            1 => String::new(),
            _ => format!(" in location `{}`", owner.kind.locations[location.position()].name),
        };
        format!(
            "the equation{place} is der({}) = {}",
            s.name(self.system),
            self.system.text(self.system.at(s.rate, location))
        )
    }

    fn rate_sources(&self, state: StateIndex) -> Vec<Leaf> {
        let row = self.system.states.at(state.position()).rate;
        self.system.graph.dependencies([self.system.at(row, self.location_of(state))]).into_iter().collect()
    }

    fn watch_text(&self, watch: WatchIndex) -> String {
        self.system.text(self.system.watches.at(watch.position()).difference)
    }

    /// The transition whose guard reads the watch in the present location, else the rate that does.
    fn watch_span(&self, watch: WatchIndex) -> Option<Span> {
        let reads = |node: NodeId| {
            self.system.graph.dependencies([node]).into_iter().any(|leaf| match leaf {
                Leaf::Truth(i) => self.system.truths.at(i.position()).watch == watch,
                Leaf::Stair(i) => {
                    let stair = self.system.stairs[i.position()];
                    stair.lower == watch || stair.upper == watch
                }
                _ => false,
            })
        };
        let transition = self.system.transitions.iter().find(|t| {
            self.engine.locations()[t.automaton.position()] == t.source
                && t.trigger.guard().is_some_and(reads)
        });
        let rates = self.system.states.iter().map(|state| state.rate);
        let values =
            self.system.algebraics.iter().map(|z| z.value).chain(self.system.guarded.iter().copied());
        let row = rates.chain(values).find_map(|row| {
            let location = self.engine.locations()[row.owner.position()];
            reads(self.system.at(row, location)).then(|| self.system.span(row, location))
        });
        transition.and_then(|t| t.span).or(row.flatten())
    }

    fn watch_sources(&self, watch: WatchIndex) -> Vec<Leaf> {
        let node = self.system.watches.at(watch.position()).difference;
        self.system.graph.dependencies([node]).into_iter().collect()
    }

    fn values(&self, leaves: Vec<Leaf>, time: f64) -> String {
        let states = self.system.states.len() as u32;
        let values: Vec<String> = leaves
            .into_iter()
            .filter_map(|leaf| {
                let source = match leaf {
                    Leaf::State(i) => i.0,
                    Leaf::Input(i) => states + i.0,
                    _ => return None,
                };
                let value = self.engine.value(SourceIndex(source), time);
                Some(format!("{} = {value}", self.system.leaf_name(leaf)))
            })
            .collect();
        if values.is_empty() { format!("at t = {time} s") } else { format!("with {}", values.join(", ")) }
    }
}
