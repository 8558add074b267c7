//! The doors: which format a path means, and results in and out of it.

use std::path::{Path, PathBuf};

use sophy_record::{Metadata, Row, Schema, Sink, Table};

use crate::FileError;
use crate::arrow::{ArrowSink, read_arrow};
use crate::csv::{CsvSink, read_csv};
use crate::parquet::{ParquetSink, read_parquet};
use crate::path::extension;

/// Opens a result file for writing; the extension tells the format.
///
/// | path | format | killed |
/// | --- | --- | --- |
/// | `-` | CSV on stdout, without metadata | |
/// | `.csv` | CSV, and `FILE.meta.json` with the metadata, units and names | whole up to the last flush |
/// | `.arrow` | Arrow IPC stream | whole up to the last flush |
/// | `.parquet` | Parquet, made at the end from `FILE.parquet.journal`, an Arrow IPC stream | the journal is whole up to the last flush |
///
/// An older file of that name is replaced. `metadata` is what is known at the start; what only the end knows
/// goes to [`Sink::finish`]. In an Arrow stream, whose head is written first, that part stands in
/// `FILE.arrow.meta.json`.
///
/// # Errors
/// [`FileError::UnknownExtension`]; [`FileError::Write`] if the file cannot be made.
pub fn open_sink(path: &Path, schema: &Schema, metadata: &Metadata) -> Result<Box<dyn Sink>, FileError> {
    if path.as_os_str() == "-" {
        return Ok(Box::new(CsvSink::stdout(schema)?));
    }
    match extension(path).as_str() {
        "csv" => Ok(Box::new(CsvSink::create(path, schema, metadata)?)),
        "arrow" => Ok(Box::new(ArrowSink::create(path, schema, metadata)?)),
        "parquet" => Ok(Box::new(ParquetSink::create(path, schema, metadata)?)),
        _ => Err(FileError::UnknownExtension { path: path.to_path_buf(), known: ".csv, .arrow, .parquet" }),
    }
}

/// Reads a result file of any format, also one whose run was killed: a torn last line or message is left out.
///
/// If `FILE.parquet` is missing but its journal is there, the journal is read.
/// A column of text holds locations or other texts; the first column named `time`, or else the first of all, is the time.
/// A CSV line counts only with its line end.
///
/// # Errors
/// [`FileError`]: not readable, not of the format, cells that are no numbers, time that decreases.
pub fn read_table(path: &Path) -> Result<Table, FileError> {
    match extension(path).as_str() {
        "csv" => read_csv(path),
        "arrow" | "journal" => read_arrow(path),
        "parquet" => {
            let journal = journal_path(path);
            if !path.exists() && journal.exists() { read_arrow(&journal) } else { read_parquet(path) }
        }
        _ => Err(FileError::UnknownExtension {
            path: path.to_path_buf(),
            known: ".csv, .arrow, .parquet, .journal",
        }),
    }
}

/// Writes a whole result in the format of the extension, as [`open_sink`] does.
///
/// # Errors
/// As [`open_sink`] and its sink.
pub fn write_table(path: &Path, table: &Table) -> Result<(), FileError> {
    let mut sink = open_sink(path, &table.schema, &table.metadata)?;
    let (mut reals, mut labels) = (Vec::new(), Vec::new());
    for (i, &time) in table.time.iter().enumerate() {
        reals.clear();
        reals.extend(table.reals.iter().map(|column| column[i]));
        labels.clear();
        labels.extend(table.labels.iter().map(|column| column[i]));
        let step = if table.schema.with_step { table.step[i] } else { 0 };
        sink.row(Row { time, step, reals: &reals, labels: &labels })?;
    }
    sink.finish(&table.metadata)?;
    Ok(())
}

/// `FILE.parquet.journal`, from which `FILE.parquet` is made at the end.
pub(crate) fn journal_path(parquet: &Path) -> PathBuf {
    crate::path::beside(parquet, ".journal")
}
