//! A table at a point as a polynomial: its coefficients stand in columns, at the position of the piece.

use super::Flattener;
use super::conditions::as_number;
use sophy_field::ColumnIndex;
use sophy_ir::{Column, NodeId, Pieces};

/// The columns of a table.
#[derive(Clone, Debug)]
pub(super) struct Columns {
    knots: ColumnIndex,
    coefficients: Vec<ColumnIndex>,
}

impl Flattener<'_> {
    /// c₀ + d·(c₁ + …) in the piece of `at`, d being the distance from its knot.
    pub(super) fn table(&mut self, table: usize, at: NodeId) -> NodeId {
        let Some(Columns { knots, coefficients }) = self.columns(table) else { return self.nothing() };
        let graph = &mut self.system.graph;
        let at = as_number(graph, at);
        let piece = graph.locate(knots, at);
        let knot = graph.lookup(knots, piece);
        let mut sum = None;
        for column in coefficients.into_iter().rev() {
            let coefficient = graph.lookup(column, piece);
            sum = Some(match sum {
                None => coefficient,
                Some(rest) => {
                    let distance = graph.subtract(at, knot);
                    let product = graph.multiply(distance, rest);
                    graph.add(coefficient, product)
                }
            });
        }
        sum.unwrap_or_else(|| self.nothing())
    }

    fn columns(&mut self, table: usize) -> Option<Columns> {
        let known = self.tables.get_mut(table)?;
        if known.is_none() {
            let table = self.tree.model.tables.get(table)?;
            let Pieces { knots, coefficients } = table.pieces();
            let graph = &mut self.system.graph;
            // Tables of one file have the same knots: then they share what watches them.
            let file = table.name.rsplit_once(": ").map_or(table.name.as_str(), |(file, _)| file);
            let knots = graph.column(Column { name: file.to_owned(), numbers: knots });
            let coefficients = (0..).zip(coefficients).map(|(power, numbers)| {
                let name = if power == 0 { table.name.clone() } else { format!("{} ^{power}", table.name) };
                graph.column(Column { name, numbers })
            });
            *known = Some(Columns { knots, coefficients: coefficients.collect() });
        }
        known.clone()
    }
}
