//! Input signals and input events from text files that people and instruments write.

use std::fs;
use std::path::Path;

use crate::FileError;
use crate::columns::check_time;

/// Signals over time.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct InputColumns {
    /// Time of each row, s; never decreasing, equal at a jump.
    pub time: Vec<f64>,
    /// Name and values of each other column of numbers. Without a header line the name is the column's
    /// position in the file, from 1.
    pub columns: Vec<(String, Vec<f64>)>,
}

/// Reads input signals from a text file of columns.
///
/// - Columns are separated by semicolons, tabs, commas or blanks: the first of these that the first line has.
/// - Lines that begin with `#` or `%` and empty lines are skipped.
/// - The first line is a header if one of its cells is no number.
/// - Time is the column named `time` or `t`, in any case and with or without a unit in brackets, or else the
///   first one.
/// - A column without any number, such as the locations of a result, is left out.
///
/// # Errors
/// [`FileError::Cell`] for a cell that is no finite number, [`FileError::CellCount`], [`FileError::TimeDecreases`],
/// [`FileError::Missing`] for a file without rows, [`FileError::Read`].
pub fn read_columns(path: &Path) -> Result<InputColumns, FileError> {
    let text = read_text(path)?;
    let lines = Lines::of(path, &text)?;
    let time =
        lines.header.as_ref().and_then(|header| header.iter().position(|name| is_time(name))).unwrap_or(0);
    let mut input = InputColumns::default();
    for column in 0..lines.width() {
        let is_text = lines.rows.iter().all(|row| row.cells[column].parse::<f64>().is_err());
        if is_text && column != time && !lines.rows.iter().all(|row| row.cells[column].is_empty()) {
            continue;
        }
        let values =
            lines.rows.iter().map(|row| lines.number(row, column)).collect::<Result<Vec<f64>, _>>()?;
        if column == time {
            input.time = values;
        } else {
            input.columns.push((lines.column_name(column), values));
        }
    }
    check_time(path, &input.time, |row| lines.rows[row].line)?;
    if input.columns.is_empty() {
        return Err(FileError::Missing {
            path: path.to_path_buf(),
            missing: "no column of numbers beside time",
        });
    }
    Ok(input)
}

/// Reads input events: lines of a time (s) and a label, separated and commented as in [`read_columns`].
///
/// # Errors
/// As [`read_columns`]; also [`FileError::Cell`] for an empty label.
pub fn read_event_labels(path: &Path) -> Result<Vec<(f64, String)>, FileError> {
    let text = read_text(path)?;
    let lines = Lines::of_events(path, &text)?;
    let mut events = Vec::new();
    for row in &lines.rows {
        if row.cells[1].is_empty() {
            return Err(lines.wrong(row, 1, "an event label"));
        }
        events.push((lines.number(row, 0)?, row.cells[1].to_owned()));
    }
    let time: Vec<f64> = events.iter().map(|event| event.0).collect();
    check_time(path, &time, |row| lines.rows[row].line)?;
    Ok(events)
}

/// The cells of a file, line by line.
struct Lines<'a> {
    path: &'a Path,
    header: Option<Vec<&'a str>>,
    rows: Vec<LineCells<'a>>,
}

struct LineCells<'a> {
    line: u64,
    cells: Vec<&'a str>,
}

impl<'a> Lines<'a> {
    fn of(path: &'a Path, text: &'a str) -> Result<Self, FileError> {
        let lines = Self::split(path, text, |cells| cells.iter().any(|cell| cell.parse::<f64>().is_err()))?;
        let missing = match (&lines.header, lines.rows.is_empty()) {
            (_, false) => return Ok(lines),
            (None, true) => "no rows",
            (Some(_), true) => "a header line but no rows",
        };
        Err(FileError::Missing { path: path.to_path_buf(), missing })
    }

    /// A header has no number where the time belongs. No events at all is a legal file.
    fn of_events(path: &'a Path, text: &'a str) -> Result<Self, FileError> {
        let lines = Self::split(path, text, |cells| cells.first().is_some_and(|time| is_time(time)))?;
        match lines.rows.first() {
            Some(row) if row.cells.len() != 2 => {
                let (line, found) = (row.line, row.cells.len());
                Err(FileError::CellCount { path: path.to_path_buf(), line, found, expected: 2 })
            }
            _ => Ok(lines),
        }
    }

    fn split(path: &'a Path, text: &'a str, is_header: impl Fn(&[&str]) -> bool) -> Result<Self, FileError> {
        let mut lines = Lines { path, header: None, rows: Vec::new() };
        let mut separator = None;
        let mut width = 0;
        for (number, line) in (1..).zip(text.lines()) {
            let content = line.trim();
            if content.is_empty() || content.starts_with(['#', '%']) {
                continue;
            }
            // Blanks at the end of a line may be empty cells between tabs.
            let first = separator.is_none();
            let separator = *separator.get_or_insert_with(|| Separator::of(content));
            let cells = separator.split(if separator == Separator::Blank { content } else { line });
            if first {
                width = cells.len();
                if is_header(&cells) {
                    lines.header = Some(cells);
                    continue;
                }
            }
            if cells.len() != width {
                let (found, expected) = (cells.len(), width);
                return Err(FileError::CellCount { path: path.to_path_buf(), line: number, found, expected });
            }
            lines.rows.push(LineCells { line: number, cells });
        }
        Ok(lines)
    }

    fn width(&self) -> usize {
        self.rows.first().map_or(0, |row| row.cells.len())
    }

    fn column_name(&self, column: usize) -> String {
        match &self.header {
            Some(header) => header[column].to_owned(),
            None => (column + 1).to_string(),
        }
    }

    fn number(&self, row: &LineCells<'_>, column: usize) -> Result<f64, FileError> {
        let text = row.cells[column];
        match text.parse::<f64>() {
            Ok(value) if value.is_finite() => Ok(value),
            Ok(_) => Err(self.wrong(row, column, "a finite number")),
            Err(_) if text.replacen(',', ".", 1).parse::<f64>().is_ok() => {
                Err(self.wrong(row, column, "a number with a decimal point instead of a comma"))
            }
            Err(_) => Err(self.wrong(row, column, "a number")),
        }
    }

    fn wrong(&self, row: &LineCells<'_>, column: usize, expected: &'static str) -> FileError {
        FileError::cell(self.path, row.line, &self.column_name(column), row.cells[column], expected)
    }
}

#[derive(Clone, Copy, PartialEq)]
enum Separator {
    Character(char),
    /// Any run of blanks.
    Blank,
}

impl Separator {
    /// The semicolon goes first: where it separates, a comma is a decimal comma.
    fn of(line: &str) -> Self {
        [';', '\t', ',']
            .into_iter()
            .find(|&c| line.contains(c))
            .map_or(Separator::Blank, Separator::Character)
    }

    fn split(self, line: &str) -> Vec<&str> {
        match self {
            Separator::Blank => line.split_whitespace().map(unquoted).collect(),
            Separator::Character(separator) => {
                let mut in_quotes = false;
                let cells = line.split(|c| {
                    in_quotes ^= c == '"';
                    c == separator && !in_quotes
                });
                cells.map(unquoted).collect()
            }
        }
    }
}

fn unquoted(cell: &str) -> &str {
    let cell = cell.trim();
    cell.strip_prefix('"').and_then(|cell| cell.strip_suffix('"')).unwrap_or(cell)
}

/// `time`, `T`, `Time (s)`, `t [s]`.
fn is_time(name: &str) -> bool {
    let bare = name.split(['(', '[']).next().unwrap_or(name).trim().to_lowercase();
    bare == "time" || bare == "t"
}

fn read_text(path: &Path) -> Result<String, FileError> {
    let text = fs::read_to_string(path).map_err(FileError::reading(path))?;
    Ok(match text.strip_prefix('\u{feff}') {
        Some(text) => text.to_owned(),
        None => text,
    })
}
