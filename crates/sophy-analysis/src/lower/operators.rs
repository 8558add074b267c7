//! `+ - * /` on single values, vectors and matrices.

use super::expression::Reader;
use super::typed::{Shape, Typed};
use crate::checks::hs0211_shape;
use crate::units::Measured;
use sophy_ir::{Binary, Graph, NodeId, Quantity};
use std::ops::Range;

/// A value and where it stands in the text.
type Operand = (Typed, Range<usize>);

impl Reader<'_, '_, '_> {
    /// `a + b`, `a - b`: element by element.
    pub(super) fn sum(&mut self, operation: Binary, a: Operand, b: Operand) -> Option<Typed> {
        let ((a, left), (b, right)) = (a, b);
        if a.shape != b.shape {
            let spans = (self.span(left), self.span(right));
            self.report(hs0211_shape::operands(spans.0, spans.1, operation.name(), (a.shape, b.shape)));
            return None;
        }
        match a.measured.binary(operation, b.measured) {
            Ok(measured) => Some(self.by_element(operation, &a, &b, measured)),
            Err(mismatch) => {
                let done = if operation == Binary::Add { "added" } else { "subtracted" };
                self.mismatch(done, mismatch, left, right);
                None
            }
        }
    }

    /// An operation on elements that stand at the same place; one of the operands may be a single value.
    pub(super) fn by_element(
        &mut self,
        operation: Binary,
        a: &Typed,
        b: &Typed,
        measured: Measured,
    ) -> Typed {
        let (left, right) = (a.elements.as_slice(), b.elements.as_slice());
        let shape = if a.shape == Shape::Scalar { b.shape } else { a.shape };
        let graph = &mut *self.lowering.graph;
        let elements: Vec<NodeId> = match (left, right) {
            (&[a], _) => right.iter().map(|&b| graph.binary(operation, a, b)).collect(),
            (_, &[b]) => left.iter().map(|&a| graph.binary(operation, a, b)).collect(),
            _ => left.iter().zip(right).map(|(&a, &b)| graph.binary(operation, a, b)).collect(),
        };
        Typed {
            elements: elements.into(),
            shape,
            quantity: combined(operation, a.quantity, b.quantity),
            measured,
            varies: a.varies.max(b.varies),
        }
    }

    /// `a*b`: by a single value, or of matrices.
    pub(super) fn product(&mut self, a: Operand, b: Operand) -> Option<Typed> {
        let ((a, left), (b, right)) = (a, b);
        let measured = a.measured.times(b.measured);
        let (rows, inner, columns, shape) = match (a.shape, b.shape) {
            (Shape::Scalar, _) | (_, Shape::Scalar) => {
                return Some(self.by_element(Binary::Multiply, &a, &b, measured));
            }
            (Shape::Matrix(rows, inner), Shape::Vector(n)) if inner == n => {
                (rows, inner, 1, Shape::Vector(rows))
            }
            (Shape::Matrix(rows, inner), Shape::Matrix(n, columns)) if inner == n => {
                (rows, inner, columns, Shape::Matrix(rows, columns))
            }
            (first, second) => {
                let names = (self.written_at(left.clone()), self.written_at(right.clone()));
                let spans = (self.span(left), self.span(right));
                self.report(hs0211_shape::product(spans, (first, second), (&names.0, &names.1)));
                return None;
            }
        };
        if !self.has_space(rows.saturating_mul(inner).saturating_mul(columns), left.start..right.end) {
            return None;
        }
        let (first, second) = (a.elements.as_slice(), b.elements.as_slice());
        let graph = &mut *self.lowering.graph;
        let mut elements = Vec::with_capacity(shape.len());
        for row in first.chunks(inner.max(1)) {
            for column in 0..columns {
                let column = second.iter().skip(column).step_by(columns.max(1));
                elements.push(scalar_product(graph, row.iter().zip(column)));
            }
        }
        Some(Typed {
            elements: elements.into(),
            shape,
            quantity: combined(Binary::Multiply, a.quantity, b.quantity),
            measured,
            varies: a.varies.max(b.varies),
        })
    }

    /// `a/b`: by a single value.
    pub(super) fn quotient(&mut self, a: Operand, b: Operand) -> Option<Typed> {
        let ((a, left), (b, right)) = (a, b);
        self.check_divisor(&b, right.clone());
        if b.shape != Shape::Scalar {
            let name = self.written_at(right.clone());
            let spans = (self.span(left), self.span(right));
            self.report(hs0211_shape::quotient(spans, (a.shape, b.shape), &name));
            return None;
        }
        let measured = a.measured.over(b.measured);
        Some(self.by_element(Binary::Divide, &a, &b, measured))
    }
}

/// Σ aᵢ·bᵢ, the first term first. Terms with a factor that is written as 0 are left out: a matrix may be sparse.
pub(super) fn scalar_product<'n>(
    graph: &mut Graph,
    pairs: impl Iterator<Item = (&'n NodeId, &'n NodeId)>,
) -> NodeId {
    let mut sum = None;
    for (&a, &b) in pairs {
        if is_zero(graph, a) || is_zero(graph, b) {
            continue;
        }
        let term = graph.multiply(a, b);
        sum = Some(match sum {
            Some(sum) => graph.add(sum, term),
            None => term,
        });
    }
    sum.unwrap_or_else(|| graph.number(0.0))
}

pub(super) fn is_zero(graph: &Graph, node: NodeId) -> bool {
    graph.as_number(node) == Some(0.0)
}

fn combined(operation: Binary, a: Quantity, b: Quantity) -> Quantity {
    let integers = a == Quantity::Integer && b == Quantity::Integer;
    let closed =
        matches!(operation, Binary::Add | Binary::Subtract | Binary::Multiply | Binary::Min | Binary::Max);
    if integers && closed { Quantity::Integer } else { Quantity::Real }
}
