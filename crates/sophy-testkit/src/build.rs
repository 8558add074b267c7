use sophy_ir::{
    Actions, Assignment, Binary, Body, Class, ClassIndex, Comparison, Composite, Emission, Equation,
    EventEnd, EventPort, EventSection, EventWire, Graph, HybridAutomaton, Leaf, Location, Member, Model,
    NodeId, Port, Quantity, Sources, Special, Table, Transition, Trigger, Unary, Variable, VariableId,
    VariableKind, Wire,
};

/// Builds a [`Model`] by hand: components side by side, all expressions in one graph, variables numbered
/// through. [`Build::model`] makes one class of each component.
#[derive(Debug, Default)]
pub struct Build {
    graph: Graph,
    /// The component of each variable, and the variable there.
    variables: Vec<(usize, VariableId)>,
    classes: Vec<Class>,
    /// What each class does.
    automata: Vec<HybridAutomaton>,
    /// What else expressions read, with its component.
    specials: Vec<(usize, Special)>,
    tables: Vec<Table>,
    wires: Vec<(VariableId, VariableId)>,
    event_wires: Vec<((usize, String), (usize, String))>,
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
        self.classes.push(Class { name: name.to_owned(), ..Class::default() });
        self.automata.push(HybridAutomaton::default());
        self.classes.len() - 1
    }

    /// The model so far.
    ///
    /// # Panics
    /// When an expression of a component reads a variable of another one.
    pub fn model(&self) -> Model {
        let mut classes: Vec<Class> = self.classes.clone();
        for (component, class) in classes.iter_mut().enumerate() {
            self.split(component, class);
        }
        if let [only] = classes.as_slice()
            && only.name.is_empty()
        {
            return Model { classes, tables: self.tables.clone(), ..Model::default() };
        }
        let mut composite = Composite::default();
        for (position, class) in classes.iter().enumerate() {
            composite.members.push(Member {
                name: class.name.clone(),
                class: ClassIndex(position as u32),
                extents: Vec::new(),
                element: Vec::new(),
                parameters: Vec::new(),
                documentation: String::new(),
                span: None,
            });
        }
        for &(from, to) in &self.wires {
            let from = Sources::One(self.port(from));
            composite.wires.push(Wire { to: self.port(to), from, span: None });
        }
        for (from, to) in &self.event_wires {
            let end = |(component, label): &(usize, String)| EventEnd {
                member: Some(*component as u32),
                copy: 0,
                label: label.as_str().into(),
            };
            composite.event_wires.push(EventWire {
                from: end(from),
                to: end(to),
                synchronised: false,
                span: None,
            });
        }
        let root = ClassIndex(classes.len() as u32);
        classes.push(Class { body: Body::Composite(composite), ..Class::default() });
        Model { classes, root, tables: self.tables.clone(), ..Model::default() }
    }

    fn port(&self, id: VariableId) -> Port {
        let (component, variable) = self.variables[id.0 as usize];
        Port { member: Some(component as u32), copy: 0, variable }
    }

    /// Moves the expressions of a component from the common graph to its own.
    fn split(&self, component: usize, class: &mut Class) {
        let mut graph = Graph::default();
        let mut node = |node: &mut NodeId| {
            *node = graph.import(&self.graph, *node, &mut |graph: &mut Graph, leaf| match leaf {
                Leaf::Variable(id) => {
                    let (of, variable) = self.variables[id.0 as usize];
                    assert_eq!(of, component, "an expression reads a variable of another component");
                    graph.leaf(Leaf::Variable(variable))
                }
                other => graph.leaf(other),
            });
        };
        for (of, special) in &self.specials {
            // Numbered through, as the leaves are: others have a place, but nothing in it.
            let mut special = if *of == component { special.clone() } else { Special::Never };
            if let Special::Smooth(inside) | Special::Table { at: inside, .. } = &mut special {
                node(inside);
            }
            class.specials.push(special);
        }
        let local = |id: &mut VariableId| *id = self.variables[id.0 as usize].1;
        for variable in &mut class.variables {
            match &mut variable.kind {
                VariableKind::Parameter { value, .. } => node(value),
                VariableKind::State(Some(value)) | VariableKind::Mode(Some(value)) => node(value),
                _ => {}
            }
        }
        let mut automaton = self.automata[component].clone();
        let mut actions: Vec<&mut Actions> = Vec::new();
        for location in &mut automaton.locations {
            for equation in location.dynamics.iter_mut().chain(&mut location.values) {
                local(&mut equation.variable);
                node(&mut equation.right);
            }
            for transition in &mut location.transitions {
                match &mut transition.trigger {
                    Trigger::When(guard) => node(guard),
                    Trigger::On { guard, .. } => guard.iter_mut().for_each(&mut node),
                    _ => {}
                }
                actions.push(&mut transition.actions);
            }
        }
        for section in &mut automaton.events {
            local(&mut section.flag);
            actions.extend(section.rising.iter_mut().chain(&mut section.falling));
        }
        let assignments = actions.iter_mut().flat_map(|actions| actions.assignments.iter_mut());
        for assignment in assignments.chain(&mut automaton.initial) {
            local(&mut assignment.variable);
            node(&mut assignment.right);
        }
        for emission in actions.iter_mut().flat_map(|actions| actions.emissions.iter_mut()) {
            emission.when.iter_mut().for_each(&mut node);
        }
        class.graph = graph;
        class.body = Body::Automaton(automaton);
    }

    fn variable(&mut self, name: &str, kind: VariableKind) -> VariableId {
        let component = self.classes.len() - 1;
        let variables = &mut self.classes[component].variables;
        variables.push(Variable {
            name: name.to_owned(),
            kind,
            quantity: Quantity::Real,
            range: None,
            choices: Vec::new(),
            viewed: false,
            structural: false,
            unit: None,
            documentation: String::new(),
            span: None,
        });
        self.variables.push((component, VariableId(variables.len() as u32 - 1)));
        VariableId(self.variables.len() as u32 - 1)
    }

    /// A reference to a variable.
    pub fn read(&mut self, id: VariableId) -> NodeId {
        self.graph.leaf(Leaf::Variable(id))
    }

    /// A state of the component begun last.
    pub fn state(&mut self, name: &str, initial: f64) -> VariableId {
        let initial = self.number(initial);
        self.variable(name, VariableKind::State(Some(initial)))
    }

    /// A mode of the component begun last.
    pub fn mode(&mut self, name: &str, initial: Option<f64>) -> VariableId {
        let initial = initial.map(|initial| self.number(initial));
        self.variable(name, VariableKind::Mode(initial))
    }

    /// A parameter.
    pub fn parameter(&mut self, name: &str, value: f64) -> NodeId {
        let value = self.number(value);
        let id = self.variable(name, VariableKind::Parameter { value, knob: false });
        self.read(id)
    }

    /// Gives the parameter that `reads` refers to another value.
    pub fn define_parameter(&mut self, reads: NodeId, value: NodeId) {
        if let sophy_ir::Node::Leaf(Leaf::Variable(id)) = self.graph.node(reads) {
            let (component, variable) = self.variables[id.0 as usize];
            let kind = VariableKind::Parameter { value, knob: false };
            self.classes[component].variables[variable.0 as usize].kind = kind;
        }
    }

    /// An input.
    pub fn input(&mut self, name: &str) -> VariableId {
        self.variable(name, VariableKind::Input { continuous: true })
    }

    /// An output; give it a value in every location.
    pub fn output(&mut self, name: &str) -> VariableId {
        self.variable(name, VariableKind::Output)
    }

    /// A flag; give it a value in every location.
    pub fn flag(&mut self, name: &str) -> VariableId {
        self.variable(name, VariableKind::Flag)
    }

    /// A location of the component begun last.
    pub fn location(&mut self, name: &str) -> Place {
        let component = self.classes.len() - 1;
        let locations = &mut self.automata[component].locations;
        locations.push(Location { name: name.to_owned(), ..Location::default() });
        let location = locations.len() - 1;
        Place { component, location }
    }

    fn at(&mut self, place: Place) -> &mut Location {
        &mut self.automata[place.component].locations[place.location]
    }

    /// `der(state) = right` in a location.
    pub fn rate(&mut self, place: Place, state: VariableId, right: NodeId) {
        self.at(place).dynamics.push(Equation { variable: state, right, span: None });
    }

    /// `output = right` in a location.
    pub fn value(&mut self, place: Place, output: VariableId, right: NodeId) {
        self.at(place).values.push(Equation { variable: output, right, span: None });
    }

    /// `initial variable := right` of the component begun last.
    pub fn initial(&mut self, variable: VariableId, right: NodeId) {
        let component = self.classes.len() - 1;
        self.automata[component].initial.push(Assignment { variable, right, span: None });
    }

    /// `event(flag)` of the component begun last: what is assigned in each direction, `None` for one without
    /// a section.
    pub fn event(
        &mut self,
        flag: VariableId,
        priority: i32,
        rising: Option<&[(VariableId, NodeId)]>,
        falling: Option<&[(VariableId, NodeId)]>,
    ) {
        let component = self.classes.len() - 1;
        let section = EventSection {
            flag,
            priority,
            rising: rising.map(actions),
            falling: falling.map(actions),
            span: None,
        };
        self.automata[component].events.push(section);
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
        declare(&mut self.classes[from.component].input_events, event);
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
        self.at(from).transitions.push(Transition {
            name: name.into(),
            documentation: String::new(),
            span: None,
            trigger,
            destination: to.location,
            actions: actions(resets),
            priority: 0,
        });
    }

    /// The transition written last at a place gets a priority.
    pub fn priority(&mut self, from: Place, priority: i32) {
        if let Some(transition) = self.at(from).transitions.last_mut() {
            transition.priority = priority;
        }
    }

    /// The transition written last at a place emits `label`.
    pub fn emit(&mut self, from: Place, label: &str) {
        self.emit_if(from, label, None);
    }

    /// The same, only if a condition holds.
    pub fn emit_if(&mut self, from: Place, label: &str, when: Option<NodeId>) {
        if let Some(transition) = self.at(from).transitions.last_mut() {
            transition.actions.emissions.push(Emission { label: label.into(), when });
        }
        declare(&mut self.classes[from.component].output_events, label);
    }

    /// A signal connection.
    pub fn connect(&mut self, from: VariableId, to: VariableId) {
        self.wires.push((from, to));
    }

    /// An event connection.
    pub fn connect_event(&mut self, from: (usize, &str), to: (usize, &str)) {
        self.event_wires.push(((from.0, from.1.to_owned()), (to.0, to.1.to_owned())));
    }

    /// A number.
    pub fn number(&mut self, value: f64) -> NodeId {
        self.graph.number(value)
    }

    /// Simulated time.
    pub fn time(&mut self) -> NodeId {
        self.graph.leaf(Leaf::Time)
    }

    /// A function of one number.
    pub fn unary(&mut self, function: Unary, a: NodeId) -> NodeId {
        self.graph.unary(function, a)
    }

    /// A function of two numbers.
    pub fn binary(&mut self, function: Binary, a: NodeId, b: NodeId) -> NodeId {
        self.graph.binary(function, a, b)
    }

    /// `smooth(a)` in the component begun last.
    pub fn smooth(&mut self, a: NodeId) -> NodeId {
        self.special(Special::Smooth(a))
    }

    /// A table at a point, in the component begun last.
    pub fn table(&mut self, table: &Table, at: NodeId) -> NodeId {
        let known = self.tables.iter().position(|known| known == table);
        let number = known.unwrap_or_else(|| {
            self.tables.push(table.clone());
            self.tables.len() - 1
        });
        self.special(Special::Table { table: number, at })
    }

    fn special(&mut self, special: Special) -> NodeId {
        self.specials.push((self.classes.len() - 1, special));
        self.graph.leaf(Leaf::Special(self.specials.len() as u32 - 1))
    }

    /// `a + b`.
    pub fn add(&mut self, a: NodeId, b: NodeId) -> NodeId {
        self.graph.add(a, b)
    }

    /// `a − b`.
    pub fn sub(&mut self, a: NodeId, b: NodeId) -> NodeId {
        self.graph.subtract(a, b)
    }

    /// `a·b`.
    pub fn mul(&mut self, a: NodeId, b: NodeId) -> NodeId {
        self.graph.multiply(a, b)
    }

    /// `a/b`.
    pub fn div(&mut self, a: NodeId, b: NodeId) -> NodeId {
        self.graph.divide(a, b)
    }

    /// `a > b`.
    pub fn greater(&mut self, a: NodeId, b: NodeId) -> NodeId {
        self.graph.compare(Comparison::Greater, a, b)
    }

    /// `a < b`.
    pub fn less(&mut self, a: NodeId, b: NodeId) -> NodeId {
        self.graph.compare(Comparison::Less, a, b)
    }

    /// Any comparison.
    pub fn compare(&mut self, comparison: Comparison, a: NodeId, b: NodeId) -> NodeId {
        self.graph.compare(comparison, a, b)
    }

    /// The graph, for everything else.
    pub fn graph(&mut self) -> &mut Graph {
        &mut self.graph
    }
}

fn actions(assigned: &[(VariableId, NodeId)]) -> Actions {
    let assignment = |&(variable, right): &(VariableId, NodeId)| Assignment { variable, right, span: None };
    Actions { assignments: assigned.iter().map(assignment).collect(), ..Actions::default() }
}

fn declare(ports: &mut Vec<EventPort>, label: &str) {
    if !ports.iter().any(|port| &*port.name == label) {
        ports.push(EventPort { name: label.into(), documentation: String::new(), span: None });
    }
}
