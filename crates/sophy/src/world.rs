use sophy_diagnostics::{World, WorldError};
use std::path::{Path, PathBuf};

/// The file system. Relative paths are relative to the working directory of the process.
#[derive(Clone, Copy, Debug, Default)]
pub struct FileWorld;

impl World for FileWorld {
    fn read(&self, path: &Path) -> Result<Vec<u8>, WorldError> {
        std::fs::read(path).map_err(|error| WorldError { reason: reason(&error) })
    }

    /// Without links; a path without a file is its own.
    fn identity(&self, path: &Path) -> PathBuf {
        std::fs::canonicalize(path).unwrap_or_else(|_| path.to_owned())
    }
}

/// What the operating system says, without its error number.
fn reason(error: &std::io::Error) -> String {
    let text = error.to_string();
    let words = text.split(" (os error").next().unwrap_or(&text);
    let mut letters = words.chars();
    letters.next().map(|first| first.to_lowercase().chain(letters).collect()).unwrap_or_default()
}
