use crate::arguments::Check;
use crate::exit::Exit;
use crate::numbers::plural;
use crate::terminal::Terminal;
use serde_json::json;
use sophy::{Diagnostics, FileWorld, Root, Severity};
use std::path::Path;

/// Shows every mistake of every file.
pub(crate) fn check(arguments: &Check, terminal: &Terminal) -> Exit {
    // A file of several components is a library, and each is checked.
    let root = arguments.system.as_deref().map_or(Root::IfClear, Root::Named);
    let exits: Vec<Exit> = arguments.files.iter().map(|file| check_file(file, root, terminal)).collect();
    let worst = [Exit::Mistakes, Exit::FileFailed].into_iter().find(|exit| exits.contains(exit));
    worst.unwrap_or(Exit::Done)
}

fn check_file(file: &Path, root: Root<'_>, terminal: &Terminal) -> Exit {
    let mut loaded = sophy::load_as(&FileWorld, file, root);
    let found = sophy::check(&loaded);
    loaded.diagnostics.extend(found);
    terminal.diagnostics(&loaded.messages(), &loaded.sources);
    let (errors, warnings) = counts(&loaded.diagnostics);
    terminal.remark(
        &format!("{}: {}", file.display(), verdict(errors, warnings)),
        &json!({ "kind": "check", "file": file, "errors": errors, "warnings": warnings }),
    );
    match (loaded.unreadable, errors) {
        (true, _) => Exit::FileFailed,
        (_, 0) => Exit::Done,
        _ => Exit::Mistakes,
    }
}

/// Errors and warnings.
pub(super) fn counts(diagnostics: &Diagnostics) -> (usize, usize) {
    (diagnostics.count(Severity::Error), diagnostics.count(Severity::Warning))
}

/// `2 errors, 1 warning`
pub(super) fn verdict(errors: usize, warnings: usize) -> String {
    match (errors as u64, warnings as u64) {
        (0, 0) => "no mistakes found".to_owned(),
        (0, warnings) => plural(warnings, "warning"),
        (errors, 0) => plural(errors, "error"),
        (errors, warnings) => format!("{}, {}", plural(errors, "error"), plural(warnings, "warning")),
    }
}
