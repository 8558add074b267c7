use std::collections::BTreeMap;
use std::path::Path;

/// The one way by which the language reaches text: a file system, an editor's buffers, or a test's map.
pub trait World {
    /// The bytes at `path`.
    ///
    /// # Errors
    /// [`WorldError`] with what the operating system said.
    fn read(&self, path: &Path) -> Result<Vec<u8>, WorldError>;
}

/// Text could not be had.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct WorldError {
    /// What the operating system said, in its words.
    pub reason: String,
}

impl std::fmt::Display for WorldError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.reason)
    }
}

impl std::error::Error for WorldError {}

/// A world in memory, for tests and for hosts without files.
#[derive(Clone, Debug, Default)]
pub struct MemoryWorld {
    files: BTreeMap<std::path::PathBuf, Vec<u8>>,
}

impl MemoryWorld {
    /// Puts `text` at `path`.
    #[must_use]
    pub fn with(mut self, path: impl AsRef<Path>, text: impl Into<Vec<u8>>) -> Self {
        self.files.insert(path.as_ref().to_owned(), text.into());
        self
    }
}

impl World for MemoryWorld {
    fn read(&self, path: &Path) -> Result<Vec<u8>, WorldError> {
        self.files.get(path).cloned().ok_or_else(|| WorldError { reason: "no such file".to_owned() })
    }
}
