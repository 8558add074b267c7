use sophy_analysis::{format_hsml, read_hsml};
use sophy_diagnostics::{Diagnostic, Sources};

/// What [`format()`] made of a file.
#[derive(Clone, Debug)]
pub struct Formatted {
    /// The file in the canonical layout, or `None` if it has mistakes.
    pub text: Option<String>,
    /// The text that messages point into.
    pub sources: Sources,
    /// Mistakes of grammar, in the order of their places.
    pub messages: Vec<Diagnostic>,
}

/// Lays out HSML: the bytes of the file that messages call `name`. Comments stay, the model stays what it is.
///
/// A file with mistakes of grammar is not laid out: what belongs together is not known.
pub fn format(name: &str, bytes: &[u8]) -> Formatted {
    let mut sources = Sources::default();
    let reading = read_hsml(&mut sources, name, bytes);
    let text = format_hsml(&reading, &sources);
    let messages = reading.diagnostics.sorted(&sources);
    Formatted { text, sources, messages }
}
