use crate::{content, declarations, encoding, judge::judge, parser};
use sophy_analysis::Declarations;
use sophy_diagnostics::{Diagnostics, SourceId, Sources};

/// The document type definition of SOPHY XML (thesis, appendix A.5), with both spellings of `inputevent` and
/// `outputevent`. Whatever definition a file names, this one holds.
pub const DTD: &str = include_str!("../SophySystem.dtd");

/// What [`read`] made of a file.
#[derive(Clone, Debug)]
pub struct Reading {
    /// The text, as an entry of the sources given to [`read`].
    pub source: SourceId,
    /// What the file declares, as far as it could be read. With errors among the diagnostics it is incomplete,
    /// and good for finding more mistakes only: a name that is empty, a guard that is `None` and an expression
    /// with syntax errors have been complained about.
    pub declarations: Option<Declarations>,
    /// Every mistake of encoding, XML, document type and expression syntax.
    pub diagnostics: Diagnostics,
}

/// Reads SOPHY XML: the bytes of the file that messages call `name`.
///
/// Takes any bytes. All mistakes are reported in one pass, expressions' syntax errors included, with places
/// in the file; whether names are declared and equations complete is for `sophy_analysis`. Time and memory
/// are proportional to the size of the file, which is limited, as are nesting and the expansion of entities.
///
/// Source: thesis, appendices A.4 and A.5. The initial state, units and functions, which the definition
/// lacks, are hints: `initial NAME`, `initial location`, `unit NAME`, `function f(a, b)`.
pub fn read(sources: &mut Sources, name: &str, bytes: &[u8]) -> Reading {
    // Bytes to text.
    let (source, decoded) = encoding::decode(sources, name, bytes);
    let mut reading = Reading { source, declarations: None, diagnostics: Diagnostics::default() };
    if let Err(diagnostic) = decoded {
        reading.diagnostics.push(*diagnostic);
        return reading;
    }
    let text = sources.text(source);
    // Text to a tree.
    let (root, mistakes) = parser::parse(source, text);
    reading.diagnostics.extend(mistakes);
    if let Some(mut root) = root {
        // The tree against the definition.
        content::check(&mut root, &mut reading.diagnostics);
        // The tree to declarations.
        reading.declarations = declarations::declare(&root, &mut reading.diagnostics);
    }
    // The strict parser's opinion.
    if !reading.diagnostics.has_errors()
        && let Some(diagnostic) = judge(source, text)
    {
        reading.diagnostics.push(diagnostic);
    }
    reading
}
