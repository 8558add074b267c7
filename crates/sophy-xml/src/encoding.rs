use crate::codes::{NOT_UTF8, TOO_LARGE};
use crate::limits::MAX_BYTES;
use sophy_diagnostics::{Diagnostic, NotText, SourceId, Sources, Span};

/// Takes the bytes of the file `name` in as text.
///
/// # Errors
/// The file is too large, or not UTF-8. It still is a source then, so that the message has a place.
pub(crate) fn decode(
    sources: &mut Sources,
    name: &str,
    bytes: &[u8],
) -> (SourceId, Result<(), Box<Diagnostic>>) {
    let utf16 = matches!(bytes, [b'<', 0, ..] | [0, b'<', ..]);
    let (source, outcome) = sophy_diagnostics::decode(sources, name, bytes, MAX_BYTES, utf16);
    let outcome = outcome.map_err(|error| match error {
        NotText::TooLarge => Box::new(too_large(source, bytes.len())),
        NotText::NotUtf8 { encoding: "UTF-16", place } => Box::new(not_utf8(place, name, "UTF-16")),
        NotText::NotUtf8 { encoding, place } => {
            let declared = declared_encoding(bytes).filter(|name| !name.eq_ignore_ascii_case("UTF-8"));
            Box::new(not_utf8(place, name, declared.unwrap_or(encoding)))
        }
    });
    (source, outcome)
}

fn too_large(source: SourceId, length: usize) -> Diagnostic {
    let message = format!("the file has {length} bytes, more than the {MAX_BYTES} a model may have");
    Diagnostic::error(TOO_LARGE, Span::new(source, 0..0), message)
        .help("signals belong in CSV files, large systems into several models")
}

fn not_utf8(span: Span, name: &str, encoding: &str) -> Diagnostic {
    Diagnostic::error(NOT_UTF8, span, format!("the file is not UTF-8; it looks like {encoding}"))
        .label_main("the first byte that is not UTF-8")
        .help(format!("convert it: iconv -f {encoding} -t UTF-8 '{name}' > utf8.xml"))
        .help("then let its first line say encoding=\"UTF-8\", or nothing about the encoding")
}

/// The encoding that the XML declaration names.
fn declared_encoding(bytes: &[u8]) -> Option<&str> {
    let head = &bytes[..bytes.len().min(200)];
    let end = head.windows(2).position(|pair| pair == b"?>")?;
    let declaration = std::str::from_utf8(&head[..end]).ok()?;
    let rest = declaration.split_once("encoding")?.1.trim_start().strip_prefix('=')?.trim_start();
    let quote = rest.chars().next().filter(|c| matches!(c, '"' | '\''))?;
    let name = rest[1..].split(quote).next()?;
    let legal = |c: char| c.is_ascii_alphanumeric() || matches!(c, '-' | '_' | '.');
    (!name.is_empty() && name.chars().all(legal)).then_some(name)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn refusal(bytes: &[u8]) -> String {
        let mut sources = Sources::default();
        let (_, outcome) = decode(&mut sources, "m.xml", bytes);
        outcome.err().map_or_else(String::new, |d| format!("{} {} {}", d.code, d.message, d.helps[0]))
    }

    #[test]
    fn what_is_not_utf8_is_named_with_the_way_to_convert_it() {
        assert_eq!(refusal("<name>τ</name>".as_bytes()), "");
        assert!(refusal(b"\xFF\xFE<\0n\0").contains("iconv -f UTF-16 -t UTF-8 'm.xml'"));
        assert!(refusal(b"<\0?\0x\0m\0l\0").contains("UTF-16"));
        assert!(refusal(b"<name>Gr\xF6\xDFe</name>").contains("iconv -f ISO-8859-1"));
        assert!(refusal(b"<name>\x93a\x94</name>").contains("iconv -f WINDOWS-1252"));
        assert!(refusal(b"<?xml version='1.0' encoding='KOI8-R'?><name>\xF6</name>").contains("-f KOI8-R"));
        assert!(refusal(&vec![b' '; MAX_BYTES + 1]).starts_with("SX0001"));
    }
}
