//! Drawings of boxes and arrows: hybrid automata and compositions.
//!
//! A [`Diagram`] says what is to be seen and nothing about where. `measure` finds how much room everything needs,
//! `layers`, `places` and `routes` arrange it (Sugiyama's method: ranks, order, coordinates, then right-angled
//! arrows in channels between the ranks), `sheet` draws it as SVG. Labels are part of the arrangement, as boxes that
//! their arrow runs through: they meet neither boxes nor one another. As DOT, Graphviz does the arranging.

mod diagram;
mod dot;
mod layers;
mod measure;
mod places;
mod routes;
mod sheet;
#[cfg(test)]
mod tests;

use std::path::Path;

use crate::FileError;
use crate::path::{extension, write_whole};
use crate::plot::png;
pub use diagram::{Arrow, ArrowEnd, BoxKind, Diagram, DiagramBox, DiagramKind, DiagramPort, Line, Symbol};

/// Draws a diagram; the extension tells the format: `.svg`, `.png`, or `.dot` (also `.gv`) for Graphviz.
///
/// # Errors
/// [`FileError::UnknownExtension`], [`FileError::Write`].
pub fn draw(path: &Path, diagram: &Diagram) -> Result<(), FileError> {
    let picture = match extension(path).as_str() {
        "svg" => sheet::svg(diagram).into_bytes(),
        "png" => png(path, &sheet::svg(diagram))?,
        "dot" | "gv" => dot::dot(diagram).into_bytes(),
        _ => {
            return Err(FileError::UnknownExtension {
                path: path.to_path_buf(),
                known: ".svg, .png, .dot, .gv",
            });
        }
    };
    write_whole(path, |file| file.write_all(&picture).map_err(FileError::writing(path)))
}
