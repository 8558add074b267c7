//! HSML to [`Declarations`](crate::Declarations) and back.

mod codes;
mod imports;
mod layout;
#[cfg(test)]
mod plain;
mod read;
#[cfg(test)]
mod tests;
mod write;

#[cfg(test)]
use crate::declarations::*;
pub use codes::HSML_CODES;
pub use imports::read_with_imports;
pub use layout::format_hsml;
pub use read::{HsmlReading, read_hsml};
pub use write::write_hsml;
