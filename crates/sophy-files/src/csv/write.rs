use std::fs::File;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use sophy_record::{ColumnKind, Metadata, Row, Schema, Sink, SinkError};

use crate::FileError;
use crate::columns::RowShape;
use crate::description::Description;
use crate::number::push_number;

/// Bytes kept before they are handed to the operating system.
const BUFFER: usize = 1 << 16;

/// Rows as CSV lines, with `FILE.meta.json` beside them.
///
/// The sidecar is written when the sink is made, so that a killed run has it, and again at the end.
pub(crate) struct CsvSink {
    /// `None` for stdout.
    path: Option<PathBuf>,
    schema: Schema,
    shape: RowShape,
    /// In the order of the file.
    columns: Vec<Cell>,
    metadata: Metadata,
    out: Box<dyn Write + Send>,
    /// Lines that `out` has not been given yet.
    lines: String,
}

/// What a row has for a column.
enum Cell {
    Real,
    /// One of these, as they stand in the file.
    Label(Vec<String>),
}

impl CsvSink {
    pub(crate) fn create(path: &Path, schema: &Schema, metadata: &Metadata) -> Result<Self, FileError> {
        let file = File::create(path).map_err(FileError::writing(path))?;
        Description::new(schema, metadata).write_beside(path)?;
        Self::start(Some(path.to_path_buf()), Box::new(file), schema, metadata)
    }

    pub(crate) fn stdout(schema: &Schema) -> Result<Self, FileError> {
        Self::start(None, Box::new(io::stdout()), schema, &Metadata::default())
    }

    fn start(
        path: Option<PathBuf>,
        out: Box<dyn Write + Send>,
        schema: &Schema,
        metadata: &Metadata,
    ) -> Result<Self, FileError> {
        let columns = schema.columns.iter().map(|column| match &column.kind {
            ColumnKind::Real => Cell::Real,
            ColumnKind::Label(names) => Cell::Label(names.iter().map(|name| quoted(name)).collect()),
        });
        let mut sink = CsvSink {
            path,
            schema: schema.clone(),
            shape: RowShape::of(schema),
            columns: columns.collect(),
            metadata: metadata.clone(),
            out,
            lines: head(schema),
        };
        sink.hand_over().map_err(FileError::writing(sink.name()))?;
        Ok(sink)
    }

    fn line(&mut self, row: Row<'_>) {
        let lines = &mut self.lines;
        push_number(lines, row.time);
        if self.schema.with_step {
            lines.push(',');
            lines.push_str(&row.step.to_string());
        }
        let (mut reals, mut labels) = (row.reals.iter(), row.labels.iter());
        for column in &self.columns {
            lines.push(',');
            match column {
                Cell::Real => push_number(lines, *reals.next().unwrap_or(&f64::NAN)),
                Cell::Label(names) => {
                    let name = labels.next().and_then(|&position| names.get(position as usize));
                    lines.push_str(name.map_or("", String::as_str));
                }
            }
        }
        lines.push('\n');
    }

    fn hand_over(&mut self) -> io::Result<()> {
        let written = self.out.write_all(self.lines.as_bytes());
        // Part of them may stand in the file: a second try would write that twice.
        self.lines.clear();
        written?;
        self.out.flush()
    }

    fn name(&self) -> &Path {
        self.path.as_deref().unwrap_or(Path::new("stdout"))
    }

    fn failed(&self, source: impl Into<Box<dyn std::error::Error + Send + Sync>>) -> SinkError {
        SinkError { sink: self.name().display().to_string(), source: source.into() }
    }
}

fn head(schema: &Schema) -> String {
    let step = schema.with_step.then_some("step");
    let names = schema.columns.iter().map(|column| column.name.as_str());
    let cells: Vec<String> = std::iter::once("time").chain(step).chain(names).map(quoted).collect();
    cells.join(",") + "\n"
}

/// A text as a cell. Numbers need no quotes.
fn quoted(text: &str) -> String {
    if text.contains([',', '"', '\n', '\r']) {
        format!("\"{}\"", text.replace('"', "\"\""))
    } else {
        text.to_owned()
    }
}

impl Sink for CsvSink {
    fn row(&mut self, row: Row<'_>) -> Result<(), SinkError> {
        self.shape.check(&self.schema, &row).map_err(|e| self.failed(e))?;
        self.line(row);
        if self.lines.len() >= BUFFER { self.flush() } else { Ok(()) }
    }

    fn flush(&mut self) -> Result<(), SinkError> {
        self.hand_over().map_err(|e| self.failed(e))
    }

    fn finish(&mut self, metadata: &Metadata) -> Result<(), SinkError> {
        self.flush()?;
        self.metadata.entries.extend(metadata.entries.clone());
        match &self.path {
            Some(path) => {
                Description::new(&self.schema, &self.metadata).write_beside(path).map_err(|e| self.failed(e))
            }
            None => Ok(()),
        }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test stops at the first surprise")]

    use super::quoted;

    #[test]
    fn texts_have_the_quotes_that_the_reader_expects() {
        let texts = ["x", "a b", " a ", "a,b", "a\"b", "\"", "two\nlines", "\r", "", "Größe", "a;b", "#"];
        for text in texts {
            let mut lines = csv::Writer::from_writer(Vec::new());
            lines.write_record(["0", text]).unwrap();
            let expected = String::from_utf8(lines.into_inner().unwrap()).unwrap();
            assert_eq!(format!("0,{}\n", quoted(text)), expected);
        }
    }
}
