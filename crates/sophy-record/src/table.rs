use crate::{ColumnKind, Metadata, Row, Schema, Sink, SinkError};

/// A result in memory, column by column.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Table {
    /// The columns.
    pub schema: Schema,
    /// Where it comes from.
    pub metadata: Metadata,
    /// Time of each row, s, never decreasing; equal at a jump.
    pub time: Vec<f64>,
    /// Micro-step of each row; empty unless `schema.with_step`.
    pub step: Vec<u32>,
    /// One vector per real column.
    pub reals: Vec<Vec<f64>>,
    /// One vector per label column.
    pub labels: Vec<Vec<u32>>,
}

impl Table {
    /// An empty table.
    pub fn new(schema: Schema, metadata: Metadata) -> Self {
        let (reals, labels) = (vec![Vec::new(); schema.reals()], vec![Vec::new(); schema.labels()]);
        Table { schema, metadata, time: Vec::new(), step: Vec::new(), reals, labels }
    }

    /// Number of rows.
    pub fn len(&self) -> usize {
        self.time.len()
    }

    /// Whether there is no row.
    pub fn is_empty(&self) -> bool {
        self.time.is_empty()
    }

    /// The values of a real column by its name.
    pub fn real(&self, name: &str) -> Option<&[f64]> {
        let mut reals = self.schema.columns.iter().filter(|c| c.kind == ColumnKind::Real);
        self.reals.get(reals.position(|c| c.name == name)?).map(Vec::as_slice)
    }

    /// The positions and the names of a label column by its name.
    pub fn label(&self, name: &str) -> Option<(&[u32], &[String])> {
        let labels = self.schema.columns.iter().filter_map(|column| match &column.kind {
            ColumnKind::Label(names) => Some((&column.name, names)),
            ColumnKind::Real => None,
        });
        let (position, (_, names)) = labels.enumerate().find(|(_, (label, _))| *label == name)?;
        Some((self.labels.get(position)?, names))
    }
}

impl Sink for Table {
    fn row(&mut self, row: Row<'_>) -> Result<(), SinkError> {
        self.time.push(row.time);
        if self.schema.with_step {
            self.step.push(row.step);
        }
        for (column, value) in self.reals.iter_mut().zip(row.reals) {
            column.push(*value);
        }
        for (column, value) in self.labels.iter_mut().zip(row.labels) {
            column.push(*value);
        }
        Ok(())
    }

    fn flush(&mut self) -> Result<(), SinkError> {
        Ok(())
    }

    fn finish(&mut self, metadata: &Metadata) -> Result<(), SinkError> {
        self.metadata.entries.extend(metadata.entries.clone());
        Ok(())
    }
}
