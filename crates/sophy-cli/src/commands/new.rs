use crate::arguments::{Kind, New};
use crate::exit::Exit;
use crate::replace::{Existing, write};
use crate::terminal::Terminal;
use serde_json::json;
use std::io::ErrorKind;
use std::path::Path;

/// Writes a template, named as asked for.
pub(crate) fn new(arguments: &New, terminal: &Terminal) -> Exit {
    let New { kind, name, output, force } = arguments;
    if let Err((why, help)) = judge(name) {
        terminal.error(&format!("`{name}` cannot be a name: {why}"), Some(&help));
        return Exit::WrongUse;
    }
    let text = template(*kind).replace(PLACEHOLDER, name);
    let Some(path) = output.as_ref().filter(|path| path.as_os_str() != "-") else {
        terminal.answer(&text, &json!({ "kind": "new", "text": text }));
        return Exit::Done;
    };
    let existing = if *force { Existing::Replace } else { Existing::Keep };
    match write(path, text.as_bytes(), existing) {
        Ok(()) => {
            let next = next(*kind, path);
            terminal.remark(
                &format!("wrote {}\n{next}", path.display()),
                &json!({ "kind": "new", "output": path, "text": text, "next": next }),
            );
            Exit::Done
        }
        Err(error) if error.kind() == ErrorKind::AlreadyExists => {
            terminal.error(&format!("{} exists", path.display()), Some("add `--force` to replace it"));
            Exit::FileFailed
        }
        Err(error) => {
            terminal.error(&format!("cannot write {}: {error}", path.display()), None);
            Exit::FileFailed
        }
    }
}

/// The name of the templates' components: they are models themselves.
const PLACEHOLDER: &str = "Template";

fn template(kind: Kind) -> &'static str {
    match kind {
        Kind::Ctc => include_str!("../../templates/ctc.hsml"),
        Kind::Dtc => include_str!("../../templates/dtc.hsml"),
        Kind::Lbc => include_str!("../../templates/lbc.hsml"),
        Kind::Cc => include_str!("../../templates/cc.hsml"),
        Kind::System => include_str!("../../templates/system.hsml"),
        Kind::Hybrid => include_str!("../../templates/hybrid.hsml"),
        Kind::Experiment => include_str!("../../templates/experiment.toml"),
    }
}

/// What to do with the file now.
fn next(kind: Kind, path: &Path) -> String {
    let (file, picture) = (path.display(), path.with_extension("html"));
    match kind {
        Kind::Experiment => format!("next: `sophy run {file}`"),
        Kind::Dtc => format!(
            "next: `sophy check {file}`; this version checks discrete-time components, and does not run them yet"
        ),
        Kind::Lbc => {
            format!("next: `sophy check {file}`; this version checks rules, and does not run them yet")
        }
        Kind::Ctc | Kind::Cc | Kind::Hybrid => {
            format!("next: `sophy run {file} --plot {}`", picture.display())
        }
        // A room takes its time.
        Kind::System => format!("next: `sophy run {file} --stop 1000 --plot {}`", picture.display()),
    }
}

/// Why a name is none, and the way out.
fn judge(name: &str) -> Result<(), (String, String)> {
    let is_part = |c: char| c.is_ascii_alphanumeric() || c == '_';
    let plain = || "write a letter first, then letters, digits and `_`, such as `Pump_2`".to_owned();
    let Some(first) = name.chars().next() else { return Err(("it is empty".to_owned(), plain())) };
    if let Some(wrong) = name.chars().find(|c| !is_part(*c)) {
        let joined: String = name.chars().map(|c| if is_part(c) { c } else { '_' }).collect();
        let help = match judge(&joined) {
            Ok(()) if joined.chars().any(|c| c != '_') => format!("write `{joined}`"),
            _ => plain(),
        };
        return Err((format!("it contains `{wrong}`"), help));
    }
    if first.is_ascii_digit() {
        return Err((format!("it begins with the digit {first}"), plain()));
    }
    // What the language takes for a name is one.
    let probe = template(Kind::Ctc).replace(PLACEHOLDER, name);
    if sophy::format("", probe.as_bytes()).text.is_none() {
        let why = "it is a word of the language".to_owned();
        return Err((why, format!("write `{name}_` or another name")));
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::judge;

    #[test]
    fn a_wrong_name_is_told_why() {
        for name in ["Pump", "pump_2", "_x", "Template", "rate"] {
            assert_eq!(judge(name), Ok(()), "{name}");
        }
        for (name, reason, way_out) in [
            ("", "it is empty", "a letter first"),
            ("2pumps", "the digit 2", "a letter first"),
            ("Ground Impact", "contains ` `", "`Ground_Impact`"),
            ("Größe", "contains `ö`", "`Gr__e`"),
            ("end", "a word of the language", "`end_`"),
            ("../x", "contains `.`", "`___x`"),
        ] {
            let (why, help) = judge(name).expect_err(name);
            assert!(why.contains(reason) && help.contains(way_out), "{name}: {why}; {help}");
        }
    }
}
