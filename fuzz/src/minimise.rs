//! Delta debugging: leaves out what is not needed to break something.

use crate::corpus::tokens;
use crate::target::Target;
use std::io;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

/// After this time what there is is small enough.
const PATIENCE: Duration = Duration::from_secs(120);

/// A smaller input that `target` does not survive either: first by words, then by bytes.
///
/// # Errors
/// A process cannot be started or a file not be written.
pub(crate) fn minimise(target: Target, input: Vec<u8>) -> io::Result<Vec<u8>> {
    let folder = std::env::temp_dir();
    let file = folder.join(format!("sophy-fuzz-{}-{}", target.name(), std::process::id()));
    let end = Instant::now() + PATIENCE;
    let mut breaks = |parts: &[&[u8]]| -> io::Result<bool> {
        if Instant::now() > end {
            return Ok(false);
        }
        std::fs::write(&file, parts.concat())?;
        broken(target, &file)
    };
    let by_words = reduced(tokens(&input), &mut breaks)?;
    let bytes: Vec<&[u8]> = by_words.chunks(1).collect();
    let smallest = if bytes.len() < 4000 { reduced(bytes, &mut breaks)? } else { by_words.clone() };
    // It is gone with the temporary folder otherwise.
    let _ = std::fs::remove_file(&file);
    Ok(smallest)
}

/// Leaves out ever smaller runs of parts.
fn reduced(
    mut parts: Vec<&[u8]>,
    breaks: &mut impl FnMut(&[&[u8]]) -> io::Result<bool>,
) -> io::Result<Vec<u8>> {
    let mut length = parts.len().div_ceil(2);
    while length > 0 {
        let mut start = 0;
        while start < parts.len() {
            let end = (start + length).min(parts.len());
            let rest = [parts.get(..start).unwrap_or(&[]), parts.get(end..).unwrap_or(&[])].concat();
            if breaks(&rest)? {
                parts = rest;
            } else {
                start = end;
            }
        }
        length = if length == 1 { 0 } else { length.div_ceil(2) };
    }
    Ok(parts.concat())
}

/// Whether a process of its own does not survive the file.
fn broken(target: Target, file: &Path) -> io::Result<bool> {
    let status = Command::new(std::env::current_exe()?)
        .args(["--check", target.name()])
        .arg(file)
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .status()?;
    Ok(!status.success())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_not_needed_goes() {
        let text = b"one two three four five six seven eight nine ten";
        let mut breaks = |parts: &[&[u8]]| {
            let text = parts.concat();
            Ok([&b"three"[..], b"nine"].iter().all(|word| text.windows(word.len()).any(|part| part == *word)))
        };
        assert_eq!(reduced(tokens(text), &mut breaks).unwrap(), b"threenine");
    }
}
