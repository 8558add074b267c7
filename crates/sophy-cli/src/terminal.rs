use crate::arguments::{Colour, Format, Output};
use serde_json::{Value, json};
use sophy::{Diagnostic, Sources, Style, render};
use std::io::{IsTerminal, Write, stderr, stdout};

/// The way of all output: text for people on stderr, or JSON lines for scripts on stdout.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Terminal {
    pub(crate) json: bool,
    style: Style,
}

impl Terminal {
    pub(crate) fn new(output: &Output) -> Self {
        let colour = match output.color {
            Colour::Always => true,
            Colour::Never => false,
            Colour::Auto => {
                stderr().is_terminal() && std::env::var_os("NO_COLOR").is_none_or(|v| v.is_empty())
            }
        };
        Terminal {
            json: output.format == Format::Json,
            style: if colour { Style::Colour } else { Style::Plain },
        }
    }

    /// Shows messages with their source excerpts.
    pub(crate) fn diagnostics(&self, diagnostics: &[Diagnostic], sources: &Sources) {
        for diagnostic in diagnostics {
            if self.json {
                data(&diagnostic_json(diagnostic, sources).to_string());
            } else {
                note(&format!("{}\n", render(diagnostic, sources, self.style)));
            }
        }
    }

    /// Shows an error that stands in no text.
    pub(crate) fn error(&self, message: &str, help: Option<&str>) {
        let diagnostic = Diagnostic {
            code: sophy::Code("FI0003"),
            severity: sophy::Severity::Error,
            message: message.to_owned(),
            labels: Vec::new(),
            notes: Vec::new(),
            helps: help.map(str::to_owned).into_iter().collect(),
        };
        self.diagnostics(&[diagnostic], &Sources::default());
    }

    /// The answer of a command that is a remark: on stderr for people.
    pub(crate) fn remark(&self, text: &str, answer: &Value) {
        if self.json { data(&answer.to_string()) } else { note(text) }
    }

    /// The answer of a command that is data: on stdout.
    pub(crate) fn answer(&self, text: &str, answer: &Value) {
        data(if self.json { answer.to_string() } else { text.to_owned() }.trim_end());
    }
}

/// A terminal that has gone away is no reason to stop.
fn note(text: &str) {
    let _ = writeln!(stderr(), "{text}");
}

fn data(text: &str) {
    let _ = writeln!(stdout(), "{text}");
}

fn diagnostic_json(diagnostic: &Diagnostic, sources: &Sources) -> Value {
    let label = |label: &sophy::Label| {
        let (source, start, end) = (label.span.source, label.span.start, label.span.end);
        let (first, last) = (sources.line_column(source, start), sources.line_column(source, end));
        json!({
            "file": sources.name(source),
            "line": first.line, "column": first.column,
            "end_line": last.line, "end_column": last.column,
            "start": start, "end": end,
            "message": label.message,
        })
    };
    json!({
        "kind": "diagnostic",
        "code": diagnostic.code.0,
        "severity": diagnostic.severity.name(),
        "message": diagnostic.message,
        "labels": diagnostic.labels.iter().map(label).collect::<Vec<_>>(),
        "notes": diagnostic.notes,
        "helps": diagnostic.helps,
    })
}
