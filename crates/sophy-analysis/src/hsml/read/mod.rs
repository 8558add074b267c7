//! HSML text → [`Declarations`].
//!
//! - `encoding`: bytes to text;
//! - `file`: imports, constants, functions, components with their interfaces;
//! - `body`: sections, declarations, events, rules;
//! - `locations`: locations with their transitions;
//! - `composition`: members and connections;
//! - `statements`: statements and equations;
//! - `reader`: names, expressions and complaints.

mod body;
mod composition;
mod encoding;
mod file;
mod locations;
mod reader;
mod statements;

use crate::declarations::Declarations;
use reader::Reader;
use sophy_diagnostics::{Diagnostic, Diagnostics, SourceId, Sources, TextMap};
use sophy_syntax::{Parse, parse_file};

/// What [`read_hsml`] made of a file.
#[derive(Clone, Debug)]
pub struct HsmlReading {
    /// The text, as an entry of the sources given to [`read_hsml`].
    pub source: SourceId,
    /// What the file declares, as far as it could be read. With errors among the diagnostics it is incomplete, and
    /// good for finding more mistakes only: an empty name has been complained about.
    pub declarations: Declarations,
    /// Every mistake of encoding and of grammar.
    pub diagnostics: Diagnostics,
    /// The tree.
    pub parse: Parse,
}

/// Reads HSML: the bytes of the file that messages call `name`.
///
/// Takes any bytes. All mistakes of grammar are reported in one pass; whether names are declared and equations
/// complete is for [`analyse`](crate::analyse). Time and memory are proportional to the size of the file, which is
/// limited, as is nesting.
pub fn read_hsml(sources: &mut Sources, name: &str, bytes: &[u8]) -> HsmlReading {
    // Bytes to text.
    let (source, decoded) = encoding::decode(sources, name, bytes);
    let text = sources.text(source);
    let mut diagnostics = Diagnostics::default();
    if let Err(diagnostic) = decoded {
        diagnostics.push(*diagnostic);
        return HsmlReading {
            source,
            declarations: Declarations::default(),
            diagnostics,
            parse: parse_file(""),
        };
    }
    // Text to a tree.
    let parse = parse_file(text);
    let length = u32::try_from(text.len()).unwrap_or(u32::MAX);
    for error in parse.errors() {
        diagnostics.push(message(error, &TextMap::plain(source, 0, length)));
    }
    // The tree to declarations.
    let mut reader = Reader::new(source, text, parse.errors(), &mut diagnostics);
    let declarations = parse.file().map(|file| reader.file(&file)).unwrap_or_default();
    HsmlReading { source, declarations, diagnostics, parse }
}

fn message(error: &sophy_syntax::SyntaxError, map: &TextMap) -> Diagnostic {
    let mut diagnostic = Diagnostic::error(error.code, map.span(error.range.clone()), &error.message);
    for (range, message) in &error.related {
        diagnostic = diagnostic.label(map.span(range.clone()), message);
    }
    for help in &error.helps {
        diagnostic = diagnostic.help(help);
    }
    diagnostic
}
