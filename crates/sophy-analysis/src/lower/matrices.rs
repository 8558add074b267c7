//! Vectors and matrices: literals, products, inverses.

use super::expression::{LARGEST, Reader};
use super::operators::{is_zero, scalar_product};
use super::typed::{Shape, Typed, Varies};
use crate::checks::{hs0211_shape, hs0213_not_known, hs0220_wrong_argument};
use crate::units::{Measured, Unit};
use sophy_diagnostics::Span;
use sophy_ir::{Graph, NodeId, Quantity, Unary};
use sophy_syntax::ast;
use std::ops::Range;

/// Up to this size an inverse is written out.
const LARGEST_WRITTEN_OUT: usize = 4;

impl Reader<'_, '_, '_> {
    /// `[1, 2]`, `[[1, 2], [3, 4]]`.
    pub(super) fn vector(&mut self, vector: &ast::Vector) -> Option<Typed> {
        let expressions = vector.elements();
        let rows: Vec<Option<Typed>> = expressions.iter().map(|e| self.expression(e)).collect();
        let rows: Vec<Typed> = rows.into_iter().collect::<Option<_>>()?;
        let first = rows.first()?;
        let (shape, mut quantity, mut measured) = (first.shape, first.quantity, first.measured);
        let mut varies = Varies::Never;
        let mut nodes = Vec::with_capacity(rows.len() * shape.len());
        for (row, expression) in rows.iter().zip(&expressions) {
            if row.shape != shape {
                let spans = (self.span(expressions.first()?.range()), self.span(expression.range()));
                self.report(hs0211_shape::rows(spans, (shape, row.shape)));
                return None;
            }
            let mut elements = row.clone();
            if quantity != row.quantity {
                let is_number = |quantity| matches!(quantity, Quantity::Real | Quantity::Integer);
                if !(is_number(quantity) && is_number(row.quantity)) {
                    elements = self.as_number(row.clone(), expression)?;
                    if !is_number(quantity) {
                        self.as_number(first.clone(), expressions.first()?)?;
                    }
                }
                quantity = Quantity::Real;
            }
            // The elements of a state may be of all kinds.
            measured = measured.agree(row.measured).unwrap_or(Measured::Unchecked);
            varies = varies.max(row.varies);
            nodes.extend_from_slice(elements.elements.as_slice());
        }
        let shape = match shape {
            Shape::Scalar => Shape::Vector(rows.len()),
            Shape::Vector(columns) => Shape::Matrix(rows.len(), columns),
            Shape::Matrix(..) => {
                let span = self.span(vector.range());
                self.report(hs0211_shape::too_many_dimensions(span));
                return None;
            }
        };
        Some(Typed { elements: nodes.into(), shape, quantity, measured, varies })
    }

    /// Whether so many elements can be had.
    pub(super) fn has_space(&mut self, elements: usize, at: Range<usize>) -> bool {
        self.lowering.symbols.work = self.lowering.symbols.work.saturating_add(elements);
        let span = self.span(at);
        elements <= LARGEST && self.has_room(span, None) || {
            self.too_large(span, None);
            false
        }
    }

    /// The same number everywhere, or that of the identity.
    pub(super) fn filled(
        &mut self,
        shape: Shape,
        at: Range<usize>,
        number: impl Fn(usize) -> f64,
    ) -> Option<Typed> {
        if !self.has_space(shape.len(), at) {
            return None;
        }
        let graph = &mut *self.lowering.graph;
        let nodes: Vec<NodeId> = (0..shape.len()).map(|position| graph.number(number(position))).collect();
        Some(Typed {
            elements: nodes.into(),
            shape,
            quantity: Quantity::Integer,
            measured: Measured::Number(None),
            varies: Varies::Never,
        })
    }

    /// √Σ xᵢ².
    pub(super) fn norm(&mut self, x: &Typed) -> Option<Typed> {
        let graph = &mut *self.lowering.graph;
        let mut sum = None;
        for &element in x.elements.as_slice() {
            let square = graph.integer_power(element, 2);
            sum = Some(sum.map_or(square, |sum| graph.add(sum, square)));
        }
        let node = graph.unary(Unary::Sqrt, sum?);
        Some(Typed::scalar(node, Quantity::Real, x.measured, x.varies))
    }

    pub(super) fn dot(&mut self, a: &Typed, b: &Typed) -> Typed {
        let pairs = a.elements.as_slice().iter().zip(b.elements.as_slice());
        let node = scalar_product(self.lowering.graph, pairs);
        Typed::scalar(node, Quantity::Real, a.measured.times(b.measured), a.varies.max(b.varies))
    }

    /// `None` unless both have three elements.
    pub(super) fn cross(&mut self, a: &Typed, b: &Typed) -> Option<Typed> {
        let (&[a1, a2, a3], &[b1, b2, b3]) = (a.elements.as_slice(), b.elements.as_slice()) else {
            return None;
        };
        let graph = &mut *self.lowering.graph;
        let mut element = |p, q, r, s| {
            let (first, second) = (graph.multiply(p, q), graph.multiply(r, s));
            graph.subtract(first, second)
        };
        let elements = vec![element(a2, b3, a3, b2), element(a3, b1, a1, b3), element(a1, b2, a2, b1)];
        Some(Typed {
            elements: elements.into(),
            shape: Shape::Vector(3),
            quantity: Quantity::Real,
            measured: a.measured.times(b.measured),
            varies: a.varies.max(b.varies),
        })
    }

    pub(super) fn transposed(&mut self, a: &Typed) -> Option<Typed> {
        let Shape::Matrix(rows, columns) = a.shape else { return None };
        let elements = a.elements.as_slice();
        let mut nodes = Vec::with_capacity(elements.len());
        for column in 0..columns {
            nodes.extend(elements.iter().skip(column).step_by(columns.max(1)));
        }
        Some(a.with(Shape::Matrix(columns, rows), nodes))
    }

    /// The inverse of a square matrix. Up to 4×4 it is written out as the adjugate over the determinant; a larger
    /// one is computed now, if its elements are known.
    pub(super) fn inverse(&mut self, a: &Typed, n: usize, span: Span) -> Option<Typed> {
        let measured = Measured::Known(Unit::ONE).over(a.measured);
        let inverse =
            |elements: Vec<NodeId>| Typed { quantity: Quantity::Real, measured, ..a.with(a.shape, elements) };
        let mut parameters = Vec::new();
        let numbers = self.lowering.evaluated(a, &mut parameters);
        if let Some(numbers) = &numbers
            && inverted(numbers, n).is_none()
        {
            self.report(hs0220_wrong_argument::singular(span));
            return None;
        }
        if n <= LARGEST_WRITTEN_OUT {
            return Some(inverse(written_out(self.lowering.graph, a.elements.as_slice(), n)));
        }
        let Some(numbers) = numbers.and_then(|numbers| inverted(&numbers, n)) else {
            if !self.lowering.symbols.unapplied {
                self.report(hs0213_not_known::inverse(span, n, LARGEST_WRITTEN_OUT));
            }
            return None;
        };
        self.lowering.structural.extend(parameters);
        let graph = &mut *self.lowering.graph;
        Some(inverse(numbers.into_iter().map(|number| graph.number(number)).collect()))
    }
}

/// adj(A)/det(A), with products of elements written as 0 left out.
fn written_out(graph: &mut Graph, a: &[NodeId], n: usize) -> Vec<NodeId> {
    let all: Vec<usize> = (0..n).collect();
    let determinant = minor(graph, a, n, &all, &all);
    let mut inverse = Vec::with_capacity(n * n);
    for row in 0..n {
        for column in 0..n {
            // Element (row, column) of the adjugate is the cofactor of (column, row).
            let without = |leave: usize| -> Vec<usize> { (0..n).filter(|&i| i != leave).collect() };
            let (rows, columns) = (without(column), without(row));
            let mut cofactor = minor(graph, a, n, &rows, &columns);
            if is_zero(graph, cofactor) {
                inverse.push(cofactor);
                continue;
            }
            if (row + column) % 2 == 1 {
                cofactor = graph.unary(Unary::Negate, cofactor);
            }
            inverse.push(graph.divide(cofactor, determinant));
        }
    }
    inverse
}

/// The determinant of some rows and columns, expanded along the first row; 1 of none.
fn minor(graph: &mut Graph, a: &[NodeId], n: usize, rows: &[usize], columns: &[usize]) -> NodeId {
    let Some((&first, others)) = rows.split_first() else { return graph.number(1.0) };
    let mut sum: Option<NodeId> = None;
    for (position, &column) in columns.iter().enumerate() {
        let Some(&element) = a.get(first * n + column) else { continue };
        if is_zero(graph, element) {
            continue;
        }
        let rest: Vec<usize> = columns.iter().copied().filter(|&c| c != column).collect();
        let below = minor(graph, a, n, others, &rest);
        if is_zero(graph, below) {
            continue;
        }
        let term = graph.multiply(element, below);
        sum = Some(match (sum, position % 2) {
            (None, 0) => term,
            (None, _) => graph.unary(Unary::Negate, term),
            (Some(sum), 0) => graph.add(sum, term),
            (Some(sum), _) => graph.subtract(sum, term),
        });
    }
    sum.unwrap_or_else(|| graph.number(0.0))
}

/// Gauss–Jordan elimination with the largest pivot; `None` if there is none but 0.
fn inverted(a: &[f64], n: usize) -> Option<Vec<f64>> {
    let mut rows: Vec<Vec<f64>> = a.chunks(n.max(1)).map(<[f64]>::to_vec).collect();
    let unit = |row: usize| (0..n).map(move |column| if column == row { 1.0 } else { 0.0 });
    for (position, row) in rows.iter_mut().enumerate() {
        row.extend(unit(position));
    }
    for column in 0..n {
        let pivot = (column..n).max_by(|&p, &q| rows[p][column].abs().total_cmp(&rows[q][column].abs()))?;
        rows.swap(column, pivot);
        let pivot = rows[column].clone();
        if pivot[column] == 0.0 || !pivot[column].is_finite() {
            return None;
        }
        for (position, row) in rows.iter_mut().enumerate() {
            let factor = row[column] / pivot[column];
            for (element, pivot_element) in row.iter_mut().zip(&pivot) {
                if position == column {
                    *element = pivot_element / pivot[column];
                } else {
                    *element -= factor * pivot_element;
                }
            }
        }
    }
    Some(rows.into_iter().flat_map(|row| row.into_iter().skip(n)).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use sophy_ir::Leaf;
    use sophy_ir::arithmetic::integer_power;

    /// The inverse written out is that of elimination.
    fn agree(a: &[f64], n: usize) -> bool {
        let mut graph = Graph::default();
        let nodes: Vec<NodeId> = a.iter().map(|&x| graph.number(x)).collect();
        let all: Vec<usize> = (0..n).collect();
        let determinant = minor(&mut graph, &nodes, n, &all, &all);
        if graph.as_number(determinant).unwrap().abs() < 0.5 {
            return true; // whole numbers: singular
        }
        let written = written_out(&mut graph, &nodes, n);
        let Some(computed) = inverted(a, n) else { return false };
        let size = a.iter().chain(&computed).fold(1.0_f64, |size, x| size.max(x.abs()));
        let tolerance = 1e-9 * integer_power(size, 4);
        written
            .iter()
            .zip(&computed)
            .all(|(&node, x)| graph.as_number(node).is_some_and(|written| (written - x).abs() <= tolerance))
    }

    proptest! {
        #[test]
        fn two_ways_to_an_inverse(n in 1..5_usize, a in prop::collection::vec(-4..5_i32, 16)) {
            let a: Vec<f64> = a.into_iter().take(n * n).map(f64::from).collect();
            prop_assert!(agree(&a, n));
        }

        #[test]
        fn a_matrix_times_its_inverse_is_the_identity(a in prop::collection::vec(-1.0..1.0_f64, 36)) {
            // Made diagonally dominant, so that it is far from singular.
            let mut a = a;
            (0..6).for_each(|i| a[7 * i] += 8.0);
            let b = inverted(&a, 6).unwrap();
            for row in 0..6 {
                for column in 0..6 {
                    let product: f64 = (0..6).map(|k| a[6 * row + k] * b[6 * k + column]).sum();
                    let expected = if row == column { 1.0 } else { 0.0 };
                    prop_assert!((product - expected).abs() < 1e-12);
                }
            }
        }
    }

    #[test]
    fn zeros_leave_no_products() {
        let mut graph = Graph::default();
        let (x, zero) = (graph.leaf(Leaf::Time), graph.number(0.0));
        let inverse = written_out(&mut graph, &[x, zero, zero, x], 2);
        assert_eq!(graph.as_number(inverse[1]), Some(0.0));
        assert!(inverted(&[1.0, 2.0, 2.0, 4.0], 2).is_none());
    }
}
