use std::collections::BTreeMap;
use std::path::{Component, Path, PathBuf};

/// The one way by which the language reaches text: a file system, an editor's buffers, or a test's map.
pub trait World {
    /// The bytes at `path`.
    ///
    /// # Errors
    /// [`WorldError`] with what the operating system said.
    fn read(&self, path: &Path) -> Result<Vec<u8>, WorldError>;

    /// The one path by which this world knows the file at `path`: two paths with the same one lead to the same file.
    ///
    /// It need not be readable. Unless a world knows better, it is the [`simplified`] path.
    fn identity(&self, path: &Path) -> PathBuf {
        simplified(path)
    }
}

/// The path without `.` and, where a folder stands before it, `..`: the same file unless that folder is a link.
pub fn simplified(path: &Path) -> PathBuf {
    let mut simple = PathBuf::new();
    for part in path.components() {
        match part {
            Component::CurDir => {}
            Component::ParentDir if matches!(simple.components().next_back(), Some(Component::Normal(_))) => {
                simple.pop();
            }
            part => simple.push(part),
        }
    }
    simple
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

/// A world in memory, for tests and for hosts without files. Its folders exist as far as paths name them.
#[derive(Clone, Debug, Default)]
pub struct MemoryWorld {
    files: BTreeMap<PathBuf, Vec<u8>>,
}

impl MemoryWorld {
    /// Puts `text` at `path`.
    #[must_use]
    pub fn with(mut self, path: impl AsRef<Path>, text: impl Into<Vec<u8>>) -> Self {
        self.files.insert(simplified(path.as_ref()), text.into());
        self
    }
}

impl World for MemoryWorld {
    fn read(&self, path: &Path) -> Result<Vec<u8>, WorldError> {
        self.files
            .get(&simplified(path))
            .cloned()
            .ok_or_else(|| WorldError { reason: "no such file".to_owned() })
    }
}
