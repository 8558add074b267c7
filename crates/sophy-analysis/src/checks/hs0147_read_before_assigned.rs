//! A local of a `:=` section is read where nothing has assigned it: it would be the value of nothing.

use sophy_diagnostics::{Code, Diagnostic, Span};

pub(crate) const CODE: Code = Code("HS0147");

pub(crate) fn diagnostic(name: &str, at: Span, declared: Option<Span>) -> Diagnostic {
    let mut error = Diagnostic::error(CODE, at, format!("local `{name}` is read before it is assigned"));
    if let Some(declared) = declared {
        error = error.label(declared, "declared here, without an equation");
    }
    error
        .help("assign it above, on every way that leads here")
        .help("a value that is to last from one event to the next is a mode")
}
