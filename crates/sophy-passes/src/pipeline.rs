use crate::flatten::{FlattenError, flatten};
use crate::lift::lift_kinks;
use sophy_ir::{Model, System, VerifyError};
use std::fmt;

/// A pass over the flat system.
pub struct Pass {
    /// Its name, as `--emit` and messages call it.
    pub name: &'static str,
    /// What it does.
    pub run: fn(&mut System),
}

/// What happens to a flat system, in this order.
pub const PIPELINE: &[Pass] =
    &[Pass { name: "lift-kinks", run: lift_kinks }, Pass { name: "shrink", run: System::shrink_to_fit }];

/// A model could not be made into a system.
#[derive(Clone, Debug, PartialEq)]
pub enum PassError {
    /// The composition is wrong.
    Flatten(FlattenError),
    /// A pass broke a rule: a mistake in Sophy.
    Verify {
        /// The pass.
        pass: &'static str,
        /// The rule.
        error: VerifyError,
    },
}

impl fmt::Display for PassError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            PassError::Flatten(error) => write!(f, "{error}"),
            PassError::Verify { pass, error } => write!(f, "after {pass}: {error}"),
        }
    }
}

impl std::error::Error for PassError {}

impl From<FlattenError> for PassError {
    fn from(error: FlattenError) -> Self {
        PassError::Flatten(error)
    }
}

/// A model as one flat system, ready for code generation.
///
/// # Errors
/// [`PassError`] if the composition has an algebraic loop.
pub fn lower(model: &Model) -> Result<System, PassError> {
    let mut system = flatten(model)?;
    for pass in PIPELINE {
        (pass.run)(&mut system);
    }
    system.verify().map_err(|error| PassError::Verify { pass: "the last pass", error })?;
    Ok(system)
}
