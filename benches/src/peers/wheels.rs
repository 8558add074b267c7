//! A Python that has the wheels of the peers.

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

pub const WHEELS: [&str; 3] = ["scipy", "pathsim", "heyoka"];

/// The system's Python if it has all wheels; else that of a virtual environment beside the benches' build, which is made
/// once. What pip cannot get is missing there.
pub fn python() -> PathBuf {
    let system = PathBuf::from("python3");
    if WHEELS.iter().all(|wheel| says_yes(&system, &["-c", &format!("import {wheel}")])) {
        return system;
    }
    let Some(folder) = folder() else { return system };
    let own = folder.join("bin/python");
    if own.exists() {
        return own;
    }
    eprintln!("making {} for the peers in Python", folder.display());
    if !says_yes(&system, &["-m", "venv", &folder.to_string_lossy()]) {
        return system;
    }
    for wheel in WHEELS {
        says_yes(&own, &["-m", "pip", "install", "--quiet", "--only-binary", ":all:", wheel]);
    }
    own
}

/// `peers` in the folder of the build, of which the program is in `release`.
fn folder() -> Option<PathBuf> {
    let program = std::env::current_exe().ok()?;
    program.parent().and_then(Path::parent).map(|target| target.join("peers"))
}

fn says_yes(python: &Path, arguments: &[&str]) -> bool {
    let silent = Command::new(python).args(arguments).stdout(Stdio::null()).stderr(Stdio::null()).status();
    silent.is_ok_and(|status| status.success())
}
