use crate::graph::Graph;
use sophy_field::ColumnIndex;
use std::sync::Arc;

/// Numbers by position, read by [`crate::Node::Lookup`]: the knots of a table or a coefficient of its pieces.
///
/// Knots increase; [`crate::Node::Locate`] searches them. An infinite last knot says that the piece before it has no
/// end.
#[derive(Clone, Debug, PartialEq)]
pub struct Column {
    /// What it is called in text forms.
    pub name: String,
    /// At least one.
    pub numbers: Vec<f64>,
}

impl Graph {
    /// A column; equal ones are kept once.
    pub fn column(&mut self, column: Column) -> ColumnIndex {
        let known = self.columns.iter().position(|known| **known == column);
        ColumnIndex::new(known.unwrap_or_else(|| {
            self.columns.push(Arc::new(column));
            self.columns.len() - 1
        }))
    }

    /// All columns.
    pub fn columns(&self) -> &[Arc<Column>] {
        &self.columns
    }

    /// The numbers of a column; none if it does not exist.
    pub fn numbers(&self, column: ColumnIndex) -> &[f64] {
        self.columns.get(column.position()).map_or(&[], |column| &column.numbers)
    }

    pub(crate) fn column_name(&self, column: ColumnIndex) -> &str {
        self.columns.get(column.position()).map_or("?", |column| &column.name)
    }

    /// The index of a column of another graph in this one.
    pub(crate) fn adopt(&mut self, from: &Graph, column: ColumnIndex) -> ColumnIndex {
        match from.columns.get(column.position()) {
            Some(theirs) => self.column(Column::clone(theirs)),
            None => column,
        }
    }
}
