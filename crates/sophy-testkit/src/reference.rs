use std::path::PathBuf;

/// The root of the repository.
pub fn repository() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// A CSV file of reference data: comma separated, one header line.
#[derive(Clone, Debug)]
pub struct Reference {
    header: Vec<String>,
    rows: Vec<Vec<String>>,
}

impl Reference {
    /// Reads `tests/reference/<path>`.
    ///
    /// # Panics
    /// If there is no such file; tests only.
    #[allow(clippy::panic)]
    pub fn read(path: &str) -> Self {
        let path = repository().join("tests/reference").join(path);
        let text = match std::fs::read_to_string(&path) {
            Ok(text) => text,
            Err(error) => panic!("{}: {error}", path.display()),
        };
        let mut lines = text.lines().filter(|line| !line.trim().is_empty());
        let split = |line: &str| line.split(',').map(|cell| cell.trim().to_owned()).collect::<Vec<_>>();
        let header = lines.next().map(split).unwrap_or_default();
        Reference { header, rows: lines.map(split).collect() }
    }

    /// The cells of a column as text.
    ///
    /// # Panics
    /// If there is no such column; tests only.
    #[allow(clippy::panic)]
    pub fn text(&self, column: &str) -> Vec<&str> {
        let Some(position) = self.header.iter().position(|name| name == column) else {
            panic!("no column `{column}` among {:?}", self.header);
        };
        self.rows.iter().map(|row| row[position].as_str()).collect()
    }

    /// The cells of a column as numbers.
    ///
    /// # Panics
    /// If a cell is not a number; tests only.
    #[allow(clippy::panic)]
    pub fn numbers(&self, column: &str) -> Vec<f64> {
        let parse = |cell: &str| cell.parse().unwrap_or_else(|_| panic!("`{cell}` in column `{column}`"));
        self.text(column).into_iter().map(parse).collect()
    }
}
