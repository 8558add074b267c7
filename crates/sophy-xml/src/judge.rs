use crate::codes::NOT_WELL_FORMED;
use crate::limits::MAX_NODES;
use roxmltree::{Document, ParsingOptions};
use sophy_diagnostics::{Diagnostic, SourceId, Span};

/// What a strict XML parser says against a text that our own reading accepted.
///
/// [`crate::parser`] is made to go on after mistakes and is lenient in the small print (such as the form of
/// the XML declaration). Whoever accepts a file promises that other tools can read it, so this is the last
/// word. Cost is bounded: what arrives here obeys the definition and the limits.
pub(crate) fn judge(source: SourceId, text: &str) -> Option<Diagnostic> {
    let nodes_limit = u32::try_from(MAX_NODES * 2).unwrap_or(u32::MAX);
    let options = ParsingOptions { allow_dtd: true, nodes_limit, entity_resolver: None };
    let error = Document::parse_with_options(text, options).err()?;
    let position = error.pos();
    let place = byte_offset(text, position.row, position.col);
    let there = text[place..].chars().next();
    let message = error.to_string();
    let mut message = message.split(" at ").next().unwrap_or(&message).to_owned();
    // The parser names the first byte of what it found only.
    if let (Some(found), Some(end)) = (there, message.find(" not '")) {
        message.truncate(end);
        message.push_str(&format!(", not U+{:04X}", u32::from(found)));
    }
    let span = Span::new(source, place..place + there.map_or(0, char::len_utf8));
    Some(
        Diagnostic::error(NOT_WELL_FORMED, span, format!("not well-formed XML: {message}"))
            .help("retype what stands here; the XML recommendation, version 1.0, says what may"),
    )
}

/// The byte at a line and a column in characters, both from 1.
fn byte_offset(text: &str, line: u32, column: u32) -> usize {
    let start = match line {
        0 | 1 => 0,
        _ => text.match_indices('\n').nth(line as usize - 2).map_or(text.len(), |(at, _)| at + 1),
    };
    let in_line = text[start..].char_indices().nth((column as usize).saturating_sub(1));
    in_line.map_or(text.len(), |(at, _)| start + at)
}
