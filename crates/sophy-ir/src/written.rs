//! Expressions of a class as a modeller writes them. In a graph a truth value that is stored is `heater > 0.5`, a text
//! is its number, and `location` is `location_index`.

use crate::arithmetic::Comparison;
use crate::class::{Body, Class, Special};
use crate::display::Write;
use crate::graph::{Leaf, Node, NodeId};
use crate::model::Quantity;

/// Branches of a text that are looked at.
const BRANCHES: u32 = 16;

impl Class {
    /// An expression as a modeller writes it, whose value is of the given kind; `texts` are those of the model.
    pub fn written(&self, node: NodeId, quantity: Quantity, texts: &[String]) -> String {
        let name = |leaf: Leaf| self.leaf_text(leaf);
        let instead = |id: NodeId, write: Write<'_>| self.instead(id, texts, write);
        if quantity == Quantity::Text {
            let write = |node: NodeId, _: u8| self.graph.display_with(node, &name, &instead);
            return self.text_value(node, texts, BRANCHES, &write);
        }
        self.graph.display_with(node, &name, &instead)
    }

    fn instead(&self, id: NodeId, texts: &[String], write: Write<'_>) -> Option<(u8, String)> {
        match self.graph.node(id) {
            Node::Number(bits) => {
                let value = f64::from_bits(bits);
                let whole = value.fract() == 0.0 && value.abs() < 1e15;
                let text = if whole { format!("{value}") } else { format!("{value:?}") };
                Some((if value.is_sign_negative() { 7 } else { 9 }, text))
            }
            Node::Compare(Comparison::Greater, a, half)
                if self.quantity(a, 0) == Some(Quantity::Boolean)
                    && self.graph.as_number(half) == Some(0.5) =>
            {
                Some((9, write(a, 9)))
            }
            Node::Compare(comparison @ (Comparison::Equal | Comparison::NotEqual), a, b) => {
                let location = |node: NodeId| self.is_location(node);
                let (a, b) = if location(a) || location(b) {
                    ("location".to_owned(), self.location_name(if location(a) { b } else { a })?)
                } else if [a, b].iter().any(|&side| self.quantity(side, BRANCHES) == Some(Quantity::Text)) {
                    (self.text_value(a, texts, BRANCHES, write), self.text_value(b, texts, BRANCHES, write))
                } else {
                    return None;
                };
                Some((4, format!("{a} {} {b}", comparison.symbol())))
            }
            _ => None,
        }
    }

    /// An operand whose value is a text.
    fn text_value(&self, node: NodeId, texts: &[String], branches: u32, write: Write<'_>) -> String {
        match self.graph.node(node) {
            Node::Number(bits) => match texts.get(f64::from_bits(bits) as usize) {
                Some(text) => format!("{text:?}"),
                None => write(node, 5),
            },
            Node::Select(condition, a, b) if branches > 0 => {
                let branch = |node: NodeId| self.text_value(node, texts, branches - 1, write);
                format!("if {} then {} else {}", write(condition, 1), branch(a), branch(b))
            }
            _ => write(node, 5),
        }
    }

    /// The kind of a variable, or of the variables that a choice chooses from.
    fn quantity(&self, node: NodeId, branches: u32) -> Option<Quantity> {
        match self.graph.node(node) {
            Node::Leaf(Leaf::Variable(id)) => self.variables.get(id.0 as usize).map(|v| v.quantity),
            Node::Select(_, a, b) if branches > 0 => {
                self.quantity(a, branches / 2).or_else(|| self.quantity(b, branches / 2))
            }
            _ => None,
        }
    }

    fn is_location(&self, node: NodeId) -> bool {
        match self.graph.node(node) {
            Node::Leaf(Leaf::Special(special)) => {
                matches!(self.specials.get(special as usize), Some(Special::Location))
            }
            _ => false,
        }
    }

    /// The location of a position, from 1.
    fn location_name(&self, position: NodeId) -> Option<String> {
        let Body::Automaton(automaton) = &self.body else { return None };
        let position = self.graph.as_number(position)? as usize;
        automaton.locations.get(position.checked_sub(1)?).map(|location| format!("{:?}", location.name))
    }
}
