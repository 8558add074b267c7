use crate::declarations::{Declarations, Spanned, TransitionDeclaration, VariableDeclaration};
use crate::lower::{LoweredEquation, LoweredLocation, LoweredTransition};
use crate::names::{Kind, Names};
use sophy_ir::{
    Component, ComponentIndex, Equation, Graph, Leaf, Location, Model, Node, NodeId, Reset, Transition,
    Trigger, Variable, VariableId, VariableKind,
};
use std::collections::HashMap;

/// The model of a system without mistakes; `None` if something is missing that the reader has reported.
pub(crate) fn assemble(
    declarations: &Declarations,
    names: &Names<'_>,
    constants: &HashMap<VariableId, NodeId>,
    initial: &HashMap<VariableId, NodeId>,
    locations: Vec<LoweredLocation>,
    mut graph: Graph,
) -> Option<Model> {
    let mut variables = variables(declarations, names, constants, initial)?;
    let mut locations: Vec<Location> = locations
        .into_iter()
        .enumerate()
        .map(|(position, lowered)| location(declarations, position, lowered, &graph))
        .collect::<Option<_>>()?;
    state_outputs(declarations, names, &mut variables, &mut locations, &mut graph);
    let initial_location = match &declarations.initial_location {
        Some(name) => declarations.locations.iter().position(|l| l.name.value == name.value)?,
        None => 0,
    };
    let transitions = || declarations.locations.iter().flat_map(|location| &location.transitions);
    let component = Component {
        name: String::new(),
        documentation: declarations.documentation.clone(),
        locations,
        initial_location,
        input_events: sorted_labels(transitions().flat_map(|transition| &transition.input_events)),
        output_events: sorted_labels(transitions().flat_map(|transition| &transition.output_events)),
    };
    Some(Model {
        name: declarations.name.value.clone(),
        documentation: declarations.documentation.clone(),
        graph,
        variables,
        components: vec![component],
        connections: Vec::new(),
        event_connections: Vec::new(),
    })
}

/// Variables in the order in which [`Names`] numbers them.
fn variables(
    declarations: &Declarations,
    names: &Names<'_>,
    constants: &HashMap<VariableId, NodeId>,
    initial: &HashMap<VariableId, NodeId>,
) -> Option<Vec<Variable>> {
    let unit_of = |name: &str| {
        let unit = declarations.units.iter().find(|(of, _)| of.value == name);
        unit.map(|(_, unit)| unit.value.clone())
    };
    let variable = |name: &Spanned<String>, documentation: &str, kind| Variable {
        name: name.value.clone(),
        component: ComponentIndex(0),
        kind,
        unit: unit_of(&name.value),
        documentation: documentation.to_owned(),
        span: Some(name.span),
    };
    let mut variables = Vec::new();
    for constant in &declarations.constants {
        let id = names.variable(&constant.name.value)?;
        variables.push(variable(&constant.name, "", VariableKind::Parameter(*constants.get(&id)?)));
    }
    for state in &declarations.states {
        let id = names.variable(&state.name.value)?;
        let kind = VariableKind::State(initial.get(&id).copied());
        variables.push(variable(&state.name, &state.documentation, kind));
    }
    let mut others = |list: &[VariableDeclaration], kind| {
        for declared in list {
            variables.push(variable(&declared.name, &declared.documentation, kind));
        }
    };
    others(&declarations.inputs, VariableKind::Input);
    let own_outputs: Vec<VariableDeclaration> = declarations
        .outputs
        .iter()
        .filter(|output| names.symbol(&output.name.value).is_none_or(|symbol| symbol.kind == Kind::Output))
        .cloned()
        .collect();
    others(&own_outputs, VariableKind::Output);
    let nameless = variables.iter().any(|variable| variable.name.is_empty());
    (!nameless).then_some(variables)
}

/// An output that is a state becomes an output of its own whose value is that state everywhere.
fn state_outputs(
    declarations: &Declarations,
    names: &Names<'_>,
    variables: &mut Vec<Variable>,
    locations: &mut [Location],
    graph: &mut Graph,
) {
    for output in &declarations.outputs {
        let Some(symbol) = names.symbol(&output.name.value) else { continue };
        let Some(state) = names.variable(&output.name.value).filter(|_| symbol.kind == Kind::State) else {
            continue;
        };
        let id = VariableId(variables.len() as u32);
        let unit = variables[state.0 as usize].unit.clone();
        variables.push(Variable {
            name: output.name.value.clone(),
            component: ComponentIndex(0),
            kind: VariableKind::Output,
            unit,
            documentation: output.documentation.clone(),
            span: Some(output.name.span),
        });
        let right = graph.leaf(Leaf::Variable(state));
        for location in locations.iter_mut() {
            location.outputs.push(Equation { variable: id, right, span: None });
        }
    }
}

fn location(
    declarations: &Declarations,
    position: usize,
    lowered: LoweredLocation,
    graph: &Graph,
) -> Option<Location> {
    let written = &declarations.locations[position];
    let equations = |list: Vec<LoweredEquation>| -> Option<Vec<Equation>> {
        let equation =
            |e: LoweredEquation| Some(Equation { variable: e.variable, right: e.right?, span: Some(e.span) });
        list.into_iter().map(equation).collect()
    };
    let mut transitions = Vec::new();
    for (written, lowered) in written.transitions.iter().zip(lowered.transitions) {
        transitions.extend(transition(written, lowered, graph)?);
    }
    Some(Location {
        name: written.name.value.clone(),
        documentation: written.documentation.clone(),
        span: Some(written.name.span),
        dynamics: equations(lowered.dynamics)?,
        outputs: equations(lowered.outputs)?,
        transitions,
    })
}

/// What is written as one transition with a guard and input events is two of one name: one is taken while the
/// guard is true, the other when an event arrives. A guard that is `false` leaves only the other.
fn transition(
    written: &TransitionDeclaration,
    lowered: LoweredTransition,
    graph: &Graph,
) -> Option<Vec<Transition>> {
    let resets: Vec<Reset> = lowered
        .resets
        .into_iter()
        .map(|reset| Some(Reset { state: reset.variable, right: reset.right?, span: Some(reset.span) }))
        .collect::<Option<_>>()?;
    let with = |trigger: Trigger| {
        Some(Transition {
            name: written.name.value.clone(),
            documentation: written.documentation.clone(),
            span: Some(written.name.span),
            trigger,
            destination: lowered.destination?,
            resets: resets.clone(),
            emits: written.output_events.iter().map(|label| label.value.clone()).collect(),
            priority: 0,
        })
    };
    let events: Vec<String> = written.input_events.iter().map(|label| label.value.clone()).collect();
    let mut transitions = Vec::new();
    match lowered.guard {
        Some(guard) if graph.node(guard) == Node::Boolean(false) && !events.is_empty() => {}
        Some(guard) => transitions.push(with(Trigger::When(guard))?),
        None if written.guard.is_some() || events.is_empty() => return None,
        None => {}
    }
    if !events.is_empty() {
        transitions.push(with(Trigger::On { events, guard: None })?);
    }
    Some(transitions)
}

fn sorted_labels<'a>(labels: impl Iterator<Item = &'a Spanned<String>>) -> Vec<String> {
    let mut labels: Vec<String> = labels.map(|label| label.value.clone()).collect();
    labels.sort();
    labels.dedup();
    labels
}
