use std::fs::File;
use std::path::Path;

use parquet::basic::{ConvertedType, Type};
use parquet::column::reader::{ColumnReader, ColumnReaderImpl};
use parquet::data_type::{ByteArray, DataType};
use parquet::errors::Result as ParquetResult;
use parquet::file::reader::{FileReader, SerializedFileReader};
use sophy_record::Table;

use super::COLUMNS_KEY;
use crate::FileError;
use crate::columns::{Cells, FileColumn, into_table};
use crate::description::Description;

/// Reads a Parquet result, ours or a flat one of another program (numbers and strings, missing ones too).
pub(crate) fn read_parquet(path: &Path) -> Result<Table, FileError> {
    let file = File::open(path).map_err(FileError::reading(path))?;
    let reader = SerializedFileReader::new(file).map_err(FileError::format(path, "Parquet"))?;
    let mut description = Description::default();
    for pair in reader.metadata().file_metadata().key_value_metadata().into_iter().flatten() {
        let Some(value) = &pair.value else { continue };
        if pair.key == COLUMNS_KEY {
            description.columns = serde_json::from_str(value).map_err(FileError::format(path, "Parquet"))?;
        } else {
            description.metadata.insert(pair.key.clone(), value.clone());
        }
    }
    let mut columns = Vec::new();
    for column in reader.metadata().file_metadata().schema_descr().columns() {
        let name = column.path().string();
        let cells = match column.physical_type() {
            Type::DOUBLE | Type::FLOAT | Type::INT32 | Type::INT64 if column.max_rep_level() == 0 => {
                Cells::Real(Vec::new())
            }
            Type::BYTE_ARRAY if column.max_rep_level() == 0 => Cells::labels(&name, &description),
            other => {
                let found = other.to_string();
                return Err(FileError::ColumnType { path: path.to_path_buf(), column: name, found });
            }
        };
        columns.push(FileColumn { name, cells });
    }
    read_groups(&reader, &mut columns).map_err(FileError::format(path, "Parquet"))?;
    into_table(path, columns, description, 1)
}

fn read_groups(reader: &SerializedFileReader<File>, columns: &mut [FileColumn]) -> ParquetResult<()> {
    for group in 0..reader.num_row_groups() {
        let group = reader.get_row_group(group)?;
        let rows = usize::try_from(group.metadata().num_rows()).unwrap_or(0);
        for (i, column) in columns.iter_mut().enumerate() {
            let kind = group.metadata().column(i).column_descr_ptr();
            let highest = kind.max_def_level();
            let unsigned = kind.converted_type() == ConvertedType::UINT_32;
            let cells = &mut column.cells;
            match group.get_column_reader(i)? {
                ColumnReader::DoubleColumnReader(r) => {
                    read(r, rows, highest, |v| cells.push_real(v.copied()))?;
                }
                ColumnReader::FloatColumnReader(r) => {
                    read(r, rows, highest, |v| cells.push_real(v.map(|&v| v.into())))?;
                }
                ColumnReader::Int32ColumnReader(r) if unsigned => {
                    read(r, rows, highest, |v| cells.push_real(v.map(|v| v.cast_unsigned().into())))?;
                }
                ColumnReader::Int32ColumnReader(r) => {
                    read(r, rows, highest, |v| cells.push_real(v.map(|&v| v.into())))?;
                }
                ColumnReader::Int64ColumnReader(r) => {
                    read(r, rows, highest, |v| cells.push_real(v.map(|&v| v as f64)))?;
                }
                ColumnReader::ByteArrayColumnReader(r) => read(r, rows, highest, |v: Option<&ByteArray>| {
                    cells.push_text(&v.map_or_else(Default::default, |v| String::from_utf8_lossy(v.data())));
                })?,
                // Refused above by its type.
                _ => {}
            }
        }
    }
    Ok(())
}

/// Hands the cells of a column of one row group to `push`, `None` for a missing one.
fn read<T: DataType>(
    mut reader: ColumnReaderImpl<T>,
    rows: usize,
    highest: i16,
    mut push: impl FnMut(Option<&T::T>),
) -> ParquetResult<()> {
    let (mut values, mut levels) = (Vec::with_capacity(rows), Vec::new());
    let mut left = rows;
    while left > 0 {
        let (records, _, _) = reader.read_records(left, Some(&mut levels), None, &mut values)?;
        if records == 0 {
            break;
        }
        left -= records;
    }
    if highest == 0 {
        values.iter().for_each(|value| push(Some(value)));
        return Ok(());
    }
    // A level below the highest says that the cell is missing.
    let mut present = values.iter();
    for level in levels {
        push(if level == highest { present.next() } else { None });
    }
    Ok(())
}
