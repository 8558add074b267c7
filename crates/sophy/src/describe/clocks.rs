use super::components::Census;
use super::quantities::Values;
use serde::Serialize;
use sophy_ir::{Body, Class, Clock, Leaf, Model, NodeId, Value, evaluate};
use std::collections::HashMap;

/// When a discrete-time component executes, or how late a logic component reacts. Times in s, of the first copy.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ClockDescription {
    /// The component.
    pub component: String,
    /// Name it was declared with.
    pub class: String,
    /// How many copies there are.
    pub copies: u64,
    /// Distance of executions, if it is periodic.
    pub period: Option<f64>,
    /// The first execution, if it is periodic and that is said.
    pub offset: Option<f64>,
    /// The variable that says when it executes, if it is not periodic.
    pub announced_by: Option<String>,
    /// From the execution to the change of the outputs.
    pub delay: Option<f64>,
    /// Smaller executes first.
    pub priority: i32,
}

pub(super) fn clocks(model: &Model, census: &Census, values: &Values<'_>) -> Vec<ClockDescription> {
    let named: HashMap<&str, f64> = values.named().collect();
    let mut clocks = Vec::new();
    for (class, of_class) in model.classes.iter().zip(&census.of_class) {
        let value = |node: &NodeId| value(class, *node, &of_class.place, &named);
        let mut clock = ClockDescription {
            component: of_class.place.clone(),
            class: class.name.clone(),
            copies: of_class.copies,
            period: None,
            offset: None,
            announced_by: None,
            delay: None,
            priority: 0,
        };
        match &class.body {
            Body::Discrete(discrete) => {
                clock.delay = discrete.delay.as_ref().and_then(value);
                clock.priority = discrete.priority;
                match &discrete.clock {
                    Clock::None => {}
                    Clock::Periodic { period, offset } => {
                        clock.period = value(period);
                        clock.offset = offset.as_ref().and_then(value);
                    }
                    Clock::Announced { next } => {
                        clock.announced_by = class.variables.get(next.0 as usize).map(|v| v.name.clone());
                    }
                }
            }
            Body::Automaton(automaton) if automaton.delay.is_some() => {
                clock.delay = automaton.delay.as_ref().and_then(value);
            }
            _ => continue,
        }
        if of_class.copies > 0 {
            clocks.push(clock);
        }
    }
    clocks
}

/// The value of an expression over the parameters of a component.
fn value(class: &Class, node: NodeId, place: &str, parameters: &HashMap<&str, f64>) -> Option<f64> {
    let mut leaf = |leaf: Leaf| {
        let name = match leaf {
            Leaf::Variable(id) => class.variables.get(id.0 as usize).map(|variable| variable.name.as_str()),
            _ => None,
        };
        let value = name.and_then(|name| {
            let full = if place.is_empty() { name.to_owned() } else { format!("{place}.{name}") };
            parameters.get(full.as_str()).copied()
        });
        Value::Real(value.unwrap_or(f64::NAN))
    };
    Some(evaluate(&class.graph, node, &mut leaf).real()).filter(|value| value.is_finite())
}
