use sophy_ir::{
    Binary, Comparison, Component, ComponentIndex, Connection, Equation, EventConnection, Graph, Leaf,
    Location, Model, NodeId, Port, Reset, Transition, Trigger, Unary, Variable, VariableId, VariableKind,
};

/// Builds a [`Model`] by hand.
#[derive(Debug, Default)]
pub struct Build {
    /// The model so far.
    pub model: Model,
}

/// A location being built: component and position.
#[derive(Clone, Copy, Debug)]
pub struct Place {
    component: usize,
    location: usize,
}

impl Build {
    /// Begins a component; a nameless one is a model of its own.
    pub fn component(&mut self, name: &str) -> usize {
        self.model.components.push(Component { name: name.to_owned(), ..Component::default() });
        self.model.components.len() - 1
    }

    fn variable(&mut self, name: &str, kind: VariableKind) -> VariableId {
        let component = ComponentIndex(self.model.components.len() as u32 - 1);
        self.model.variables.push(Variable {
            name: name.to_owned(),
            component,
            kind,
            unit: None,
            documentation: String::new(),
            span: None,
        });
        VariableId(self.model.variables.len() as u32 - 1)
    }

    /// A reference to a variable.
    pub fn read(&mut self, id: VariableId) -> NodeId {
        self.model.graph.leaf(Leaf::Variable(id))
    }

    /// A state of the component begun last.
    pub fn state(&mut self, name: &str, initial: f64) -> VariableId {
        let initial = self.number(initial);
        self.variable(name, VariableKind::State(Some(initial)))
    }

    /// A parameter.
    pub fn parameter(&mut self, name: &str, value: f64) -> NodeId {
        let value = self.number(value);
        let id = self.variable(name, VariableKind::Parameter(value));
        self.read(id)
    }

    /// An input.
    pub fn input(&mut self, name: &str) -> VariableId {
        self.variable(name, VariableKind::Input)
    }

    /// An output; give it a value in every location.
    pub fn output(&mut self, name: &str) -> VariableId {
        self.variable(name, VariableKind::Output)
    }

    /// A location of the component begun last.
    pub fn location(&mut self, name: &str) -> Place {
        let component = self.model.components.len() - 1;
        let locations = &mut self.model.components[component].locations;
        locations.push(Location { name: name.to_owned(), ..Location::default() });
        Place { component, location: locations.len() - 1 }
    }

    fn at(&mut self, place: Place) -> &mut Location {
        &mut self.model.components[place.component].locations[place.location]
    }

    /// `der(state) = right` in a location.
    pub fn rate(&mut self, place: Place, state: VariableId, right: NodeId) {
        self.at(place).dynamics.push(Equation { variable: state, right, span: None });
    }

    /// `output = right` in a location.
    pub fn value(&mut self, place: Place, output: VariableId, right: NodeId) {
        self.at(place).outputs.push(Equation { variable: output, right, span: None });
    }

    /// `transition name when guard goto to do resets`.
    pub fn when(
        &mut self,
        from: Place,
        name: &str,
        guard: NodeId,
        to: Place,
        resets: &[(VariableId, NodeId)],
    ) {
        self.transition(from, name, Trigger::When(guard), to, resets);
    }

    /// `transition name on event goto to do resets`.
    pub fn on(&mut self, from: Place, event: &str, to: Place, resets: &[(VariableId, NodeId)]) {
        let events = &mut self.model.components[from.component].input_events;
        if !events.iter().any(|e| e == event) {
            events.push(event.to_owned());
        }
        let trigger = Trigger::On { events: vec![event.to_owned()], guard: None };
        self.transition(from, event, trigger, to, resets);
    }

    fn transition(
        &mut self,
        from: Place,
        name: &str,
        trigger: Trigger,
        to: Place,
        resets: &[(VariableId, NodeId)],
    ) {
        let resets = resets.iter().map(|&(state, right)| Reset { state, right, span: None }).collect();
        self.at(from).transitions.push(Transition {
            name: name.to_owned(),
            documentation: String::new(),
            span: None,
            trigger,
            destination: to.location,
            resets,
            emits: Vec::new(),
            priority: 0,
        });
    }

    /// The transition written last at a place emits `label`.
    pub fn emit(&mut self, from: Place, label: &str) {
        if let Some(transition) = self.at(from).transitions.last_mut() {
            transition.emits.push(label.to_owned());
        }
        let events = &mut self.model.components[from.component].output_events;
        if !events.iter().any(|e| e == label) {
            events.push(label.to_owned());
        }
    }

    /// A signal connection.
    pub fn connect(&mut self, from: VariableId, to: VariableId) {
        self.model.connections.push(Connection { from, to });
    }

    /// An event connection.
    pub fn connect_event(&mut self, from: (usize, &str), to: (usize, &str)) {
        let port = |(component, label): (usize, &str)| Port {
            component: ComponentIndex(component as u32),
            label: label.to_owned(),
        };
        self.model.event_connections.push(EventConnection { from: port(from), to: port(to) });
    }

    /// A number.
    pub fn number(&mut self, value: f64) -> NodeId {
        self.model.graph.number(value)
    }

    /// Simulated time.
    pub fn time(&mut self) -> NodeId {
        self.model.graph.leaf(Leaf::Time)
    }

    /// A function of one number.
    pub fn unary(&mut self, function: Unary, a: NodeId) -> NodeId {
        self.model.graph.unary(function, a)
    }

    /// A function of two numbers.
    pub fn binary(&mut self, function: Binary, a: NodeId, b: NodeId) -> NodeId {
        self.model.graph.binary(function, a, b)
    }

    /// `a + b`.
    pub fn add(&mut self, a: NodeId, b: NodeId) -> NodeId {
        self.model.graph.add(a, b)
    }

    /// `a − b`.
    pub fn sub(&mut self, a: NodeId, b: NodeId) -> NodeId {
        self.model.graph.subtract(a, b)
    }

    /// `a·b`.
    pub fn mul(&mut self, a: NodeId, b: NodeId) -> NodeId {
        self.model.graph.multiply(a, b)
    }

    /// `a/b`.
    pub fn div(&mut self, a: NodeId, b: NodeId) -> NodeId {
        self.model.graph.divide(a, b)
    }

    /// `a > b`.
    pub fn greater(&mut self, a: NodeId, b: NodeId) -> NodeId {
        self.model.graph.compare(Comparison::Greater, a, b)
    }

    /// `a < b`.
    pub fn less(&mut self, a: NodeId, b: NodeId) -> NodeId {
        self.model.graph.compare(Comparison::Less, a, b)
    }

    /// Any comparison.
    pub fn compare(&mut self, comparison: Comparison, a: NodeId, b: NodeId) -> NodeId {
        self.model.graph.compare(comparison, a, b)
    }

    /// The graph, for everything else.
    pub fn graph(&mut self) -> &mut Graph {
        &mut self.model.graph
    }
}
