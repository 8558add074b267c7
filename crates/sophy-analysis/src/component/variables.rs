use super::builder::Builder;
use super::statements::{assigned_by, assigned_names};
use super::types::{PortType, Range};
use crate::checks::{
    hs0124_unknown_view, hs0125_type_does_not_suit, hs0127_declaration_for_another_kind, hs0128_port_differs,
    hs0209_units,
};
use crate::declarations::{
    ClockDeclaration, ComponentKind, Dialect, Direction, PortDeclaration, RangeText, Spanned, Statement,
    TriggerDeclaration, VariableDeclaration, VariableRole,
};
use crate::lower::{Expected, Place, Shape, Symbol, SymbolKind, SymbolValue, VariableSymbol, Varies};
use crate::units::Measured;
use sophy_diagnostics::Span;
use sophy_ir::{Allowed, EventPort, Quantity, Variable, VariableId, VariableKind};
use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::rc::Rc;

/// A port, for those who connect it.
#[derive(Clone, Debug)]
pub(crate) struct Port {
    pub(crate) name: String,
    pub(crate) direction: Direction,
    pub(crate) kind: PortType,
    pub(crate) shape: Shape,
    /// The first element; of an event port nothing.
    pub(crate) first: VariableId,
    pub(crate) measured: Measured,
    pub(crate) unit: Option<String>,
    pub(crate) choices: Vec<usize>,
    /// Least and greatest value, where they are known.
    pub(crate) bounds: Option<[f64; 2]>,
    pub(crate) span: Span,
}

/// What a component shows to the outside.
#[derive(Clone, Debug, Default)]
pub(crate) struct Interface {
    pub(crate) ports: Vec<Port>,
    pub(crate) input_events: Vec<EventPort>,
    pub(crate) output_events: Vec<EventPort>,
    pub(crate) synchronised: Vec<EventPort>,
    /// Outputs that are variables of the body: each has a copy of the name among the class's variables.
    pub(crate) exported: Vec<(VariableId, VariableId)>,
}

impl Interface {
    /// Whether a port has this name.
    pub(crate) fn has(&self, name: &str) -> bool {
        let mut events = self.input_events.iter().chain(&self.output_events).chain(&self.synchronised);
        self.ports.iter().any(|port| port.name == name) || events.any(|event| &*event.name == name)
    }
}

/// A variable with all that is known of it.
struct Declared<'d> {
    name: &'d Spanned<String>,
    documentation: &'d str,
    kind: SymbolKind,
    port: PortType,
    shape: Shape,
    varies: Varies,
    range: Range,
    measured: Measured,
    unit: Option<String>,
}

impl<'a> Builder<'_, 'a> {
    /// Makes known which names will be declared, so that what uses them too early is told so.
    pub(crate) fn foreshadow(&mut self) {
        let declaration = self.declaration;
        let locations = declaration.locations.iter().flat_map(|location| &location.variables);
        for variable in declaration.variables.iter().chain(locations) {
            self.symbols.foreshadow(&variable.name.value, role_kind(variable.role), variable.name.span);
        }
        if let Some(ClockDeclaration::Announced { name, .. }) = &declaration.clock {
            self.symbols.foreshadow(&name.value, SymbolKind::Mode, name.span);
        }
        for port in &declaration.ports {
            let kind = match port.direction {
                Direction::Input => SymbolKind::Input,
                Direction::Output => SymbolKind::Output,
                Direction::Synchronised => SymbolKind::Event,
            };
            self.symbols.foreshadow(&port.name.value, kind, port.name.span);
        }
    }

    /// Enters the variables of the body and the ports. An output with the name of a variable *is* that variable.
    pub(crate) fn declare_variables(&mut self) -> Interface {
        let declaration = self.declaration;
        let mut interface = Interface::default();
        let assigned: BTreeSet<&str> = assigned_names(declaration).into_keys().collect();
        let mut of_body: BTreeMap<&str, &VariableDeclaration> = BTreeMap::new();
        for variable in &declaration.variables {
            of_body.entry(&variable.name.value).or_insert(variable);
            self.declare_variable(variable);
        }
        self.declare_variables_of_locations();
        if let Some(ClockDeclaration::Announced { name, .. }) = &declaration.clock {
            self.declare_clock(name);
        }
        // Inputs before outputs, as SOPHY XML has them.
        for direction in [Direction::Input, Direction::Output, Direction::Synchronised] {
            for port in declaration.ports.iter().filter(|port| port.direction == direction) {
                let own = of_body.get(port.name.value.as_str()).copied();
                self.declare_port(port, own, &assigned, &mut interface);
            }
        }
        if declaration.dialect == Dialect::Xml {
            self.labels_of_transitions(&mut interface);
        }
        self.symbols.nothing_coming();
        self.declare_views();
        interface
    }

    /// What a location declares exists there only, so that another one may use the name for something else.
    fn declare_variables_of_locations(&mut self) {
        for (position, location) in self.declaration.locations.iter().enumerate() {
            self.symbols.enter_location(Some(position));
            for variable in &location.variables {
                let first = self.variables.len() as u32;
                self.declare_variable(variable);
                self.homes.extend((first..self.variables.len() as u32).map(|id| (VariableId(id), position)));
            }
        }
        self.symbols.enter_location(None);
        // Seen from outside the names must differ.
        let mut locations: HashMap<String, usize> = HashMap::new();
        for (_, name, _) in self.symbols.of_locations() {
            *locations.entry(name.to_owned()).or_default() += 1;
        }
        for (id, &position) in &self.homes {
            let name = self.symbols.declared_as(*id).unwrap_or("");
            let Some(location) = self.declaration.locations.get(position) else { continue };
            if locations.get(name).is_some_and(|&count| count > 1) {
                let variable = &mut self.variables[id.0 as usize];
                variable.name = format!("{}.{}", location.name.value, variable.name);
            }
        }
    }

    /// SOPHY XML has no interface for events: the labels are those of the transitions.
    fn labels_of_transitions(&mut self, interface: &mut Interface) {
        let transitions = self.declaration.locations.iter().flat_map(|location| &location.transitions);
        let mut received: BTreeMap<&str, Span> = BTreeMap::new();
        let mut emitted: BTreeMap<&str, Span> = BTreeMap::new();
        for transition in transitions {
            if let TriggerDeclaration::WhenOrOn(_, events) = &transition.trigger {
                for label in events {
                    received.entry(&label.value).or_insert(label.span);
                }
            }
            for statement in &transition.actions {
                if let Statement::Emit(label) = statement {
                    emitted.entry(&label.value).or_insert(label.span);
                }
            }
        }
        let ports = |labels: BTreeMap<&str, Span>| -> Vec<EventPort> {
            let port = |(name, span): (&str, Span)| EventPort {
                name: name.into(),
                documentation: String::new(),
                span: Some(span),
            };
            labels.into_iter().map(port).collect()
        };
        interface.input_events = ports(received);
        interface.output_events = ports(emitted);
    }

    fn declare_variable(&mut self, variable: &'a VariableDeclaration) {
        use ComponentKind::{Cc, Ctc, Dtc, Lbc, System};
        let kind = role_kind(variable.role);
        let suits = match (self.declaration.kind, variable.role) {
            (Ctc, _) | (Dtc, VariableRole::State | VariableRole::Local | VariableRole::Mode) => true,
            (Lbc, VariableRole::Mode | VariableRole::Local) => true,
            (Dtc | Lbc | Cc | System, _) => false,
        };
        if !suits {
            let name = &variable.name;
            self.report(hs0127_declaration_for_another_kind::diagnostic(
                self.declaration.kind,
                kind.with_article(),
                &name.value,
                name.span,
            ));
        }
        let range = self.range_of(variable.range.as_ref());
        let written = match &variable.kind {
            Some(written) => match self.port_type(written) {
                Some(typed) => Some(typed),
                None => {
                    let symbol = Symbol { kind, span: variable.name.span, value: SymbolValue::Broken };
                    self.declare(&variable.name, symbol);
                    return;
                }
            },
            None => None,
        };
        let (port, shape) = written.unwrap_or_else(|| self.implied_type(variable, &range));
        if port == PortType::Event || (port != PortType::Signal && variable.role == VariableRole::Flag) {
            let span = variable.kind.as_ref().map_or(variable.name.span, |kind| kind.name.span);
            self.report(hs0125_type_does_not_suit::variable(port.name(), kind.with_article(), span));
        }
        let continuous =
            matches!(variable.role, VariableRole::State | VariableRole::Local | VariableRole::Flag)
                && self.declaration.kind == ComponentKind::Ctc
                && port.quantity() == Quantity::Real;
        let declared = Declared {
            name: &variable.name,
            documentation: &variable.documentation,
            kind,
            port,
            shape,
            varies: if continuous { Varies::Continuously } else { Varies::Instants },
            range,
            measured: self.measured(variable.unit.as_ref()),
            unit: self.unit_label(&variable.name.value, variable.unit.as_ref()),
        };
        let own_kind = match variable.role {
            VariableRole::State => VariableKind::State(None),
            // What an update assigns, the output equations read until the next one.
            VariableRole::Local if self.is_held_local(&variable.name.value) => VariableKind::Mode(None),
            VariableRole::Local => VariableKind::Local,
            VariableRole::Mode => VariableKind::Mode(None),
            VariableRole::Flag => VariableKind::Flag,
        };
        self.enter(declared, own_kind);
    }

    /// Whether a local of a discrete-time component keeps what an update assigns.
    pub(crate) fn is_held_local(&self, name: &str) -> bool {
        self.declaration.kind == ComponentKind::Dtc && self.assigned.contains(name)
    }

    /// The type of a variable without one: what its range or its value at the start says, else real.
    fn implied_type(&mut self, variable: &'a VariableDeclaration, range: &Range) -> (PortType, Shape) {
        let real = match variable.role {
            VariableRole::Mode => PortType::Held(Quantity::Real),
            _ => PortType::Signal,
        };
        let of = |quantity| match quantity {
            Quantity::Real | Quantity::Integer => real,
            other => PortType::Held(other),
        };
        if let Some(quantity) = range.quantity {
            return (of(quantity), Shape::Scalar);
        }
        let Some(initial) = &variable.initial else { return (real, Shape::Scalar) };
        match self.silently(|b| b.at(Place::INITIAL).value(initial)) {
            Some(value) => (of(value.quantity), value.shape),
            None => (real, Shape::Scalar),
        }
    }

    fn declare_clock(&mut self, name: &'a Spanned<String>) {
        let declared = Declared {
            name,
            documentation: "the next execution",
            kind: SymbolKind::Mode,
            port: PortType::Held(Quantity::Real),
            shape: Shape::Scalar,
            varies: Varies::Instants,
            range: Range::default(),
            measured: Measured::Unchecked,
            unit: Some("s".to_owned()),
        };
        self.enter(declared, VariableKind::Mode(None));
    }

    /// Makes the variables of a name and enters it; the first of them.
    fn enter(&mut self, declared: Declared<'_>, kind: VariableKind) -> Option<VariableId> {
        let first = VariableId(self.variables.len() as u32);
        let symbol = VariableSymbol {
            first,
            shape: declared.shape,
            quantity: declared.port.quantity(),
            measured: declared.measured,
            varies: declared.varies,
            choices: Rc::from(declared.range.choices.as_slice()),
            known: None,
        };
        let symbol =
            Symbol { kind: declared.kind, span: declared.name.span, value: SymbolValue::Variable(symbol) };
        if !self.declare(declared.name, symbol) {
            return None;
        }
        self.push_variables(&declared, kind);
        Some(first)
    }

    fn push_variables(&mut self, declared: &Declared<'_>, kind: VariableKind) {
        for k in 0..declared.shape.len() {
            self.variables.push(Variable {
                name: format!("{}{}", declared.name.value, declared.shape.suffix(k)),
                kind,
                quantity: declared.port.quantity(),
                range: declared.range.allowed(),
                choices: declared.range.choices.clone(),
                viewed: false,
                structural: false,
                unit: declared.unit.clone(),
                documentation: declared.documentation.to_owned(),
                span: Some(declared.name.span),
            });
        }
    }

    fn declare_port(
        &mut self,
        port: &'a PortDeclaration,
        own: Option<&'a VariableDeclaration>,
        assigned: &BTreeSet<&str>,
        interface: &mut Interface,
    ) {
        let name = &port.name;
        if name.value.is_empty() {
            return;
        }
        let typed = match &port.kind {
            Some(written) => self.port_type(written),
            None => Some((PortType::Signal, Shape::Scalar)),
        };
        let symbol_kind = match port.direction {
            Direction::Input => SymbolKind::Input,
            Direction::Output => SymbolKind::Output,
            Direction::Synchronised => SymbolKind::Event,
        };
        let Some((kind, shape)) = typed else {
            self.declare(name, Symbol { kind: symbol_kind, span: name.span, value: SymbolValue::Broken });
            return;
        };
        if kind == PortType::Event || port.direction == Direction::Synchronised {
            self.declare_event(port, interface);
            return;
        }
        let range = self.range_of(port.range.as_ref());
        let bounds = range.bounds.and_then(|bounds| self.known_bounds(bounds));
        if let Some(range) = &port.range
            && bounds.is_some()
        {
            self.check_in_range(&name.value, range, &[], name.span); // says if it is reversed
        }
        let own_symbol = match self.symbols.declared(&name.value).map(|s| (s.kind, s.value.clone())) {
            Some((own_kind, SymbolValue::Variable(symbol)))
                if port.direction == Direction::Output && own.is_some() =>
            {
                Some((own_kind, symbol))
            }
            _ => None,
        };
        let discrete = matches!(self.declaration.kind, ComponentKind::Dtc | ComponentKind::Lbc);
        if port.direction == Direction::Output && discrete && kind == PortType::Signal {
            let span = port.kind.as_ref().map_or(name.span, |kind| kind.name.span);
            self.report(hs0125_type_does_not_suit::output(self.declaration.kind, &name.value, span));
        }
        let mut declared = Declared {
            name,
            documentation: &port.documentation,
            kind: symbol_kind,
            port: kind,
            shape,
            varies: self.port_varies(port.direction, kind),
            measured: self.measured(port.unit.as_ref()),
            unit: self.unit_label(&name.value, port.unit.as_ref()),
            range,
        };
        let first = match own_symbol {
            Some((own_kind, symbol)) => {
                // What one of the two declarations leaves out, the other may say.
                if let Some(own) = own {
                    self.compare_with_own(port, (kind, shape), own, &symbol);
                    if let Err(mismatch) = symbol.measured.agree(declared.measured) {
                        let what = format!("output `{}`", name.value);
                        let port = port.unit.as_ref().map(|unit| unit.span);
                        let own = own.unit.as_ref().map_or(own.name.span, |unit| unit.span);
                        self.report(hs0209_units::assigned(own, &what, port, mismatch));
                    }
                    if declared.unit.is_none() {
                        declared.unit = own.unit.as_ref().map(|unit| unit.value.clone());
                        declared.measured = symbol.measured;
                    } else if own.unit.is_none() {
                        let id = symbol.first.0 as usize;
                        for variable in self.variables.iter_mut().skip(id).take(symbol.shape.len()) {
                            variable.unit.clone_from(&declared.unit);
                        }
                        let merged = VariableSymbol { measured: declared.measured, ..symbol.clone() };
                        let span = own.name.span;
                        let value = SymbolValue::Variable(merged);
                        self.symbols.redeclare(&name.value, Symbol { kind: own_kind, span, value });
                    }
                }
                declared.shape = symbol.shape;
                if own_kind == SymbolKind::Local {
                    for variable in
                        self.variables.iter_mut().skip(symbol.first.0 as usize).take(symbol.shape.len())
                    {
                        variable.kind = VariableKind::Output;
                    }
                    symbol.first
                } else {
                    self.export(&declared, symbol.first, interface)
                }
            }
            None if port.direction == Direction::Output && assigned.contains(name.value.as_str()) => {
                declared.kind = SymbolKind::Mode;
                declared.varies = Varies::Instants;
                match self
                    .enter(Declared { range: declared.range.clone(), ..declared }, VariableKind::Mode(None))
                {
                    Some(first) => {
                        let declared = self.declared_again(port, kind, shape);
                        self.export(&declared, first, interface)
                    }
                    None => return,
                }
            }
            None => {
                let own_kind = match port.direction {
                    Direction::Output => VariableKind::Output,
                    _ => VariableKind::Input { continuous: kind == PortType::Signal },
                };
                let declared_port = self.declared_again(port, kind, shape);
                match self.enter(declared_port, own_kind) {
                    Some(first) => first,
                    None => return,
                }
            }
        };
        let port_measured = match self.symbols.declared(&name.value).map(|symbol| &symbol.value) {
            Some(SymbolValue::Variable(symbol)) => symbol.measured,
            _ => Measured::Unchecked,
        };
        let unit = self.variables.get(first.0 as usize).and_then(|v| v.unit.clone());
        let choices = self.variables.get(first.0 as usize).map(|v| v.choices.clone()).unwrap_or_default();
        interface.ports.push(Port {
            name: name.value.clone(),
            direction: port.direction,
            kind,
            shape,
            first,
            measured: port_measured,
            unit,
            choices,
            bounds,
            span: name.span,
        });
    }

    fn declared_again(&mut self, port: &'a PortDeclaration, kind: PortType, shape: Shape) -> Declared<'a> {
        Declared {
            name: &port.name,
            documentation: &port.documentation,
            kind: if port.direction == Direction::Output { SymbolKind::Output } else { SymbolKind::Input },
            port: kind,
            shape,
            varies: self.port_varies(port.direction, kind),
            range: self.range_of(port.range.as_ref()),
            measured: self.measured(port.unit.as_ref()),
            unit: self.unit_label(&port.name.value, port.unit.as_ref()),
        }
    }

    fn port_varies(&self, direction: Direction, kind: PortType) -> Varies {
        match (self.declaration.kind, direction, kind) {
            (ComponentKind::Dtc, ..) => Varies::Instants,
            (ComponentKind::Lbc, Direction::Output, _) => Varies::Instants,
            (_, _, PortType::Signal) => Varies::Continuously,
            (ComponentKind::Ctc, Direction::Output, PortType::Held(Quantity::Real))
                if self.declaration.dialect == Dialect::Hsml =>
            {
                Varies::Continuously
            }
            _ => Varies::Instants,
        }
    }

    pub(crate) fn known_bounds(&self, [low, high]: [sophy_ir::NodeId; 2]) -> Option<[f64; 2]> {
        Some([self.known_value(low)?, self.known_value(high)?])
    }

    /// An output of its own whose value is a variable of the body.
    fn export(&mut self, declared: &Declared<'_>, own: VariableId, interface: &mut Interface) -> VariableId {
        let first = VariableId(self.variables.len() as u32);
        self.push_variables(declared, VariableKind::Output);
        for k in 0..declared.shape.len() as u32 {
            interface.exported.push((VariableId(first.0 + k), VariableId(own.0 + k)));
            let own = &self.variables[(own.0 + k) as usize];
            let (unit, choices) = (own.unit.clone(), own.choices.clone());
            let copy = &mut self.variables[(first.0 + k) as usize];
            if copy.unit.is_none() {
                copy.unit = unit;
            }
            if copy.choices.is_empty() {
                copy.choices = choices;
            }
        }
        first
    }

    fn compare_with_own(
        &mut self,
        port: &'a PortDeclaration,
        (kind, shape): (PortType, Shape),
        own: &'a VariableDeclaration,
        symbol: &VariableSymbol,
    ) {
        let xml = self.declaration.dialect == Dialect::Xml;
        let quantities = [kind.quantity(), symbol.quantity];
        let numbers = quantities.iter().all(|q| matches!(q, Quantity::Real | Quantity::Integer));
        if !xml && (shape != symbol.shape || !(numbers || quantities[0] == quantities[1])) {
            self.report(hs0128_port_differs::diagnostic(&port.name.value, port.name.span, own.name.span));
        }
    }

    fn declare_event(&mut self, port: &'a PortDeclaration, interface: &mut Interface) {
        let name = &port.name;
        let symbol = Symbol { kind: SymbolKind::Event, span: name.span, value: SymbolValue::Event };
        let has_elements = port.kind.as_ref().is_some_and(|kind| !kind.shape.is_empty());
        if port.range.is_some() || port.unit.is_some() || has_elements {
            let span = port.unit.as_ref().map_or(name.span, |unit| unit.span);
            self.report(hs0125_type_does_not_suit::event_with_value(&name.value, span));
        }
        if !self.declare(name, symbol) {
            return;
        }
        let event = EventPort {
            name: name.value.as_str().into(),
            documentation: port.documentation.clone(),
            span: Some(name.span),
        };
        match port.direction {
            Direction::Input => interface.input_events.push(event),
            Direction::Output => interface.output_events.push(event),
            Direction::Synchronised => interface.synchronised.push(event),
        }
    }

    fn declare_views(&mut self) {
        for view in &self.declaration.views {
            let everywhere = self.symbols.look_up(&view.value).map(|symbol| symbol.value);
            let elsewhere = self.symbols.elsewhere(&view.value);
            let found: Vec<SymbolValue<'_>> =
                everywhere.into_iter().chain(elsewhere.into_iter().map(|(_, s)| s.value.clone())).collect();
            if found.is_empty() {
                let diagnostic = hs0124_unknown_view::diagnostic(view, &self.symbols);
                self.report(diagnostic);
            }
            for value in found {
                match value {
                    SymbolValue::Variable(symbol) => {
                        let start = symbol.first.0 as usize;
                        for variable in self.variables.iter_mut().skip(start).take(symbol.shape.len()) {
                            variable.viewed = true;
                        }
                    }
                    SymbolValue::Broken => {}
                    _ => self.report(hs0124_unknown_view::no_variable(view)),
                }
            }
        }
    }

    /// Values that declarations give at the start; all names are known by now.
    pub(crate) fn initial_values(&mut self) {
        let declaration = self.declaration;
        let of_locations = declaration.locations.iter().enumerate().map(|(k, l)| (Some(k), &l.variables));
        for (location, variables) in std::iter::once((None, &declaration.variables)).chain(of_locations) {
            self.symbols.enter_location(location);
            for variable in variables {
                let Some(initial) = &variable.initial else { continue };
                self.initial_value(&variable.name, initial, variable.range.as_ref());
            }
        }
        self.symbols.enter_location(None);
        if let Some(ClockDeclaration::Announced { name, initial: Some(initial) }) = &declaration.clock {
            self.initial_value(name, initial, None);
        }
        self.resting_states();
        self.first_of_sets();
    }

    /// A mode that nothing initialises starts with the first value of its set, unless a flag says which.
    fn first_of_sets(&mut self) {
        let sections = self.declaration.events.iter().flat_map(|event| [&event.rising, &event.falling]);
        let by_flags = assigned_by(sections.flatten().flatten().collect());
        for position in 0..self.variables.len() {
            let variable = &self.variables[position];
            if !matches!(variable.kind, VariableKind::Mode(None)) {
                continue;
            }
            let base = variable.name.split('[').next().unwrap_or("");
            let first = match (&variable.range, variable.choices.first()) {
                (_, Some(&choice)) => choice as f64,
                (Some(Allowed::OneOf(numbers)), None) if !by_flags.contains_key(base) => {
                    match numbers.first() {
                        Some(&number) => number,
                        None => continue,
                    }
                }
                _ => continue,
            };
            self.variables[position].kind = VariableKind::Mode(Some(self.graph.number(first)));
        }
    }

    /// The location that a run starts in.
    pub(crate) fn first_location(&self) -> Option<usize> {
        let locations = &self.declaration.locations;
        match &self.declaration.initial_location {
            Some(first) => locations.iter().position(|location| location.name.value == first.value),
            None => (!locations.is_empty()).then_some(0),
        }
    }

    /// States of a location that a run does not start in do not exist at the start: any value will do.
    fn resting_states(&mut self) {
        let declaration = self.declaration;
        let first = self.first_location();
        for (position, location) in declaration.locations.iter().enumerate() {
            if first == Some(position) {
                continue;
            }
            for variable in location.variables.iter().filter(|v| v.role == VariableRole::State) {
                let declared = self.symbols.of_location(position, &variable.name.value);
                let Some(SymbolValue::Variable(symbol)) = declared.map(|symbol| symbol.value.clone()) else {
                    continue;
                };
                let zero = self.graph.number(0.0);
                for id in Builder::elements(symbol.first, symbol.shape.len()) {
                    if let VariableKind::State(start @ None) = &mut self.variables[id.0 as usize].kind {
                        *start = Some(zero);
                    }
                }
            }
        }
    }

    fn initial_value(
        &mut self,
        name: &'a Spanned<String>,
        initial: &'a crate::declarations::ExpressionText,
        range: Option<&'a RangeText>,
    ) {
        let Some((symbol, expected)) = self.expected(&name.value, "") else { return };
        let Some(value) = self.at(Place::INITIAL).value_for(initial, &expected) else { return };
        let nodes = value.elements.as_slice().to_vec();
        for (id, &node) in Builder::elements(symbol.first, nodes.len()).zip(&nodes) {
            match &mut self.variables[id.0 as usize].kind {
                VariableKind::State(start) | VariableKind::Mode(start) => *start = Some(node),
                _ => {}
            }
        }
        if let Some(range) = range {
            let known: Vec<f64> = nodes.iter().filter_map(|&node| self.known_value(node)).collect();
            self.check_in_range(&name.value, range, &known, initial.span);
        }
    }

    /// What the right-hand side for a variable must be; `prefix` and `suffix` make the words of a message.
    pub(crate) fn expected(&self, name: &str, around: &str) -> Option<(VariableSymbol, Expected)> {
        Builder::expected_of(self.symbols.declared(name)?, name, around)
    }

    /// The same for what a name stands for.
    pub(crate) fn expected_of(
        symbol: &Symbol<'a>,
        name: &str,
        around: &str,
    ) -> Option<(VariableSymbol, Expected)> {
        let SymbolValue::Variable(variable) = &symbol.value else { return None };
        let what = if around.is_empty() { format!("`{name}`") } else { format!("`{around}({name})`") };
        let expected = Expected {
            shape: variable.shape,
            quantity: variable.quantity,
            measured: variable.measured,
            choices: variable.choices.to_vec(),
            what,
            span: Some(symbol.span),
        };
        Some((variable.clone(), expected))
    }
}

fn role_kind(role: VariableRole) -> SymbolKind {
    match role {
        VariableRole::State => SymbolKind::State,
        VariableRole::Local => SymbolKind::Local,
        VariableRole::Mode => SymbolKind::Mode,
        VariableRole::Flag => SymbolKind::Flag,
    }
}
