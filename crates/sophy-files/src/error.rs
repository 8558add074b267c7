use std::path::{Path, PathBuf};

use sophy_record::SinkError;

/// A file could not be read, written or understood. Every variant says which file.
#[derive(Debug, thiserror::Error)]
pub enum FileError {
    /// The operating system refused to read.
    #[error("cannot read {}: {source}", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// Its reason.
        source: std::io::Error,
    },
    /// The operating system refused to write.
    #[error("cannot write {}: {source}", path.display())]
    Write {
        /// The file.
        path: PathBuf,
        /// Its reason.
        source: std::io::Error,
    },
    /// The extension names no format that serves here.
    #[error("cannot tell the format of {} by its extension; known are {known}", path.display())]
    UnknownExtension {
        /// The file.
        path: PathBuf,
        /// Extensions that would do.
        known: &'static str,
    },
    /// The content is not what the extension promises.
    #[error("{} is not a readable {format} file: {source}", path.display())]
    Format {
        /// The file.
        path: PathBuf,
        /// Name of the format.
        format: &'static str,
        /// What its reader says.
        source: Box<dyn std::error::Error + Send + Sync>,
    },
    /// A cell holds something else than it should.
    #[error("{}:{line}: column {column}: expected {expected}, found \"{text}\"", path.display())]
    Cell {
        /// The file.
        path: PathBuf,
        /// Line in the file, from 1.
        line: u64,
        /// Name of the column, or its position from 1 where it has none.
        column: String,
        /// The cell as written, cut if it is long.
        text: String,
        /// What belongs there.
        expected: &'static str,
    },
    /// A line has too few or too many cells.
    #[error("{}:{line}: {found} cells where the first line has {expected}", path.display())]
    CellCount {
        /// The file.
        path: PathBuf,
        /// Line in the file, from 1.
        line: u64,
        /// Cells of this line.
        found: usize,
        /// Cells of the first line.
        expected: usize,
    },
    /// Time runs backwards.
    #[error("{}:{line}: time falls from {before} s to {time} s; it may only grow, or stay at a jump", path.display())]
    TimeDecreases {
        /// The file.
        path: PathBuf,
        /// Line (of text) or row (of Arrow and Parquet), from 1.
        line: u64,
        /// Time of the row before, s.
        before: f64,
        /// Time of this row, s.
        time: f64,
    },
    /// Nothing in it that could be used.
    #[error("{} holds {missing}", path.display())]
    Missing {
        /// The file.
        path: PathBuf,
        /// What it lacks: "no rows", "no time column".
        missing: &'static str,
    },
    /// A column has a type that no result has.
    #[error("column {column} of {} has the type {found}; results hold numbers and text", path.display())]
    ColumnType {
        /// The file.
        path: PathBuf,
        /// Name of the column.
        column: String,
        /// Its type in the words of the format.
        found: String,
    },
    /// A variable that was asked for is not in the result.
    #[error("the result has no variable {name}; it has {known}")]
    NoVariable {
        /// The name asked for.
        name: String,
        /// Those there are.
        known: String,
    },
    /// A sink refused a row.
    #[error(transparent)]
    Sink(#[from] SinkError),
}

impl FileError {
    pub(crate) fn reading(path: &Path) -> impl FnOnce(std::io::Error) -> FileError {
        move |source| FileError::Read { path: path.to_path_buf(), source }
    }

    pub(crate) fn writing(path: &Path) -> impl FnOnce(std::io::Error) -> FileError {
        move |source| FileError::Write { path: path.to_path_buf(), source }
    }

    /// A cell of a text file that holds something else than `expected`.
    pub(crate) fn cell(
        path: &Path,
        line: u64,
        column: &str,
        text: &str,
        expected: &'static str,
    ) -> FileError {
        const LONGEST: usize = 60;
        let mut text: String = text.chars().take(LONGEST + 1).collect();
        if text.chars().count() > LONGEST {
            text.pop();
            text.push('…');
        }
        FileError::Cell { path: path.to_path_buf(), line, column: column.to_owned(), text, expected }
    }

    pub(crate) fn format<E>(path: &Path, format: &'static str) -> impl FnOnce(E) -> FileError
    where
        E: Into<Box<dyn std::error::Error + Send + Sync>>,
    {
        move |source| FileError::Format { path: path.to_path_buf(), format, source: source.into() }
    }
}

/// A row does not fit the schema its sink was opened with.
#[derive(Debug, thiserror::Error)]
pub(crate) enum RowMismatch {
    #[error(
        "a row of {reals} numbers and {labels} labels; the schema has {schema_reals} and {schema_labels}"
    )]
    Count { reals: usize, labels: usize, schema_reals: usize, schema_labels: usize },
    #[error("label {position} of column {column}, which has {names} names")]
    Label { column: String, position: u32, names: usize },
}
