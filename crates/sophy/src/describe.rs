use crate::error::Error;
use serde::Serialize;
use sophy_ir::{FlatTransition, FlatTrigger, Leaf, Model, Row, System, Value, VariableId, evaluate};

/// What there is to know of a model without running it.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Description {
    /// Name of the model.
    pub name: String,
    /// What it is, in the author's words.
    pub documentation: String,
    /// Continuous states with their initial values.
    pub states: Vec<Quantity>,
    /// Inputs.
    pub inputs: Vec<Quantity>,
    /// Outputs.
    pub outputs: Vec<Quantity>,
    /// Constants, which an experiment may set, with their values.
    pub constants: Vec<Quantity>,
    /// The automata; a model that is one component has one.
    pub automata: Vec<AutomatonDescription>,
    /// The coupling matrix D (thesis §3.2.2), row by row.
    pub dependencies: Vec<Dependency>,
    /// Quantities whose sign changes are located.
    pub watches: Vec<WatchDescription>,
}

/// A named number.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Quantity {
    /// Full name.
    pub name: String,
    /// Unit as written.
    pub unit: Option<String>,
    /// Value (initial value of a state), where the model gives one.
    pub value: Option<f64>,
    /// What it means, in the author's words.
    pub documentation: String,
}

/// A hybrid automaton.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct AutomatonDescription {
    /// Component; empty for a model of one nameless component.
    pub component: String,
    /// Location a run starts in.
    pub initial: String,
    /// Its locations.
    pub locations: Vec<LocationDescription>,
}

/// A location and the ways out of it.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LocationDescription {
    /// Name.
    pub name: String,
    /// Outgoing transitions, the most urgent first.
    pub transitions: Vec<TransitionDescription>,
}

/// A transition.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct TransitionDescription {
    /// Name.
    pub name: String,
    /// Location it leads to.
    pub to: String,
    /// When it is taken, as text.
    pub trigger: String,
    /// Whether every comparison of its condition has crossings in closed form (is affine).
    pub affine: bool,
    /// New values of states, as text.
    pub resets: Vec<String>,
    /// Event labels it emits.
    pub emits: Vec<String>,
}

/// What the rate of a state reads.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Dependency {
    /// The state.
    pub state: String,
    /// States, inputs and `time` that occur in its rate, in the order of the columns.
    pub reads: Vec<String>,
    /// The same location by location, where it differs.
    pub by_location: Vec<(String, Vec<String>)>,
}

/// A quantity whose sign changes are located.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct WatchDescription {
    /// The quantity, as text.
    pub quantity: String,
    /// Whether it is affine in states, inputs and time.
    pub affine: bool,
}

/// Describes a model.
///
/// # Errors
/// [`Error::Composition`] if the model is no system.
pub fn describe(model: &Model) -> Result<Description, Error> {
    let system = sophy_passes::lower(model)?;
    let parameters = parameter_values(&system);
    let quantity = |name: &str, unit: &Option<String>, value: Option<f64>| Quantity {
        name: name.to_owned(),
        unit: unit.clone(),
        value: value.filter(|value| value.is_finite()),
        documentation: documentation(model, name),
    };
    let initial = |state: &sophy_ir::State| state.initial.map(|node| value(&system, node, &parameters));
    Ok(Description {
        name: model.name.clone(),
        documentation: own_documentation(model),
        states: system.states.iter().map(|x| quantity(&x.name, &x.unit, initial(x))).collect(),
        inputs: system.inputs.iter().map(|u| quantity(&u.name, &u.unit, None)).collect(),
        outputs: system.outputs.iter().map(|y| quantity(&y.name, &y.unit, None)).collect(),
        constants: system
            .parameters
            .iter()
            .zip(&parameters)
            .map(|(p, value)| quantity(&p.name, &p.unit, Some(*value)))
            .collect(),
        automata: automata(&system),
        dependencies: system
            .states
            .iter()
            .map(|state| dependency(&system, &state.name, &state.rate))
            .collect(),
        watches: system
            .watches
            .iter()
            .map(|w| WatchDescription { quantity: system.text(w.difference), affine: w.affine })
            .collect(),
    })
}

fn parameter_values(system: &System) -> Vec<f64> {
    system.parameters.iter().fold(Vec::new(), |mut values, parameter| {
        let next = value(system, parameter.value, &values);
        values.push(next);
        values
    })
}

fn value(system: &System, node: sophy_ir::NodeId, parameters: &[f64]) -> f64 {
    let mut leaf = |leaf: Leaf| {
        Value::Real(match leaf {
            Leaf::Parameter(index) => parameters.get(index.position()).copied().unwrap_or(f64::NAN),
            _ => f64::NAN,
        })
    };
    evaluate(&system.graph, node, &mut leaf).real()
}

fn own_documentation(model: &Model) -> String {
    match model.components.as_slice() {
        [only] if model.documentation.is_empty() => only.documentation.clone(),
        _ => model.documentation.clone(),
    }
}

fn documentation(model: &Model, name: &str) -> String {
    let position = (0..model.variables.len()).find(|&i| model.full_name(VariableId(i as u32)) == name);
    position.map(|position| model.variables[position].documentation.clone()).unwrap_or_default()
}

fn automata(system: &System) -> Vec<AutomatonDescription> {
    let name = |automaton: &sophy_ir::Automaton, location: sophy_field::LocationIndex| {
        automaton.locations[location.position()].name.clone()
    };
    let transition = |automaton: &sophy_ir::Automaton, t: &FlatTransition| TransitionDescription {
        name: t.name.clone(),
        to: name(automaton, t.destination),
        trigger: system.trigger_text(&t.trigger),
        affine: is_affine(system, &t.trigger),
        resets: t
            .resets
            .iter()
            .map(|r| format!("{} := {}", system.states[r.state.position()].name, system.text(r.value)))
            .collect(),
        emits: t.emits.iter().map(|(label, _)| label.clone()).collect(),
    };
    let location = |automaton: &sophy_ir::Automaton, location: &sophy_ir::FlatLocation| LocationDescription {
        name: location.name.clone(),
        transitions: location
            .transitions
            .iter()
            .map(|&t| transition(automaton, &system.transitions[t.position()]))
            .collect(),
    };
    system
        .automata
        .iter()
        .map(|automaton| AutomatonDescription {
            component: automaton.name.clone(),
            initial: name(automaton, automaton.initial),
            locations: automaton.locations.iter().map(|l| location(automaton, l)).collect(),
        })
        .collect()
}

fn is_affine(system: &System, trigger: &FlatTrigger) -> bool {
    let guard = match trigger {
        FlatTrigger::When(guard) => Some(*guard),
        FlatTrigger::On { guard, .. } => *guard,
    };
    system.graph.dependencies(guard).into_iter().all(|leaf| match leaf {
        Leaf::Truth(truth) => system.watches[system.truths[truth.position()].watch.position()].affine,
        _ => true,
    })
}

fn dependency(system: &System, state: &str, rate: &Row) -> Dependency {
    let reads = |row: &Row| system.row_sources(row).into_iter().map(|leaf| system.leaf_name(leaf)).collect();
    let owner = &system.automata[rate.owner.position()];
    let mut by_location: Vec<(String, Vec<String>)> = owner
        .locations
        .iter()
        .zip(&rate.by_location)
        .map(|(location, &node)| {
            let row = Row { owner: rate.owner, by_location: vec![node], spans: Vec::new() };
            (location.name.clone(), reads(&row))
        })
        .collect();
    if by_location.windows(2).all(|pair| pair[0].1 == pair[1].1) {
        by_location.clear();
    }
    Dependency { state: state.to_owned(), reads: reads(rate), by_location }
}
