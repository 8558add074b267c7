//! Names of an experiment become indices of a system; every mistake is found before the run starts.

use crate::experiment::{Experiment, ExperimentError, QuantumRule, Signal, matches};
use crate::inputs;
use rustc_hash::FxHashMap;
use sophy_codegen::Parameters;
use sophy_diagnostics::closest;
use sophy_field::{EventIndex, InputIndex, LocationIndex, ParameterIndex};
use sophy_ir::{Automaton, Role, State, System};
use sophy_solvers::Quantum;

/// What an experiment says, in indices.
pub(crate) struct Configured {
    pub(crate) knobs: Parameters,
    pub(crate) locations: Vec<LocationIndex>,
    pub(crate) quanta: Vec<Quantum>,
    pub(crate) signals: Vec<(InputIndex, Signal)>,
    pub(crate) events: Vec<(f64, EventIndex)>,
    pub(crate) order: u32,
}

/// Resolves everything but initial values, which need the values of parameters.
pub(crate) fn configure(
    system: &System,
    experiment: &Experiment,
) -> Result<Configured, Vec<ExperimentError>> {
    let mut errors = Vec::new();
    let mut collect = |result: Result<(), ExperimentError>| errors.extend(result.err());
    collect(times(experiment));
    let mut knobs = Parameters::new();
    let parameters = positions(&system.parameters, |p| p.name.clone(), experiment.knobs.is_empty());
    for (name, value) in &experiment.knobs {
        match parameters.get(name.as_str()) {
            Some(&position) if system.parameters[position].structural => {
                let message =
                    format!("`{name}` decides the structure of the model and cannot be set for a run");
                let error = ExperimentError::new(format!("knobs.{name}"), message);
                collect(Err(error.help("change its value in the model, or where the component is a member")));
            }
            Some(&position) => {
                knobs.insert(ParameterIndex::new(position), *value);
            }
            None => {
                collect(Err(unknown(
                    "knobs",
                    "parameter",
                    name,
                    &names(&system.parameters, |p| p.name.clone()),
                )));
            }
        }
    }
    let mut locations: Vec<LocationIndex> = system.automata.iter().map(|a| a.kind.initial).collect();
    for (component, location) in &experiment.initial_locations {
        collect(initial_location(system, component, location, &mut locations));
    }
    let states = || names(system.states.iter(), |s| s.name(system));
    let known = positions(system.states.iter(), |s| s.name(system), experiment.initial.is_empty());
    for (name, _) in &experiment.initial {
        if !known.contains_key(name.as_str()) {
            collect(Err(unknown("initial", "state", name, &states())));
        }
    }
    for rule in &experiment.quanta {
        collect(quantum_rule(rule, system, states));
    }
    let default = Quantum::from_tolerance(experiment.tolerance);
    let quanta = quanta(experiment, system, default);
    let signals = match input_signals(system, experiment) {
        Ok(signals) => signals,
        Err(found) => {
            found.into_iter().for_each(|error| collect(Err(error)));
            Vec::new()
        }
    };
    let mut events = Vec::new();
    let known = if experiment.events.is_empty() { FxHashMap::default() } else { receivers(system) };
    for (time, label) in &experiment.events {
        let mut receivers = known.get(label.as_str()).cloned().unwrap_or_default();
        // An event of the whole, which members may know by another name.
        if let Some(port) = system.event_inputs.iter().find(|port| port.name == *label) {
            receivers.clone_from(&port.receivers);
        } else if receivers.is_empty() {
            let mut known = names(&system.event_inputs, |port| port.name.clone());
            known.extend(names(system.events.iter(), |event| event.name(system)));
            collect(Err(unknown("input_events", "input event", label, &known)));
        }
        events.extend(receivers.into_iter().map(|event| (*time, event)));
    }
    if errors.is_empty() {
        let order = experiment.method.order();
        Ok(Configured { knobs, locations, quanta, signals, events, order })
    } else {
        Err(errors)
    }
}

/// The quantum of every state: that of the last rule that matches it.
fn quanta(experiment: &Experiment, system: &System, default: Quantum) -> Vec<Quantum> {
    // Rules that name one state are found by its name; later ones win over earlier.
    let rules = experiment.quanta.iter().enumerate();
    let (patterns, exact): (Vec<_>, Vec<_>) = rules.partition(|(_, rule)| rule.pattern.contains('*'));
    let exact: FxHashMap<&str, (usize, Quantum)> =
        exact.into_iter().map(|(at, rule)| (rule.pattern.as_str(), (at, rule.quantum))).collect();
    // Names are computed: not where nobody asks for them.
    let asked = experiment.quanta.iter().any(|rule| rule.pattern != "*");
    let quantum = |state: State| {
        let name = if asked { state.name(system) } else { String::new() };
        let exact = exact.get(name.as_str()).copied();
        let after = patterns.iter().rev().take_while(|(at, _)| exact.is_none_or(|(exact, _)| *at > exact));
        let pattern = after.map(|(_, rule)| rule).find(|rule| matches(&rule.pattern, &name));
        pattern.map(|rule| rule.quantum).or(exact.map(|(_, quantum)| quantum)).unwrap_or(default)
    };
    system.states.iter().map(quantum).collect()
}

/// The events that a name or a label means.
fn receivers(system: &System) -> FxHashMap<String, Vec<EventIndex>> {
    let mut known: FxHashMap<String, Vec<EventIndex>> = FxHashMap::default();
    for (position, event) in system.events.iter().enumerate() {
        let (index, name) = (EventIndex::new(position), event.name(system));
        if *name != *event.label {
            known.entry(name).or_default().push(index);
        }
        known.entry(event.label.to_string()).or_default().push(index);
    }
    known
}

fn times(experiment: &Experiment) -> Result<(), ExperimentError> {
    let Experiment { start, stop, tolerance, every, .. } = *experiment;
    if !start.is_finite() || !stop.is_finite() || stop < start {
        return Err(ExperimentError::new(
            "run.stop",
            format!("the run cannot go from {start} s to {stop} s"),
        )
        .help("give a stop time after the start, such as `--stop 20`"));
    }
    if !(tolerance > 0.0 && tolerance < 1.0) {
        return Err(ExperimentError::new(
            "engine.tolerance",
            format!("the tolerance {tolerance} is not in (0, 1)"),
        )
        .help("1e-3 is coarse, 1e-6 fine"));
    }
    if every.is_some_and(|step| !(step > 0.0 && step.is_finite())) {
        return Err(ExperimentError::new("record.every", "the recording step must be positive")
            .help("give seconds, such as `--every 0.01`"));
    }
    Ok(())
}

fn quantum_rule(
    rule: &QuantumRule,
    system: &System,
    states: impl Fn() -> Vec<String>,
) -> Result<(), ExperimentError> {
    let QuantumRule { pattern, quantum } = rule;
    let relative = quantum.relative >= 0.0 && quantum.relative.is_finite();
    if !relative {
        return Err(ExperimentError::new(
            format!("engine.quantum.{pattern}"),
            format!("the relative quantum of `{pattern}` must not be negative, it is {}", quantum.relative),
        ));
    }
    if !(quantum.absolute > 0.0 && quantum.absolute.is_finite()) {
        return Err(ExperimentError::new(
            format!("engine.quantum.{pattern}"),
            format!("the quantum of `{pattern}` must be positive, it is {}", quantum.absolute),
        ));
    }
    if pattern != "*" && !system.states.iter().any(|state| matches(pattern, &state.name(system))) {
        return Err(unknown("engine.quantum", "state", pattern, &states()));
    }
    Ok(())
}

fn initial_location(
    system: &System,
    component: &str,
    location: &str,
    locations: &mut [LocationIndex],
) -> Result<(), ExperimentError> {
    let is_meant = |a: Automaton| a.kind.role == Role::Component && a.name(system) == component;
    let Some(position) = system.automata.iter().position(is_meant) else {
        let components = system.automata.iter().filter(|a| a.kind.role == Role::Component);
        let known: Vec<String> = components.map(|a| a.name(system)).collect();
        return Err(unknown("initial_location", "component", component, &known));
    };
    let automaton = &system.automata.at(position).kind;
    match automaton.locations.iter().position(|l| l.name == location) {
        Some(found) => {
            locations[position] = LocationIndex::new(found);
            Ok(())
        }
        None => Err(unknown(
            "initial_location",
            "location",
            location,
            &names(&automaton.locations, |l| l.name.clone()),
        )),
    }
}

fn input_signals(
    system: &System,
    experiment: &Experiment,
) -> Result<Vec<(InputIndex, Signal)>, Vec<ExperimentError>> {
    let mut errors = Vec::new();
    let known = positions(&system.inputs, |u| u.name(system), experiment.inputs.is_empty());
    let given: FxHashMap<&str, &Signal> =
        experiment.inputs.iter().map(|(name, signal)| (name.as_str(), signal)).collect();
    for (name, signal) in &experiment.inputs {
        if !known.contains_key(name.as_str()) {
            errors.push(unknown("inputs", "input", name, &names(&system.inputs, |u| u.name(system))));
        } else {
            errors.extend(inputs::check(name, signal, experiment.start, experiment.stop).err());
        }
    }
    let mut signals = Vec::new();
    for (position, input) in system.inputs.iter().enumerate() {
        let name = input.name(system);
        match given.get(name.as_str()) {
            Some(&signal) => signals.push((InputIndex::new(position), signal.clone())),
            None => {
                let unit = input.declared.unit.as_ref().map(|u| format!(" ({u})")).unwrap_or_default();
                errors.push(
                    ExperimentError::new(
                        format!("inputs.{name}"),
                        format!("input `{name}`{unit} of the model is not given"),
                    )
                    .help(format!(
                        "give it a CSV file with a column `time` in s (`--input {name}=FILE.csv`), or a constant (`--input {name}=VALUE`)"
                    )),
                );
            }
        }
    }
    if errors.is_empty() { Ok(signals) } else { Err(errors) }
}

/// `name` is not one of `known`.
pub(crate) fn unknown(item: &str, kind: &str, name: &str, known: &[String]) -> ExperimentError {
    let error = ExperimentError::new(format!("{item}.{name}"), format!("the model has no {kind} `{name}`"));
    let common = without_indices(name);
    match closest(name, known.iter().map(String::as_str)) {
        _ if kind == "parameter" && common != name && known.contains(&common) => {
            error.help(format!("the copies have it in common: it is `{common}`"))
        }
        Some(meant) => error.help(format!("did you mean `{meant}`?")),
        None if known.is_empty() => error.help(format!("the model has no {kind}s at all")),
        None => {
            // Its neighbours first: what the component has, if there is one.
            let path = |name: &str| name.rsplit_once('.').map(|(path, _)| path.to_owned());
            let mut near: Vec<&String> = known.iter().filter(|one| path(one) == path(name)).collect();
            if near.is_empty() {
                near = known.iter().collect();
            }
            let known = near;
            let shown: Vec<String> = known.iter().take(12).map(|name| format!("`{name}`")).collect();
            let more = if known.len() > 12 { ", …" } else { "" };
            error.help(format!("it has {}{more}", shown.join(", ")))
        }
    }
}

/// `room.gain` of `room[2].gain`.
fn without_indices(name: &str) -> String {
    let Some((path, last)) = name.rsplit_once('.') else { return name.to_owned() };
    let parts = path.split('.').map(|part| part.split_once('[').map_or(part, |(name, _)| name));
    parts.chain([last]).collect::<Vec<_>>().join(".")
}

/// Positions by name, the first of each; nothing if nobody will ask.
fn positions<T>(
    items: impl IntoIterator<Item = T>,
    name: impl Fn(T) -> String,
    unasked: bool,
) -> FxHashMap<String, usize> {
    let mut known = FxHashMap::default();
    if !unasked {
        for (position, item) in items.into_iter().enumerate() {
            known.entry(name(item)).or_insert(position);
        }
    }
    known
}

pub(crate) fn names<T>(items: impl IntoIterator<Item = T>, name: impl Fn(T) -> String) -> Vec<String> {
    items.into_iter().map(name).collect()
}
