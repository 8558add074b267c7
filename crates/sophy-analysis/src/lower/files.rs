use super::record::Record;
use sophy_diagnostics::{SourceId, World};
use sophy_ir::{Interpolation, Table};
use std::collections::HashMap;
use std::fmt;
use std::path::PathBuf;
use std::rc::Rc;

/// Tables and data files: each is read once per analysis.
pub(crate) struct Files<'a> {
    world: &'a dyn World,
    /// See [`sophy_ir::Model::tables`].
    pub(crate) tables: Vec<Table>,
    folders: HashMap<SourceId, PathBuf>,
    texts: HashMap<PathBuf, Result<Rc<Text>, FileMistake>>,
    records: HashMap<PathBuf, Result<Rc<Record>, FileMistake>>,
    known: HashMap<(PathBuf, Column), usize>,
}

/// A column of a file over another one.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub(super) struct Column {
    /// As written.
    pub(super) file: String,
    pub(super) name: String,
    /// The column of the knots, if the file has it; else it is the first.
    pub(super) knots: Option<&'static str>,
    pub(super) between: Interpolation,
    pub(super) extends: bool,
}

/// What is wrong with a file.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum FileMistake {
    /// It cannot be read; what the system says.
    Unreadable(String),
    /// A line cannot be understood.
    Malformed { line: u64, reason: String },
    /// There is no such column; those there are.
    NoColumn { name: String, columns: Vec<String> },
    /// A field is no number.
    NotANumber { line: u64, column: String, field: String },
    /// Knots do not increase.
    NotIncreasing { line: u64, column: String, before: f64, here: f64 },
    /// There are too few lines.
    TooShort { needed: usize },
}

/// A file of comma-separated values, in fields.
struct Text {
    columns: Vec<String>,
    /// With the lines they stand in.
    rows: Vec<(u64, csv::StringRecord)>,
}

impl<'a> Files<'a> {
    /// Paths start from where `world` does, until [`Files::set_folder`] says something else.
    pub(crate) fn new(world: &'a dyn World) -> Self {
        Files {
            world,
            tables: Vec::new(),
            folders: HashMap::new(),
            texts: HashMap::new(),
            records: HashMap::new(),
            known: HashMap::new(),
        }
    }

    /// Paths that are written in `source` start from `folder`.
    pub(crate) fn set_folder(&mut self, source: SourceId, folder: PathBuf) {
        self.folders.insert(source, folder);
    }

    fn path(&self, file: &str, source: SourceId) -> PathBuf {
        self.folders.get(&source).map_or_else(|| PathBuf::from(file), |folder| folder.join(file))
    }

    /// The number of a table.
    pub(super) fn table(&mut self, column: &Column, source: SourceId) -> Result<usize, FileMistake> {
        let path = self.path(&column.file, source);
        let key = (path.clone(), column.clone());
        if let Some(&table) = self.known.get(&key) {
            return Ok(table);
        }
        let world = self.world;
        let text = self.texts.entry(path.clone()).or_insert_with(|| {
            let bytes = world.read(&path).map_err(|error| FileMistake::Unreadable(error.reason))?;
            read(&bytes).map(Rc::new)
        });
        let table = text.clone()?.table(column)?;
        self.tables.push(table);
        self.known.insert(key, self.tables.len() - 1);
        Ok(self.tables.len() - 1)
    }

    /// The constants of a file.
    pub(super) fn data(&mut self, file: &str, source: SourceId) -> Result<Rc<Record>, FileMistake> {
        let path = self.path(file, source);
        let world = self.world;
        let record = self.records.entry(path.clone()).or_insert_with(|| {
            let bytes = world.read(&path).map_err(|error| FileMistake::Unreadable(error.reason))?;
            let text = String::from_utf8_lossy(&bytes);
            let table: toml::Table = text.parse().map_err(|error: toml::de::Error| {
                let start = error.span().map_or(0, |span| span.start);
                let before = text.get(..start).unwrap_or("");
                let line = 1 + before.bytes().filter(|&byte| byte == b'\n').count() as u64;
                let reason = error.message().lines().next().unwrap_or("").to_owned();
                FileMistake::Malformed { line, reason }
            })?;
            Ok(Rc::new(Record::from(&table)))
        });
        record.clone()
    }
}

fn read(bytes: &[u8]) -> Result<Text, FileMistake> {
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    let mut reader = csv::ReaderBuilder::new()
        .trim(csv::Trim::All)
        .comment(Some(b'#'))
        .has_headers(true)
        .from_reader(bytes);
    let malformed = |error: csv::Error| {
        let line = error.position().map_or(1, csv::Position::line);
        let reason = match error.kind() {
            csv::ErrorKind::UnequalLengths { expected_len, len, .. } => {
                format!("it has {len} fields, the line before it {expected_len}")
            }
            csv::ErrorKind::Utf8 { .. } => "it is not UTF-8".to_owned(),
            _ => error.to_string(),
        };
        FileMistake::Malformed { line, reason }
    };
    let columns = reader.headers().map_err(malformed)?.iter().map(str::to_owned).collect();
    let mut rows = Vec::new();
    for record in reader.records() {
        let record = record.map_err(malformed)?;
        rows.push((record.position().map_or(0, csv::Position::line), record));
    }
    Ok(Text { columns, rows })
}

impl Text {
    fn table(&self, column: &Column) -> Result<Table, FileMistake> {
        let named = |name: &str| self.columns.iter().position(|column| column == name);
        let Some(values) = named(&column.name) else {
            return Err(FileMistake::NoColumn { name: column.name.clone(), columns: self.columns.clone() });
        };
        let of_time = |name: &str| self.columns.iter().position(|column| column.eq_ignore_ascii_case(name));
        let knots = column.knots.and_then(of_time).unwrap_or(0);
        let needed = match column.between {
            Interpolation::Hold => 1,
            Interpolation::Linear => 2,
            Interpolation::Cubic => 3,
        };
        if self.rows.len() < needed {
            return Err(FileMistake::TooShort { needed });
        }
        let name = format!("{}: {}", column.file, column.name);
        let (knots, values) = (self.increasing(knots)?, self.numbers(values)?);
        Ok(Table { name, knots, values, between: column.between, extends: column.extends })
    }

    fn numbers(&self, column: usize) -> Result<Vec<f64>, FileMistake> {
        let number = |(line, row): &(u64, csv::StringRecord)| {
            let field = row.get(column).unwrap_or("");
            field.parse().ok().filter(|x: &f64| x.is_finite()).ok_or_else(|| FileMistake::NotANumber {
                line: *line,
                column: self.columns.get(column).cloned().unwrap_or_default(),
                field: field.to_owned(),
            })
        };
        self.rows.iter().map(number).collect()
    }

    fn increasing(&self, column: usize) -> Result<Vec<f64>, FileMistake> {
        let numbers = self.numbers(column)?;
        let falls = numbers.iter().zip(numbers.iter().skip(1)).position(|(before, here)| before >= here);
        let Some(position) = falls else { return Ok(numbers) };
        let at = |position: usize| numbers.get(position).copied().unwrap_or(f64::NAN);
        Err(FileMistake::NotIncreasing {
            line: self.rows.get(position + 1).map_or(0, |(line, _)| *line),
            column: self.columns.get(column).cloned().unwrap_or_default(),
            before: at(position),
            here: at(position + 1),
        })
    }
}

/// The value of a table within its range, where it needs no spline.
pub(super) fn value_at(table: &Table, x: f64) -> Option<f64> {
    let after = table.knots.partition_point(|&knot| knot <= x);
    let value = |position: usize| table.values.get(position).copied();
    let before = after.checked_sub(1)?;
    let (Some(&low), Some(&high)) = (table.knots.get(before), table.knots.get(after)) else {
        return value(before);
    };
    match table.between {
        Interpolation::Hold => value(before),
        Interpolation::Linear => {
            let (y, next) = (value(before)?, value(after)?);
            Some(y + (x - low) * ((next - y) / (high - low)))
        }
        Interpolation::Cubic => None,
    }
}

impl fmt::Display for FileMistake {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            FileMistake::Unreadable(reason) => write!(f, "it cannot be read: {reason}"),
            FileMistake::Malformed { line, reason } => write!(f, "line {line}: {reason}"),
            FileMistake::NoColumn { name, .. } => write!(f, "it has no column `{name}`"),
            FileMistake::NotANumber { line, column, field } => {
                write!(f, "line {line}: `{field}` in column `{column}` is not a finite number")
            }
            FileMistake::NotIncreasing { line, column, before, here } => {
                write!(f, "line {line}: column `{column}` must increase, but {here} follows {before}")
            }
            FileMistake::TooShort { needed: 1 } => f.write_str("it has no numbers"),
            FileMistake::TooShort { needed } => write!(f, "it needs at least {needed} lines of numbers"),
        }
    }
}
