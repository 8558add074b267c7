use std::fs;
use std::io::Cursor;
use std::path::Path;

use arrow_array::RecordBatch;
use arrow_ipc::reader::{FileReader, StreamReader};
use arrow_schema::{ArrowError, SchemaRef};
use sophy_record::Table;

use super::batch::{append, cells_for};
use crate::FileError;
use crate::columns::{FileColumn, into_table};
use crate::description::{CellKind, ColumnDescription, Description};

/// Head of the Arrow *file* format, which other programs also name `.arrow`.
const FILE_MAGIC: &[u8] = b"ARROW1";

/// A message of a stream is not one.
#[derive(Debug, thiserror::Error)]
enum StreamError {
    #[error("the message at byte {0} is damaged")]
    Damaged(usize),
}

/// Reads an Arrow IPC stream or file; a torn last message is left out.
pub(crate) fn read_arrow(path: &Path) -> Result<Table, FileError> {
    let bytes = fs::read(path).map_err(FileError::reading(path))?;
    if bytes.starts_with(FILE_MAGIC) {
        let reader =
            FileReader::try_new(Cursor::new(&bytes), None).map_err(FileError::format(path, "Arrow"))?;
        return collect(path, reader.schema(), reader);
    }
    let whole = whole_messages(&bytes).map_err(FileError::format(path, "Arrow"))?;
    if whole == 0 {
        return Err(FileError::Missing { path: path.to_path_buf(), missing: "no Arrow schema" });
    }
    let reader = StreamReader::try_new(&bytes[..whole], None).map_err(FileError::format(path, "Arrow"))?;
    collect(path, reader.schema(), reader)
}

fn collect(
    path: &Path,
    schema: SchemaRef,
    batches: impl Iterator<Item = Result<RecordBatch, ArrowError>>,
) -> Result<Table, FileError> {
    let mut columns = Vec::new();
    let mut description =
        Description { metadata: schema.metadata().clone().into_iter().collect(), ..Default::default() };
    for field in schema.fields() {
        let cells = cells_for(field.data_type()).ok_or_else(|| FileError::ColumnType {
            path: path.to_path_buf(),
            column: field.name().clone(),
            found: field.data_type().to_string(),
        })?;
        columns.push(FileColumn { name: field.name().clone(), cells });
        let is_step = field.name() == "step" && *field.data_type() == arrow_schema::DataType::UInt32;
        description.columns.push(ColumnDescription {
            name: field.name().clone(),
            kind: if is_step { CellKind::Step } else { CellKind::Real },
            unit: field.metadata().get("unit").cloned(),
            names: Vec::new(),
        });
    }
    for batch in batches {
        let batch = batch.map_err(FileError::format(path, "Arrow"))?;
        for (column, array) in columns.iter_mut().zip(batch.columns()) {
            append(&mut column.cells, array);
        }
    }
    if let Some(end) = Description::read_beside(path)? {
        description.metadata.extend(end.metadata);
    }
    into_table(path, columns, description, 1)
}

/// Number of leading bytes that are whole messages.
///
/// A message is `FFFFFFFF`, the length of its head, the head (which says the length of the body), the body.
/// A kill can only cut the last one short; anything else that does not fit is damage, not a kill.
fn whole_messages(bytes: &[u8]) -> Result<usize, StreamError> {
    let mut at = 0;
    loop {
        let Some(prefix) = bytes.get(at..at + 8) else { return Ok(at) };
        let word = |i: usize| u32::from_le_bytes([prefix[i], prefix[i + 1], prefix[i + 2], prefix[i + 3]]);
        if word(0) != u32::MAX {
            return Err(StreamError::Damaged(at));
        }
        let head = word(4) as usize;
        if head == 0 {
            return Ok(at + 8);
        }
        let Some(head) = bytes.get(at + 8..at + 8 + head) else { return Ok(at) };
        let message = arrow_ipc::root_as_message(head).map_err(|_| StreamError::Damaged(at))?;
        let body = usize::try_from(message.bodyLength()).map_err(|_| StreamError::Damaged(at))?;
        let end = (at + 8 + head.len()).saturating_add(body);
        if end > bytes.len() {
            return Ok(at);
        }
        at = end;
    }
}
