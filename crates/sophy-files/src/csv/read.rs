use std::fs;
use std::path::Path;

use sophy_record::Table;

use crate::FileError;
use crate::columns::{Cells, FileColumn, into_table};
use crate::description::Description;

/// Reads a CSV result; a last line without its line end was torn by a kill and is left out.
pub(crate) fn read_csv(path: &Path) -> Result<Table, FileError> {
    let bytes = fs::read(path).map_err(FileError::reading(path))?;
    let whole = bytes.iter().rposition(|&b| b == b'\n').map_or(0, |end| end + 1);
    let text = std::str::from_utf8(&bytes[..whole]).map_err(FileError::format(path, "CSV"))?;
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let description = Description::read_beside(path)?.unwrap_or_default();

    let mut reader = csv::ReaderBuilder::new().flexible(true).from_reader(text.as_bytes());
    let header = reader.headers().map_err(FileError::format(path, "CSV"))?.clone();
    if header.is_empty() {
        return Err(FileError::Missing { path: path.to_path_buf(), missing: "no header line" });
    }
    let mut columns: Vec<FileColumn> = Vec::new();
    let mut record = csv::StringRecord::new();
    while reader.read_record(&mut record).map_err(FileError::format(path, "CSV"))? {
        let line = record.position().map_or(0, csv::Position::line);
        if record.len() != header.len() {
            let (found, expected) = (record.len(), header.len());
            return Err(FileError::CellCount { path: path.to_path_buf(), line, found, expected });
        }
        if columns.is_empty() {
            columns = start_columns(&header, Some(&record), &description);
        }
        for (column, text) in columns.iter_mut().zip(&record) {
            match &mut column.cells {
                Cells::Label(labels) => labels.push(text),
                Cells::Real(values) => values.push(
                    number(text)
                        .ok_or_else(|| FileError::cell(path, line, &column.name, text, "a number"))?,
                ),
            }
        }
    }
    if columns.is_empty() {
        columns = start_columns(&header, None, &description);
    }
    into_table(path, columns, description, 2)
}

/// Columns are what the description says, or else numbers if their first cell is one.
fn start_columns(
    header: &csv::StringRecord,
    first: Option<&csv::StringRecord>,
    description: &Description,
) -> Vec<FileColumn> {
    let is_label = |i: usize, name: &str| match description.columns.iter().find(|c| c.name == name) {
        Some(column) => column.kind.is_label(),
        None => first.is_some_and(|cells| number(&cells[i]).is_none()),
    };
    let cells = |(i, name): (usize, &str)| {
        let cells =
            if is_label(i, name) { Cells::labels(name, description) } else { Cells::Real(Vec::new()) };
        FileColumn { name: name.to_owned(), cells }
    };
    header.iter().enumerate().map(cells).collect()
}

/// An empty cell is a missing value.
fn number(text: &str) -> Option<f64> {
    let text = text.trim();
    if text.is_empty() { Some(f64::NAN) } else { text.parse().ok() }
}
