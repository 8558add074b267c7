//! Locations and transitions. An event section is an automaton of its own: its locations are the sides of the
//! flag, its transitions the two directions.

use super::Flattener;
use super::copy::Context;
use super::events::Routes;
use sophy_field::{AutomatonIndex, LocationIndex, StateIndex, TransitionIndex};
use sophy_ir::{
    Actions, Automaton, Body, Class, Comparison, EventSection, FlatEmission, FlatLocation, FlatReset,
    FlatTransition, FlatTrigger, HybridAutomaton, Leaf, Node, Role, Trigger, VariableId,
};

/// The sides of a flag, as locations.
const NEGATIVE: LocationIndex = LocationIndex(0);
const POSITIVE: LocationIndex = LocationIndex(1);

impl<'a> Flattener<'a> {
    pub(super) fn automata(&mut self) {
        let routes = self.routes();
        self.event_inputs(&routes);
        for &instance in &self.tree.order {
            let class = self.tree.class(instance);
            match &class.body {
                Body::Composite(_) => {}
                Body::Discrete(_) => {
                    let name = self.tree.name(instance);
                    self.system.automata.push(without_locations(name));
                }
                Body::Automaton(automaton) => {
                    self.component(instance, automaton, &routes);
                    for section in &automaton.events {
                        self.section(instance, class, section, &routes);
                    }
                }
            }
        }
        // Outputs of a composite without members need an owner.
        if self.system.automata.is_empty() {
            self.system.automata.push(without_locations(String::new()));
        }
    }

    fn component(&mut self, instance: u32, automaton: &'a HybridAutomaton, routes: &Routes<'a>) {
        let owner = self.owner(instance);
        let mut locations = Vec::with_capacity(automaton.locations.len());
        for (source, location) in automaton.locations.iter().enumerate() {
            let context = self.context(instance, Some(source as u32));
            let first = self.system.transitions.len();
            for (position, transition) in location.transitions.iter().enumerate() {
                let trigger = match &transition.trigger {
                    Trigger::When(guard) => FlatTrigger::When(self.condition(context, *guard)),
                    Trigger::On { events, guard } => FlatTrigger::On {
                        events: events.iter().filter_map(|label| self.event(instance, label)).collect(),
                        guard: guard.map(|guard| self.condition(context, guard)),
                    },
                    _ => FlatTrigger::When(self.await_trigger(context, (source, position), transition)),
                };
                let (resets, emits) = self.actions(context, instance, &transition.actions, routes);
                self.system.transitions.push(FlatTransition {
                    name: transition.name.clone(),
                    automaton: owner,
                    source: LocationIndex::new(source),
                    destination: LocationIndex::new(transition.destination),
                    trigger,
                    resets,
                    emits,
                    priority: transition.priority,
                    silent: false,
                    span: transition.span,
                });
            }
            locations.push(self.location(location.name.clone(), first));
        }
        self.system.automata.push(Automaton {
            name: self.tree.name(instance),
            role: Role::Component,
            locations,
            initial: LocationIndex::new(automaton.initial_location),
        });
    }

    /// A location whose transitions are those from `first` on.
    fn location(&self, name: String, first: usize) -> FlatLocation {
        let mut transitions: Vec<_> =
            (first..self.system.transitions.len()).map(TransitionIndex::new).collect();
        transitions.sort_by_key(|t| self.system.transitions[t.position()].priority);
        FlatLocation { name, transitions }
    }

    fn section(&mut self, instance: u32, class: &'a Class, section: &'a EventSection, routes: &Routes<'a>) {
        let context = self.context(instance, None);
        let automaton = AutomatonIndex::new(self.system.automata.len());
        let slot = self.tree.instance(instance).base + section.flag.0;
        let flag = self.nodes[slot as usize].unwrap_or_else(|| self.nothing());
        let zero = self.system.graph.number(0.0);
        let name = &class.variable(section.flag).name;
        let directions = [
            ("-", "negative-to-positive", NEGATIVE, POSITIVE, Comparison::Greater, &section.rising),
            ("+", "positive-to-negative", POSITIVE, NEGATIVE, Comparison::Less, &section.falling),
        ];
        let mut locations = Vec::with_capacity(2);
        for (side, direction, source, destination, comparison, actions) in directions {
            let first = self.system.transitions.len();
            let guard = self.system.graph.compare(comparison, flag, zero);
            let (resets, emits) = match actions {
                Some(actions) => self.actions(context, instance, actions, routes),
                None => (Vec::new(), Vec::new()),
            };
            self.system.transitions.push(FlatTransition {
                name: format!("{name} {direction}"),
                automaton,
                source,
                destination,
                trigger: FlatTrigger::When(guard),
                resets,
                emits,
                priority: section.priority,
                silent: actions.is_none(),
                span: section.span,
            });
            locations.push(self.location(side.to_owned(), first));
            self.modes_of(instance, actions.as_ref(), flag);
        }
        let name = self.tree.name(instance);
        self.system.automata.push(Automaton { name, role: Role::Flag, locations, initial: NEGATIVE });
    }

    fn actions(
        &mut self,
        context: Context,
        instance: u32,
        actions: &'a Actions,
        routes: &Routes<'a>,
    ) -> (Vec<FlatReset>, Vec<FlatEmission>) {
        let mut resets = Vec::with_capacity(actions.assignments.len());
        for assignment in &actions.assignments {
            let value = self.number(context, assignment.right);
            if let Some(state) = self.state_of(instance, assignment.variable) {
                resets.push(FlatReset { state, value, span: assignment.span });
            }
        }
        let mut emits = Vec::with_capacity(actions.emissions.len());
        for emission in &actions.emissions {
            emits.push(FlatEmission {
                label: emission.label.clone(),
                receivers: self.receivers(routes, instance, &emission.label),
                when: emission.when.map(|when| self.condition(context, when)),
            });
        }
        (resets, emits)
    }

    pub(super) fn state_of(&self, instance: u32, id: VariableId) -> Option<StateIndex> {
        let slot = self.tree.instance(instance).base + id.0;
        match self.system.graph.node(self.nodes[slot as usize]?) {
            Node::Leaf(Leaf::State(index)) => Some(index),
            _ => None,
        }
    }
}

fn without_locations(name: String) -> Automaton {
    let only = FlatLocation { name: String::new(), transitions: Vec::new() };
    Automaton { name, role: Role::Owner, locations: vec![only], initial: LocationIndex(0) }
}
