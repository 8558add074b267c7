//! Which instances there are. Copies refer to their class; names are computed.

use super::facts::{Facts, Slot};
use sophy_ir::{
    Body, Class, ClassIndex, ComponentIndex, Components, Composite, Members, Model, Port, VariableId,
};

/// One component of the system, a composite included.
#[derive(Clone, Copy, Debug)]
pub(super) struct Instance {
    pub(super) class: ClassIndex,
    pub(super) place: u32,
    /// The composite that holds it.
    pub(super) parent: Option<u32>,
    /// Where its slots begin.
    pub(super) base: u32,
    /// Where the members of a composite begin among the instances.
    pub(super) children: u32,
}

/// A member, whatever the copy: what has parameters.
#[derive(Clone, Copy, Debug)]
pub(super) struct Place {
    pub(super) class: ClassIndex,
    pub(super) parent: Option<u32>,
    pub(super) member: u32,
    /// Where its variables begin among the parameters.
    pub(super) base: u32,
    /// Where the members of a composite begin among the places.
    children: u32,
}

/// All instances of a model.
pub(super) struct Tree<'a> {
    pub(super) model: &'a Model,
    facts: &'a [Facts],
    pub(super) instances: Vec<Instance>,
    /// Their names.
    pub(super) components: Components,
    /// Instances in the order in which they are written, members after their composite.
    pub(super) order: Vec<u32>,
    pub(super) places: Vec<Place>,
    /// Number of slots of all instances.
    pub(super) slots: u32,
    /// Number of variables of all places.
    pub(super) place_variables: u32,
}

impl<'a> Tree<'a> {
    /// `facts`: of every class.
    pub(super) fn new(model: &'a Model, facts: &'a [Facts]) -> Self {
        let mut tree = Tree {
            model,
            facts,
            instances: Vec::new(),
            components: Components::default(),
            order: Vec::new(),
            places: Vec::new(),
            slots: 0,
            place_variables: 0,
        };
        if model.classes.is_empty() {
            return tree;
        }
        tree.grow_places();
        tree.grow_instances();
        tree
    }

    fn composite(&self, class: ClassIndex) -> Option<&'a Composite> {
        match &self.model.class(class).body {
            Body::Composite(composite) => Some(composite),
            _ => None,
        }
    }

    fn grow_places(&mut self) {
        self.add_place(self.model.root, None, 0);
        let mut next = 0;
        while let Some(&place) = self.places.get(next) {
            if let Some(composite) = self.composite(place.class) {
                self.places[next].children = self.places.len() as u32;
                for (member, one) in composite.members.iter().enumerate() {
                    self.add_place(one.class, Some(next as u32), member as u32);
                }
            }
            next += 1;
        }
    }

    fn add_place(&mut self, class: ClassIndex, parent: Option<u32>, member: u32) {
        self.places.push(Place { class, parent, member, base: self.place_variables, children: 0 });
        self.place_variables += self.model.class(class).variables.len() as u32;
    }

    fn grow_instances(&mut self) {
        self.add_instance(self.model.root, 0, None);
        let members = |class: &Class| match &class.body {
            Body::Composite(composite) => Members::of(composite),
            _ => Members::default(),
        };
        let members: Vec<Members> = self.model.classes.iter().map(members).collect();
        let mut pending = vec![0];
        while let Some(next) = pending.pop() {
            self.order.push(next);
            let instance = self.instances[next as usize];
            let Some(composite) = self.composite(instance.class) else { continue };
            let first = self.instances.len() as u32;
            self.instances[next as usize].children = first;
            self.components.hold(first, ComponentIndex(next), members[instance.class.0 as usize].clone());
            let places = self.places[instance.place as usize].children;
            for (member, one) in composite.members.iter().enumerate() {
                for _ in 0..one.copies() {
                    self.add_instance(one.class, places + member as u32, Some(next));
                }
            }
            pending.extend((first..self.instances.len() as u32).rev());
        }
    }

    fn add_instance(&mut self, class: ClassIndex, place: u32, parent: Option<u32>) {
        let base = self.slots;
        self.slots += self.facts[class.0 as usize].slots();
        self.instances.push(Instance { class, place, parent, base, children: 0 });
    }

    pub(super) fn instance(&self, instance: u32) -> Instance {
        self.instances[instance as usize]
    }

    pub(super) fn class(&self, instance: u32) -> &'a Class {
        self.model.class(self.instance(instance).class)
    }

    pub(super) fn facts(&self, instance: u32) -> &'a Facts {
        &self.facts[self.instance(instance).class.0 as usize]
    }

    pub(super) fn class_facts(&self, class: ClassIndex) -> &'a Facts {
        &self.facts[class.0 as usize]
    }

    /// The places of the members of a composite.
    pub(super) fn members_of(&self, place: u32) -> std::ops::Range<u32> {
        let at = self.places[place as usize];
        let members = self.composite(at.class).map_or(0, |composite| composite.members.len() as u32);
        at.children..at.children + members
    }

    /// The instance that a port of a composite belongs to, and the slot of its variable there.
    pub(super) fn port(&self, composite: u32, port: Port) -> (u32, Slot) {
        (self.end(composite, port.member, port.copy), port.variable.0)
    }

    /// A copy of a member of a composite, or the composite itself.
    pub(super) fn end(&self, composite: u32, member: Option<u32>, copy: u32) -> u32 {
        match member {
            None => composite,
            Some(member) => {
                let first = self.facts(composite).first_copies[member as usize];
                self.instance(composite).children + first + copy
            }
        }
    }

    /// The composite that holds an instance, and which copy of which member of it that is.
    pub(super) fn held_as(&self, instance: u32) -> Option<(u32, u32, u32)> {
        let (member, copy) = self.components.place(ComponentIndex(instance))?;
        Some((self.instance(instance).parent?, member, copy))
    }

    /// `a.b[2]`, or nothing for the root.
    pub(super) fn name(&self, instance: u32) -> String {
        self.components.name(ComponentIndex(instance))
    }

    /// `a.b`, the same for all copies.
    pub(super) fn place_name(&self, place: u32) -> String {
        let mut parts = Vec::new();
        let mut at = self.places[place as usize];
        while let Some(parent) = at.parent {
            let parent = self.places[parent as usize];
            if let Some(composite) = self.composite(parent.class) {
                let member = &composite.members[at.member as usize];
                parts.push(if member.element.is_empty() { member.name.clone() } else { member.copy_name(0) });
            }
            at = parent;
        }
        parts.reverse();
        parts.join(".")
    }

    /// `a.b[2].x`.
    pub(super) fn full_name(&self, instance: u32, id: VariableId) -> String {
        prefixed(&self.name(instance), &self.class(instance).variable(id).name)
    }
}

/// `component.name`, or the name alone in a model of one nameless component.
pub(super) fn prefixed(component: &str, name: &str) -> String {
    if component.is_empty() { name.to_owned() } else { format!("{component}.{name}") }
}
