//! Wires, states and open inputs get their places before any expression is copied.

use super::Flattener;
use super::facts::Becomes;
use sophy_field::{AutomatonIndex, InputIndex, StateIndex};
use sophy_ir::{Body, Class, ComponentIndex, Input, Leaf, Row, State, VariableId, VariableKind};

impl Flattener<'_> {
    pub(super) fn variables(&mut self) {
        self.wire_up();
        self.number_automata();
        for &instance in &self.tree.order {
            let (at, class, facts) =
                (self.tree.instance(instance), self.tree.class(instance), self.tree.facts(instance));
            let (component, owner) = (ComponentIndex(instance), self.owner(instance));
            for (position, (variable, becomes)) in class.variables.iter().zip(&facts.becomes).enumerate() {
                let slot = at.base as usize + position;
                let declared = |flattener: &Self| flattener.declared(at.class, VariableId(position as u32));
                let leaf = match becomes {
                    Becomes::State(_) => {
                        let index = StateIndex::new(self.system.states.len());
                        let continuous = matches!(class.body, Body::Automaton(_))
                            && matches!(variable.kind, VariableKind::State(_));
                        self.system.states.push(State {
                            component,
                            declared: declared(self),
                            discrete: !continuous,
                            initial: None,
                            sign_of: None,
                            rate: Row { owner, first: 0, locations: 0, spans: Row::NOWHERE },
                        });
                        Leaf::State(index)
                    }
                    Becomes::Input if self.wires[slot].is_none() => {
                        let index = InputIndex::new(self.system.inputs.len());
                        self.system.inputs.push(Input { component, declared: declared(self) });
                        Leaf::Input(index)
                    }
                    _ => continue,
                };
                self.nodes[slot] = Some(self.system.graph.leaf(leaf));
            }
        }
    }

    fn wire_up(&mut self) {
        for &composite in &self.tree.order {
            let Body::Composite(body) = &self.tree.class(composite).body else { continue };
            for (wire, one) in body.wires.iter().enumerate() {
                let (instance, slot) = self.tree.port(composite, one.to);
                self.wires[(self.tree.instance(instance).base + slot) as usize] = Some(wire as u32);
            }
        }
    }

    /// Every component that is no composite has an automaton, followed by one per event section; those in which nothing
    /// ever happens share the first of theirs.
    fn number_automata(&mut self) {
        let (mut next, mut shared) = (0, None);
        for &instance in &self.tree.order {
            let class = self.tree.class(instance);
            let sections = match &class.body {
                Body::Composite(_) => continue,
                Body::Discrete(_) => 0,
                Body::Automaton(automaton) => automaton.events.len(),
            };
            if is_uneventful(class) {
                let owner = *shared.get_or_insert(AutomatonIndex::new(next));
                self.automaton_of[instance as usize] = Some(owner);
                next += usize::from(owner == AutomatonIndex::new(next));
                continue;
            }
            self.automaton_of[instance as usize] = Some(AutomatonIndex::new(next));
            next += 1 + sections;
        }
    }

    /// The automaton whose location selects the rows of an instance.
    pub(super) fn owner(&self, instance: u32) -> AutomatonIndex {
        self.automaton_of[instance as usize].unwrap_or(AutomatonIndex(0))
    }
}

/// Whether a component has one nameless location and nothing to react to.
fn is_uneventful(class: &Class) -> bool {
    let Body::Automaton(automaton) = &class.body else { return false };
    let [location] = &automaton.locations[..] else { return false };
    location.name.is_empty()
        && location.transitions.is_empty()
        && automaton.events.is_empty()
        && class.input_events.is_empty()
}
