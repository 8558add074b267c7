use crate::arguments::Convert;
use crate::exit::Exit;
use crate::replace::{Existing, write};
use crate::terminal::Terminal;
use serde_json::json;
use sophy::{Conversion, FileWorld, Root};
use std::path::Path;

const KNOWN: &str = "models go from .hsml to .xml and from .xml to .hsml or .xml; results from .csv, .arrow, .parquet or .journal to .csv, .arrow or .parquet";

/// Writes a model in the other language, or a result in another format.
pub(crate) fn convert(arguments: &Convert, terminal: &Terminal) -> Exit {
    let Convert { input, output, .. } = arguments;
    let exit = match (language(input), language(output)) {
        (Some(Language::Hsml), Some(Language::Hsml)) => {
            terminal.error("this is HSML already", Some("`sophy fmt` lays it out"));
            Exit::WrongUse
        }
        (Some(_), Some(language)) => convert_model(arguments, language, terminal),
        (None, None) => convert_result(input, output, terminal),
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

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Language {
    Hsml,
    Xml,
}

fn language(path: &Path) -> Option<Language> {
    match path.extension()?.to_str()?.to_ascii_lowercase().as_str() {
        "hsml" => Some(Language::Hsml),
        "xml" => Some(Language::Xml),
        _ => None,
    }
}

/// A model with mistakes is not written, nor one that the other language cannot say: something would be lost.
fn convert_model(arguments: &Convert, language: Language, terminal: &Terminal) -> Exit {
    let Convert { input, output, system } = arguments;
    // Several components can be HSML; which one becomes SOPHY XML has to be clear.
    let mut loaded = sophy::load_as(&FileWorld, input, system.as_deref().map_or(Root::IfClear, Root::Named));
    let Conversion { text, diagnostics } = match language {
        Language::Hsml => sophy::to_hsml(&loaded),
        Language::Xml => sophy::to_xml(&loaded),
    };
    loaded.diagnostics.extend(diagnostics);
    terminal.diagnostics(&loaded.messages(), &loaded.sources);
    let Some(text) = text else {
        return if loaded.unreadable { Exit::FileFailed } else { Exit::Mistakes };
    };
    match write(output, text.as_bytes(), Existing::Replace) {
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
