//! A table or data file cannot be used.

use super::suggestion::suggest;
use crate::lower::FileMistake;
use sophy_diagnostics::{Code, Diagnostic, Span};

pub(crate) const CODE: Code = Code("HS0215");

/// The name of the file stands at `file_span`, that of the column at `column_span`.
pub(crate) fn diagnostic(
    file_span: Span,
    column_span: Span,
    file: &str,
    mistake: &FileMistake,
) -> Diagnostic {
    let span = if matches!(mistake, FileMistake::NoColumn { .. }) { column_span } else { file_span };
    let error = Diagnostic::error(CODE, span, format!("`{file}` cannot be used: {mistake}"));
    match mistake {
        FileMistake::Unreadable(_) => {
            error.help("paths start from the folder of the file they are written in")
        }
        FileMistake::NoColumn { name, columns } => {
            let columns: Vec<&str> = columns.iter().map(String::as_str).collect();
            error.help(suggest(name, &columns, "columns").help)
        }
        FileMistake::NotIncreasing { .. } => {
            error.help("sort the lines, and keep one of those that are equal")
        }
        FileMistake::Malformed { .. } | FileMistake::NotANumber { .. } | FileMistake::TooShort { .. } => {
            error.help("correct the file")
        }
    }
}
