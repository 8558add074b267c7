use super::notation::without_index;
use sophy_files::{DiagramPort, Symbol};
use sophy_ir::{Body, Class, EventPort, Quantity, Variable, VariableKind};
use std::collections::HashMap;

/// The inputs or outputs of a box; the elements of a vector share one port.
#[derive(Debug, Default)]
pub(super) struct Ports {
    pub(super) ports: Vec<DiagramPort>,
    /// Number of elements.
    extents: Vec<u32>,
    named: HashMap<(bool, String), usize>,
}

impl Ports {
    /// The inputs that a class declares.
    pub(super) fn inputs(class: &Class) -> Self {
        let mut ports = Ports::default();
        let inputs = class.variables.iter().filter(|v| matches!(v.kind, VariableKind::Input { .. }));
        inputs.for_each(|variable| ports.declare(class, variable));
        class.input_events.iter().for_each(|event| ports.declare_event(event));
        ports
    }

    /// The outputs that a class declares.
    pub(super) fn outputs(class: &Class) -> Self {
        let mut ports = Ports::default();
        let outputs = class.variables.iter().filter(|v| matches!(v.kind, VariableKind::Output));
        outputs.for_each(|variable| ports.declare(class, variable));
        class.output_events.iter().for_each(|event| ports.declare_event(event));
        ports
    }

    fn declare(&mut self, class: &Class, variable: &Variable) {
        let port = self.variable(class, variable);
        if let Some(extent) = self.extents.get_mut(port) {
            *extent += 1;
        }
    }

    fn declare_event(&mut self, event: &EventPort) {
        let port = self.event(&event.name);
        if let Some(port) = self.ports.get_mut(port) {
            port.tip.clone_from(&event.documentation);
        }
    }

    /// The port of a variable, made if it does not exist.
    pub(super) fn variable(&mut self, class: &Class, variable: &Variable) -> usize {
        let name = without_index(&variable.name);
        let key = (false, name.to_owned());
        if let Some(&known) = self.named.get(&key) {
            return known;
        }
        let unit = variable.unit.as_ref().map(|unit| format!(" [{unit}]")).unwrap_or_default();
        let port = DiagramPort {
            name: format!("{name}{unit}"),
            symbol: symbol(class, variable),
            tip: variable.documentation.clone(),
        };
        self.add(key, port)
    }

    /// The port of an event, made if it does not exist.
    pub(super) fn event(&mut self, label: &str) -> usize {
        let key = (true, label.to_owned());
        match self.named.get(&key) {
            Some(&known) => known,
            None => {
                let port = DiagramPort { name: label.to_owned(), symbol: Symbol::Event, tip: String::new() };
                self.add(key, port)
            }
        }
    }

    fn add(&mut self, key: (bool, String), port: DiagramPort) -> usize {
        self.named.insert(key, self.ports.len());
        self.ports.push(port);
        self.extents.push(0);
        self.ports.len() - 1
    }

    /// The ports, vectors with their length.
    pub(super) fn finished(mut self) -> Vec<DiagramPort> {
        for (port, extent) in self.ports.iter_mut().zip(&self.extents) {
            if *extent > 1 {
                port.name = format!("{} ({extent})", port.name);
            }
        }
        self.ports
    }
}

fn symbol(class: &Class, variable: &Variable) -> Symbol {
    let automaton = matches!(&class.body, Body::Automaton(automaton) if !automaton.logic);
    let continuous = match variable.kind {
        VariableKind::Input { continuous } => continuous,
        VariableKind::Mode(_) => false,
        _ => automaton || matches!(class.body, Body::Composite(_)),
    };
    match variable.quantity {
        Quantity::Real if continuous => Symbol::Signal,
        Quantity::Real => Symbol::Real,
        Quantity::Integer => Symbol::Integer,
        Quantity::Boolean => Symbol::Boolean,
        Quantity::Text => Symbol::Text,
    }
}
