//! When and where something was measured.

use std::process::Command;

/// What stands above every table.
#[derive(Clone, Debug)]
pub struct Stamp {
    /// The day, in universal time.
    pub date: String,
    /// Processor, number of processors and system.
    pub machine: String,
    /// The commit that was measured.
    pub commit: String,
}

impl Stamp {
    pub fn now() -> Self {
        let cores = std::thread::available_parallelism().map_or(1, usize::from);
        let system = format!("{} {}", std::env::consts::OS, std::env::consts::ARCH);
        Stamp {
            date: said("date", &["-u", "+%Y-%m-%d"]),
            machine: format!("{}, {cores} processors, {system}", processor()),
            commit: said("git", &["-C", env!("CARGO_MANIFEST_DIR"), "describe", "--always", "--dirty"]),
        }
    }
}

fn processor() -> String {
    let text = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let name =
        text.lines().find(|line| line.starts_with("model name")).and_then(|line| line.split(": ").nth(1));
    name.unwrap_or("unknown processor").trim().to_owned()
}

/// The line that a program prints.
fn said(program: &str, arguments: &[&str]) -> String {
    let output = Command::new(program).args(arguments).output().ok().filter(|output| output.status.success());
    let text = output.map(|output| String::from_utf8_lossy(&output.stdout).trim().to_owned());
    text.filter(|text| !text.is_empty()).unwrap_or_else(|| "unknown".to_owned())
}
