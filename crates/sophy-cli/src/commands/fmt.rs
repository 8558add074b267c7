use crate::arguments::Fmt;
use crate::exit::Exit;
use crate::replace::{Existing, write};
use crate::terminal::Terminal;
use serde_json::json;
use std::io::Read;
use std::path::Path;

/// Lays out files in place, or says which are not laid out.
pub(crate) fn fmt(arguments: &Fmt, terminal: &Terminal) -> Exit {
    let one = |file: &Path| {
        if file.as_os_str() == "-" {
            stdin(arguments.check, terminal)
        } else {
            in_place(file, arguments.check, terminal)
        }
    };
    let exits: Vec<Exit> = arguments.files.iter().map(|file| one(file)).collect();
    let worst =
        [Exit::FileFailed, Exit::Mistakes, Exit::WrongUse].into_iter().find(|exit| exits.contains(exit));
    worst.unwrap_or(Exit::Done)
}

fn in_place(file: &Path, check: bool, terminal: &Terminal) -> Exit {
    if !file.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("hsml")) {
        let message = format!("{} is no file of HSML (.hsml)", file.display());
        terminal.error(&message, Some("`sophy convert` writes other models as HSML"));
        return Exit::WrongUse;
    }
    let bytes = match std::fs::read(file) {
        Ok(bytes) => bytes,
        Err(error) => {
            terminal.error(&format!("cannot read {}: {error}", file.display()), None);
            return Exit::FileFailed;
        }
    };
    let Some(text) = laid_out(&file.display().to_string(), &bytes, terminal) else { return Exit::Mistakes };
    let (first, last) = changed_lines(&bytes, &text);
    let lines = if first == last { format!("line {first}") } else { format!("lines {first} to {last}") };
    let changes = text.as_bytes() != bytes;
    let said = match (changes, check) {
        (false, _) => "is laid out".to_owned(),
        (true, true) => format!("{lines} would change"),
        (true, false) => format!("{lines} changed"),
    };
    if changes
        && !check
        && let Err(error) = write(file, text.as_bytes(), Existing::Replace)
    {
        terminal.error(&format!("cannot write {}: {error}", file.display()), None);
        return Exit::FileFailed;
    }
    let mut answer = json!({ "kind": "fmt", "file": file, "changes": changes, "written": changes && !check });
    if changes {
        answer["lines"] = json!([first, last]);
    }
    terminal.remark(&format!("{}: {said}", file.display()), &answer);
    if changes && check { Exit::Mistakes } else { Exit::Done }
}

fn stdin(check: bool, terminal: &Terminal) -> Exit {
    let mut bytes = Vec::new();
    if let Err(error) = std::io::stdin().lock().read_to_end(&mut bytes) {
        terminal.error(&format!("cannot read stdin: {error}"), None);
        return Exit::FileFailed;
    }
    let Some(text) = laid_out("stdin", &bytes, terminal) else { return Exit::Mistakes };
    let changes = text.as_bytes() != bytes;
    if check {
        let said = if changes { "would change" } else { "is laid out" };
        terminal
            .remark(&format!("stdin: {said}"), &json!({ "kind": "fmt", "file": "-", "changes": changes }));
        return if changes { Exit::Mistakes } else { Exit::Done };
    }
    terminal.answer(&text, &json!({ "kind": "fmt", "file": "-", "changes": changes, "text": text }));
    Exit::Done
}

/// The layout, or nothing after the mistakes were said.
fn laid_out(name: &str, bytes: &[u8], terminal: &Terminal) -> Option<String> {
    let formatted = sophy::format(name, bytes);
    terminal.diagnostics(&formatted.messages, &formatted.sources);
    if formatted.text.is_none() {
        let text = format!("{name}: left as it is, for it has mistakes of grammar");
        terminal.remark(&text, &json!({ "kind": "fmt", "file": name, "refused": true }));
    }
    formatted.text
}

/// The lines of the file, from 1, outside of which the layout is the same.
fn changed_lines(before: &[u8], after: &str) -> (usize, usize) {
    let before = String::from_utf8_lossy(before);
    let (old, new): (Vec<&str>, Vec<&str>) = (before.split('\n').collect(), after.split('\n').collect());
    let head = old.iter().zip(&new).take_while(|(a, b)| a == b).count();
    let rest = old.len().min(new.len()) - head;
    let tail = old.iter().rev().zip(new.iter().rev()).take(rest).take_while(|(a, b)| a == b).count();
    (head + 1, (old.len() - tail).max(head + 1))
}

#[cfg(test)]
mod tests {
    use super::changed_lines;

    #[test]
    fn changed_lines_are_those_between_what_is_the_same() {
        assert_eq!(changed_lines(b"a\nb \nc\n", "a\nb\nc\n"), (2, 2));
        assert_eq!(changed_lines(b"a\nc\n", "a\nb\nc\n"), (2, 2));
        assert_eq!(changed_lines(b"a\n\n\nc\n", "a\n\nc\n"), (3, 3));
        assert_eq!(changed_lines(b"a", "a\n"), (2, 2));
        assert_eq!(changed_lines(b"a\r\nb\r\n", "a\nb\n"), (1, 2));
    }
}
