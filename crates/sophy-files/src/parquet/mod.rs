//! Results as Parquet, through Parquet's own column writer: `time` and variables are required doubles, `step`
//! an unsigned 32-bit integer, locations and texts strings. Run metadata are key-value metadata; the key `sophy.columns`
//! holds units and names as JSON.

mod read;
mod write;

pub(crate) use read::read_parquet;
pub(crate) use write::ParquetSink;

/// Key of the column description.
const COLUMNS_KEY: &str = "sophy.columns";
