//! Declared ranges: what an experiment sets, what a state starts with and what it is assigned lie inside, exactly.
//! What moves between events is watched by the engine, with a margin: a trajectory may leave its bounds by what the
//! quanta make uncertain.

use crate::experiment::ExperimentError;
use sophy_field::{ColumnIndex, Equations, StairIndex, StateIndex};
use sophy_ir::{Allowed, Declared, Leaf, NodeId, Range, Ranged, System, Value, evaluate};
use sophy_solvers::Quantum;
use std::collections::BTreeMap;

/// What a quantity may be, as numbers.
#[derive(Clone, Debug)]
enum Numbers {
    Between([f64; 2]),
    OneOf(Vec<f64>),
}

/// The ranges of the states, in the order of the states.
#[derive(Debug, Default)]
pub(crate) struct Ranges(Vec<(StateIndex, Numbers)>);

impl Ranges {
    /// # Errors
    /// An [`ExperimentError`] for every parameter that is outside of its range.
    pub(crate) fn new(system: &System, parameters: &[f64]) -> Result<Self, Vec<ExperimentError>> {
        let (mut states, mut errors) = (Vec::new(), Vec::new());
        for range in &system.ranges {
            let numbers = || match &range.allowed {
                Allowed::Between(bounds) => {
                    Numbers::Between(bounds.map(|bound| number(system, parameters, bound)))
                }
                Allowed::OneOf(numbers) => Numbers::OneOf(numbers.clone()),
            };
            match range.of {
                Ranged::State(state) => states.push((state, numbers())),
                Ranged::Parameter(i) => {
                    let Some(parameter) = system.parameters.get(i.position()) else { continue };
                    let value = parameters.get(i.position()).copied().unwrap_or(f64::NAN);
                    let name = &parameter.name;
                    if let Some(sentence) =
                        refusal(|| name.clone(), value, &numbers(), parameter.unit.as_deref())
                    {
                        errors.push(
                            ExperimentError::new(format!("knobs.{name}"), sentence)
                                .help("change the value, or the range in the model"),
                        );
                    }
                }
                Ranged::Value { .. } => {}
            }
        }
        if errors.is_empty() { Ok(Ranges(states)) } else { Err(errors) }
    }

    /// What is wrong with a value of a state.
    pub(crate) fn refuse(&self, system: &System, state: StateIndex, value: f64) -> Option<String> {
        let Declared { choices, unit, .. } = &*system.states.pattern(state.position()).declared;
        let name = || system.states.at(state.position()).name(system);
        if !choices.is_empty() {
            let text = |number: usize| system.texts.get(number).map_or("", String::as_str);
            if choices.iter().any(|&choice| choice as f64 == value) {
                return None;
            }
            let known: Vec<_> = choices.iter().map(|&choice| format!("\"{}\"", text(choice))).collect();
            let value = text(value as usize);
            return Some(format!("`{}` is \"{value}\", which is none of {{{}}}", name(), known.join(", ")));
        }
        let found = self.0.binary_search_by_key(&state, |(state, _)| *state).ok()?;
        refusal(name, value, &self.0.get(found)?.1, unit.as_deref())
    }
}

/// That a value is outside; what is not a number has messages of its own.
fn refusal(name: impl Fn() -> String, value: f64, numbers: &Numbers, unit: Option<&str>) -> Option<String> {
    match numbers {
        Numbers::Between(bounds) => {
            (value < bounds[0] || value > bounds[1]).then(|| outside(&name(), value, *bounds, unit))
        }
        Numbers::OneOf(numbers) => (!value.is_nan() && !numbers.contains(&value)).then(|| {
            let numbers: Vec<String> = numbers.iter().map(f64::to_string).collect();
            format!("`{}` is {value}, which is none of {{{}}}", name(), numbers.join(", "))
        }),
    }
}

/// That a value is outside of its bounds.
pub(crate) fn outside(name: &str, value: f64, [low, high]: [f64; 2], unit: Option<&str>) -> String {
    let unit = unit.map(|unit| format!(" {unit}")).unwrap_or_default();
    format!("`{name}` is {value}{unit}, outside its range ({low}, {high}){unit}")
}

/// Name, unit and bounds of what a stair watches, without margins, and its range.
pub(crate) fn watched<'a>(
    system: &'a System,
    parameters: &[f64],
    stair: StairIndex,
) -> Option<(&'a Range, String, Option<&'a str>, [f64; 2])> {
    let range = system.ranges.iter().find(|range| range.stairs.contains(&stair))?;
    let Allowed::Between(bounds) = range.allowed else { return None };
    let (name, unit) = match &range.of {
        Ranged::State(state) => {
            let name = system.states.get(state.position())?.name(system);
            (name, &system.states.pattern(state.position()).declared.unit)
        }
        Ranged::Value { component, declared, .. } => {
            (system.components.full_name(*component, &declared.name), &declared.unit)
        }
        Ranged::Parameter(_) => return None,
    };
    Some((range, name, unit.as_deref(), bounds.map(|bound| number(system, parameters, bound))))
}

fn number(system: &System, parameters: &[f64], node: NodeId) -> f64 {
    system.graph.as_number(node).unwrap_or_else(|| {
        let mut leaf = |leaf| match leaf {
            Leaf::Parameter(i) => Value::Real(parameters.get(i.position()).copied().unwrap_or(f64::NAN)),
            _ => Value::Real(f64::NAN),
        };
        evaluate(&system.graph, node, &mut leaf).real()
    })
}

/// Tells the engine the bounds of what moves, a margin further out. `moved(node, state)`: by how much a value is
/// another one at the start if a state is moved by its quantum.
pub(crate) fn watch(
    system: &System,
    equations: &mut Equations,
    parameters: &[f64],
    quanta: &[Quantum],
    mut moved: impl FnMut(NodeId, StateIndex, f64) -> f64,
) {
    // Copies of a component share their columns; the largest margin is that of all.
    let mut margins: BTreeMap<ColumnIndex, ([f64; 2], f64)> = BTreeMap::new();
    for range in &system.ranges {
        let Allowed::Between(bounds) = &range.allowed else { continue };
        let Some(column) = range.stairs.first().and_then(|stair| system.stairs[stair.position()].knots)
        else {
            continue;
        };
        let (bounds, margin) = margins
            .entry(column)
            .or_insert_with(|| (bounds.map(|bound| number(system, parameters, bound)), 0.0));
        let largest =
            bounds.iter().map(|bound| bound.abs()).filter(|bound| bound.is_finite()).fold(0.0, f64::max);
        let quantum =
            |state: StateIndex| quanta.get(state.position()).map_or(0.0, |quantum| quantum.at(largest));
        let own = match &range.of {
            Ranged::State(state) => quantum(*state),
            Ranged::Value { value, .. } => {
                let sources = system.row_sources(*value);
                let mut of = |node: NodeId| {
                    let of_one = |leaf: &Leaf| match leaf {
                        Leaf::State(state) => moved(node, *state, quantum(*state)),
                        _ => 0.0,
                    };
                    sources.iter().map(of_one).filter(|moved| moved.is_finite()).sum::<f64>()
                };
                system.nodes(*value).iter().map(|&node| of(node)).fold(0.0, f64::max)
            }
            Ranged::Parameter(_) => 0.0,
        };
        // What reads nothing quantised is uncertain by rounding; what is not affine is not known by its start.
        let affine =
            |stair: &StairIndex| system.watches.at(system.stairs[stair.position()].lower.position()).affine;
        let unknown = if range.stairs.iter().all(affine) { 1e-9 } else { 1e-3 };
        *margin = margin.max(own).max(unknown * largest);
    }
    let rest = equations.layout.rest;
    for (stair, code) in system.stairs.iter().zip(&equations.stairs) {
        if let Some(([low, high], margin)) = stair.knots.and_then(|column| margins.get(&column)) {
            // No step of a stair is below its first knot: minus infinity is a very low one.
            equations.image[(code.knots.start - rest) as usize] = (low - margin).max(f64::MIN);
            equations.image[(code.knots.end - 1 - rest) as usize] = high + margin;
        }
    }
}
