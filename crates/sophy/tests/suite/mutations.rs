use sophy::{FileWorld, Root, Severity, Style, World, WorldError, load_as, render};
use std::fs;
use std::path::{Path, PathBuf};

/// The disk, with one file changed.
struct Changed<'a> {
    path: &'a Path,
    text: &'a str,
}

impl World for Changed<'_> {
    fn read(&self, path: &Path) -> Result<Vec<u8>, WorldError> {
        if path == self.path { Ok(self.text.as_bytes().to_vec()) } else { FileWorld.read(path) }
    }
}

/// Errors and warnings of every `every`th mutation of the files, each with a text that shows it.
pub fn message_counts(files: impl Iterator<Item = PathBuf>, every: usize) -> Vec<(usize, String)> {
    let mut counts = Vec::new();
    let mut number = 0;
    for path in files {
        let text = fs::read_to_string(&path).unwrap();
        for (what, mutated) in mutations(&text) {
            number += 1;
            if number % every != 0 {
                continue;
            }
            let loaded = load_as(&Changed { path: &path, text: &mutated }, &path, Root::IfClear);
            let found = loaded.messages();
            let serious: Vec<String> = found
                .iter()
                .filter(|message| message.severity != Severity::Note)
                .map(|message| render(message, &loaded.sources, Style::Plain))
                .collect();
            counts.push((serious.len(), format!("{}: {what}\n{}", path.display(), serious.join("\n"))));
        }
    }
    counts
}

/// The texts that differ by a token deleted, doubled or swapped with the next, each with what was done.
fn mutations(text: &str) -> Vec<(String, String)> {
    let tokens = tokens(text);
    let with = |replaced: std::ops::Range<usize>, by: &str| {
        let mut mutated = text[..replaced.start].to_owned();
        mutated.push_str(by);
        mutated.push_str(&text[replaced.end..]);
        mutated
    };
    let mut all = Vec::new();
    for (position, token) in tokens.iter().enumerate() {
        let written = &text[token.clone()];
        let line = text[..token.start].matches('\n').count() + 1;
        all.push((format!("`{written}` of line {line} deleted"), with(token.clone(), " ")));
        all.push((
            format!("`{written}` of line {line} doubled"),
            with(token.clone(), &format!("{written} {written}")),
        ));
        if let Some(next) = tokens.get(position + 1) {
            let other = &text[next.clone()];
            let between = &text[token.end..next.start];
            let swapped = with(token.start..next.end, &format!("{other} {between}{written}"));
            all.push((format!("`{written}` and `{other}` of line {line} swapped"), swapped));
        }
    }
    all
}

/// Where the tokens stand: words, numbers, texts in quotes, operators; comments are none.
fn tokens(text: &str) -> Vec<std::ops::Range<usize>> {
    let word = |c: char| c.is_alphanumeric() || c == '_';
    let mut tokens = Vec::new();
    let mut at = 0;
    while let Some(first) = text[at..].chars().next() {
        let rest = &text[at..];
        let length = match first {
            '%' => rest.find('\n').unwrap_or(rest.len()),
            '"' | '\'' => rest[1..].find(first).map_or(rest.len(), |end| end + 2),
            _ if word(first) => {
                let hyphenated = ["negative-to-positive", "positive-to-negative"];
                let known =
                    hyphenated.iter().find(|known| rest.starts_with(**known)).map(|known| known.len());
                known.unwrap_or_else(|| rest.find(|c| !word(c)).unwrap_or(rest.len()))
            }
            _ => {
                let known =
                    [":=", "->", "<=", ">=", "<>", ".."].iter().find(|known| rest.starts_with(**known));
                known.map_or(first.len_utf8(), |known| known.len())
            }
        };
        if first != '%' && !first.is_whitespace() {
            tokens.push(at..at + length);
        }
        at += length;
    }
    tokens
}
