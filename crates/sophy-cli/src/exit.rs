use std::process::ExitCode;

/// How the process ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Exit {
    /// Everything asked for was done.
    Done,
    /// The model or the experiment has errors.
    Mistakes,
    /// The command line is wrong (clap uses the same code).
    WrongUse,
    /// The run failed.
    RunFailed,
    /// A file could not be read or written.
    FileFailed,
    /// The user interrupted; results so far are complete files.
    Interrupted,
}

impl From<Exit> for ExitCode {
    fn from(exit: Exit) -> Self {
        ExitCode::from(match exit {
            Exit::Done => 0,
            Exit::Mistakes => 1,
            Exit::WrongUse => 2,
            Exit::RunFailed => 3,
            Exit::FileFailed => 4,
            Exit::Interrupted => 130,
        })
    }
}

/// Of a file that something is wrong with: was it named wrongly, or could it not be had?
impl From<&sophy::FileError> for Exit {
    fn from(error: &sophy::FileError) -> Self {
        match error {
            sophy::FileError::UnknownExtension { .. } | sophy::FileError::NoVariable { .. } => Exit::WrongUse,
            _ => Exit::FileFailed,
        }
    }
}
