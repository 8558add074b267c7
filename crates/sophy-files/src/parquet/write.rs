use std::fs::File;
use std::io::{BufReader, Write};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use arrow_ipc::reader::StreamReader;
use parquet::basic::{Compression, IntType, LogicalType, Repetition, Type as Physical};
use parquet::data_type::{ByteArray, ByteArrayType, DataType, DoubleType, Int32Type};
use parquet::errors::{ParquetError, Result as ParquetResult};
use parquet::file::metadata::KeyValue;
use parquet::file::properties::WriterProperties;
use parquet::file::writer::{SerializedFileWriter, SerializedRowGroupWriter};
use parquet::schema::types::Type;
use sophy_record::{Metadata, Row, Schema, Sink, SinkError};

use super::COLUMNS_KEY;
use crate::FileError;
use crate::arrow::{ArrowSink, append, cells_for};
use crate::columns::Cells;
use crate::description::{CellKind, Description};
use crate::path::{remove_if_there, write_whole};
use crate::results::journal_path;

/// Rows of one row group.
const ROW_GROUP: usize = 1 << 17;

/// Rows into an Arrow journal, and the journal into Parquet at the end.
///
/// Parquet has its index at the end of the file and is nothing without it, so a run cannot write it as it goes.
pub(crate) struct ParquetSink {
    path: PathBuf,
    journal: ArrowSink,
    schema: Schema,
    metadata: Metadata,
}

impl ParquetSink {
    pub(crate) fn create(path: &Path, schema: &Schema, metadata: &Metadata) -> Result<Self, FileError> {
        // Nobody shall take the result of an earlier run for that of this one, should this one be killed.
        remove_if_there(path)?;
        let journal = ArrowSink::create(&journal_path(path), schema, metadata)?;
        Ok(ParquetSink {
            path: path.to_path_buf(),
            journal,
            schema: schema.clone(),
            metadata: metadata.clone(),
        })
    }
}

impl Sink for ParquetSink {
    fn row(&mut self, row: Row<'_>) -> Result<(), SinkError> {
        self.journal.row(row)
    }

    fn flush(&mut self) -> Result<(), SinkError> {
        self.journal.flush()
    }

    fn finish(&mut self, metadata: &Metadata) -> Result<(), SinkError> {
        self.journal.end()?;
        self.metadata.entries.extend(metadata.entries.clone());
        let journal = journal_path(&self.path);
        let description = Description::new(&self.schema, &self.metadata);
        write_whole(&self.path, |out| convert(&journal, out, &description, &self.path))
            .and_then(|()| remove_if_there(&journal))
            .map_err(|error| SinkError { sink: self.path.display().to_string(), source: Box::new(error) })
    }
}

/// Writes the rows of a journal as Parquet.
fn convert(
    journal: &Path,
    out: &mut (dyn Write + Send),
    description: &Description,
    path: &Path,
) -> Result<(), FileError> {
    let in_journal = |error| FileError::format(journal, "Arrow")(error);
    let in_parquet = |error| FileError::format(path, "Parquet")(error);
    let file = BufReader::new(File::open(journal).map_err(FileError::reading(journal))?);
    let batches = StreamReader::try_new(file, None).map_err(in_journal)?;
    let mut cells: Vec<Cells> =
        batches.schema().fields().iter().filter_map(|field| cells_for(field.data_type())).collect();

    let mut writer = start(out, description).map_err(in_parquet)?;
    for batch in batches {
        let batch = batch.map_err(in_journal)?;
        for (cells, array) in cells.iter_mut().zip(batch.columns()) {
            append(cells, array);
        }
        if cells.first().is_some_and(|time| time.len() >= ROW_GROUP) {
            write_group(&mut writer, description, &mut cells).map_err(in_parquet)?;
        }
    }
    if cells.first().is_some_and(|time| time.len() > 0) {
        write_group(&mut writer, description, &mut cells).map_err(in_parquet)?;
    }
    writer.close().map_err(in_parquet)?;
    Ok(())
}

fn start<W: Write + Send>(out: W, description: &Description) -> ParquetResult<SerializedFileWriter<W>> {
    let mut fields = Vec::new();
    for column in &description.columns {
        let (physical, logical) = match column.kind {
            CellKind::Time | CellKind::Real => (Physical::DOUBLE, None),
            CellKind::Step => {
                (Physical::INT32, Some(LogicalType::Integer(IntType { bit_width: 32, is_signed: false })))
            }
            CellKind::Location | CellKind::Text => (Physical::BYTE_ARRAY, Some(LogicalType::String)),
        };
        let field = Type::primitive_type_builder(&column.name, physical)
            .with_repetition(Repetition::REQUIRED)
            .with_logical_type(logical)
            .build()?;
        fields.push(Arc::new(field));
    }
    let root = Type::group_type_builder("result").with_fields(fields).build()?;
    let mut pairs = description.metadata.clone();
    let columns =
        serde_json::to_string(&description.columns).map_err(|e| ParquetError::External(Box::new(e)))?;
    pairs.insert(COLUMNS_KEY.to_owned(), columns);
    let pairs = pairs.into_iter().map(|(key, value)| KeyValue::new(key, value)).collect();
    let properties = WriterProperties::builder()
        .set_compression(Compression::SNAPPY)
        .set_key_value_metadata(Some(pairs))
        .build();
    SerializedFileWriter::new(out, Arc::new(root), Arc::new(properties))
}

/// Writes the rows in `cells` as one row group and empties them.
fn write_group<W: Write + Send>(
    writer: &mut SerializedFileWriter<W>,
    description: &Description,
    cells: &mut [Cells],
) -> ParquetResult<()> {
    let mut group = writer.next_row_group()?;
    for (column, cells) in description.columns.iter().zip(cells) {
        match cells {
            Cells::Real(values) if column.kind == CellKind::Step => {
                let steps: Vec<i32> = values.iter().map(|&step| (step as u32).cast_signed()).collect();
                write_column::<Int32Type, W>(&mut group, &steps)?;
            }
            Cells::Real(values) => write_column::<DoubleType, W>(&mut group, values)?,
            Cells::Label(labels) => {
                let texts: Vec<ByteArray> = labels.texts().map(ByteArray::from).collect();
                write_column::<ByteArrayType, W>(&mut group, &texts)?;
            }
        }
        cells.clear();
    }
    group.close()?;
    Ok(())
}

fn write_column<T: DataType, W: Write + Send>(
    group: &mut SerializedRowGroupWriter<'_, W>,
    values: &[T::T],
) -> ParquetResult<()> {
    if let Some(mut column) = group.next_column()? {
        column.typed::<T>().write_batch(values, None, None)?;
        column.close()?;
    }
    Ok(())
}
