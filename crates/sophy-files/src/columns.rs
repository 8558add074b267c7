//! Columns as a file has them, before they are a [`Table`].

use std::collections::HashMap;
use std::path::Path;

use sophy_record::{Column, ColumnKind, Metadata, Row, Schema, Table};

use crate::FileError;
use crate::description::{CellKind, Description};
use crate::error::RowMismatch;

pub(crate) struct FileColumn {
    pub(crate) name: String,
    pub(crate) cells: Cells,
}

pub(crate) enum Cells {
    Real(Vec<f64>),
    Label(Labels),
}

/// Texts as positions in a list of names.
#[derive(Default)]
pub(crate) struct Labels {
    names: Vec<String>,
    known: HashMap<String, u32>,
    positions: Vec<u32>,
}

impl Labels {
    /// Position of a name, which is added if it is new.
    pub(crate) fn intern(&mut self, name: &str) -> u32 {
        if let Some(&position) = self.known.get(name) {
            return position;
        }
        let position = self.names.len() as u32;
        self.names.push(name.to_owned());
        self.known.insert(name.to_owned(), position);
        position
    }

    pub(crate) fn push(&mut self, name: &str) {
        let position = self.intern(name);
        self.positions.push(position);
    }

    /// The texts of all cells.
    pub(crate) fn texts(&self) -> impl Iterator<Item = &str> {
        self.positions.iter().map(|&position| self.names[position as usize].as_str())
    }

    /// Appends a cell whose name has this position.
    pub(crate) fn push_position(&mut self, position: u32) {
        self.positions.push(position);
    }
}

impl Cells {
    pub(crate) fn len(&self) -> usize {
        match self {
            Cells::Real(values) => values.len(),
            Cells::Label(labels) => labels.positions.len(),
        }
    }

    /// Appends a number, NaN for a missing one, to cells of numbers.
    pub(crate) fn push_real(&mut self, value: Option<f64>) {
        if let Cells::Real(values) = self {
            values.push(value.unwrap_or(f64::NAN));
        }
    }

    /// Appends a text to cells of texts.
    pub(crate) fn push_text(&mut self, text: &str) {
        if let Cells::Label(labels) = self {
            labels.push(text);
        }
    }

    /// Removes all cells; the names stay.
    pub(crate) fn clear(&mut self) {
        match self {
            Cells::Real(values) => values.clear(),
            Cells::Label(labels) => labels.positions.clear(),
        }
    }

    /// Empty cells of a column that `description` may know: its names keep their order.
    pub(crate) fn labels(name: &str, description: &Description) -> Self {
        let mut labels = Labels::default();
        for location in
            description.columns.iter().filter(|c| c.name == name && c.kind.is_label()).flat_map(|c| &c.names)
        {
            labels.intern(location);
        }
        Cells::Label(labels)
    }
}

/// Makes a table of the columns of a file; `first_line` is the line of the first row, for messages.
pub(crate) fn into_table(
    path: &Path,
    columns: Vec<FileColumn>,
    description: Description,
    first_line: u64,
) -> Result<Table, FileError> {
    let mut table =
        Table { metadata: Metadata { entries: description.metadata.clone() }, ..Table::default() };
    let described = |name: &str| description.columns.iter().find(|c| c.name == name);
    let time = columns.iter().position(|c| c.name == "time").unwrap_or(0);
    // Without a description an integer column `step` right after the time is the micro-step.
    let step = match description.columns.iter().any(|c| c.kind == CellKind::Step) {
        true => columns.iter().position(|c| c.name == "step"),
        false if description.columns.is_empty() => Some(1).filter(|&i| columns.get(i).is_some_and(is_step)),
        false => None,
    };
    for (i, column) in columns.into_iter().enumerate() {
        let unit = described(&column.name).and_then(|d| d.unit.clone());
        match column.cells {
            Cells::Real(values) if i == time => table.time = values,
            Cells::Real(values) if Some(i) == step => table.step = values.iter().map(|&v| v as u32).collect(),
            Cells::Real(values) => {
                table.schema.columns.push(Column { name: column.name, unit, kind: ColumnKind::Real });
                table.reals.push(values);
            }
            Cells::Label(_) if i == time => {
                return Err(FileError::Missing { path: path.to_path_buf(), missing: "no time column" });
            }
            Cells::Label(cells) => {
                let kind = ColumnKind::Label(cells.names);
                table.schema.columns.push(Column { name: column.name, unit, kind });
                table.labels.push(cells.positions);
            }
        }
    }
    table.schema.with_step = step.is_some();
    check_time(path, &table.time, |row| first_line + row as u64)?;
    Ok(table)
}

fn is_step(column: &FileColumn) -> bool {
    let Cells::Real(values) = &column.cells else { return false };
    column.name == "step" && values.iter().all(|&v| v == f64::from(v as u32))
}

/// Time never decreases and is a number.
pub(crate) fn check_time(path: &Path, time: &[f64], line: impl Fn(usize) -> u64) -> Result<(), FileError> {
    for (row, pair) in time.windows(2).enumerate() {
        if pair[1] < pair[0] || pair[1].is_nan() {
            let (before, time) = (pair[0], pair[1]);
            return Err(FileError::TimeDecreases {
                path: path.to_path_buf(),
                line: line(row + 1),
                before,
                time,
            });
        }
    }
    Ok(())
}

/// What rows of a schema have in common; asked for every row, so it is counted once.
pub(crate) struct RowShape {
    reals: usize,
    /// Names of each label.
    names: Vec<usize>,
}

impl RowShape {
    pub(crate) fn of(schema: &Schema) -> Self {
        let names = schema.columns.iter().filter_map(|column| match &column.kind {
            ColumnKind::Label(names) => Some(names.len()),
            ColumnKind::Real => None,
        });
        RowShape { reals: schema.reals(), names: names.collect() }
    }

    /// Whether a row fits `schema`, of which this is.
    pub(crate) fn check(&self, schema: &Schema, row: &Row<'_>) -> Result<(), RowMismatch> {
        let mut labels = row.labels.iter().zip(&self.names);
        let counts = row.reals.len() == self.reals && row.labels.len() == self.names.len();
        let fits = counts && labels.all(|(&position, &names)| (position as usize) < names);
        if fits { Ok(()) } else { check_row(schema, row) }
    }
}

/// Whether a row fits the schema.
fn check_row(schema: &Schema, row: &Row<'_>) -> Result<(), RowMismatch> {
    let (schema_reals, schema_labels) = (schema.reals(), schema.labels());
    if (row.reals.len(), row.labels.len()) != (schema_reals, schema_labels) {
        let (reals, labels) = (row.reals.len(), row.labels.len());
        return Err(RowMismatch::Count { reals, labels, schema_reals, schema_labels });
    }
    let labels = schema.columns.iter().filter_map(|column| match &column.kind {
        ColumnKind::Label(names) => Some((&column.name, names.len())),
        ColumnKind::Real => None,
    });
    for ((column, names), &position) in labels.zip(row.labels) {
        if position as usize >= names {
            return Err(RowMismatch::Label { column: column.clone(), position, names });
        }
    }
    Ok(())
}
