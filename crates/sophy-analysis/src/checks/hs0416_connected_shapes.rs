//! A connection joins ports of different shapes.

use crate::lower::Shape;
use sophy_diagnostics::{Code, Diagnostic, Span};

pub(crate) const CODE: Code = Code("HS0416");

pub(crate) fn diagnostic(from: (Shape, Span), to: (Shape, Span)) -> Diagnostic {
    Diagnostic::error(CODE, from.1, format!("{} cannot feed {}", from.0, to.0))
        .label_main(from.0.to_string())
        .label(to.1, to.0.to_string())
        .help("connect ports of one shape, or single elements: `a.y[1] -> b.u;`")
}
