//! The text form of a model (`--emit model`).

use crate::model::{Component, ComponentIndex, Model, Transition, Trigger, VariableKind};
use crate::{Leaf, NodeId};
use std::fmt;

impl Model {
    /// An expression in the notation of the language.
    pub fn text(&self, node: NodeId) -> String {
        self.graph.display(node, &|leaf| match leaf {
            Leaf::Variable(id) => self.full_name(id),
            Leaf::Time => "time".to_owned(),
            other => format!("{other:?}"),
        })
    }
}

impl fmt::Display for Model {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "model {}", self.name)?;
        for (index, component) in self.components.iter().enumerate() {
            if !component.name.is_empty() {
                writeln!(f, "component {}", component.name)?;
            }
            self.write_variables(f, ComponentIndex(index as u32))?;
            self.write_locations(f, component)?;
        }
        for c in &self.connections {
            writeln!(f, "connect {} -> {}", self.full_name(c.from), self.full_name(c.to))?;
        }
        for c in &self.event_connections {
            let name = |port: &crate::Port| {
                format!("{}.{}", self.components[port.component.0 as usize].name, port.label)
            };
            writeln!(f, "connect event {} -> {}", name(&c.from), name(&c.to))?;
        }
        Ok(())
    }
}

impl Model {
    fn write_variables(&self, f: &mut fmt::Formatter<'_>, component: ComponentIndex) -> fmt::Result {
        for id in self.variables_of(component, |_| true) {
            let variable = self.variable(id);
            let unit = variable.unit.as_ref().map(|u| format!(" \"{u}\"")).unwrap_or_default();
            let name = &variable.name;
            match variable.kind {
                VariableKind::Parameter(value) => {
                    writeln!(f, "  constant {name} = {}{unit}", self.text(value))?;
                }
                VariableKind::State(Some(initial)) => {
                    writeln!(f, "  state {name} := {}{unit}", self.text(initial))?;
                }
                VariableKind::State(None) => writeln!(f, "  state {name}{unit}")?,
                VariableKind::Input => writeln!(f, "  input {name}{unit}")?,
                VariableKind::Output => writeln!(f, "  output {name}{unit}")?,
            }
        }
        Ok(())
    }

    fn write_locations(&self, f: &mut fmt::Formatter<'_>, component: &Component) -> fmt::Result {
        for (position, location) in component.locations.iter().enumerate() {
            let initial = if position == component.initial_location { " (initial)" } else { "" };
            writeln!(f, "  location {}{initial}", location.name)?;
            for equation in &location.dynamics {
                let state = &self.variable(equation.variable).name;
                writeln!(f, "    der({state}) = {}", self.text(equation.right))?;
            }
            for equation in &location.outputs {
                let output = &self.variable(equation.variable).name;
                writeln!(f, "    {output} = {}", self.text(equation.right))?;
            }
            for transition in &location.transitions {
                self.write_transition(f, component, transition)?;
            }
        }
        Ok(())
    }

    fn write_transition(
        &self,
        f: &mut fmt::Formatter<'_>,
        component: &Component,
        transition: &Transition,
    ) -> fmt::Result {
        let trigger = match &transition.trigger {
            Trigger::When(guard) => format!("when {}", self.text(*guard)),
            Trigger::On { events, guard } => {
                let guard = guard.map(|g| format!(" when {}", self.text(g))).unwrap_or_default();
                format!("on {}{guard}", events.join(", "))
            }
        };
        let to = &component.locations[transition.destination].name;
        writeln!(f, "    transition {} {trigger} goto {to}", transition.name)?;
        for reset in &transition.resets {
            let state = &self.variable(reset.state).name;
            writeln!(f, "      {state} := {}", self.text(reset.right))?;
        }
        for label in &transition.emits {
            writeln!(f, "      emit {label}")?;
        }
        Ok(())
    }
}
