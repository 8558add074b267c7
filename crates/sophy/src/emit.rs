//! Text forms of what the stages between file and run make, for bug reports and the curious.

use sophy_analysis::{Declarations, EquationDeclaration, VariableDeclaration};
use sophy_ir::Model;
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
    model.to_string()
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
