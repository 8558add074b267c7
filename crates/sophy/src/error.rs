use sophy_files::FileError;
use sophy_passes::PassError;
use sophy_record::SinkError;
use sophy_run::{ExperimentError, Failure, SimulateError, StartError};

/// A run could not be made, or did not end well.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// The model cannot be made into one system.
    #[error(transparent)]
    Composition(#[from] PassError),
    /// The experiment does not fit the model.
    #[error("{}", .0.iter().map(ToString::to_string).collect::<Vec<_>>().join("\n"))]
    Experiment(Vec<ExperimentError>),
    /// The run cannot go on. Files hold everything until then.
    #[error(transparent)]
    Failure(Box<Failure>),
    /// A result cannot be written.
    #[error(transparent)]
    Sink(#[from] SinkError),
    /// A file cannot be read or written.
    #[error(transparent)]
    File(#[from] FileError),
}

impl From<SimulateError> for Error {
    fn from(error: SimulateError) -> Self {
        match error {
            SimulateError::Experiment(errors) => Error::Experiment(errors),
            SimulateError::Failure(failure) => Error::Failure(failure),
            SimulateError::Sink(error) => Error::Sink(error),
        }
    }
}

impl From<StartError> for Error {
    fn from(error: StartError) -> Self {
        SimulateError::from(error).into()
    }
}
