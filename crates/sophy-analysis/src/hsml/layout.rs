use super::HsmlReading;
use sophy_diagnostics::Sources;

/// The text of a file in the canonical layout (comments stay, tokens stay), or `None` if it has mistakes.
pub fn format_hsml(reading: &HsmlReading, sources: &Sources) -> Option<String> {
    if reading.diagnostics.has_errors() {
        return None;
    }
    sophy_syntax::format(sources.text(reading.source)).ok()
}
