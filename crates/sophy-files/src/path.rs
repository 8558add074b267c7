use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};

use crate::FileError;

/// Lower-case extension, empty if there is none.
pub(crate) fn extension(path: &Path) -> String {
    path.extension().map(|e| e.to_string_lossy().to_lowercase()).unwrap_or_default()
}

/// `FILE` + `suffix` in the same folder.
pub(crate) fn beside(path: &Path, suffix: &str) -> PathBuf {
    let mut name = path.as_os_str().to_owned();
    name.push(suffix);
    PathBuf::from(name)
}

/// Writes a file so that nobody ever sees half of it: under another name first, then renamed.
pub(crate) fn write_whole(
    path: &Path,
    write: impl FnOnce(&mut (dyn Write + Send)) -> Result<(), FileError>,
) -> Result<(), FileError> {
    let unfinished = beside(path, ".unfinished");
    let result = (|| {
        let file = fs::File::create(&unfinished).map_err(FileError::writing(path))?;
        let mut file = std::io::BufWriter::new(file);
        write(&mut file)?;
        file.flush().map_err(FileError::writing(path))?;
        fs::rename(&unfinished, path).map_err(FileError::writing(path))
    })();
    if result.is_err() {
        // The first error is the one to report; that the remains stay is a lesser evil.
        let _ = fs::remove_file(&unfinished);
    }
    result
}

/// Removes an older file, if there is one.
pub(crate) fn remove_if_there(path: &Path) -> Result<(), FileError> {
    match fs::remove_file(path) {
        Err(error) if error.kind() != std::io::ErrorKind::NotFound => Err(FileError::writing(path)(error)),
        _ => Ok(()),
    }
}
