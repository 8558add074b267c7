use crate::arguments::Explain;
use crate::exit::Exit;
use crate::terminal::Terminal;
use serde_json::{Value, json};
use sophy::Page;
use std::fmt::Write;

/// Prints the page of a code, or the list of all codes.
pub(crate) fn explain(arguments: &Explain, terminal: &Terminal) -> Exit {
    let Some(code) = &arguments.code else {
        terminal.answer(
            &list(),
            &json!({ "kind": "codes", "codes": sophy::pages().map(head).collect::<Vec<_>>() }),
        );
        return Exit::Done;
    };
    let Some(page) = sophy::page(code) else {
        let known: Vec<&str> = sophy::pages().map(|page| page.code).collect();
        let help = match sophy::closest(&code.to_ascii_uppercase(), known.iter().copied()) {
            Some(meant) => format!("did you mean `{meant}`? `sophy explain` lists all codes"),
            None => "`sophy explain` lists all codes".to_owned(),
        };
        terminal.error(&format!("there is no code `{code}`"), Some(&help));
        return Exit::WrongUse;
    };
    let Page { code, title, text } = page;
    let mut answer = head(page);
    answer["kind"] = json!("page");
    answer["text"] = json!(text);
    terminal.answer(&format!("{code}: {title}\n\n{text}"), &answer);
    Exit::Done
}

fn list() -> String {
    let mut text = String::new();
    for Page { code, title, .. } in sophy::pages() {
        // Writing into a string does not fail.
        let _ = writeln!(text, "{code}  {title}");
    }
    text
}

fn head(page: Page) -> Value {
    json!({ "code": page.code, "title": page.title })
}
