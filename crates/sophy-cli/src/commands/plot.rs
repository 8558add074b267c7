use crate::arguments::Plot;
use crate::exit::Exit;
use crate::terminal::Terminal;
use serde_json::json;
use sophy::{FileError, PlotOptions};
use std::path::{Path, PathBuf};

/// Draws result files.
pub(crate) fn plot(arguments: &Plot, terminal: &Terminal) -> Exit {
    if arguments.output.is_some() && arguments.results.len() > 1 {
        terminal
            .error("one picture cannot show several results", Some("leave out `-o`: each then has its own"));
        return Exit::WrongUse;
    }
    for result in &arguments.results {
        let picture = arguments.output.clone().unwrap_or_else(|| beside(result));
        match draw(arguments, result, &picture) {
            Ok(not_drawn) => {
                let said = not_drawn
                    .as_ref()
                    .map(|names| format!("; not shown: {names}; `--variables NAME,…` chooses"));
                terminal.remark(
                    &format!("wrote {}{}", picture.display(), said.unwrap_or_default()),
                    &json!({ "kind": "plot", "result": result, "output": picture, "not_drawn": not_drawn }),
                );
            }
            Err(error) => {
                terminal.error(&error.to_string(), None);
                return Exit::from(&error);
            }
        }
    }
    Exit::Done
}

fn draw(arguments: &Plot, result: &Path, picture: &Path) -> Result<Option<String>, FileError> {
    let table = sophy::read_table(result)?;
    let events = arguments.events.as_deref().map(sophy::read_events).transpose()?;
    let options = PlotOptions {
        title: arguments.title.clone(),
        variables: (!arguments.variables.is_empty()).then(|| arguments.variables.clone()),
        phase: arguments.phase.clone(),
        ..PlotOptions::default()
    };
    sophy::plot(picture, &table, &events.unwrap_or_default(), &options)
}

/// `hopper.parquet` and `hopper.parquet.journal` are drawn in `hopper.png`.
fn beside(result: &Path) -> PathBuf {
    let journal = result.extension().is_some_and(|extension| extension == "journal");
    let result = if journal { result.with_extension("") } else { result.to_owned() };
    result.with_extension("png")
}
