//! Where text comes from, where in it something is wrong, and how that is said.
//!
//! [`Sources`] holds the texts of a session and hands out [`SourceId`]s; a [`Span`] is a byte range in one
//! of them. A [`Diagnostic`] is data: a [`Code`], a sentence, [`Label`]s on the places involved and the way
//! out. [`render`] draws it with its source excerpt. Text is reached through [`World`] only, so that a
//! language crate never opens a file.

mod diagnostic;
mod encoding;
mod render;
mod source;
mod suggest;
mod text_map;
mod world;

pub use diagnostic::{Code, Diagnostic, Diagnostics, Label, Severity};
pub use encoding::{NotText, decode};
pub use render::{Style, render};
pub use source::{LineColumn, SourceId, Sources, Span};
pub use suggest::closest;
pub use text_map::TextMap;
pub use world::{MemoryWorld, World, WorldError, simplified};
