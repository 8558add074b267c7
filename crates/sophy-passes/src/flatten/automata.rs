//! Locations and transitions. An event section is an automaton of its own: its locations are the sides of the
//! flag, its transitions the two directions.

use super::Flattener;
use super::copy::Context;
use super::events::Routes;
use sophy_field::{AutomatonIndex, LocationIndex, StateIndex, TransitionIndex};
use sophy_ir::{
    Actions, Automaton, AutomatonKind, Body, Class, Comparison, ComponentIndex, EventSection, FlatEmission,
    FlatLocation, FlatReset, FlatTransition, FlatTrigger, HybridAutomaton, Leaf, Node, Role, Shared, Trigger,
    VariableId,
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
                Body::Discrete(_) => self.without_locations(instance),
                Body::Automaton(_) if self.rests_elsewhere(instance) => {}
                Body::Automaton(automaton) => {
                    self.component(instance, automaton, &routes);
                    for (number, section) in (1..).zip(&automaton.events) {
                        self.section(instance, class, (number, section), &routes);
                    }
                }
            }
        }
        // Outputs of a composite without members need an owner.
        if self.system.automata.is_empty() {
            self.without_locations(0);
        }
    }

    /// Whether the rows of an instance belong to the automaton of an earlier one.
    fn rests_elsewhere(&self, instance: u32) -> bool {
        self.automaton_of[instance as usize] < Some(AutomatonIndex::new(self.system.automata.len()))
    }

    fn component(&mut self, instance: u32, automaton: &'a HybridAutomaton, routes: &Routes) {
        let owner = self.owner(instance);
        let first = self.system.transitions.len();
        for (source, location) in automaton.locations.iter().enumerate() {
            let context = self.context(instance, Some(source as u32));
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
        }
        let names = automaton.locations.iter().map(|location| location.name.as_str());
        let initial = LocationIndex::new(automaton.initial_location);
        self.automaton(instance, 0, first, names, (Role::Component, initial));
    }

    /// An automaton whose transitions are those from `first` on; `number`: which one of its component.
    fn automaton<'n>(
        &mut self,
        instance: u32,
        number: usize,
        first: usize,
        names: impl Iterator<Item = &'n str>,
        (role, initial): (Role, LocationIndex),
    ) {
        let own = &self.system.transitions.unfinished()[first..];
        let make = || {
            let mut locations: Vec<_> =
                names.map(|name| FlatLocation { name: name.to_owned(), transitions: Vec::new() }).collect();
            for (transition, one) in (0..).zip(own) {
                locations[one.source.position()].transitions.push(transition);
            }
            for location in &mut locations {
                location.transitions.sort_by_key(|&transition| own[transition as usize].priority);
            }
            Shared::new(AutomatonKind { role, locations, initial })
        };
        let key = (self.tree.instance(instance).class, number);
        let kind = self.kinds.entry(key).or_insert_with(make).clone();
        let (component, first) = (ComponentIndex(instance), TransitionIndex::new(first));
        self.system.automata.push(Automaton { component, kind, first });
    }

    fn without_locations(&mut self, instance: u32) {
        let first = self.system.transitions.len();
        self.automaton(instance, 0, first, [""].into_iter(), (Role::Owner, LocationIndex(0)));
    }

    fn section(
        &mut self,
        instance: u32,
        class: &'a Class,
        (number, section): (usize, &'a EventSection),
        routes: &Routes,
    ) {
        let context = self.context(instance, None);
        let automaton = AutomatonIndex::new(self.system.automata.len());
        let slot = self.tree.instance(instance).base + section.flag.0;
        let flag = self.nodes[slot as usize].unwrap_or_else(|| self.nothing());
        let zero = self.system.graph.number(0.0);
        let name = &class.variable(section.flag).name;
        let directions = [
            ("negative-to-positive", NEGATIVE, POSITIVE, Comparison::Greater, &section.rising),
            ("positive-to-negative", POSITIVE, NEGATIVE, Comparison::Less, &section.falling),
        ];
        let first = self.system.transitions.len();
        for (direction, source, destination, comparison, actions) in directions {
            let guard = self.system.graph.compare(comparison, flag, zero);
            let (resets, emits) = match actions {
                Some(actions) => self.actions(context, instance, actions, routes),
                None => (Vec::new(), Vec::new()),
            };
            self.system.transitions.push(FlatTransition {
                name: format!("{name} {direction}").into(),
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
            self.modes_of(instance, actions.as_ref(), flag);
        }
        self.automaton(instance, number, first, ["-", "+"].into_iter(), (Role::Flag, NEGATIVE));
    }

    fn actions(
        &mut self,
        context: Context,
        instance: u32,
        actions: &'a Actions,
        routes: &Routes,
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
