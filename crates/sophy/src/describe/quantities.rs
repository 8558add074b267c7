use serde::Serialize;
use sophy_ir::{Allowed, Declared, Leaf, Model, NodeId, Origin, System, Value, Variable, evaluate};

/// A named quantity.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Quantity {
    /// Full name.
    pub name: String,
    /// Unit as written.
    pub unit: Option<String>,
    /// Value (initial value of a state), where the model gives one; of a string, its number among the model's texts.
    pub value: Option<f64>,
    /// The value of a string or truth value, as it is written.
    pub text: Option<String>,
    /// Least and greatest value, where they were declared, as text.
    pub range: Option<[String; 2]>,
    /// Texts or numbers it can have, where they were declared, as they are written.
    pub choices: Vec<String>,
    /// Whether it is a parameter of the interface.
    pub knob: bool,
    /// Whether it is a parameter that decides the structure of the model, so that a run cannot change it.
    pub structural: bool,
    /// What it means, in the author's words.
    pub documentation: String,
}

/// The values of parameters, and what is said of quantities where they are declared.
pub(super) struct Values<'a> {
    model: &'a Model,
    system: &'a System,
    parameters: Vec<f64>,
}

impl<'a> Values<'a> {
    pub(super) fn new(model: &'a Model, system: &'a System) -> Self {
        let mut values = Values { model, system, parameters: Vec::with_capacity(system.parameters.len()) };
        for parameter in &system.parameters {
            values.parameters.push(values.of(parameter.value));
        }
        values
    }

    pub(super) fn state(&self, state: &sophy_ir::State) -> Quantity {
        let initial = state.initial.map(|node| self.of(node));
        self.declared(state.name(self.system), &state.declared, initial)
    }

    pub(super) fn input(&self, input: &sophy_ir::Input) -> Quantity {
        self.declared(input.name(self.system), &input.declared, None)
    }

    pub(super) fn output(&self, output: &sophy_ir::Output) -> Quantity {
        self.declared(output.name(self.system), &output.declared, None)
    }

    fn declared(&self, name: String, declared: &Declared, value: Option<f64>) -> Quantity {
        self.quantity(&name, declared.unit.as_ref(), declared.origin, value)
    }

    pub(super) fn constants(&self) -> Vec<Quantity> {
        let described = self.system.parameters.iter().zip(&self.parameters).map(|(parameter, &value)| {
            let quantity =
                self.quantity(&parameter.name, parameter.unit.as_ref(), parameter.origin, Some(value));
            Quantity { knob: parameter.knob, structural: parameter.structural, ..quantity }
        });
        described.collect()
    }

    /// Names and values of all parameters.
    pub(super) fn named(&self) -> impl Iterator<Item = (&str, f64)> {
        self.system.parameters.iter().map(|p| p.name.as_str()).zip(self.parameters.iter().copied())
    }

    /// The value of an expression over parameters.
    fn of(&self, node: NodeId) -> f64 {
        let mut leaf = |leaf: Leaf| {
            Value::Real(match leaf {
                Leaf::Parameter(index) => self.parameters.get(index.position()).copied().unwrap_or(f64::NAN),
                _ => f64::NAN,
            })
        };
        evaluate(&self.system.graph, node, &mut leaf).real()
    }

    fn quantity(&self, name: &str, unit: Option<&String>, origin: Origin, value: Option<f64>) -> Quantity {
        let class = self.model.classes.get(origin.class.0 as usize);
        let declared = class.and_then(|class| class.variables.get(origin.variable.0 as usize));
        let value = value.filter(|value| value.is_finite());
        let allowed = declared.and_then(|variable| variable.range.as_ref());
        let text = |number: &usize| format!("{:?}", self.model.texts.get(*number).map_or("", String::as_str));
        Quantity {
            name: name.to_owned(),
            unit: unit.cloned(),
            value,
            text: declared.zip(value).and_then(|(variable, value)| self.text(variable, value)),
            range: match (allowed, class) {
                (Some(Allowed::Between(bounds)), Some(class)) => {
                    let real = sophy_ir::Quantity::Real;
                    Some(bounds.map(|bound| class.written(bound, real, &self.model.texts)))
                }
                _ => None,
            },
            choices: match allowed {
                Some(Allowed::OneOf(numbers)) => numbers.iter().map(f64::to_string).collect(),
                _ => declared.map(|variable| variable.choices.iter().map(text).collect()).unwrap_or_default(),
            },
            knob: false,
            structural: false,
            documentation: declared.map(|variable| variable.documentation.clone()).unwrap_or_default(),
        }
    }

    fn text(&self, variable: &Variable, value: f64) -> Option<String> {
        match variable.quantity {
            sophy_ir::Quantity::Boolean => Some((value != 0.0).to_string()),
            sophy_ir::Quantity::Text => self.model.texts.get(value as usize).map(|text| format!("{text:?}")),
            _ => None,
        }
    }
}
