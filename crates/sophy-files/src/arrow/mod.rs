//! Results as an Arrow IPC stream: `time` and variables as float64, `step` as uint32, locations and texts as
//! dictionary<uint32, utf8>. Units are field metadata (`unit`), run metadata is schema metadata.

mod batch;
mod read;
mod write;

pub(crate) use batch::{append, cells_for};
pub(crate) use read::read_arrow;
pub(crate) use write::ArrowSink;
