//! Names are computed: a copy stores neither its name nor what was declared for all copies.

use crate::model_text::copy_name;
use crate::system::{Algebraic, Automaton, Event, Input, Output, State, System};
use crate::{Composite, Member};
use std::sync::Arc;

/// A component of a system, composites included; the whole is number 0.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct ComponentIndex(pub u32);

/// What a [`System`] consists of. The members of a composite are numbered in a row, copies row by row, so that only
/// composites are stored.
#[derive(Clone, Debug, Default)]
pub struct Components {
    /// In the order of `first`.
    composites: Vec<Held>,
}

/// The members of a composite.
#[derive(Clone, Debug)]
struct Held {
    /// The first of them.
    first: u32,
    composite: ComponentIndex,
    members: Members,
}

/// The names of what a composite holds, shared by all its copies.
#[derive(Clone, Debug, Default)]
pub struct Members(Arc<[Group]>);

/// The copies of a member.
#[derive(Clone, Debug)]
struct Group {
    /// The first of them, among all that the composite holds.
    first: u32,
    name: String,
    extents: Vec<u32>,
    element: Vec<u32>,
}

impl Members {
    /// Those of a composite.
    pub fn of(composite: &Composite) -> Self {
        let mut next = 0;
        let group = |member: &Member| {
            let first = next;
            next += member.copies();
            let (name, extents, element) =
                (member.name.clone(), member.extents.clone(), member.element.clone());
            Group { first, name, extents, element }
        };
        Members(composite.members.iter().map(group).collect())
    }
}

impl Components {
    /// Says that the components from `first` on are the members of a composite; composites come in this order.
    pub fn hold(&mut self, first: u32, composite: ComponentIndex, members: Members) {
        self.composites.push(Held { first, composite, members });
    }

    /// `a.b[2]`, or nothing for the whole.
    pub fn name(&self, component: ComponentIndex) -> String {
        let mut parts = Vec::new();
        let mut at = component;
        while let Some(held) = self.holder(at) {
            let (member, copy) = held.place(at);
            if let Some(group) = held.members.0.get(member as usize) {
                parts.push(copy_name(&group.name, &group.extents, &group.element, copy));
            }
            at = held.composite;
        }
        parts.reverse();
        parts.join(".")
    }

    /// Which member of its composite a component is, and which copy of it; `None` for the whole.
    pub fn place(&self, component: ComponentIndex) -> Option<(u32, u32)> {
        self.holder(component).map(|held| held.place(component))
    }

    /// The last composite whose members begin at or before a component.
    fn holder(&self, component: ComponentIndex) -> Option<&Held> {
        let behind = self.composites.partition_point(|held| held.first <= component.0);
        self.composites.get(behind.checked_sub(1)?)
    }

    /// `a.b[2].x`, or the name alone in the whole.
    pub fn full_name(&self, component: ComponentIndex, name: &str) -> String {
        let component = self.name(component);
        if component.is_empty() { name.to_owned() } else { format!("{component}.{name}") }
    }
}

impl Held {
    fn place(&self, component: ComponentIndex) -> (u32, u32) {
        let position = component.0 - self.first;
        let member = self.members.0.partition_point(|group| group.first <= position).saturating_sub(1);
        (member as u32, position - self.members.0.get(member).map_or(0, |group| group.first))
    }
}

impl State {
    /// Full name.
    pub fn name(&self, system: &System) -> String {
        system.components.full_name(self.component, &self.declared.name)
    }
}

impl Input {
    /// Full name.
    pub fn name(&self, system: &System) -> String {
        system.components.full_name(self.component, &self.declared.name)
    }
}

impl Algebraic {
    /// Full name.
    pub fn name(&self, system: &System) -> String {
        system.components.full_name(self.component, &self.declared.name)
    }
}

impl Output {
    /// Full name.
    pub fn name(&self, system: &System) -> String {
        system.components.full_name(self.component, &self.declared.name)
    }
}

impl Event {
    /// `component.label`, or the label alone.
    pub fn name(&self, system: &System) -> String {
        system.components.full_name(self.component, &self.label)
    }
}

impl Automaton {
    /// Name of the component; empty in a model of one nameless component.
    pub fn name(&self, system: &System) -> String {
        system.components.name(self.component)
    }
}
