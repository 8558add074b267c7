//! Pictures of a result.
//!
//! [`Content`] decides what is shown; `time_figure` and `phase_figure` draw it as SVG; a PNG is that SVG in pixels,
//! an HTML page draws the same content with uPlot so that it can be zoomed.

mod axis;
mod content;
mod curve;
mod html;
mod options;
pub(crate) mod palette;
mod phase_figure;
mod png;
pub(crate) mod svg;
pub(crate) mod text;
mod time_figure;

use std::path::Path;

use sophy_record::{EventRecord, Table};

use crate::FileError;
use crate::path::{extension, write_whole};
use content::Content;
pub use options::PlotOptions;
pub(crate) use png::png;

/// Draws a result; the extension tells the format: `.svg`, `.png`, `.html`.
///
/// Variables of one unit share a panel (a variable without unit has its own while there is room, six panels at
/// most); a note under the picture says what found no room. Locations, texts and truth values are strips under the
/// panels, transitions thin lines; two rows of one time are a jump, drawn as a break; a value that is no number leaves a gap.
/// `events` may be empty: the changes of location then tell where transitions were.
///
/// Of many rows only those that show are drawn: the first, lowest, highest and last of every pixel column.
///
/// Returns the variables that found no room, in a few words, if there are any.
///
/// # Errors
/// [`FileError::UnknownExtension`], [`FileError::NoVariable`], [`FileError::Write`].
pub fn plot(
    path: &Path,
    table: &Table,
    events: &[EventRecord],
    options: &PlotOptions,
) -> Result<Option<String>, FileError> {
    let content = Content::new(table, events, options)?;
    let picture = match extension(path).as_str() {
        "svg" => figure(table, &content, options)?.into_bytes(),
        "png" => png(path, &figure(table, &content, options)?)?,
        "html" => html::page(table, &content, events, options)?.into_bytes(),
        _ => {
            return Err(FileError::UnknownExtension { path: path.to_path_buf(), known: ".svg, .png, .html" });
        }
    };
    write_whole(path, |file| file.write_all(&picture).map_err(FileError::writing(path)))?;
    // A phase portrait shows what was asked for.
    Ok(if options.phase.is_some() && extension(path) != "html" { None } else { content.note() })
}

/// The picture as SVG: curves over time, or the phase portrait if one is asked for.
fn figure(table: &Table, content: &Content<'_>, options: &PlotOptions) -> Result<String, FileError> {
    let title = options.title.as_deref();
    match &options.phase {
        Some((horizontal, vertical)) => {
            phase_figure::phase_figure(table, content, (horizontal, vertical), options, title)
        }
        None => Ok(time_figure::time_figure(content, options, title)),
    }
}
