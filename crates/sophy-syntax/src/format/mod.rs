//! The canonical layout of a file.
//!
//! - two spaces for each block, one item on a line;
//! - blank lines between items are kept, but never more than one, and none at the start or end of a block;
//! - a comment stays where it is: on its own line, or behind what it follows;
//! - `+`, `-`, comparisons and words have spaces around them, `*`, `/` and `^` have none;
//! - a line longer than [`WIDTH`] goes on, indented, after a comma or before an operator.
//!
//! The tokens stay what they are: only the space between them changes.

mod layout;
mod lines;
mod spacing;

use crate::error::SyntaxError;
use crate::parse::parse_file;

/// Characters of a line, comments behind it not counted.
const WIDTH: usize = 100;

/// The canonical layout of a file.
///
/// # Errors
/// A file with mistakes is not laid out: its structure is not known. The mistakes are returned.
pub fn format(text: &str) -> Result<String, Vec<SyntaxError>> {
    let parse = parse_file(text);
    if parse.errors().is_empty() {
        Ok(layout::laid_out(&parse.syntax(), text))
    } else {
        Err(parse.errors().to_vec())
    }
}
