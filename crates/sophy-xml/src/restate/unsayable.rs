use super::complaints::Complaints;
use super::is_event;
use crate::hints::is_identifier;
use sophy_analysis::{
    ClockDeclaration, ComponentDeclaration, Dialect, Direction, Equations, ExpressionText,
    FunctionDeclaration, LocationDeclaration, ParameterDeclaration, PortDeclaration, RangeText, Spanned,
    TypeText, VariableDeclaration, VariableRole,
};
use sophy_diagnostics::Span;
use sophy_syntax::ast::{Expression, LiteralValue};
use std::collections::HashMap;

/// Complains about the parts that SOPHY XML has no words for, other than equations, transitions and expressions.
pub(super) fn refuse(
    component: &ComponentDeclaration,
    functions: &[FunctionDeclaration],
    constants: &[ParameterDeclaration],
    complaints: &mut Complaints,
) {
    sections(component, complaints);
    component.ports.iter().for_each(|port| refuse_port(port, complaints));
    component.variables.iter().for_each(|variable| refuse_variable(variable, complaints));
    component.locations.iter().for_each(|location| refuse_location(location, complaints));
    constraints(&component.equations, complaints);
    functions.iter().for_each(|function| refuse_function(function, complaints));
    refuse_views(component, complaints);
    hidden_constants(component, constants, complaints);
    if component.dialect == Dialect::Hsml {
        names(component, constants).for_each(|name| refuse_name(name, complaints));
    }
}

fn sections(component: &ComponentDeclaration, complaints: &mut Complaints) {
    if let Some(clock) = &component.clock {
        let span = match clock {
            ClockDeclaration::Announced { name, .. } => name.span,
            ClockDeclaration::Every { span, .. } => *span,
        };
        complaints.cannot(span, "SOPHY XML has no execution times", "only a DTC has them");
    }
    if let Some(delay) = &component.delay {
        complaints.cannot(delay.span, "SOPHY XML has no delays of execution", "only DTC and LBC have them");
    }
    if let Some(priority) = &component.priority {
        complaints.cannot(priority.span, "SOPHY XML has no priorities", "delete the priority");
    }
    if let Some(event) = component.events.first() {
        let way_out = "write a location for each sign of the flag, with transitions between them";
        complaints.cannot(event.flag.span, "SOPHY XML has no event sections", way_out);
    }
    if let Some(rule) = component.rules.first() {
        let way_out = "write locations with transitions, or keep the component in HSML";
        complaints.cannot(rule.span, "SOPHY XML has no rules", way_out);
    }
}

fn refuse_port(port: &PortDeclaration, complaints: &mut Complaints) {
    let name = &port.name.value;
    if port.direction == Direction::Synchronised {
        let message = format!("SOPHY XML has no transitions taken together, as those labelled `{name}`");
        return complaints.cannot(port.name.span, message, "delete the label");
    }
    let known = if is_event(port) { &["event"][..] } else { &["signal"] };
    refuse_type(name, port.kind.as_ref(), known, "signal", complaints);
    refuse_range(name, port.range.as_ref(), port.name.span, complaints);
}

fn refuse_variable(variable: &VariableDeclaration, complaints: &mut Complaints) {
    let name = &variable.name.value;
    match variable.role {
        VariableRole::State => {
            refuse_type(name, variable.kind.as_ref(), &["signal", "real"], "real", complaints);
        }
        VariableRole::Mode => {
            refuse_type(name, variable.kind.as_ref(), &["signal", "real"], "real", complaints);
            if let (None, Some(initial)) = (&variable.kind, &variable.initial)
                && !is_number(initial)
            {
                let message = format!("SOPHY XML has no modes that are not real, as `{name}` is");
                complaints.cannot(variable.name.span, message, "write a location for each of its values");
            }
        }
        VariableRole::Local => {
            let known = ["signal", "real", "boolean"];
            refuse_type(name, variable.kind.as_ref(), &known, "real", complaints);
        }
        VariableRole::Flag => {
            let message = format!("SOPHY XML has no flags, as `{name}` is");
            complaints.cannot(variable.name.span, message, "write its sign as the guards of transitions");
        }
    }
    refuse_range(name, variable.range.as_ref(), variable.name.span, complaints);
}

fn is_number(expression: &ExpressionText) -> bool {
    match &expression.expression {
        Some(Expression::Literal(literal)) => matches!(literal.value(), Some(LiteralValue::Number(_))),
        _ => true,
    }
}

fn refuse_type(name: &str, kind: Option<&TypeText>, known: &[&str], best: &str, complaints: &mut Complaints) {
    let Some(kind) = kind else { return };
    let span = kind.name.span;
    if !known.contains(&kind.name.value.as_str()) {
        let message = format!("SOPHY XML has real numbers only, and `{name}` is {}", kind.name.value);
        complaints.cannot(span, message, format!("make it {best}, or keep the component in HSML"));
    }
    if !kind.shape.is_empty() {
        let message = format!("SOPHY XML has no vectors, as `{name}` is");
        complaints.cannot(span, message, "write its elements as variables of their own");
    }
}

fn refuse_range(name: &str, range: Option<&RangeText>, span: Span, complaints: &mut Complaints) {
    if range.is_some() {
        let message = format!("SOPHY XML has no ranges, as `{name}` has");
        complaints.cannot(span, message, "delete the range; its bounds could be guards of transitions");
    }
}

fn refuse_location(location: &LocationDeclaration, complaints: &mut Complaints) {
    if let Some(invariant) = &location.invariant {
        complaints.cannot(
            invariant.span,
            "SOPHY XML has no invariants",
            "write a transition `when not (…)` instead",
        );
    }
    for variable in &location.variables {
        let name = &variable.name.value;
        if variable.role == VariableRole::Local {
            refuse_variable(variable, complaints);
        } else {
            let message = format!("SOPHY XML has no variables of one location, as `{name}` is");
            complaints.cannot(variable.name.span, message, "declare it in the body");
        }
    }
    constraints(&location.equations, complaints);
}

fn constraints(equations: &Equations, complaints: &mut Complaints) {
    if let Some(constraint) = equations.constraints.first() {
        let way_out = "solve them for the variables, or keep the component in HSML";
        complaints.cannot(constraint.left.span, "SOPHY XML has no constraints", way_out);
    }
}

fn refuse_function(function: &FunctionDeclaration, complaints: &mut Complaints) {
    let types = function.parameters.iter().map(|(name, kind)| (name, kind.as_ref()));
    for (name, kind) in types.chain([(&function.name, function.result.as_ref())]) {
        refuse_type(&name.value, kind, &["real", "signal", "boolean"], "real", complaints);
        if !is_identifier(&name.value) {
            let message = format!("SOPHY XML has no quoted names in functions, as `{}` is", name.value);
            complaints.cannot(name.span, message, "choose a name of letters, digits and `_`");
        }
    }
}

/// A view of a local that will not be there.
fn refuse_views(component: &ComponentDeclaration, complaints: &mut Complaints) {
    let names = super::Names::of(component);
    for view in component.views.iter().filter(|view| names.locals.contains(view.value.as_str())) {
        let message = format!("SOPHY XML has no locals, and `{}` is to be viewed", view.value);
        complaints.cannot(view.span, message, "make it an output");
    }
}

/// In SOPHY XML a constant of the file is one of the component, and cannot be hidden.
fn hidden_constants(
    component: &ComponentDeclaration,
    constants: &[ParameterDeclaration],
    complaints: &mut Complaints,
) {
    if constants.is_empty() {
        return;
    }
    let own: HashMap<&str, Span> =
        names(component, &[]).map(|name| (name.value.as_str(), name.span)).collect();
    for constant in constants {
        let name = constant.name.value.as_str();
        if let Some(span) = own.get(name) {
            let message = format!(
                "`{name}` hides a constant of the file, and SOPHY XML has no files around components"
            );
            complaints.cannot(*span, message, "rename one of the two");
        }
    }
}

/// Names of everything that has a value.
fn names<'c>(
    component: &'c ComponentDeclaration,
    constants: &'c [ParameterDeclaration],
) -> impl Iterator<Item = &'c Spanned<String>> {
    let parameters = component.parameters.iter().chain(constants).map(|parameter| &parameter.name);
    let ports = component.ports.iter().map(|port| &port.name);
    parameters.chain(ports).chain(component.variables.iter().map(|variable| &variable.name))
}

/// Names that would be read as something else.
fn refuse_name(name: &Spanned<String>, complaints: &mut Complaints) {
    if name.value == "location" {
        let message = "in a hint of SOPHY XML, `location` is the first location";
        complaints.cannot(name.span, message, "choose another name");
    } else if name.value.trim() != name.value {
        let message = format!("SOPHY XML has no blanks at the ends of names, as `{}` has", name.value);
        complaints.cannot(name.span, message, "delete them");
    }
}
