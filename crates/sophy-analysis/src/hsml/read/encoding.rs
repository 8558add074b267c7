use crate::hsml::codes::{NOT_TEXT, NOT_UTF8, TOO_LARGE};
use sophy_diagnostics::{Diagnostic, NotText, SourceId, Sources, Span};

/// Largest file, in bytes.
const MAX_BYTES: usize = 64 << 20;

/// Takes the bytes of the file `name` in as text, without a byte order mark.
///
/// # Errors
/// The file is too large, not UTF-8, or contains a zero byte. It still is a source then, so that the message has a
/// place.
pub(super) fn decode(
    sources: &mut Sources,
    name: &str,
    bytes: &[u8],
) -> (SourceId, Result<(), Box<Diagnostic>>) {
    let bytes = bytes.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(bytes);
    let (source, outcome) = sophy_diagnostics::decode(sources, name, bytes, MAX_BYTES, false);
    let text = match outcome {
        Ok(()) => sources.text(source),
        Err(NotText::TooLarge) => return (source, Err(Box::new(too_large(source, bytes.len())))),
        Err(NotText::NotUtf8 { encoding, place }) => {
            return (source, Err(Box::new(not_utf8(place, name, encoding))));
        }
    };
    match text.find('\0') {
        None => (source, Ok(())),
        Some(zero) => {
            let diagnostic = Diagnostic::error(
                NOT_TEXT,
                Span::new(source, zero..zero + 1),
                "the file contains a zero byte",
            )
            .help("a model is a text file; if this one is UTF-16, convert it to UTF-8");
            (source, Err(Box::new(diagnostic)))
        }
    }
}

fn too_large(source: SourceId, length: usize) -> Diagnostic {
    let message = format!("the file has {length} bytes, more than the {MAX_BYTES} a model may have");
    Diagnostic::error(TOO_LARGE, Span::new(source, 0..0), message)
        .help("signals belong in CSV files, copies of a component into an array")
}

fn not_utf8(span: Span, name: &str, encoding: &str) -> Diagnostic {
    Diagnostic::error(NOT_UTF8, span, format!("the file is not UTF-8; it looks like {encoding}"))
        .label_main("the first byte that is not UTF-8")
        .help(format!("convert it: iconv -f {encoding} -t UTF-8 '{name}' > utf8.hsml"))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn refusal(bytes: &[u8]) -> String {
        let mut sources = Sources::default();
        let (_, outcome) = decode(&mut sources, "m.hsml", bytes);
        outcome.err().map_or_else(String::new, |d| format!("{} {} {}", d.code, d.message, d.helps[0]))
    }

    #[test]
    fn what_is_no_text_is_named_with_the_way_to_convert_it() {
        assert_eq!(refusal("% τ".as_bytes()), "");
        assert_eq!(refusal("\u{feff}% τ".as_bytes()), "");
        assert!(refusal(b"\xFF\xFEC\0T\0C\0").contains("iconv -f UTF-16 -t UTF-8 'm.hsml'"));
        assert!(refusal(b"C\0T\0C\0").starts_with("HS0083"));
        assert!(refusal(b"% Gr\xF6\xDFe").contains("iconv -f ISO-8859-1"));
        assert!(refusal(b"% \x93a\x94").contains("iconv -f WINDOWS-1252"));
        assert!(refusal(&vec![b' '; MAX_BYTES + 1]).starts_with("HS0081"));
    }
}
