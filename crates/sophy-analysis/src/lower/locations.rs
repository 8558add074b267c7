use super::expression::{Context, Scope, Typed};
use super::names_in;
use crate::checks::{hs0108_defined_twice, hs0111_output_differs_from_state, hs0303_algebraic_loop};
use crate::declarations::{Declarations, EquationDeclaration, LocationDeclaration};
use crate::dependency_order::dependency_order;
use crate::names::Kind;
use sophy_diagnostics::Span;
use sophy_ir::{Graph, Leaf, Node, NodeId, VariableId};
use std::collections::HashMap;

/// A location as far as it is free of mistakes.
#[derive(Default)]
pub(crate) struct LoweredLocation {
    pub(crate) dynamics: Vec<LoweredEquation>,
    pub(crate) outputs: Vec<LoweredEquation>,
    /// One for each that was written.
    pub(crate) transitions: Vec<LoweredTransition>,
}

/// An equation, output map or reset; the right-hand side is `None` if it has mistakes.
pub(crate) struct LoweredEquation {
    pub(crate) variable: VariableId,
    pub(crate) right: Option<NodeId>,
    pub(crate) span: Span,
}

/// A transition as far as it is free of mistakes.
pub(crate) struct LoweredTransition {
    pub(crate) guard: Option<NodeId>,
    pub(crate) destination: Option<usize>,
    pub(crate) resets: Vec<LoweredEquation>,
}

/// Equations whose left-hand side names nothing that could have one, with the position of their location.
#[derive(Default)]
pub(crate) struct Strays<'a> {
    pub(crate) equations: Vec<(usize, &'a EquationDeclaration)>,
    pub(crate) maps: Vec<(usize, &'a EquationDeclaration)>,
    pub(crate) resets: Vec<(usize, &'a EquationDeclaration)>,
}

/// Values of the outputs of a location by name, `None` where the map has mistakes.
type OutputValues<'a> = HashMap<&'a str, Option<Typed>>;

/// Lowers location `position`: its output maps first, since everything else may read outputs.
pub(crate) fn lower_location<'a>(
    declarations: &'a Declarations,
    position: usize,
    graph: &mut Graph,
    context: &mut Context<'_, 'a>,
    strays: &mut Strays<'a>,
) -> LoweredLocation {
    let location = &declarations.locations[position];
    let mut lowered = LoweredLocation::default();
    let values = lower_maps(location, position, graph, context, strays, &mut lowered.outputs);

    let what = |name: &str| format!("`der({name})` in location `{}`", location.name.value);
    let (dynamics, stray) = lower_equations(&location.dynamics, what, graph, context, &values);
    lowered.dynamics = dynamics;
    strays.equations.extend(stray.into_iter().map(|equation| (position, equation)));

    for transition in &location.transitions {
        let scope = Scope::Location { outputs: &values };
        let guard = transition.guard.as_ref().and_then(|guard| context.condition(graph, scope, guard));
        let is_destination = |other: &LocationDeclaration| other.name.value == transition.destination.value;
        let what = |name: &str| format!("the reset of `{name}` in transition `{}`", transition.name.value);
        let (resets, stray) = lower_equations(&transition.resets, what, graph, context, &values);
        strays.resets.extend(stray.into_iter().map(|reset| (position, reset)));
        lowered.transitions.push(LoweredTransition {
            guard: guard.map(|guard| guard.node),
            destination: declarations.locations.iter().position(is_destination),
            resets,
        });
    }
    lowered
}

/// Lowers equations or resets of states; those of no state are returned beside.
fn lower_equations<'a>(
    equations: &'a [EquationDeclaration],
    what: impl Fn(&str) -> String,
    graph: &mut Graph,
    context: &mut Context<'_, 'a>,
    values: &OutputValues<'a>,
) -> (Vec<LoweredEquation>, Vec<&'a EquationDeclaration>) {
    let (mut lowered, mut strays) = (Vec::new(), Vec::new());
    let mut first: HashMap<&str, Span> = HashMap::new();
    for equation in equations {
        let right = context.number(graph, Scope::Location { outputs: values }, &equation.right);
        let name = equation.target.value.as_str();
        let state = context.names.symbol(name).filter(|symbol| symbol.kind == Kind::State);
        match (state, context.names.variable(name), first.get(name)) {
            (Some(_), Some(_), Some(&first)) => {
                let again = equation.target.span;
                context.findings.report(hs0108_defined_twice::diagnostic(&what(name), first, again));
            }
            (Some(_), Some(variable), None) => {
                first.insert(name, equation.target.span);
                let right = right.map(|value| value.node);
                lowered.push(LoweredEquation { variable, right, span: equation.right.map.whole() });
            }
            _ => strays.push(equation),
        }
    }
    (lowered, strays)
}

/// Lowers output maps, each after those it reads.
fn lower_maps<'a>(
    location: &'a LocationDeclaration,
    position: usize,
    graph: &mut Graph,
    context: &mut Context<'_, 'a>,
    strays: &mut Strays<'a>,
    lowered: &mut Vec<LoweredEquation>,
) -> OutputValues<'a> {
    let mut map_of: HashMap<&str, usize> = HashMap::new();
    for (index, map) in location.outputs.iter().enumerate() {
        let name = map.target.value.as_str();
        if context.names.output(name).is_none() {
            strays.maps.push((position, map));
        } else if let Some(&first) = map_of.get(name) {
            let what = format!("output `{name}` in location `{}`", location.name.value);
            let first = location.outputs[first].target.span;
            context.findings.report(hs0108_defined_twice::diagnostic(&what, first, map.target.span));
        } else {
            map_of.insert(name, index);
        }
    }
    let is_output = |name: &str| context.names.symbol(name).is_some_and(|s| s.kind == Kind::Output);
    let needs: Vec<Vec<usize>> = location
        .outputs
        .iter()
        .map(|map| {
            let used = names_in(&map.right).into_iter().filter(|name| is_output(name));
            used.filter_map(|name| map_of.get(name.as_str()).copied()).collect()
        })
        .collect();
    let sorted = dependency_order(&needs);
    for cycle in &sorted.cycles {
        let members: Vec<&EquationDeclaration> = cycle.iter().map(|&map| &location.outputs[map]).collect();
        context.findings.report(hs0303_algebraic_loop::diagnostic(&location.name.value, &members));
    }
    let mut values = OutputValues::new();
    for index in sorted.order {
        let map = &location.outputs[index];
        let name = map.target.value.as_str();
        let value = context.number(graph, Scope::Location { outputs: &values }, &map.right);
        if map_of.get(name) != Some(&index) {
            continue;
        }
        let (Some(symbol), Some(variable)) = (context.names.symbol(name), context.names.variable(name))
        else {
            continue;
        };
        if symbol.kind == Kind::State {
            let is_state = |value: Typed| graph.node(value.node) == Node::Leaf(Leaf::Variable(variable));
            if value.is_some_and(|value| !is_state(value)) {
                let declared = symbol.span;
                context.findings.report(hs0111_output_differs_from_state::diagnostic(map, declared));
            }
            continue;
        }
        values.insert(name, value);
        let right = value.map(|value| value.node);
        lowered.push(LoweredEquation { variable, right, span: map.right.map.whole() });
    }
    lowered.sort_by_key(|map| map.variable);
    values
}
