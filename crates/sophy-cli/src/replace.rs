use std::fs::{self, File, OpenOptions};
use std::io::{Error, ErrorKind, Write};
use std::path::{Path, PathBuf};

/// What is done with a file that is there already.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Existing {
    /// It stays, and that is an error.
    Keep,
    /// It is replaced, with its permissions, through links.
    Replace,
}

/// Writes a whole file or nothing: at no time is there half of it at `path`.
///
/// # Errors
/// What the operating system says; [`ErrorKind::AlreadyExists`] if there is a file that has to stay.
pub(crate) fn write(path: &Path, bytes: &[u8], existing: Existing) -> Result<(), Error> {
    if existing == Existing::Keep {
        // Nobody else's file is overwritten, even if it was made this moment.
        let mut file = OpenOptions::new().write(true).create_new(true).open(path)?;
        return file.write_all(bytes);
    }
    let target = match fs::canonicalize(path) {
        Ok(target) if target.is_file() => target,
        // A folder, or something that is not replaced but written to, such as /dev/stdout.
        Ok(target) => return fs::write(target, bytes),
        Err(error) if error.kind() == ErrorKind::NotFound => path.to_owned(),
        Err(error) => return Err(error),
    };
    let draft = draft(&target)?;
    let result = finish(&draft, &target, bytes);
    if result.is_err() {
        let _ = fs::remove_file(&draft.1);
    }
    result
}

/// A new file beside the target: renaming works within a folder.
fn draft(target: &Path) -> Result<(File, PathBuf), Error> {
    let name = target.file_name().ok_or(ErrorKind::InvalidInput)?;
    for number in 0.. {
        let mut draft = std::ffi::OsString::from(".");
        draft.push(name);
        draft.push(format!(".{}.{number}", std::process::id()));
        let path = target.with_file_name(draft);
        match OpenOptions::new().write(true).create_new(true).open(&path) {
            Ok(file) => return Ok((file, path)),
            Err(error) if error.kind() == ErrorKind::AlreadyExists && number < 100 => {}
            Err(error) => return Err(error),
        }
    }
    Err(ErrorKind::AlreadyExists.into())
}

fn finish((file, path): &(File, PathBuf), target: &Path, bytes: &[u8]) -> Result<(), Error> {
    let mut file = file;
    file.write_all(bytes)?;
    if let Ok(metadata) = fs::metadata(target) {
        file.set_permissions(metadata.permissions())?;
    }
    file.sync_all()?;
    fs::rename(path, target)
}
