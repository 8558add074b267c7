//! `a < b`: of numbers, truth values, texts and locations.

use super::expression::Reader;
use super::lowering::whole;
use super::typed::{Shape, Typed, Varies};
use crate::checks::{hs0204_equality, hs0210_wrong_kind, hs0211_shape, hs0214_choices};
use sophy_ir::{Comparison, Leaf, Node, NodeId, Quantity, Special};
use sophy_syntax::ast::{self, ComparisonOperator, Expression};

impl Reader<'_, '_, '_> {
    pub(super) fn comparison(&mut self, comparison: &ast::Comparison) -> Option<Typed> {
        let (left, right) = (comparison.left(), comparison.right());
        let operator = match comparison.operator()? {
            ComparisonOperator::Less => Comparison::Less,
            ComparisonOperator::LessEqual => Comparison::LessEqual,
            ComparisonOperator::Greater => Comparison::Greater,
            ComparisonOperator::GreaterEqual => Comparison::GreaterEqual,
            ComparisonOperator::Equal => Comparison::Equal,
            ComparisonOperator::NotEqual => Comparison::NotEqual,
        };
        let equality = matches!(operator, Comparison::Equal | Comparison::NotEqual);
        if equality && let Some(value) = self.location_comparison(operator, left.as_ref(), right.as_ref()) {
            return value;
        }
        let a = left.as_ref().and_then(|e| self.expression(e));
        let b = right.as_ref().and_then(|e| self.expression(e));
        let (left, right, a, b) = (left?, right?, a?, b?);
        let varies = a.varies.max(b.varies);
        if a.shape != Shape::Scalar || b.shape != Shape::Scalar {
            let symbol = operator.symbol();
            let (span, shapes) = (self.span(comparison.range()), (a.shape, b.shape));
            self.report(hs0211_shape::comparison(span, symbol, shapes));
            return None;
        }
        match (a.quantity, b.quantity) {
            (Quantity::Boolean, Quantity::Boolean) if equality => {
                let same = self.equivalence(a.node()?, b.node()?);
                let node = if operator == Comparison::Equal { same } else { self.graph().not(same) };
                return Some(Typed::truth(node, varies));
            }
            (Quantity::Text, Quantity::Text) if equality => {
                self.check_choices((&a, &left), (&b, &right))?;
                let node = self.lowering.graph.compare(operator, a.node()?, b.node()?);
                return Some(Typed::truth(node, varies));
            }
            (Quantity::Text, Quantity::Text) => {
                let span = self.span(comparison.operator_range()?);
                self.report(hs0210_wrong_kind::texts_in_order(span, operator.symbol()));
                return None;
            }
            _ => {}
        }
        let (a, b) = (self.as_number(a, &left), self.as_number(b, &right));
        let (a, b) = (a?, b?);
        if let Err(mismatch) = a.measured.agree(b.measured) {
            self.mismatch("compared", mismatch, left.range(), right.range());
            return None;
        }
        if equality && varies == Varies::Continuously {
            let span = self.span(comparison.operator_range()?);
            let (left, right) = (self.written(&left), self.written(&right));
            self.report(hs0204_equality::diagnostic(span, operator, &left, &right));
            return None;
        }
        Some(Typed::truth(self.lowering.graph.compare(operator, a.node()?, b.node()?), varies))
    }

    /// `location = "Flight"`: the position of the location tells.
    fn location_comparison(
        &mut self,
        operator: Comparison,
        left: Option<&Expression>,
        right: Option<&Expression>,
    ) -> Option<Option<Typed>> {
        let is_location =
            |e: &Expression| matches!(e, Expression::Reference(r) if r.name().as_deref() == Some("location"));
        let string = match (left?, right?) {
            (place, Expression::StringLiteral(string)) | (Expression::StringLiteral(string), place)
                if is_location(place) =>
            {
                string
            }
            _ => return None,
        };
        let symbols = &self.lowering.symbols;
        if symbols.get("location").is_some()
            || symbols.in_function()
            || self.lowering.place.most < Varies::Instants
        {
            return None;
        }
        let name = string.value()?;
        let Some(position) = symbols.locations.iter().position(|location| *location == name) else {
            let locations = symbols.locations.clone();
            let span = self.span(string.range());
            self.report(hs0214_choices::no_location(span, &name, &locations));
            return Some(None);
        };
        let index = self.lowering.special(Special::Location);
        let number = self.graph().number((position + 1) as f64);
        Some(Some(Typed::truth(self.graph().compare(operator, index, number), Varies::Instants)))
    }

    /// A text that is compared with a variable must be one that the variable can be.
    fn check_choices(&mut self, a: (&Typed, &Expression), b: (&Typed, &Expression)) -> Option<()> {
        for ((variable, _), (literal, written)) in [(a, b), (b, a)] {
            let Node::Leaf(Leaf::Variable(id)) = self.lowering.graph.node(variable.node()?) else { continue };
            let Some(text) = self.lowering.graph.as_number(literal.node()?).and_then(whole) else { continue };
            let choices = self.lowering.symbols.choices(id);
            if choices.is_empty() || choices.contains(&(text as usize)) {
                continue;
            }
            let name = |text: usize| self.lowering.texts.get(text).cloned().unwrap_or_default();
            let choices: Vec<String> = choices.into_iter().map(name).collect();
            let text = name(text as usize);
            let declared = self.lowering.symbols.declared_at(id);
            let declared = declared.map(|(name, span)| (name.to_owned(), span));
            let span = self.span(written.range());
            self.report(hs0214_choices::compared(span, &text, &choices, declared));
            return None;
        }
        Some(())
    }

    /// Both true or both false.
    fn equivalence(&mut self, a: NodeId, b: NodeId) -> NodeId {
        let graph = self.graph();
        let (not_a, not_b) = (graph.not(a), graph.not(b));
        let (both, neither) = (graph.and(a, b), graph.and(not_a, not_b));
        graph.or(both, neither)
    }
}
