use crate::source::{SourceId, Sources, Span};

/// Why bytes are no text of a model.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum NotText {
    /// More bytes than allowed.
    TooLarge,
    /// Not UTF-8 but, as it looks, `encoding`; `place` is the first byte that is wrong.
    NotUtf8 {
        /// As `iconv` calls it.
        encoding: &'static str,
        /// In the text whose wrong bytes are replaced.
        place: Span,
    },
}

/// Takes the bytes of the file `name` in as text. `utf16` says that they look like it.
///
/// # Errors
/// There are more than `most` bytes, or they are not UTF-8. They still are a source then, so that a message has a
/// place.
pub fn decode(
    sources: &mut Sources,
    name: &str,
    bytes: &[u8],
    most: usize,
    utf16: bool,
) -> (SourceId, Result<(), NotText>) {
    if bytes.len() > most {
        return (sources.add(name, ""), Err(NotText::TooLarge));
    }
    if utf16 || matches!(bytes, [0xFF, 0xFE, ..] | [0xFE, 0xFF, ..]) {
        let source = sources.add(name, "");
        return (source, Err(NotText::NotUtf8 { encoding: "UTF-16", place: Span::new(source, 0..0) }));
    }
    match std::str::from_utf8(bytes) {
        Ok(text) => (sources.add(name, text), Ok(())),
        Err(error) => {
            // The replaced text is the same up to the first byte that is wrong.
            let start = error.valid_up_to();
            let text = String::from_utf8_lossy(bytes).into_owned();
            let wrong = text.get(start..).and_then(|rest| rest.chars().next()).map_or(0, char::len_utf8);
            let source = sources.add(name, text);
            // Bytes 0x80 to 0x9F are control characters in Latin-1, letters and quotes in Windows-1252.
            let windows = bytes.iter().any(|byte| (0x80..0xA0).contains(byte));
            let encoding = if windows { "WINDOWS-1252" } else { "ISO-8859-1" };
            (source, Err(NotText::NotUtf8 { encoding, place: Span::new(source, start..start + wrong) }))
        }
    }
}
