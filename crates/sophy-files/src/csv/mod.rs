//! CSV results.

mod read;
mod write;

pub(crate) use read::read_csv;
pub(crate) use write::CsvSink;
