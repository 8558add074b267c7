//! Declared ranges: what an experiment sets, what a state starts with and what it is assigned lie inside.

use crate::experiment::ExperimentError;
use sophy_field::StateIndex;
use sophy_ir::{Leaf, NodeId, State, System, Value, evaluate};

/// The ranges of the states, their bounds as numbers, in the order of the states.
#[derive(Debug, Default)]
pub(crate) struct Ranges(Vec<(StateIndex, [f64; 2])>);

impl Ranges {
    /// # Errors
    /// An [`ExperimentError`] for every parameter that is outside of its range.
    pub(crate) fn new(system: &System, parameters: &[f64]) -> Result<Self, Vec<ExperimentError>> {
        let value = |i: usize| parameters.get(i).copied().unwrap_or(f64::NAN);
        let number = |node: NodeId| {
            system.graph.as_number(node).unwrap_or_else(|| {
                let mut leaf = |leaf| match leaf {
                    Leaf::Parameter(i) => Value::Real(value(i.position())),
                    _ => Value::Real(f64::NAN),
                };
                evaluate(&system.graph, node, &mut leaf).real()
            })
        };
        let (mut states, mut errors) = (Vec::new(), Vec::new());
        for range in &system.ranges {
            let bounds = range.bounds.map(number);
            match range.of {
                Leaf::State(state) => states.push((state, bounds)),
                Leaf::Parameter(i) => {
                    let Some(parameter) = system.parameters.get(i.position()) else { continue };
                    let name = &parameter.name;
                    if let Some(sentence) =
                        sentence(name, value(i.position()), bounds, parameter.unit.as_deref())
                    {
                        errors.push(
                            ExperimentError::new(format!("knobs.{name}"), sentence)
                                .help("change the value, or the range in the model"),
                        );
                    }
                }
                _ => {}
            }
        }
        if errors.is_empty() { Ok(Ranges(states)) } else { Err(errors) }
    }

    /// What is wrong with a value of a state.
    pub(crate) fn refuse(&self, system: &System, state: StateIndex, value: f64) -> Option<String> {
        let State { name, choices, unit, .. } = system.states.get(state.position())?;
        if !choices.is_empty() {
            let text = |number: usize| system.texts.get(number).map_or("", String::as_str);
            if choices.iter().any(|&choice| choice as f64 == value) {
                return None;
            }
            let known: Vec<_> = choices.iter().map(|&choice| format!("\"{}\"", text(choice))).collect();
            let value = text(value as usize);
            return Some(format!("`{name}` is \"{value}\", which is none of {{{}}}", known.join(", ")));
        }
        let found = self.0.binary_search_by_key(&state, |(state, _)| *state).ok()?;
        sentence(name, value, self.0.get(found)?.1, unit.as_deref())
    }
}

/// That a value is outside; what is not a number has messages of its own.
fn sentence(name: &str, value: f64, [low, high]: [f64; 2], unit: Option<&str>) -> Option<String> {
    let outside = value < low || value > high;
    let unit = unit.map(|unit| format!(" {unit}")).unwrap_or_default();
    outside.then(|| format!("`{name}` is {value}{unit}, outside its range ({low}, {high}){unit}"))
}
