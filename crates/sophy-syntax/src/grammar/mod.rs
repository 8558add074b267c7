//! The grammar, one file per region of the language.

pub(crate) mod expressions;
