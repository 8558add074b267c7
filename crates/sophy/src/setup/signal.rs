use sophy_diagnostics::closest;
use sophy_files::{FileError, read_columns};
use sophy_run::{AtEnd, Interpolation, Signal};
use std::path::{Path, PathBuf};

/// An input's samples could not be had.
#[derive(Debug, thiserror::Error)]
pub enum SignalError {
    /// The file.
    #[error(transparent)]
    File(#[from] FileError),
    /// The file has no such column, or several where none was named.
    #[error("{}", message(.path, .wanted.as_deref(), .columns))]
    Column {
        /// The file.
        path: PathBuf,
        /// The column asked for.
        wanted: Option<String>,
        /// The columns there are.
        columns: Vec<String>,
    },
}

/// Reads the samples of input `input` from a text file of columns, held between samples.
///
/// The column is the one named `column`; without a name, the one called as the input, else the only one.
///
/// # Errors
/// [`SignalError`].
pub fn read_signal(path: &Path, input: &str, column: Option<&str>) -> Result<Signal, SignalError> {
    let table = read_columns(path)?;
    let named = |name: &str| table.columns.iter().position(|(column, _)| column == name);
    let position = match column {
        Some(column) => named(column),
        None => named(input).or_else(|| (table.columns.len() == 1).then_some(0)),
    };
    let Some((name, values)) = position.and_then(|position| table.columns.get(position)) else {
        let columns = table.columns.into_iter().map(|(name, _)| name).collect();
        return Err(SignalError::Column {
            path: path.to_owned(),
            wanted: column.map(str::to_owned),
            columns,
        });
    };
    Ok(Signal {
        times: table.time,
        values: values.clone(),
        interpolation: Interpolation::default(),
        at_end: AtEnd::default(),
        origin: format!("{}, column {name}", path.display()),
    })
}

fn message(path: &Path, wanted: Option<&str>, columns: &[String]) -> String {
    let file = path.display();
    let list = columns.iter().map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", ");
    let Some(wanted) = wanted else {
        return format!("{file} has several columns, say which one: {list}");
    };
    match closest(wanted, columns.iter().map(String::as_str)) {
        Some(meant) => format!("{file} has no column `{wanted}`; did you mean `{meant}`?"),
        None => format!("{file} has no column `{wanted}`, only {list}"),
    }
}
