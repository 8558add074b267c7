//! Text forms of what the stages between file and run make, for bug reports and the curious.

use sophy_analysis::{Declarations, EquationDeclaration, VariableDeclaration};
use sophy_ir::{Component, ComponentIndex, Equation, Leaf, Model, NodeId, Trigger, VariableId, VariableKind};
use std::fmt::Write;

/// What a file declares, nothing resolved yet.
pub fn declarations_text(declarations: &Declarations) -> String {
    let d = declarations;
    let mut out = Lines::default();
    out.line(0, format!("system {}", d.name.value));
    d.constants.iter().for_each(|c| out.line(1, format!("constant {} = {}", c.name.value, c.value.text)));
    for function in &d.functions {
        let parameters: Vec<&str> = function.parameters.iter().map(|p| p.value.as_str()).collect();
        let head = format!("function {}({})", function.name.value, parameters.join(", "));
        out.line(1, format!("{head} = {}", function.body.text));
    }
    for (kind, variables) in [("state", &d.states), ("input", &d.inputs), ("output", &d.outputs)] {
        variables.iter().for_each(|variable| out.line(1, declaration(kind, variable)));
    }
    d.units.iter().for_each(|(name, unit)| out.line(1, format!("unit {} {:?}", name.value, unit.value)));
    out.equations(1, "initial ", &d.initial, "=");
    if let Some(location) = &d.initial_location {
        out.line(1, format!("initial location {}", location.value));
    }
    d.hints.iter().for_each(|(name, value)| out.line(1, format!("hint {} {:?}", name.value, value.value)));
    for location in &d.locations {
        out.line(1, format!("location {}", location.name.value));
        out.equations(2, "der ", &location.dynamics, "=");
        out.equations(2, "output ", &location.outputs, "=");
        for transition in &location.transitions {
            let guard = transition.guard.as_ref().map_or("?", |guard| &guard.text);
            let name = &transition.name.value;
            out.line(2, format!("transition {name:?} when {guard} -> {}", transition.destination.value));
            out.equations(3, "", &transition.resets, ":=");
            transition.input_events.iter().for_each(|event| out.line(3, format!("on {}", event.value)));
            transition.output_events.iter().for_each(|event| out.line(3, format!("emit {}", event.value)));
        }
    }
    out.0
}

/// A checked model: names are resolved, expressions are graphs.
pub fn model_text(model: &Model) -> String {
    let mut out = Lines::default();
    out.line(0, format!("model {}", model.name));
    for (position, component) in model.components.iter().enumerate() {
        out.line(
            1,
            format!("component {}", if component.name.is_empty() { "(nameless)" } else { &component.name }),
        );
        variables(model, ComponentIndex(position as u32), &mut out);
        locations(model, component, &mut out);
    }
    for connection in &model.connections {
        let (from, to) = (model.full_name(connection.from), model.full_name(connection.to));
        out.line(1, format!("connect {from} -> {to}"));
    }
    let port = |port: &sophy_ir::Port| {
        let component = model.components.get(port.component.0 as usize);
        format!("{}.{}", component.map_or("?", |component| &component.name), port.label)
    };
    for connection in &model.event_connections {
        out.line(1, format!("connect event {} -> {}", port(&connection.from), port(&connection.to)));
    }
    out.0
}

fn variables(model: &Model, component: ComponentIndex, out: &mut Lines) {
    for id in model.variables_of(component, |_| true) {
        let variable = model.variable(id);
        let unit = variable.unit.as_ref().map(|unit| format!(" {unit:?}")).unwrap_or_default();
        let name = &variable.name;
        out.line(
            2,
            match variable.kind {
                VariableKind::Parameter(value) => format!("parameter {name} = {}{unit}", text(model, value)),
                VariableKind::State(Some(initial)) => {
                    format!("state {name} := {}{unit}", text(model, initial))
                }
                VariableKind::State(None) => format!("state {name}{unit}"),
                VariableKind::Input => format!("input {name}{unit}"),
                VariableKind::Output => format!("output {name}{unit}"),
            },
        );
    }
}

fn locations(model: &Model, component: &Component, out: &mut Lines) {
    let name = |variable: VariableId| &model.variable(variable).name;
    let equation =
        |e: &Equation, left: &str| format!("{left}{} = {}", name(e.variable), text(model, e.right));
    for (position, location) in component.locations.iter().enumerate() {
        let initial = if position == component.initial_location { " (initial)" } else { "" };
        out.line(2, format!("location {}{initial}", location.name));
        location.dynamics.iter().for_each(|e| out.line(3, equation(e, "der ")));
        location.outputs.iter().for_each(|e| out.line(3, equation(e, "output ")));
        for transition in &location.transitions {
            let trigger = match &transition.trigger {
                Trigger::When(guard) => format!("when {}", text(model, *guard)),
                Trigger::On { events, guard } => {
                    let guard =
                        guard.map(|guard| format!(" when {}", text(model, guard))).unwrap_or_default();
                    format!("on {}{guard}", events.join(", "))
                }
            };
            let to = component.locations.get(transition.destination).map_or("?", |location| &location.name);
            out.line(3, format!("transition {:?} {trigger} -> {to}", transition.name));
            for reset in &transition.resets {
                out.line(4, format!("{} := {}", name(reset.state), text(model, reset.right)));
            }
            transition.emits.iter().for_each(|label| out.line(4, format!("emit {label}")));
        }
    }
}

fn text(model: &Model, node: NodeId) -> String {
    model.graph.display(node, &|leaf| match leaf {
        Leaf::Variable(id) => model.full_name(id),
        Leaf::Time => "time".to_owned(),
        other => format!("{other:?}"),
    })
}

fn declaration(kind: &str, variable: &VariableDeclaration) -> String {
    let name = &variable.name.value;
    if variable.documentation.is_empty() {
        format!("{kind} {name}")
    } else {
        format!("{kind} {name} {:?}", variable.documentation)
    }
}

/// Indented lines.
#[derive(Default)]
struct Lines(String);

impl Lines {
    fn line(&mut self, depth: usize, text: impl AsRef<str>) {
        // Writing into a string does not fail.
        let _ = writeln!(self.0, "{}{}", "  ".repeat(depth), text.as_ref());
    }

    fn equations(&mut self, depth: usize, what: &str, equations: &[EquationDeclaration], sign: &str) {
        for equation in equations {
            self.line(depth, format!("{what}{} {sign} {}", equation.target.value, equation.right.text));
        }
    }
}

/// The flat system a run computes with.
///
/// # Errors
/// [`crate::Error::Composition`] if the model is no system.
pub fn system_text(model: &Model) -> Result<String, crate::Error> {
    Ok(sophy_passes::lower(model)?.to_string())
}
