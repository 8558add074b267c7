//! Event ports: those of composites are aliases, so an emitted label reaches its receivers through any number
//! of boundaries.

use super::Flattener;
use sophy_field::EventIndex;
use sophy_ir::{Body, Class, ComponentIndex, Event, EventEnd, EventInput, Receiver};
use std::collections::{BTreeSet, HashMap, HashSet};
use std::sync::Arc;

/// Per composite class: where the events of an end go.
pub(super) type Routes = Vec<HashMap<EventEnd, Vec<EventEnd>>>;

impl<'a> Flattener<'a> {
    /// Every component that is no composite has an input event per label it receives.
    pub(super) fn events(&mut self) {
        for &instance in &self.tree.order {
            let class = self.tree.class(instance);
            if matches!(class.body, Body::Composite(_)) {
                continue;
            }
            self.first_event[instance as usize] = self.system.events.len() as u32;
            for port in &class.input_events {
                self.system.events.push(Event {
                    component: ComponentIndex(instance),
                    label: port.name.clone(),
                    receiver: Receiver { automaton: self.owner(instance) },
                });
            }
        }
    }

    /// The input events of the whole that members receive.
    pub(super) fn event_inputs(&mut self, routes: &Routes) {
        let Some(&root) = self.tree.order.first() else { return };
        let class = self.tree.class(root);
        if matches!(class.body, Body::Composite(_)) {
            for port in &class.input_events {
                let mut found = BTreeSet::new();
                let end = EventEnd { member: None, copy: 0, label: Arc::clone(&port.name) };
                self.follow(routes, root, end, &mut found);
                let receivers = found.into_iter().collect();
                self.system.event_inputs.push(EventInput { name: port.name.to_string(), receivers });
            }
        }
    }

    /// The connections of events, class by class.
    pub(super) fn routes(&self) -> Routes {
        let of = |class: &'a Class| {
            let mut routes: HashMap<_, Vec<EventEnd>> = HashMap::new();
            if let Body::Composite(composite) = &class.body {
                for wire in composite.event_wires.iter().filter(|wire| !wire.synchronised) {
                    routes.entry(wire.from).or_default().push(wire.to);
                }
            }
            routes
        };
        self.tree.model.classes.iter().map(of).collect()
    }

    /// The input events that receive a label of an instance.
    pub(super) fn receivers(&self, routes: &Routes, instance: u32, label: &Arc<str>) -> Vec<EventIndex> {
        let mut found = BTreeSet::new();
        if let Some((parent, member, copy)) = self.tree.held_as(instance) {
            let end = EventEnd { member: Some(member), copy, label: Arc::clone(label) };
            self.follow(routes, parent, end, &mut found);
        }
        found.into_iter().collect()
    }

    /// Follows the connections that leave an end of a composite.
    fn follow(&self, routes: &Routes, composite: u32, end: EventEnd, found: &mut BTreeSet<EventIndex>) {
        let mut pending = vec![(composite, end)];
        let mut seen = HashSet::new();
        while let Some((composite, end)) = pending.pop() {
            if !seen.insert((composite, end.clone())) {
                continue;
            }
            let routes = &routes[self.tree.instance(composite).class.0 as usize];
            for to in routes.get(&end).into_iter().flatten() {
                match (to.member, self.tree.held_as(composite)) {
                    (None, None) => {}
                    (None, Some((parent, member, copy))) => {
                        let label = Arc::clone(&to.label);
                        pending.push((parent, EventEnd { member: Some(member), copy, label }));
                    }
                    (Some(_), _) => {
                        let receiver = self.tree.end(composite, to.member, to.copy);
                        match &self.tree.class(receiver).body {
                            Body::Composite(_) => {
                                let label = Arc::clone(&to.label);
                                pending.push((receiver, EventEnd { member: None, copy: 0, label }));
                            }
                            _ => found.extend(self.event(receiver, &to.label)),
                        }
                    }
                }
            }
        }
    }

    /// The event of a label of an instance.
    pub(super) fn event(&self, instance: u32, label: &str) -> Option<EventIndex> {
        let ports = &self.tree.class(instance).input_events;
        let position = ports.iter().position(|port| &*port.name == label)?;
        Some(EventIndex(self.first_event[instance as usize] + position as u32))
    }
}
