use crate::declarations::{
    ComponentDeclaration, Dialect, Direction, EquationItem, PortDeclaration, Spanned, Statement,
    TransitionDeclaration, TriggerDeclaration, TypeText, VariableRole,
};
use sophy_syntax::ast::{Expression, LiteralValue};
use std::collections::{HashMap, HashSet};

/// A component of SOPHY XML as one of HSML, and what of it can only be a comment.
pub(super) fn in_words_of_hsml(component: &ComponentDeclaration) -> (ComponentDeclaration, Vec<String>) {
    let mut component = component.clone();
    component.dialect = Dialect::Hsml;
    let mut comments = Vec::new();
    units(&mut component, &mut comments);
    initial_values(&mut component);
    event_labels(&mut component);
    outputs_of_states(&mut component);
    for location in &mut component.locations {
        location.transitions =
            std::mem::take(&mut location.transitions).into_iter().flat_map(split).collect();
    }
    for (name, text) in std::mem::take(&mut component.hints) {
        comments.push(format!("hint {}: {}", name.value, text.value));
    }
    (component, comments)
}

/// Puts units to what they are units of.
fn units(component: &mut ComponentDeclaration, comments: &mut Vec<String>) {
    let mut units: HashMap<String, (Spanned<String>, bool)> = HashMap::new();
    let said = std::mem::take(&mut component.units);
    for (name, unit) in &said {
        units.entry(name.value.clone()).or_insert_with(|| (unit.clone(), false));
    }
    let mut find = |name: &Spanned<String>, place: &mut Option<Spanned<String>>| {
        if let (Some((unit, used)), None) = (units.get_mut(&name.value), &*place) {
            *used = true;
            *place = Some(unit.clone());
        }
    };
    component.variables.iter_mut().for_each(|variable| find(&variable.name, &mut variable.unit));
    component.ports.iter_mut().for_each(|port| find(&port.name, &mut port.unit));
    component.knobs.iter_mut().for_each(|knob| find(&knob.name, &mut knob.unit));
    component.parameters.iter_mut().for_each(|parameter| find(&parameter.name, &mut parameter.unit));
    for (name, unit) in said {
        if units.get(&name.value).is_none_or(|(_, used)| !used) {
            comments.push(format!("unit {}: {}", name.value, unit.value));
        }
    }
}

/// Puts the initial values of states to the states.
fn initial_values(component: &mut ComponentDeclaration) {
    let states = component.variables.iter().enumerate();
    let states = states.filter(|(_, variable)| variable.role == VariableRole::State);
    let places: HashMap<String, usize> =
        states.map(|(at, variable)| (variable.name.value.clone(), at)).collect();
    let statements = std::mem::take(&mut component.initial);
    for statement in statements {
        match statement {
            Statement::Assign { target, right } if target.indices.is_empty() => {
                let place = places.get(&target.name.value).and_then(|&at| component.variables.get_mut(at));
                match place.filter(|variable| variable.initial.is_none()) {
                    Some(variable) => variable.initial = Some(right),
                    None => component.initial.push(Statement::Assign { target, right }),
                }
            }
            other => component.initial.push(other),
        }
    }
}

/// Declares the labels that transitions wait for and emit.
fn event_labels(component: &mut ComponentDeclaration) {
    let mut known: HashSet<String> = component.ports.iter().map(|port| port.name.value.clone()).collect();
    let transitions = || component.locations.iter().flat_map(|location| &location.transitions);
    let awaited = transitions().flat_map(|transition| match &transition.trigger {
        TriggerDeclaration::On(labels, _) | TriggerDeclaration::WhenOrOn(_, labels) => labels.as_slice(),
        _ => &[],
    });
    let emitted =
        transitions().flat_map(|transition| &transition.actions).filter_map(|action| match action {
            Statement::Emit(label) => Some(label),
            _ => None,
        });
    let awaited = awaited.map(|label| (Direction::Input, label));
    let labels: Vec<_> = awaited.chain(emitted.map(|label| (Direction::Output, label))).collect();
    let mut ports = Vec::new();
    for (direction, label) in labels {
        if known.insert(label.value.clone()) {
            ports.push(PortDeclaration {
                name: label.clone(),
                documentation: String::new(),
                direction,
                kind: Some(TypeText {
                    name: Spanned::new("event".to_owned(), label.span),
                    shape: Vec::new(),
                }),
                range: None,
                unit: None,
            });
        }
    }
    component.ports.extend(ports);
}

/// Leaves out the equation `x = x` of an output that is a state.
fn outputs_of_states(component: &mut ComponentDeclaration) {
    let states: HashSet<String> =
        component.variables.iter().map(|variable| variable.name.value.clone()).collect();
    let says_nothing = |item: &EquationItem| match item {
        EquationItem::Equation(equation) => {
            let right = equation.right.expression.clone().and_then(Expression::unparenthesised);
            let name = &equation.target.name.value;
            states.contains(name)
                && matches!(right, Some(Expression::Reference(reference)) if reference.name().as_ref() == Some(name))
        }
        _ => false,
    };
    for location in &mut component.locations {
        location.equations.output.retain(|item| !says_nothing(item));
    }
}

/// A transition that waits for a condition or an event becomes two; the condition `false` alone is none.
fn split(transition: TransitionDeclaration) -> Vec<TransitionDeclaration> {
    let TriggerDeclaration::WhenOrOn(guard, labels) = transition.trigger else { return vec![transition] };
    let never = guard.as_ref().is_none_or(|guard| {
        matches!(&guard.expression, Some(Expression::Literal(literal)) if literal.value() == Some(LiteralValue::Boolean(false)))
    });
    let on = TransitionDeclaration { trigger: TriggerDeclaration::On(labels, None), ..transition };
    if never {
        return vec![on];
    }
    let when = TransitionDeclaration { trigger: TriggerDeclaration::When(guard), ..on.clone() };
    vec![when, TransitionDeclaration { documentation: String::new(), ..on }]
}
