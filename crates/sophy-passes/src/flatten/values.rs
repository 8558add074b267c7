//! What every value and input is, through any number of connections: an input is what feeds it; a value is
//! written out where its own automaton reads it, location by location; seen from elsewhere it is its
//! definition if that is the same in all locations, else an algebraic variable.

use super::conditions::as_number;
use super::facts::{Becomes, Definition, Slot};
use super::{FlattenError, Flattener, LoopEquation};
use sophy_diagnostics::Span;
use sophy_field::AlgebraicIndex;
use sophy_ir::{
    Algebraic, Body, ClassIndex, ComponentIndex, Declared, Leaf, NodeId, Output, Row, Shared, Sources, State,
    VariableId, VariableKind, Wire,
};

/// A slot of an instance.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Place {
    instance: u32,
    slot: Slot,
}

impl<'a> Flattener<'a> {
    /// All values are resolved, read or not; outputs, and what is to be looked at, become outputs.
    pub(super) fn outputs(&mut self) -> Result<(), FlattenError> {
        for &instance in &self.tree.order {
            let (class, facts) = (self.tree.class(instance), self.tree.facts(instance));
            let is_root = self.tree.instance(instance).parent.is_none();
            for (position, variable) in class.variables.iter().enumerate() {
                let (id, becomes) = (VariableId(position as u32), facts.becomes[position]);
                if let Becomes::Value(value) = becomes {
                    for location in 0..facts.locations as u32 {
                        self.resolve(instance, facts.inside(value, location))?;
                    }
                }
                let is_output = variable.kind == VariableKind::Output;
                let shown = is_output || variable.viewed;
                if !shown || matches!(class.body, Body::Composite(_)) && !is_root {
                    continue;
                }
                let Some(value) = self.output_row(instance, id)? else { continue };
                let declared = self.declared(self.tree.instance(instance).class, id);
                let component = ComponentIndex(instance);
                self.system.outputs.push(Output { component, declared, view: !is_output, value });
            }
        }
        Ok(())
    }

    pub(super) fn output_row(&mut self, instance: u32, id: VariableId) -> Result<Option<Row>, FlattenError> {
        let facts = self.tree.facts(instance);
        Ok(match facts.of(id) {
            Becomes::Value(value) => {
                let (nodes, spans) = self.value_nodes(instance, value);
                Some(self.system.row(self.owner(instance), &nodes, spans))
            }
            Becomes::Nothing | Becomes::Parameter(_) => None,
            _ => {
                let node = self.resolve(instance, id.0)?;
                let node = as_number(&mut self.system.graph, node);
                let locations = self.locations_of_owner(instance);
                let owner = self.owner(instance);
                Some(self.system.row(owner, &vec![node; locations], Row::NOWHERE))
            }
        })
    }

    /// Locations of the automaton that owns the rows of an instance: of a composite, the first of all.
    fn locations_of_owner(&self, instance: u32) -> usize {
        let owner = match self.automaton_of[instance as usize] {
            Some(_) => Some(instance),
            None => self.tree.order.iter().copied().find(|&i| self.automaton_of[i as usize].is_some()),
        };
        owner.map_or(1, |owner| self.tree.facts(owner).locations)
    }

    /// A value location by location, as numbers, and where that stands.
    fn value_nodes(&mut self, instance: u32, value: u32) -> (Vec<NodeId>, u32) {
        let facts = self.tree.facts(instance);
        let mut nodes = Vec::with_capacity(facts.locations);
        let base = self.tree.instance(instance).base;
        for location in 0..facts.locations as u32 {
            let node = self.nodes[(base + facts.inside(value, location)) as usize];
            let node = node.unwrap_or_else(|| self.nothing());
            nodes.push(as_number(&mut self.system.graph, node));
        }
        let definitions = self.spans_of(self.tree.instance(instance).class) + facts.rates.len() as u32;
        (nodes, definitions + value * facts.locations as u32)
    }

    /// Where the spans of a class begin: those of its rates, state by state, then those of its values.
    fn spans_of(&mut self, class: ClassIndex) -> u32 {
        let (facts, spans) = (self.tree.class_facts(class), &mut self.system.spans);
        *self.first_span[class.0 as usize].get_or_insert_with(|| {
            let first = spans.len() as u32;
            let mut add = |definitions: &[Definition], count: usize| {
                for one in 0..count {
                    let of_one = definitions.iter().skip(one).step_by(count);
                    spans.extend(of_one.map(|definition| definition.and_then(|(_, span)| span)));
                }
            };
            add(&facts.rates, facts.states.len());
            add(&facts.definitions, facts.values.len());
            first
        })
    }

    /// Rates and initial values.
    pub(super) fn states(&mut self) -> Result<(), FlattenError> {
        let (mut next, mut nodes) = (0, Vec::new());
        for &instance in &self.tree.order {
            let at = self.tree.instance(instance);
            let (class, facts) = (self.tree.class(instance), self.tree.facts(instance));
            for &id in facts.inputs_read.iter().chain(&facts.values_read) {
                self.resolve(instance, id.0)?;
            }
            let outside = self.context(instance, None);
            for (k, &id) in facts.states.iter().enumerate() {
                nodes.clear();
                for location in 0..facts.locations {
                    // What is not defined in a location rests.
                    nodes.push(match facts.rates[location * facts.states.len() + k] {
                        Some((right, _)) => {
                            let context = self.context(instance, Some(location as u32));
                            self.number(context, right)
                        }
                        None => self.system.graph.number(0.0),
                    });
                }
                let initial = match class.variable(id).kind {
                    VariableKind::State(initial) | VariableKind::Mode(initial) => initial,
                    _ => None,
                };
                let initial = initial.map(|node| self.number(outside, node));
                let spans = self.spans_of(at.class) + (k * facts.locations) as u32;
                let rate = self.system.row(self.owner(instance), &nodes, spans);
                let state: &mut State = &mut self.system.states.unfinished()[next];
                state.rate = rate;
                state.initial = initial;
                next += 1;
            }
        }
        Ok(())
    }

    /// What a slot has become, and before it all that it depends on.
    pub(super) fn resolve(&mut self, instance: u32, slot: Slot) -> Result<NodeId, FlattenError> {
        let root = Place { instance, slot };
        if let Some(known) = self.node_of(root) {
            return Ok(known);
        }
        let position = self.position(root);
        self.open[position] = true;
        let mut open = vec![(root, 0)];
        while let Some((place, next)) = open.last_mut() {
            let place = *place;
            let Some(read) = self.reads(place, *next) else {
                let node = self.define(place);
                let position = self.position(place);
                self.nodes[position] = Some(node);
                self.open[position] = false;
                open.pop();
                continue;
            };
            *next += 1;
            if self.node_of(read).is_none() {
                let position = self.position(read);
                if std::mem::replace(&mut self.open[position], true) {
                    return Err(self.algebraic_loop(&open, read));
                }
                open.push((read, 0));
            }
        }
        Ok(self.node_of(root).unwrap_or_else(|| self.nothing()))
    }

    fn position(&self, place: Place) -> usize {
        (self.tree.instance(place.instance).base + place.slot) as usize
    }

    fn node_of(&self, place: Place) -> Option<NodeId> {
        self.nodes[self.position(place)]
    }

    /// The `next`th slot that one depends on.
    fn reads(&self, place: Place, next: usize) -> Option<Place> {
        let facts = self.tree.facts(place.instance);
        if let Some(definition) = facts.definition_of(place.slot) {
            let id = *facts.reads.get(definition)?.get(next)?;
            let slot = match facts.of(id) {
                Becomes::Value(value) => facts.inside(value, (definition / facts.values.len()) as u32),
                _ => id.0,
            };
            return Some(Place { instance: place.instance, slot });
        }
        match facts.of(VariableId(place.slot)) {
            Becomes::Value(value) if next < facts.locations => {
                Some(Place { instance: place.instance, slot: facts.inside(value, next as u32) })
            }
            Becomes::Input | Becomes::Port => {
                let (composite, wire) = self.wire(place)?;
                let port = match &wire.from {
                    Sources::One(port) => (next == 0).then_some(*port),
                    Sources::Sum(terms) => terms.get(next).map(|(_, port)| *port),
                }?;
                let (instance, slot) = self.tree.port(composite, port);
                Some(Place { instance, slot })
            }
            _ => None,
        }
    }

    /// What feeds an input or an output of a composite, and the composite where that is written.
    fn wire(&self, place: Place) -> Option<(u32, Wire)> {
        let wire = self.wires[self.position(place)]?;
        let composite = match self.tree.facts(place.instance).of(VariableId(place.slot)) {
            Becomes::Port => place.instance,
            _ => self.tree.instance(place.instance).parent?,
        };
        match &self.tree.class(composite).body {
            Body::Composite(body) => Some((composite, body.wires.get(wire as usize)?)),
            _ => None,
        }
    }

    /// What a slot becomes; all that it depends on is known.
    fn define(&mut self, place: Place) -> NodeId {
        let facts = self.tree.facts(place.instance);
        if let Some(definition) = facts.definition_of(place.slot) {
            let location = (definition / facts.values.len()) as u32;
            let context = self.context(place.instance, Some(location));
            return match facts.definitions[definition] {
                Some((right, _)) => self.copy(context, right),
                None => self.undefined(place.instance, location),
            };
        }
        match facts.of(VariableId(place.slot)) {
            Becomes::Value(value) => {
                let (nodes, spans) = self.value_nodes(place.instance, value);
                let class = self.tree.instance(place.instance).class;
                let declared = self.declared(class, VariableId(place.slot));
                self.seen_from_outside(&nodes, spans, place.instance, declared)
            }
            Becomes::Parameter(_) => {
                let context = self.context(place.instance, None);
                let base = self.tree.places[context.place as usize].base;
                self.parameters[(base + place.slot) as usize].unwrap_or_else(|| self.nothing())
            }
            Becomes::Input | Becomes::Port => self.fed(place),
            _ => self.nothing(),
        }
    }

    /// A row as others read it: its only expression, or an algebraic variable.
    fn seen_from_outside(
        &mut self,
        nodes: &[NodeId],
        spans: u32,
        instance: u32,
        declared: Shared<Declared>,
    ) -> NodeId {
        match nodes.first() {
            Some(&only) if nodes.iter().all(|&node| node == only) => only,
            _ => {
                let index = AlgebraicIndex::new(self.system.algebraics.len());
                let component = ComponentIndex(instance);
                let owner = self.owner(instance);
                let [value, plain] = [(); 2].map(|()| self.system.row(owner, nodes, spans));
                self.system.algebraics.push(Algebraic { component, declared, value, plain });
                self.system.graph.leaf(Leaf::Algebraic(index))
            }
        }
    }

    /// `location_index` of an automaton as others read it.
    pub(super) fn location_seen_from_outside(&mut self, instance: u32) -> NodeId {
        if let Some(&known) = self.location_numbers.get(&instance) {
            return known;
        }
        let locations = 1..=self.tree.facts(instance).locations;
        let nodes: Vec<NodeId> = locations.map(|n| self.system.graph.number(n as f64)).collect();
        let declared = self.location_index.clone();
        let node = self.seen_from_outside(&nodes, Row::NOWHERE, instance, declared);
        self.location_numbers.insert(instance, node);
        node
    }

    fn fed(&mut self, place: Place) -> NodeId {
        // An output of a composite that nothing feeds does not pass the checks.
        let Some((composite, wire)) = self.wire(place) else { return self.system.graph.number(0.0) };
        let source = |flattener: &Self, port| {
            let (instance, slot) = flattener.tree.port(composite, port);
            flattener.node_of(Place { instance, slot })
        };
        match &wire.from {
            Sources::One(port) => source(self, *port).unwrap_or_else(|| self.nothing()),
            Sources::Sum(terms) => {
                let mut sum = None;
                for &(weight, port) in terms.iter() {
                    let term = source(self, port).unwrap_or_else(|| self.nothing());
                    let graph = &mut self.system.graph;
                    let term = as_number(graph, term);
                    let weight = graph.number(weight);
                    let term = graph.multiply(weight, term);
                    sum = Some(sum.map_or(term, |sum| graph.add(sum, term)));
                }
                sum.unwrap_or_else(|| self.system.graph.number(0.0))
            }
        }
    }

    fn algebraic_loop(&self, open: &[(Place, usize)], again: Place) -> FlattenError {
        let start = open.iter().position(|(place, _)| *place == again).unwrap_or(0);
        let equations = open[start..].iter().filter_map(|(place, _)| self.loop_equation(*place));
        FlattenError::AlgebraicLoop(equations.collect())
    }

    /// The equation of a slot; `None` for a value seen from outside, whose definition is on the loop, too.
    fn loop_equation(&self, place: Place) -> Option<LoopEquation> {
        let (facts, class) = (self.tree.facts(place.instance), self.tree.class(place.instance));
        if let Some(definition) = facts.definition_of(place.slot) {
            let id = facts.values[definition % facts.values.len()];
            let (right, span) = facts.definitions[definition]?;
            let text = format!("{} = {}", class.variable(id).name, class.text(right));
            return Some(LoopEquation { name: self.tree.full_name(place.instance, id), text, span });
        }
        let (composite, wire) = self.wire(place)?;
        let name = self.tree.full_name(place.instance, VariableId(place.slot));
        let full = |port| {
            let (instance, slot) = self.tree.port(composite, port);
            self.tree.full_name(instance, VariableId(slot))
        };
        let right = match &wire.from {
            Sources::One(port) => full(*port),
            Sources::Sum(terms) => {
                let terms: Vec<_> = terms.iter().map(|(w, port)| format!("{w:?}*{}", full(*port))).collect();
                terms.join(" + ")
            }
        };
        let span: Option<Span> = wire.span;
        Some(LoopEquation { text: format!("{name} = {right}"), name, span })
    }
}
