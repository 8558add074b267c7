//! The grammar, one file per region of the language.

pub(crate) mod blocks;
mod body;
mod composition;
pub(crate) mod expressions;
pub(crate) mod file;
mod items;
mod locations;
mod statements;
