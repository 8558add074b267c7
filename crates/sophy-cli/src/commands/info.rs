mod lists;
mod structure;

use crate::arguments::Info;
use crate::exit::Exit;
use crate::terminal::Terminal;
use lists::Lists;
use serde_json::{Value, json};
use sophy::{FileWorld, Model, Root};

/// Shows what a model consists of.
pub(crate) fn info(arguments: &Info, terminal: &Terminal) -> Exit {
    let root = arguments.system.as_deref().map_or(Root::Implied, Root::Named);
    let loaded = sophy::load_as(&FileWorld, &arguments.file, root);
    terminal.diagnostics(&loaded.messages(), &loaded.sources);
    let Some(model) = &loaded.model else {
        return if loaded.unreadable { Exit::FileFailed } else { Exit::Mistakes };
    };
    if !arguments.draw.is_empty() {
        return draw(arguments, model, terminal);
    }
    match sophy::describe(model) {
        Ok(description) if terminal.json => {
            let mut answer = serde_json::to_value(&description).unwrap_or(Value::Null);
            answer["kind"] = json!("info");
            terminal.answer("", &answer);
            Exit::Done
        }
        Ok(description) => {
            terminal.answer(&structure::text(&description, Lists::new(arguments.all)), &Value::Null);
            Exit::Done
        }
        Err(sophy::Error::Composition(error)) => {
            terminal.diagnostics(&[sophy::explain_composition(&error)], &loaded.sources);
            Exit::Mistakes
        }
        Err(error) => {
            terminal.error(&error.to_string(), None);
            Exit::Mistakes
        }
    }
}

fn draw(arguments: &Info, model: &Model, terminal: &Terminal) -> Exit {
    let diagram = match sophy::diagram(model, arguments.component.as_deref()) {
        Ok(diagram) => diagram,
        Err(error) => {
            terminal.error(&error.to_string(), None);
            return Exit::WrongUse;
        }
    };
    for picture in &arguments.draw {
        if let Err(error) = sophy::draw(picture, &diagram) {
            terminal.error(&error.to_string(), None);
            return Exit::from(&error);
        }
        terminal.remark(
            &format!("wrote {}", picture.display()),
            &json!({ "kind": "info", "model": arguments.file, "output": picture }),
        );
    }
    Exit::Done
}
