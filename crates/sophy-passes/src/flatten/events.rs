//! Event ports: those of composites are aliases, so an emitted label reaches its receivers through any number
//! of boundaries.

use super::Flattener;
use super::tree::prefixed;
use sophy_field::EventIndex;
use sophy_ir::{Body, Class, Event, EventEnd, EventInput, Receiver};
use std::collections::{BTreeSet, HashMap};

/// Per composite class: where the events of an end go.
pub(super) type Routes<'a> = Vec<HashMap<(Option<u32>, u32, &'a str), Vec<&'a EventEnd>>>;

impl<'a> Flattener<'a> {
    /// Every component that is no composite has an input event per label it receives.
    pub(super) fn events(&mut self) {
        for &instance in &self.tree.order {
            let class = self.tree.class(instance);
            if matches!(class.body, Body::Composite(_)) {
                continue;
            }
            self.first_event[instance as usize] = self.system.events.len() as u32;
            let name = self.tree.name(instance);
            for port in &class.input_events {
                self.system.events.push(Event {
                    name: prefixed(&name, &port.name),
                    label: port.name.clone(),
                    receiver: Receiver { automaton: self.owner(instance) },
                });
            }
        }
    }

    /// The input events of the whole that members receive.
    pub(super) fn event_inputs(&mut self, routes: &Routes<'a>) {
        let Some(&root) = self.tree.order.first() else { return };
        let class = self.tree.class(root);
        if matches!(class.body, Body::Composite(_)) {
            for port in &class.input_events {
                let mut found = BTreeSet::new();
                self.follow(routes, root, None, 0, &port.name, &mut found);
                let receivers = found.into_iter().collect();
                self.system.event_inputs.push(EventInput { name: port.name.clone(), receivers });
            }
        }
    }

    /// The connections of events, class by class.
    pub(super) fn routes(&self) -> Routes<'a> {
        let of = |class: &'a Class| {
            let mut routes: HashMap<_, Vec<&'a EventEnd>> = HashMap::new();
            if let Body::Composite(composite) = &class.body {
                for wire in composite.event_wires.iter().filter(|wire| !wire.synchronised) {
                    let from = (wire.from.member, wire.from.copy, wire.from.label.as_str());
                    routes.entry(from).or_default().push(&wire.to);
                }
            }
            routes
        };
        self.tree.model.classes.iter().map(of).collect()
    }

    /// The input events that receive a label of an instance.
    pub(super) fn receivers(&self, routes: &Routes<'a>, instance: u32, label: &'a str) -> Vec<EventIndex> {
        let mut found = BTreeSet::new();
        if let Some((parent, member, copy)) = self.tree.held_as(instance) {
            self.follow(routes, parent, Some(member), copy, label, &mut found);
        }
        found.into_iter().collect()
    }

    /// Follows the connections that leave an end of a composite.
    fn follow(
        &self,
        routes: &Routes<'a>,
        composite: u32,
        member: Option<u32>,
        copy: u32,
        label: &'a str,
        found: &mut BTreeSet<EventIndex>,
    ) {
        let mut pending = vec![(composite, member, copy, label)];
        let mut seen = BTreeSet::new();
        while let Some(end) = pending.pop() {
            if !seen.insert(end) {
                continue;
            }
            let (composite, member, copy, label) = end;
            let routes = &routes[self.tree.instance(composite).class.0 as usize];
            for to in routes.get(&(member, copy, label)).into_iter().flatten() {
                match (to.member, self.tree.held_as(composite)) {
                    (None, None) => {}
                    (None, Some((parent, member, copy))) => {
                        pending.push((parent, Some(member), copy, &to.label));
                    }
                    (Some(_), _) => {
                        let receiver = self.tree.end(composite, to.member, to.copy);
                        match &self.tree.class(receiver).body {
                            Body::Composite(_) => pending.push((receiver, None, 0, &to.label)),
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
        let position = ports.iter().position(|port| port.name == label)?;
        Some(EventIndex(self.first_event[instance as usize] + position as u32))
    }
}
