use crate::arguments::Info;
use crate::exit::Exit;
use crate::numbers::plural;
use crate::terminal::Terminal;
use serde_json::{Value, json};
use sophy::{AutomatonDescription, Description, FileWorld, Quantity, TransitionDescription};
use std::fmt::Write;

/// Shows what a model consists of.
pub(crate) fn info(arguments: &Info, terminal: &Terminal) -> Exit {
    let loaded = sophy::load(&FileWorld, &arguments.file);
    terminal.diagnostics(&loaded.messages(), &loaded.sources);
    let Some(model) = &loaded.model else {
        return if loaded.unreadable { Exit::FileFailed } else { Exit::Mistakes };
    };
    match sophy::describe(model) {
        Ok(description) => {
            let mut answer = serde_json::to_value(&description).unwrap_or(Value::Null);
            answer["kind"] = json!("info");
            terminal.answer(&text(&description), &answer);
            Exit::Done
        }
        Err(error) => {
            terminal.error(&error.to_string(), None);
            Exit::Mistakes
        }
    }
}

fn text(d: &Description) -> String {
    let mut out = String::new();
    line(&mut out, &d.name);
    for paragraph in d.documentation.trim().lines() {
        line(&mut out, &format!("  {}", paragraph.trim()));
    }
    line(&mut out, "");
    line(&mut out, &sizes(d));
    quantities("States", "initial", &d.states, &mut out);
    quantities("Inputs", "", &d.inputs, &mut out);
    quantities("Outputs", "", &d.outputs, &mut out);
    quantities("Constants", "value", &d.constants, &mut out);
    d.automata.iter().for_each(|automaton| locations(automaton, &mut out));
    dependencies(d, &mut out);
    if !d.watches.is_empty() {
        line(&mut out, "\nWatched for changes of sign");
        for watch in &d.watches {
            line(&mut out, &format!("  {}  ({})", watch.quantity, kind(watch.affine)));
        }
    }
    out
}

fn sizes(d: &Description) -> String {
    let locations: usize = d.automata.iter().map(|a| a.locations.len()).sum();
    let transitions: usize = d.automata.iter().flat_map(|a| &a.locations).map(|l| l.transitions.len()).sum();
    [
        (d.states.len(), "state"),
        (d.inputs.len(), "input"),
        (d.outputs.len(), "output"),
        (d.constants.len(), "constant"),
        (locations, "location"),
        (transitions, "transition"),
    ]
    .map(|(number, noun)| plural(number as u64, noun))
    .join(", ")
}

fn quantities(title: &str, value_title: &str, quantities: &[Quantity], out: &mut String) {
    if quantities.is_empty() {
        return;
    }
    let names: Vec<String> = quantities
        .iter()
        .map(|q| match &q.unit {
            Some(unit) => format!("{} [{unit}]", q.name),
            None => q.name.clone(),
        })
        .collect();
    let values: Vec<String> = quantities
        .iter()
        .map(|q| match (q.value, value_title) {
            (Some(value), _) => value.to_string(),
            (None, "initial") => "not given".to_owned(),
            (None, _) => String::new(),
        })
        .collect();
    let (width, value_width) = (widest(&names).max(title.len()), widest(&values).max(value_title.len()));
    line(out, &format!("\n{title:<width$}    {value_title}"));
    for ((name, value), quantity) in names.iter().zip(&values).zip(quantities) {
        line(out, &format!("  {name:<width$}  {value:<value_width$}  {}", quantity.documentation));
    }
}

fn locations(automaton: &AutomatonDescription, out: &mut String) {
    match automaton.component.as_str() {
        "" => line(out, "\nLocations"),
        component => line(out, &format!("\nLocations of {component}")),
    }
    for location in &automaton.locations {
        let initial = if location.name == automaton.initial { "  (initial)" } else { "" };
        line(out, &format!("  {}{initial}", location.name));
        location.transitions.iter().for_each(|t| transition(t, out));
    }
}

fn transition(t: &TransitionDescription, out: &mut String) {
    line(out, &format!("    → {}  {}", t.to, t.name));
    line(out, &format!("        {}  ({})", t.trigger, kind(t.affine)));
    t.resets.iter().for_each(|reset| line(out, &format!("        {reset}")));
    t.emits.iter().for_each(|label| line(out, &format!("        emits {label}")));
}

/// How crossings are found.
fn kind(affine: bool) -> &'static str {
    if affine { "affine" } else { "not affine" }
}

/// The coupling matrix D: rows are rates, columns what they read.
fn dependencies(d: &Description, out: &mut String) {
    if d.dependencies.is_empty() {
        return;
    }
    let named = d.states.iter().chain(&d.inputs).map(|q| q.name.as_str()).chain(["time"]);
    let is_read = |name: &&str| d.dependencies.iter().any(|row| row.reads.iter().any(|read| read == name));
    let columns: Vec<&str> = named.filter(is_read).collect();
    let width = d.dependencies.iter().map(|row| row.state.chars().count() + 5).max().unwrap_or(0);
    line(out, "\nDependencies (× read in all locations, + in some)");
    line(out, &format!("  {:<width$}  {}", "", columns.join("  ")));
    for row in &d.dependencies {
        let mut text = format!("  {:<width$}", format!("der({})", row.state));
        for column in &columns {
            let everywhere = row.by_location.iter().all(|(_, reads)| reads.iter().any(|read| read == column));
            let mark = match (row.reads.iter().any(|read| read == column), everywhere) {
                (false, _) => '·',
                (true, true) => '×',
                (true, false) => '+',
            };
            let cell = column.chars().count();
            // Writing into a string does not fail.
            let _ = write!(text, "  {mark:<cell$}");
        }
        line(out, &text);
    }
    for row in &d.dependencies {
        for (location, reads) in &row.by_location {
            let reads = if reads.is_empty() { "nothing".to_owned() } else { reads.join(", ") };
            line(out, &format!("  in {location}, der({}) reads {reads}", row.state));
        }
    }
}

fn widest(texts: &[String]) -> usize {
    texts.iter().map(|text| text.chars().count()).max().unwrap_or(0)
}

fn line(out: &mut String, text: &str) {
    out.push_str(text.trim_end());
    out.push('\n');
}
