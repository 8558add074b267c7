//! `Declarations` (plain, spanned, unresolved) → `Model`: names, types, equations. One file per check.
mod declarations;
pub use declarations::*;
