//! Values of states at the start, in the order of their rank: the experiment's; declared values; `initial`
//! sections; for a mode that nothing initialises the sign of its flag.

use crate::experiment::{Experiment, ExperimentError};
use crate::ranges::Ranges;
use crate::tables::outside;
use sophy_field::{LocationIndex, StateIndex};
use sophy_ir::{Leaf, NodeId, System, Value, evaluate};
use std::collections::{BTreeMap, BTreeSet, HashMap};

/// x of every state at the start.
///
/// # Errors
/// An [`ExperimentError`] for every state without a finite value.
pub(crate) fn initial_states(
    system: &System,
    experiment: &Experiment,
    parameters: &[f64],
    inputs: &[[f64; 2]],
    locations: &[LocationIndex],
    ranges: &Ranges,
) -> Result<Vec<f64>, Vec<ExperimentError>> {
    let given: HashMap<&str, f64> =
        experiment.initial.iter().map(|(name, value)| (name.as_str(), *value)).collect();
    // Names are computed: not where nobody asks for them.
    let given = |position: usize| {
        if given.is_empty() {
            None
        } else {
            given.get(system.states.at(position).name(system).as_str()).copied()
        }
    };
    let states = vec![None; system.states.len()];
    let mut start = Start { system, time: experiment.start, parameters, inputs, locations, states };
    for (position, state) in system.states.iter().enumerate() {
        start.states[position] = given(position).or_else(|| state.initial.map(|node| start.value(node)));
    }
    for assignment in &system.initial {
        let position = assignment.state.position();
        if given(position).is_none() {
            start.states[position] = Some(start.value(assignment.value));
        }
    }
    let sides: Vec<Option<f64>> = system
        .states
        .iter()
        .zip(&start.states)
        .map(|(state, value)| match (value, state.sign_of) {
            (None, Some(flag)) => Some(if start.value(flag) > 0.0 { 1.0 } else { -1.0 }),
            (value, _) => *value,
        })
        .collect();
    let mut errors = Vec::new();
    let mut values = Vec::with_capacity(sides.len());
    for (position, (state, value)) in system.states.iter().zip(sides).enumerate() {
        match value {
            Some(value) if value.is_finite() => {
                values.push(value);
                if let Some(sentence) = ranges.refuse(system, StateIndex::new(position), value) {
                    let name = state.name(system);
                    errors.push(ExperimentError::new(
                        format!("initial.{name}"),
                        format!("{sentence}, at the start"),
                    ));
                }
            }
            Some(value) => {
                let name = state.name(system);
                let reasons = start.outside(position);
                let reason =
                    if reasons.is_empty() { String::new() } else { format!(": {}", reasons.join(", ")) };
                errors.push(ExperimentError::new(
                    format!("initial.{name}"),
                    format!("the initial value of state `{name}` is {value}{reason}"),
                ));
            }
            None => {
                let name = state.name(system);
                errors.push(ExperimentError::new(
                    format!("initial.{name}"),
                    format!("state `{name}` has no initial value"),
                )
                .help(format!(
                    "give one in the experiment (`[initial] \"{name}\" = 0`, `--initial {name}=0`) or in the model (`state {name} := 0;`, in SOPHY XML `<hint hintname=\"initial {name}\">0</hint>`)"
                )));
            }
        }
    }
    if errors.is_empty() { Ok(values) } else { Err(errors) }
}

/// By how much an expression is another one at the start if a state is moved.
pub(crate) fn moved<'a>(
    system: &'a System,
    time: f64,
    parameters: &'a [f64],
    inputs: &'a [[f64; 2]],
    locations: &'a [LocationIndex],
    states: &[f64],
) -> impl FnMut(NodeId, StateIndex, f64) -> f64 + use<'a> {
    let states = states.iter().copied().map(Some).collect();
    let mut start = Start { system, time, parameters, inputs, locations, states };
    move |node, state, by| {
        let still = start.value(node);
        let Some(Some(value)) = start.states.get_mut(state.position()) else { return 0.0 };
        let before = std::mem::replace(value, *value + by);
        let moved = start.value(node);
        start.states[state.position()] = Some(before);
        (moved - still).abs()
    }
}

/// What is known at the start.
struct Start<'a> {
    system: &'a System,
    time: f64,
    parameters: &'a [f64],
    inputs: &'a [[f64; 2]],
    locations: &'a [LocationIndex],
    states: Vec<Option<f64>>,
}

impl Start<'_> {
    /// An expression, switches as written. A mode that has no value yet counts as 0.
    fn value(&self, root: NodeId) -> f64 {
        if let Some(number) = self.system.graph.as_number(root) {
            return number;
        }
        // Algebraic variables are numbered in an order in which they can be evaluated.
        let (mut below, mut pending) = (BTreeSet::new(), vec![root]);
        while let Some(node) = pending.pop() {
            for leaf in self.system.graph.dependencies([node]) {
                if let Leaf::Algebraic(z) = leaf
                    && below.insert(z)
                {
                    pending.extend(self.definition(z.position()));
                }
            }
        }
        let mut known = BTreeMap::new();
        for z in below {
            if let Some(node) = self.definition(z.position()) {
                let value = self.expression(node, &known);
                known.insert(z.position(), value);
            }
        }
        self.expression(root, &known)
    }

    fn definition(&self, z: usize) -> Option<NodeId> {
        let row = self.system.algebraics.get(z)?.plain;
        let location = self.locations.get(row.owner.position())?;
        self.system.nodes(row).get(location.position()).copied()
    }

    /// Tables read outside of their range by what a state starts with.
    fn outside(&self, state: usize) -> Vec<String> {
        let assigned = self.system.initial.iter().filter(|reset| reset.state.position() == state);
        let declared = self.system.states.get(state).and_then(|state| state.initial);
        let roots = assigned.map(|reset| reset.value).chain(declared);
        let none = BTreeMap::new();
        let tables = |root| outside(&self.system.graph, root, &mut |leaf| self.leaf(leaf, &none));
        roots.flat_map(tables).collect()
    }

    fn expression(&self, node: NodeId, algebraics: &BTreeMap<usize, f64>) -> f64 {
        evaluate(&self.system.graph, node, &mut |leaf| self.leaf(leaf, algebraics)).real()
    }

    fn leaf(&self, leaf: Leaf, algebraics: &BTreeMap<usize, f64>) -> Value {
        Value::Real(match leaf {
            Leaf::Parameter(i) => self.parameters.get(i.position()).copied().unwrap_or(f64::NAN),
            Leaf::Input(i) => self.inputs.get(i.position()).map_or(f64::NAN, |line| line[0]),
            Leaf::Time => self.time,
            Leaf::State(i) => match self.states.get(i.position()) {
                Some(Some(value)) => *value,
                _ if self.is_open(i.position()) => 0.0,
                _ => f64::NAN,
            },
            Leaf::Algebraic(z) => algebraics.get(&z.position()).copied().unwrap_or(f64::NAN),
            _ => f64::NAN,
        })
    }

    /// Whether a state takes the sign of a flag.
    fn is_open(&self, state: usize) -> bool {
        self.system.states.get(state).is_some_and(|state| state.sign_of.is_some())
    }
}
