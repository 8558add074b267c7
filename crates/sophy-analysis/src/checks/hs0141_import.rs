//! Another file cannot be imported.

use crate::declarations::Spanned;
use sophy_diagnostics::{Code, Diagnostic};

pub(crate) const CODE: Code = Code("HS0141");

pub(crate) fn diagnostic(path: &Spanned<String>, why: &str) -> Diagnostic {
    Diagnostic::error(CODE, path.span, format!("\"{}\" cannot be imported: {why}", path.value))
        .help("paths start at the folder of the importing file")
}
