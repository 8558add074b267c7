//! `der(x)` on a right-hand side. An equation defines a derivative; reading it would ask for the order in which
//! equations are solved.

use sophy_diagnostics::{Code, Diagnostic, Span};

pub(crate) const CODE: Code = Code("HS0218");

/// The derivative of `name` is read.
pub(crate) fn diagnostic(span: Span, name: &str) -> Diagnostic {
    Diagnostic::error(CODE, span, format!("`der({name})` can only stand on the left of an equation")).help(
        format!("define a local, `{name}_dot = …;`, write `der({name}) = {name}_dot;`, and use it here"),
    )
}
