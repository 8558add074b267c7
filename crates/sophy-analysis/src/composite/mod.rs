//! Composites: members with their classes, and what connects them.

mod composite;
mod connections;
mod library;
mod matrix;
mod members;

pub(crate) use library::Library;
