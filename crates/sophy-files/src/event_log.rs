//! The event log: a CSV of the transitions taken.

use std::fs;
use std::fs::File;
use std::path::{Path, PathBuf};

use sophy_record::{EventRecord, Metadata};

use crate::FileError;
use crate::description::Description;
use crate::number::push_number;

const HEADER: [&str; 6] = ["time", "micro_step", "component", "transition", "from", "to"];

/// Writes transitions as lines of `time,micro_step,component,transition,from,to`, time in s.
///
/// The run's metadata stands in `FILE.meta.json` beside it.
pub struct EventLog {
    path: PathBuf,
    lines: csv::Writer<File>,
    metadata: Metadata,
}

impl EventLog {
    /// Makes the file, replacing an older one.
    ///
    /// # Errors
    /// [`FileError::Write`].
    pub fn create(path: &Path, metadata: &Metadata) -> Result<Self, FileError> {
        let lines = csv::Writer::from_writer(File::create(path).map_err(FileError::writing(path))?);
        let mut log = EventLog { path: path.to_path_buf(), lines, metadata: metadata.clone() };
        log.describe()?;
        log.lines.write_record(HEADER).map_err(|e| log.failed(e))?;
        log.flush()?;
        Ok(log)
    }

    /// Appends one transition.
    ///
    /// # Errors
    /// [`FileError::Write`].
    pub fn append(&mut self, event: &EventRecord) -> Result<(), FileError> {
        let mut time = String::new();
        push_number(&mut time, event.time);
        let step = event.step.to_string();
        let cells = [&time, &step, &event.component, &event.transition, &event.from, &event.to];
        self.lines.write_record(cells).map_err(|e| self.failed(e))
    }

    /// Hands everything appended to the operating system, so that it outlives this process.
    ///
    /// # Errors
    /// [`FileError::Write`].
    pub fn flush(&mut self) -> Result<(), FileError> {
        self.lines.flush().map_err(FileError::writing(&self.path))
    }

    /// Completes the log; `metadata` adds what was known only at the end.
    ///
    /// # Errors
    /// [`FileError::Write`].
    pub fn finish(&mut self, metadata: &Metadata) -> Result<(), FileError> {
        self.flush()?;
        self.metadata.entries.extend(metadata.entries.clone());
        self.describe()
    }

    fn describe(&self) -> Result<(), FileError> {
        let metadata = self.metadata.entries.clone();
        Description { metadata, columns: Vec::new() }.write_beside(&self.path)
    }

    fn failed(&self, error: csv::Error) -> FileError {
        FileError::writing(&self.path)(error.into())
    }
}

/// Reads an event log; a torn last line is left out.
///
/// # Errors
/// [`FileError::Read`], [`FileError::CellCount`], [`FileError::Cell`].
pub fn read_events(path: &Path) -> Result<Vec<EventRecord>, FileError> {
    let bytes = fs::read(path).map_err(FileError::reading(path))?;
    let whole = bytes.iter().rposition(|&b| b == b'\n').map_or(0, |end| end + 1);
    let mut reader = csv::ReaderBuilder::new().flexible(true).from_reader(&bytes[..whole]);
    let mut events = Vec::new();
    for record in reader.records() {
        let record = record.map_err(FileError::format(path, "CSV"))?;
        let line = record.position().map_or(0, csv::Position::line);
        if record.len() != HEADER.len() {
            let (found, expected) = (record.len(), HEADER.len());
            return Err(FileError::CellCount { path: path.to_path_buf(), line, found, expected });
        }
        let wrong = |i: usize, expected| FileError::cell(path, line, HEADER[i], &record[i], expected);
        events.push(EventRecord {
            time: record[0].parse().map_err(|_| wrong(0, "a number"))?,
            step: record[1].parse().map_err(|_| wrong(1, "a whole number"))?,
            component: record[2].to_owned(),
            transition: record[3].to_owned(),
            from: record[4].to_owned(),
            to: record[5].to_owned(),
        });
    }
    Ok(events)
}
