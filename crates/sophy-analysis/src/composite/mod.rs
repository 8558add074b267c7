//! Composites: members with their classes, and what connects them.

mod build;
mod connections;
mod library;
mod matrix;
mod members;

pub(crate) use library::{Library, findings_in_use};
