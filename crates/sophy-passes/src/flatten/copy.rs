//! Expressions of a class in terms of the system.

use super::facts::{Becomes, operands};
use super::{Flattener, conditions};
use sophy_ir::{Class, ClassIndex, Leaf, Node, NodeId, Special, VariableId};

/// For whom an expression of a class is copied.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Context {
    pub(super) class: ClassIndex,
    pub(super) place: u32,
    /// `None` for expressions over parameters.
    pub(super) instance: Option<u32>,
    /// `None` for what holds whatever the location.
    pub(super) location: Option<u32>,
}

/// What was copied for the context met last: per node of the class, when, and its copy.
#[derive(Default)]
pub(super) struct Scratch {
    context: Option<Context>,
    round: u32,
    copies: Vec<Option<(u32, NodeId)>>,
}

impl Scratch {
    fn begin(&mut self, context: Context, nodes: usize) {
        self.copies.resize(nodes, None);
        if self.context != Some(context) {
            self.context = Some(context);
            self.round += 1;
        }
    }

    fn get(&self, node: NodeId) -> Option<NodeId> {
        let (round, copy) = (*self.copies.get(node.position())?)?;
        (round == self.round).then_some(copy)
    }

    fn set(&mut self, node: NodeId, copy: NodeId) {
        self.copies[node.position()] = Some((self.round, copy));
    }
}

impl Flattener<'_> {
    /// The context of an instance: in a location, or whatever the location.
    pub(super) fn context(&self, instance: u32, location: Option<u32>) -> Context {
        let at = self.tree.instance(instance);
        // A single location is the location.
        let location = if self.tree.facts(instance).locations == 1 { Some(0) } else { location };
        Context { class: at.class, place: at.place, instance: Some(instance), location }
    }

    /// Copies an expression; what it reads has been resolved.
    pub(super) fn copy(&mut self, context: Context, root: NodeId) -> NodeId {
        let class = self.tree.model.class(context.class);
        let mut scratch = std::mem::take(&mut self.scratch[context.class.0 as usize]);
        let mut pending = std::mem::take(&mut self.pending);
        scratch.begin(context, class.graph.len());
        pending.push(root);
        while let Some(&id) = pending.last() {
            if scratch.get(id).is_some() {
                pending.pop();
                continue;
            }
            let before = pending.len();
            operands(class, &class.graph, id, |operand| {
                if scratch.get(operand).is_none() {
                    pending.push(operand);
                }
            });
            if pending.len() == before {
                pending.pop();
                let copy = self.node(context, class, id, &scratch);
                scratch.set(id, copy);
            }
        }
        let copy = scratch.get(root);
        self.pending = pending;
        self.scratch[context.class.0 as usize] = scratch;
        copy.unwrap_or_else(|| self.nothing())
    }

    /// The same, as a number.
    pub(super) fn number(&mut self, context: Context, root: NodeId) -> NodeId {
        let copy = self.copy(context, root);
        conditions::as_number(&mut self.system.graph, copy)
    }

    /// The same, as a condition.
    pub(super) fn condition(&mut self, context: Context, root: NodeId) -> NodeId {
        let copy = self.copy(context, root);
        conditions::as_condition(&mut self.system.graph, copy)
    }

    fn node(&mut self, context: Context, class: &Class, id: NodeId, scratch: &Scratch) -> NodeId {
        match class.graph.node(id) {
            Node::Leaf(Leaf::Variable(variable)) => {
                self.variable(context, variable).unwrap_or_else(|| self.nothing())
            }
            Node::Leaf(Leaf::Special(special)) => match class.specials.get(special as usize) {
                Some(Special::Location) => self.location_number(context),
                Some(Special::Smooth(e)) => {
                    let inner = scratch.get(*e).unwrap_or_else(|| self.nothing());
                    conditions::smooth(&mut self.system.graph, inner)
                }
                Some(Special::Table { table, at }) => {
                    let at = scratch.get(*at).unwrap_or_else(|| self.nothing());
                    self.table(*table, at)
                }
                _ => self.await_special(context, special),
            },
            other => {
                let mapped = other.map(|operand| scratch.get(operand).unwrap_or(operand));
                conditions::rebuild(&mut self.system.graph, mapped)
            }
        }
    }

    /// What a variable has become.
    fn variable(&self, context: Context, id: VariableId) -> Option<NodeId> {
        let at = match context.instance {
            None => return self.parameter(context.place, id),
            Some(instance) => instance,
        };
        let facts = self.tree.facts(at);
        let slot = match (facts.of(id), context.location) {
            (Becomes::Parameter(_), _) => return self.parameter(context.place, id),
            (Becomes::Value(value), Some(location)) => facts.inside(value, location),
            _ => id.0,
        };
        self.nodes[(self.tree.instance(at).base + slot) as usize]
    }

    fn parameter(&self, place: u32, id: VariableId) -> Option<NodeId> {
        let base = self.tree.places.get(place as usize)?.base;
        *self.parameters.get((base + id.0) as usize)?
    }

    /// The position of the present location, from 1.
    fn location_number(&mut self, context: Context) -> NodeId {
        match (context.location, context.instance) {
            (Some(location), _) => self.system.graph.number(f64::from(location) + 1.0),
            (None, Some(instance)) => self.location_seen_from_outside(instance),
            (None, None) => self.nothing(),
        }
    }

    /// In place of what does not exist; a correct model has none of it.
    pub(super) fn nothing(&mut self) -> NodeId {
        self.system.graph.number(f64::NAN)
    }
}
