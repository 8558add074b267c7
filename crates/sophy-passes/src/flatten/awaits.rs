//! What is checked but cannot be run yet: said once per member, whatever the number of its copies.

use super::Flattener;
use super::copy::Context;
use sophy_diagnostics::Span;
use sophy_ir::{
    Actions, Awaited, Body, Class, Feature, HybridAutomaton, Leaf, NodeId, Special, Transition, Trigger,
};

/// What of a class is awaited, so that it is said once.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) enum Part {
    Special(u32),
    /// By its location and its place there.
    Transition(usize, usize),
}

impl Flattener<'_> {
    fn await_one(&mut self, what: Feature, place: u32, text: String, span: Option<Span>) -> u32 {
        let component = self.tree.place_name(place);
        self.system.awaits.push(Awaited { what, component, text, span });
        self.system.awaits.len() as u32 - 1
    }

    /// The leaf of a special that only the later kernel evaluates.
    pub(super) fn await_special(&mut self, context: Context, special: u32) -> NodeId {
        if let Some(&known) = self.awaited.get(&(context.place, Part::Special(special))) {
            return known;
        }
        let class = self.tree.model.class(context.class);
        let what = match class.specials.get(special as usize) {
            Some(Special::Delayed { .. }) => Feature::Delayed,
            Some(Special::Noise { .. }) => Feature::Noise,
            Some(Special::Chance(_)) => Feature::Chance,
            Some(Special::Never) => Feature::Never,
            _ => Feature::Edge,
        };
        let number = self.await_one(what, context.place, class.special_text(special), class.span);
        let leaf = self.system.graph.leaf(Leaf::Special(number));
        self.awaited.insert((context.place, Part::Special(special)), leaf);
        leaf
    }

    /// A value without an equation: constraints determine it; where there are none, it is 0.
    pub(super) fn undefined(&mut self, instance: u32, location: u32) -> NodeId {
        let constrained = match &self.tree.class(instance).body {
            Body::Automaton(automaton) => {
                automaton.locations.get(location as usize).is_some_and(|l| !l.constraints.is_empty())
            }
            _ => false,
        };
        if constrained { self.nothing() } else { self.system.graph.number(0.0) }
    }

    /// A condition that stands for the trigger of a transition that cannot be taken yet.
    pub(super) fn await_trigger(
        &mut self,
        context: Context,
        (location, position): (usize, usize),
        transition: &Transition,
    ) -> NodeId {
        let key = (context.place, Part::Transition(location, position));
        if let Some(&known) = self.awaited.get(&key) {
            return known;
        }
        let what = match &transition.trigger {
            Trigger::Rate { .. } => Feature::Rate,
            Trigger::Synchronised { .. } => Feature::Synchronised,
            _ => Feature::Invariant,
        };
        let text = self.tree.model.class(context.class).trigger_text(&transition.trigger);
        let number = self.await_one(what, context.place, text, transition.span);
        let leaf = self.system.graph.leaf(Leaf::Special(number));
        self.awaited.insert(key, leaf);
        leaf
    }

    /// The parts of components that have no place in a system yet.
    pub(super) fn awaited_parts(&mut self) {
        for place in 0..self.tree.places.len() as u32 {
            let class = self.tree.model.class(self.tree.places[place as usize].class);
            match &class.body {
                Body::Composite(_) => {}
                Body::Discrete(_) => {
                    self.await_one(Feature::DiscreteTime, place, class.name.clone(), class.span);
                }
                Body::Automaton(automaton) => self.awaited_of(place, class, automaton),
            }
        }
    }

    fn awaited_of(&mut self, place: u32, class: &Class, automaton: &HybridAutomaton) {
        if let Some(delay) = automaton.delay {
            let text = format!("tdelay {}", class.text(delay));
            self.await_one(Feature::LogicDelay, place, text, class.span);
        }
        for location in &automaton.locations {
            for constraint in &location.constraints {
                let text = format!("{} = {}", class.text(constraint.left), class.text(constraint.right));
                self.await_one(Feature::Constraint, place, text, constraint.span);
            }
            if let Some(invariant) = location.invariant {
                let text = format!("invariant {}", class.text(invariant));
                self.await_one(Feature::Invariant, place, text, location.span);
            }
            for transition in &location.transitions {
                self.awaited_holds(place, class, &transition.actions, transition.span);
            }
        }
        for section in &automaton.events {
            for actions in section.rising.iter().chain(&section.falling) {
                self.awaited_holds(place, class, actions, section.span);
            }
        }
        for rule in &automaton.rules {
            let text = format!("when {}", class.text(rule.condition));
            self.await_one(Feature::Rule, place, text, rule.span);
        }
    }

    fn awaited_holds(&mut self, place: u32, class: &Class, actions: &Actions, span: Option<Span>) {
        for &flag in &actions.holds {
            let text = format!("hold {}", class.variable(flag).name);
            self.await_one(Feature::Hold, place, text, span);
        }
    }
}
