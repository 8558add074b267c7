use std::fs::File;
use std::io::BufWriter;
use std::path::{Path, PathBuf};

use arrow_array::ArrayRef;
use arrow_ipc::writer::StreamWriter;
use arrow_schema::{ArrowError, SchemaRef};
use sophy_record::{Metadata, Row, Schema, Sink, SinkError, Table};

use super::batch::{arrow_schema, dictionaries, take_batch};
use crate::FileError;
use crate::columns::RowShape;
use crate::description::{Description, sidecar_path};
use crate::path::remove_if_there;

/// Rows of one message, unless a flush comes first.
const BATCH: usize = 8192;

/// Rows as messages of an Arrow IPC stream.
pub(crate) struct ArrowSink {
    path: PathBuf,
    stream: StreamWriter<BufWriter<File>>,
    schema: SchemaRef,
    shape: RowShape,
    dictionaries: Vec<ArrayRef>,
    /// Rows of the next message, and the metadata of the start.
    pending: Table,
}

impl ArrowSink {
    pub(crate) fn create(path: &Path, schema: &Schema, metadata: &Metadata) -> Result<Self, FileError> {
        remove_if_there(&sidecar_path(path))?;
        let file = BufWriter::new(File::create(path).map_err(FileError::writing(path))?);
        let pending = Table::new(schema.clone(), metadata.clone());
        let shape = RowShape::of(schema);
        let (schema, dictionaries) = (arrow_schema(schema, metadata), dictionaries(schema));
        let started = StreamWriter::try_new(file, &schema).and_then(|stream| {
            let mut sink =
                ArrowSink { path: path.to_path_buf(), stream, schema, shape, dictionaries, pending };
            // An empty first message carries the names of labels, so that they stand whatever happens.
            sink.message()?;
            sink.stream.flush()?;
            Ok(sink)
        });
        started.map_err(|error| FileError::writing(path)(std::io::Error::other(error)))
    }

    fn message(&mut self) -> Result<(), ArrowError> {
        let batch = take_batch(&mut self.pending, &self.schema, &self.dictionaries)?;
        self.stream.write(&batch)
    }

    /// Ends the stream, without a word about the end of the run.
    pub(crate) fn end(&mut self) -> Result<(), SinkError> {
        self.flush()?;
        self.stream.finish().map_err(|e| self.failed(e))
    }

    fn failed(&self, source: impl Into<Box<dyn std::error::Error + Send + Sync>>) -> SinkError {
        SinkError { sink: self.path.display().to_string(), source: source.into() }
    }
}

impl Sink for ArrowSink {
    fn row(&mut self, row: Row<'_>) -> Result<(), SinkError> {
        self.shape.check(&self.pending.schema, &row).map_err(|e| self.failed(e))?;
        self.pending.row(row)?;
        if self.pending.len() >= BATCH {
            self.message().map_err(|e| self.failed(e))?;
        }
        Ok(())
    }

    fn flush(&mut self) -> Result<(), SinkError> {
        if !self.pending.is_empty() {
            self.message().map_err(|e| self.failed(e))?;
        }
        self.stream.flush().map_err(|e| self.failed(e))
    }

    fn finish(&mut self, metadata: &Metadata) -> Result<(), SinkError> {
        self.end()?;
        let mut all = self.pending.metadata.clone();
        all.entries.extend(metadata.entries.clone());
        Description::new(&self.pending.schema, &all).write_beside(&self.path).map_err(|e| self.failed(e))
    }
}
