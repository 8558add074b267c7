use crate::arguments::Convert;
use crate::exit::Exit;
use crate::terminal::Terminal;
use serde_json::json;
use sophy::FileWorld;
use std::path::Path;

const KNOWN: &str = "models go from .xml to .xml; results from .csv, .arrow, .parquet or .journal to .csv, .arrow or .parquet";

/// Writes a model or a result in another form.
pub(crate) fn convert(arguments: &Convert, terminal: &Terminal) -> Exit {
    let Convert { input, output } = arguments;
    let exit = match (is_model(input), is_model(output)) {
        (true, true) => convert_model(input, output, terminal),
        (false, false) => convert_result(input, output, terminal),
        _ => {
            let message = format!("cannot convert {} to {}", input.display(), output.display());
            terminal.error(&message, Some(KNOWN));
            Exit::WrongUse
        }
    };
    // On stdout goes the data, and nothing else.
    if exit == Exit::Done && output.as_os_str() != "-" {
        terminal.remark(
            &format!("wrote {}", output.display()),
            &json!({ "kind": "convert", "input": input, "output": output }),
        );
    }
    exit
}

fn convert_model(input: &Path, output: &Path, terminal: &Terminal) -> Exit {
    let loaded = sophy::load_model(&FileWorld, input);
    terminal.diagnostics(&loaded.messages(), &loaded.sources);
    if loaded.unreadable {
        return Exit::FileFailed;
    }
    // A model with mistakes is not written: what was not understood would be lost.
    let (Some(declarations), Some(_)) = (&loaded.declarations, &loaded.model) else { return Exit::Mistakes };
    match std::fs::write(output, sophy::write_xml(declarations)) {
        Ok(()) => Exit::Done,
        Err(error) => {
            terminal.error(&format!("cannot write {}: {error}", output.display()), None);
            Exit::FileFailed
        }
    }
}

fn convert_result(input: &Path, output: &Path, terminal: &Terminal) -> Exit {
    match sophy::read_table(input).and_then(|table| sophy::write_table(output, &table)) {
        Ok(()) => Exit::Done,
        Err(error) => {
            let exit = Exit::from(&error);
            terminal.error(&error.to_string(), (exit == Exit::WrongUse).then_some(KNOWN));
            exit
        }
    }
}

fn is_model(path: &Path) -> bool {
    path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("xml"))
}
