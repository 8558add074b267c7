//! Components side by side become one system: variables get indices, connected inputs become what feeds
//! them, parameters are ordered by dependency.

use sophy_field::{
    AlgebraicIndex, AutomatonIndex, EventIndex, InputIndex, LocationIndex, ParameterIndex, StateIndex,
    TransitionIndex,
};
use sophy_ir::{
    Algebraic, Automaton, Component, ComponentIndex, Event, FlatLocation, FlatReset, FlatTransition,
    FlatTrigger, Graph, Input, Leaf, Model, NodeId, Output, Parameter, Receiver, Row, State, System, Trigger,
    VariableId, VariableKind,
};
use std::collections::{HashMap, HashSet};
use std::fmt;

/// Why components cannot be put together.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum FlattenError {
    /// Outputs depend on one another in a circle; the names, first again at the end.
    AlgebraicLoop(Vec<String>),
    /// Parameters depend on one another in a circle.
    ParameterLoop(Vec<String>),
}

impl fmt::Display for FlattenError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (what, names) = match self {
            FlattenError::AlgebraicLoop(names) => ("an algebraic loop", names),
            FlattenError::ParameterLoop(names) => ("parameters that define one another", names),
        };
        write!(f, "the composition has {what}: {}", names.join(" -> "))
    }
}

impl std::error::Error for FlattenError {}

/// The flat system of a model; kinks are still as written.
///
/// # Errors
/// [`FlattenError`] if outputs of several components form an algebraic loop.
pub fn flatten(model: &Model) -> Result<System, FlattenError> {
    let mut flattener = Flattener {
        model,
        system: System { name: model.name.clone(), ..System::default() },
        leaves: HashMap::new(),
        open: Vec::new(),
        fed_by: model.connections.iter().map(|c| (c.to, c.from)).collect(),
    };
    flattener.parameters()?;
    flattener.variables();
    flattener.events();
    flattener.outputs()?;
    flattener.rates()?;
    flattener.transitions()?;
    Ok(flattener.system)
}

struct Flattener<'a> {
    model: &'a Model,
    system: System,
    /// What each variable has become.
    leaves: HashMap<VariableId, NodeId>,
    /// Variables being resolved, to find circles.
    open: Vec<VariableId>,
    fed_by: HashMap<VariableId, VariableId>,
}

impl Flattener<'_> {
    /// Parameters in an order in which each comes after those it reads; a stack of its own, because a file
    /// may chain many thousands of them.
    fn parameters(&mut self) -> Result<(), FlattenError> {
        let mut open = HashSet::new();
        for (root, kind) in self.variables_in_order() {
            if !matches!(kind, VariableKind::Parameter(_)) {
                continue;
            }
            let mut pending = vec![root];
            while let Some(&id) = pending.last() {
                if self.leaves.contains_key(&id) {
                    pending.pop();
                    continue;
                }
                let VariableKind::Parameter(value) = self.model.variable(id).kind else {
                    pending.pop();
                    continue;
                };
                let missing: Vec<VariableId> = self
                    .model
                    .graph
                    .dependencies([value])
                    .into_iter()
                    .filter_map(|leaf| match leaf {
                        Leaf::Variable(other) if !self.leaves.contains_key(&other) => Some(other),
                        _ => None,
                    })
                    .collect();
                if missing.is_empty() {
                    pending.pop();
                    self.parameter(id, value);
                } else if !open.insert(id) {
                    let mut circle: Vec<String> = pending
                        .iter()
                        .filter(|id| open.contains(id))
                        .map(|&id| self.model.full_name(id))
                        .collect();
                    circle.push(self.model.full_name(id));
                    return Err(FlattenError::ParameterLoop(circle));
                } else {
                    pending.extend(missing);
                }
            }
        }
        Ok(())
    }

    fn parameter(&mut self, id: VariableId, value: NodeId) {
        let value = self.copy(value);
        let variable = self.model.variable(id);
        let index = ParameterIndex::new(self.system.parameters.len());
        self.system.parameters.push(Parameter {
            name: self.model.full_name(id),
            value,
            unit: variable.unit.clone(),
            span: variable.span,
        });
        let leaf = self.system.graph.leaf(Leaf::Parameter(index));
        self.leaves.insert(id, leaf);
    }

    /// States and open inputs get their indices before any expression is copied.
    fn variables(&mut self) {
        for (id, kind) in self.variables_in_order() {
            let (name, variable) = (self.model.full_name(id), self.model.variable(id));
            let leaf = match kind {
                VariableKind::State(_) => {
                    let index = StateIndex::new(self.system.states.len());
                    self.system.states.push(State {
                        name,
                        unit: variable.unit.clone(),
                        initial: None,
                        rate: Row { owner: AutomatonIndex(0), by_location: Vec::new(), spans: Vec::new() },
                        span: variable.span,
                    });
                    Leaf::State(index)
                }
                VariableKind::Input if !self.fed_by.contains_key(&id) => {
                    let index = InputIndex::new(self.system.inputs.len());
                    self.system.inputs.push(Input { name, unit: variable.unit.clone(), span: variable.span });
                    Leaf::Input(index)
                }
                _ => continue,
            };
            let leaf = self.system.graph.leaf(leaf);
            self.leaves.insert(id, leaf);
        }
    }

    fn events(&mut self) {
        for (position, component) in self.model.components.iter().enumerate() {
            for label in &component.input_events {
                self.system.events.push(Event {
                    name: prefixed(component, label),
                    label: label.clone(),
                    receiver: Receiver { automaton: AutomatonIndex::new(position) },
                });
            }
        }
    }

    fn outputs(&mut self) -> Result<(), FlattenError> {
        for (id, kind) in self.variables_in_order() {
            if kind != VariableKind::Output {
                continue;
            }
            let value = self.output_row(id)?;
            let variable = self.model.variable(id);
            self.system.outputs.push(Output {
                name: self.model.full_name(id),
                unit: variable.unit.clone(),
                value,
            });
        }
        Ok(())
    }

    fn output_row(&mut self, id: VariableId) -> Result<Row, FlattenError> {
        let component = self.model.variable(id).component;
        self.row(component, |locations, location| {
            let equation = locations[location].outputs.iter().find(|e| e.variable == id);
            equation.map(|e| (e.right, e.span))
        })
    }

    fn rates(&mut self) -> Result<(), FlattenError> {
        let mut state = 0;
        for (id, kind) in self.variables_in_order() {
            let VariableKind::State(initial) = kind else { continue };
            let component = self.model.variable(id).component;
            let rate = self.row(component, |locations, location| {
                let equation = locations[location].dynamics.iter().find(|e| e.variable == id);
                equation.map(|e| (e.right, e.span))
            })?;
            let initial = match initial {
                Some(node) => Some(self.resolve(node)?),
                None => None,
            };
            self.system.states[state].rate = rate;
            self.system.states[state].initial = initial;
            state += 1;
        }
        Ok(())
    }

    /// One expression per location; what is not defined in a location rests (0).
    fn row(
        &mut self,
        component: ComponentIndex,
        find: impl Fn(&[sophy_ir::Location], usize) -> Option<(NodeId, Option<sophy_diagnostics::Span>)>,
    ) -> Result<Row, FlattenError> {
        let locations = &self.model.components[component.0 as usize].locations;
        let mut row = Row {
            owner: AutomatonIndex(component.0),
            by_location: Vec::with_capacity(locations.len()),
            spans: Vec::with_capacity(locations.len()),
        };
        for location in 0..locations.len() {
            let (node, span) = match find(locations, location) {
                Some((node, span)) => (self.resolve(node)?, span),
                None => (self.system.graph.number(0.0), None),
            };
            row.by_location.push(node);
            row.spans.push(span);
        }
        Ok(row)
    }

    fn transitions(&mut self) -> Result<(), FlattenError> {
        for (position, component) in self.model.components.iter().enumerate() {
            let automaton = AutomatonIndex::new(position);
            let mut locations = Vec::new();
            for (source, location) in component.locations.iter().enumerate() {
                let first = self.system.transitions.len();
                for transition in &location.transitions {
                    let trigger = self.trigger(automaton, &transition.trigger)?;
                    let mut resets = Vec::new();
                    for reset in &transition.resets {
                        let value = self.resolve(reset.right)?;
                        if let Some(state) = self.state_of(reset.state) {
                            resets.push(FlatReset { state, value, span: reset.span });
                        }
                    }
                    let emits = transition
                        .emits
                        .iter()
                        .map(|label| (label.clone(), self.receivers(position, label)))
                        .collect();
                    self.system.transitions.push(FlatTransition {
                        name: transition.name.clone(),
                        automaton,
                        source: LocationIndex::new(source),
                        destination: LocationIndex::new(transition.destination),
                        trigger,
                        resets,
                        emits,
                        priority: transition.priority,
                        span: transition.span,
                    });
                }
                let mut outgoing: Vec<_> =
                    (first..self.system.transitions.len()).map(TransitionIndex::new).collect();
                outgoing.sort_by_key(|t| self.system.transitions[t.position()].priority);
                locations.push(FlatLocation { name: location.name.clone(), transitions: outgoing });
            }
            self.system.automata.push(Automaton {
                name: component.name.clone(),
                locations,
                initial: LocationIndex::new(component.initial_location),
            });
        }
        Ok(())
    }

    fn trigger(&mut self, automaton: AutomatonIndex, trigger: &Trigger) -> Result<FlatTrigger, FlattenError> {
        Ok(match trigger {
            Trigger::When(guard) => FlatTrigger::When(self.resolve(*guard)?),
            Trigger::On { events, guard } => FlatTrigger::On {
                events: events.iter().filter_map(|label| self.event(automaton, label)).collect(),
                guard: match guard {
                    Some(guard) => Some(self.resolve(*guard)?),
                    None => None,
                },
            },
        })
    }

    fn event(&self, automaton: AutomatonIndex, label: &str) -> Option<EventIndex> {
        let matches = |e: &Event| e.receiver.automaton == automaton && e.label == label;
        self.system.events.iter().position(matches).map(EventIndex::new)
    }

    fn receivers(&self, component: usize, label: &str) -> Vec<EventIndex> {
        let from_here = |c: &&sophy_ir::EventConnection| {
            c.from.component.0 as usize == component && c.from.label == label
        };
        let mut receivers: Vec<_> = self
            .model
            .event_connections
            .iter()
            .filter(from_here)
            .filter_map(|c| self.event(AutomatonIndex(c.to.component.0), &c.to.label))
            .collect();
        receivers.sort();
        receivers
    }

    fn state_of(&self, id: VariableId) -> Option<StateIndex> {
        match self.system.graph.node(*self.leaves.get(&id)?) {
            sophy_ir::Node::Leaf(Leaf::State(index)) => Some(index),
            _ => None,
        }
    }

    /// An expression of the model in terms of the system.
    fn resolve(&mut self, node: NodeId) -> Result<NodeId, FlattenError> {
        for leaf in self.model.graph.dependencies([node]) {
            if let Leaf::Variable(id) = leaf {
                self.variable(id)?;
            }
        }
        Ok(self.copy(node))
    }

    /// An input becomes what feeds it; an output that does not depend on the location becomes its
    /// definition, another one an algebraic variable.
    fn variable(&mut self, id: VariableId) -> Result<(), FlattenError> {
        if self.leaves.contains_key(&id) {
            return Ok(());
        }
        if self.open.contains(&id) {
            return Err(FlattenError::AlgebraicLoop(self.circle(id)));
        }
        self.open.push(id);
        let leaf = if let Some(&source) = self.fed_by.get(&id) {
            self.variable(source)?;
            self.leaves.get(&source).copied()
        } else {
            let row = self.output_row(id)?;
            match row.by_location.first() {
                Some(&only) if row.is_constant() => Some(only),
                _ => {
                    let index = AlgebraicIndex::new(self.system.algebraics.len());
                    let name = self.model.full_name(id);
                    self.system.algebraics.push(Algebraic { name, value: row.clone(), plain: row });
                    Some(self.system.graph.leaf(Leaf::Algebraic(index)))
                }
            }
        };
        self.open.pop();
        if let Some(leaf) = leaf {
            self.leaves.insert(id, leaf);
        }
        Ok(())
    }

    fn copy(&mut self, node: NodeId) -> NodeId {
        let leaves = &self.leaves;
        self.system.graph.import(&self.model.graph, node, &mut |graph: &mut Graph, leaf| match leaf {
            Leaf::Variable(id) => match leaves.get(&id) {
                Some(&known) => known,
                None => graph.number(f64::NAN),
            },
            other => graph.leaf(other),
        })
    }

    fn circle(&self, again: VariableId) -> Vec<String> {
        let start = self.open.iter().position(|&id| id == again).unwrap_or(0);
        let names = self.open[start..].iter().chain([&again]);
        names.map(|&id| self.model.full_name(id)).collect()
    }

    fn variables_in_order(&self) -> Vec<(VariableId, VariableKind)> {
        let numbered = self.model.variables.iter().enumerate();
        numbered.map(|(position, v)| (VariableId(position as u32), v.kind)).collect()
    }
}

fn prefixed(component: &Component, label: &str) -> String {
    if component.name.is_empty() { label.to_owned() } else { format!("{}.{label}", component.name) }
}
