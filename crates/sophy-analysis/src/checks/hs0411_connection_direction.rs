//! A connection runs against the direction of its ports.

use sophy_diagnostics::{Code, Diagnostic, Span};

pub(crate) const CODE: Code = Code("HS0411");

/// Whether source and target are wrong, whether the connection would be right the other way round, and whether each
/// end is a port of the composite itself.
pub(crate) fn diagnostic(
    wrong: Span,
    source_wrong: bool,
    target_right: bool,
    reversed: bool,
    own: (bool, bool),
) -> Diagnostic {
    let message = match (source_wrong, own) {
        (true, (false, _)) => "an input cannot feed anything",
        (true, (true, _)) => "an output of the composite cannot feed anything inside it",
        (false, (_, false)) => "an output cannot be fed",
        (false, (_, true)) => "an input of the composite cannot be fed from inside it",
    };
    let error = Diagnostic::error(CODE, wrong, message);
    if reversed && !(source_wrong && target_right) {
        error.help("turn the connection round: what feeds stands on the left of `->`")
    } else {
        error.help("on the left of `->` stands an output of a member or an input of the composite, on the right an input of a member or an output of the composite")
    }
}
