//! Whether a value can stand where something certain is expected.

use super::lowering::{Expected, Lowering, whole};
use super::typed::{Elements, Shape, Typed};
use crate::checks::{hs0209_units, hs0210_wrong_kind, hs0211_shape, hs0214_choices};
use crate::declarations::Dialect;
use crate::units::Measured;
use sophy_diagnostics::Span;
use sophy_ir::{Leaf, Node, NodeId, Quantity};

impl Lowering<'_, '_> {
    /// The value as one of the expected kind, or a report of why it is none.
    ///
    /// Integers are real numbers; whole numbers that are written out are integers; the number 0 fills any shape.
    /// Variables store what [`Lowering::stored`] makes of the result.
    pub(crate) fn fit(&mut self, value: Typed, at: Span, expected: &Expected) -> Option<Typed> {
        let value = self.in_shape(value, at, expected)?;
        let value = self.of_quantity(value, at, expected)?;
        match value.measured.agree(expected.measured) {
            Ok(_) => Some(Typed { measured: self.measured_as(value.measured, expected), ..value }),
            Err(mismatch) => {
                self.report(hs0209_units::assigned(at, &expected.what, expected.span, mismatch));
                None
            }
        }
    }

    /// What gets a value has its own unit, if one is declared.
    fn measured_as(&self, measured: Measured, expected: &Expected) -> Measured {
        if expected.measured == Measured::Unchecked { measured } else { expected.measured }
    }

    fn in_shape(&mut self, value: Typed, at: Span, expected: &Expected) -> Option<Typed> {
        if value.shape == expected.shape {
            return Some(value);
        }
        if let Some(node) = value.node()
            && self.graph.as_number(node) == Some(0.0)
        {
            return Some(value.with(expected.shape, vec![node; expected.shape.len()]));
        }
        let scalar = value.shape == Shape::Scalar;
        let mut error =
            hs0211_shape::assigned(at, &expected.what, expected.span, expected.shape, value.shape);
        if scalar && matches!(value.quantity, Quantity::Real | Quantity::Integer) {
            let ones =
                expected.shape.extents().iter().map(ToString::to_string).collect::<Vec<_>>().join(", ");
            error = error.help(format!("for the same number everywhere write `(…)*ones({ones})`"));
        }
        self.report(error);
        None
    }

    fn of_quantity(&mut self, value: Typed, at: Span, expected: &Expected) -> Option<Typed> {
        use Quantity as Q;
        let wrong = match (expected.quantity, value.quantity) {
            (Q::Real, Q::Real | Q::Integer) | (Q::Boolean, Q::Boolean) | (Q::Integer, Q::Integer) => false,
            (Q::Integer, Q::Real) => {
                let mut numbers = value.elements.as_slice().iter().map(|&node| self.graph.as_number(node));
                !numbers.all(|number| number.and_then(whole).is_some())
            }
            (Q::Real | Q::Integer, Q::Boolean) if self.dialect == Dialect::Xml => {
                let elements = Elements::from(self.stored(&value));
                return Some(Typed { elements, quantity: Q::Real, ..value });
            }
            (Q::Text, Q::Text) => {
                let unfit = value.elements.as_slice().iter().find_map(|&node| {
                    self.texts_of(node).into_iter().find(|text| !expected.choices.contains(text))
                });
                if let (Some(text), false) = (unfit, expected.choices.is_empty()) {
                    let name = |&text: &usize| self.texts.get(text).map_or("", String::as_str).to_owned();
                    let choices: Vec<String> = expected.choices.iter().map(name).collect();
                    let text = name(&text);
                    self.report(hs0214_choices::assigned(at, &expected.what, expected.span, &text, &choices));
                    return None;
                }
                false
            }
            _ => true,
        };
        if wrong {
            self.report(hs0210_wrong_kind::assigned(
                at,
                &expected.what,
                expected.span,
                expected.quantity,
                value.quantity,
            ));
            return None;
        }
        Some(Typed { quantity: expected.quantity, ..value })
    }

    /// Numbers of the texts that a node can be, as far as they are known.
    fn texts_of(&self, node: NodeId) -> Vec<usize> {
        let mut found = Vec::new();
        let mut pending = vec![node];
        while let Some(node) = pending.pop() {
            match self.graph.node(node) {
                Node::Number(bits) => found.extend(whole(f64::from_bits(bits)).map(|n| n as usize)),
                Node::Select(_, a, b) => pending.extend([b, a]),
                Node::Leaf(Leaf::Variable(id)) => found.extend(self.symbols.choices(id)),
                _ => {}
            }
        }
        found
    }
}
