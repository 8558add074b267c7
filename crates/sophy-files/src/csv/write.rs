use std::fs::File;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use sophy_record::{ColumnKind, Metadata, Row, Schema, Sink, SinkError};

use crate::FileError;
use crate::columns::check_row;
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
    metadata: Metadata,
    lines: csv::Writer<Box<dyn Write + Send>>,
    cell: String,
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
        let lines = csv::WriterBuilder::new().buffer_capacity(BUFFER).from_writer(out);
        let (schema, metadata) = (schema.clone(), metadata.clone());
        let mut sink = CsvSink { path, schema, metadata, lines, cell: String::new() };
        sink.head().map_err(FileError::writing(sink.name()))?;
        Ok(sink)
    }

    fn head(&mut self) -> io::Result<()> {
        self.lines.write_field("time")?;
        if self.schema.with_step {
            self.lines.write_field("step")?;
        }
        for column in &self.schema.columns {
            self.lines.write_field(&column.name)?;
        }
        self.lines.write_record(None::<&[u8]>)?;
        self.lines.flush()
    }

    fn line(&mut self, row: Row<'_>) -> csv::Result<()> {
        number(&mut self.lines, &mut self.cell, row.time)?;
        if self.schema.with_step {
            self.lines.write_field(row.step.to_string())?;
        }
        let (mut reals, mut labels) = (row.reals.iter(), row.labels.iter());
        for column in &self.schema.columns {
            match &column.kind {
                ColumnKind::Real => {
                    number(&mut self.lines, &mut self.cell, *reals.next().unwrap_or(&f64::NAN))?;
                }
                ColumnKind::Label(names) => {
                    let name = labels.next().and_then(|&position| names.get(position as usize));
                    self.lines.write_field(name.map_or("", String::as_str))?;
                }
            }
        }
        self.lines.write_record(None::<&[u8]>)
    }

    fn name(&self) -> &Path {
        self.path.as_deref().unwrap_or(Path::new("stdout"))
    }

    fn failed(&self, source: impl Into<Box<dyn std::error::Error + Send + Sync>>) -> SinkError {
        SinkError { sink: self.name().display().to_string(), source: source.into() }
    }
}

fn number(lines: &mut csv::Writer<Box<dyn Write + Send>>, cell: &mut String, value: f64) -> csv::Result<()> {
    cell.clear();
    push_number(cell, value);
    lines.write_field(&*cell)
}

impl Sink for CsvSink {
    fn row(&mut self, row: Row<'_>) -> Result<(), SinkError> {
        check_row(&self.schema, &row).map_err(|e| self.failed(e))?;
        self.line(row).map_err(|e| self.failed(e))
    }

    fn flush(&mut self) -> Result<(), SinkError> {
        self.lines.flush().map_err(|e| self.failed(e))
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
