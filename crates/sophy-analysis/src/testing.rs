//! Systems in a small text form, and their diagnostics as text, for the tests of this crate.
//!
//! ```text
//! constant G = 9.82
//! function f(x, y) = x + y
//! state Position
//! input u
//! output V
//! unit Position = m
//! initial Position = 1.9
//! start Flight
//! location Flight
//!   der Position = Speed
//!   out V = f(Position, 1)
//!   transition impact when Position < L goto Compression
//!     reset Speed = 0
//!     on input_event
//!     emit output_event
//! ```

use crate::declarations::{
    ConstantDeclaration, Declarations, EquationDeclaration, ExpressionText, FunctionDeclaration,
    LocationDeclaration, Spanned, TransitionDeclaration, VariableDeclaration,
};
use sophy_diagnostics::{Diagnostic, Diagnostics, Severity, SourceId, Sources, Span, TextMap};
use sophy_ir::Model;
use sophy_syntax::parse_expression;

/// Analyses `text` and compares all diagnostics, sorted by place, with `expected` (indentation aside).
pub(crate) fn check(text: &str, expected: &str) {
    let (sources, declarations) = read(text);
    let (model, diagnostics) = crate::analyse(&declarations);
    assert!(model.is_none() || !diagnostics.has_errors(), "a model with errors");
    let expected: Vec<&str> = expected.lines().map(str::trim).collect();
    assert_eq!(rendered(diagnostics, &sources), expected.join("\n"));
}

/// The same for a system without errors.
pub(crate) fn check_model(text: &str, expected: &str) -> Model {
    check(text, expected);
    crate::analyse(&read(text).1).0.expect("there are no errors")
}

/// The model of a system without anything to complain of.
pub(crate) fn model_of(text: &str) -> Model {
    check_model(text, "")
}

/// All diagnostics of `text`.
pub(crate) fn diagnostics_of(text: &str) -> Vec<Diagnostic> {
    crate::analyse(&read(text).1).1.iter().cloned().collect()
}

/// Codes of the errors in `text`.
pub(crate) fn errors_of(text: &str) -> Vec<&'static str> {
    let errors = diagnostics_of(text).into_iter().filter(|d| d.severity == Severity::Error);
    errors.map(|diagnostic| diagnostic.code.0).collect()
}

fn rendered(diagnostics: Diagnostics, sources: &Sources) -> String {
    let place = |span: Span| {
        let line = sources.line_column(span.source, span.start).line;
        format!("line {line} `{}`", sources.excerpt(span))
    };
    let mut lines = Vec::new();
    for diagnostic in diagnostics.sorted(sources) {
        let (severity, code) = (diagnostic.severity.name(), diagnostic.code);
        for (index, label) in diagnostic.labels.iter().enumerate() {
            let place = place(label.span);
            lines.push(match (index, label.message.as_str()) {
                (0, "") => format!("{severity}[{code}] {place}: {}", diagnostic.message),
                (0, said) => format!("{severity}[{code}] {place}: {} ({said})", diagnostic.message),
                (_, said) => format!("{place}: {said}"),
            });
        }
        lines.extend(diagnostic.notes.iter().map(|note| format!("note: {note}")));
        lines.extend(diagnostic.helps.iter().map(|help| format!("help: {help}")));
    }
    lines.join("\n")
}

/// Reads the text form; panics where a test is wrong.
pub(crate) fn read(text: &str) -> (Sources, Declarations) {
    let mut sources = Sources::default();
    let source = sources.add("test", text);
    let at = |part: &str| part.as_ptr() as usize - text.as_ptr() as usize;
    let name = |part: &str| Spanned::new(part.to_owned(), Span::new(source, at(part)..at(part) + part.len()));
    let expression = |part: &str| expression(part, source, at(part));
    let equation = |rest: &str| {
        let (target, right) = split(text, at(rest), rest.len(), "=");
        EquationDeclaration { target: name(target), right: expression(right) }
    };
    let variable = |rest: &str| VariableDeclaration { name: name(rest), documentation: String::new() };
    let mut d = Declarations {
        name: Spanned::new(String::new(), Span::new(source, 0..0)),
        documentation: String::new(),
        constants: Vec::new(),
        functions: Vec::new(),
        states: Vec::new(),
        inputs: Vec::new(),
        outputs: Vec::new(),
        initial: Vec::new(),
        initial_location: None,
        units: Vec::new(),
        hints: Vec::new(),
        locations: Vec::new(),
    };
    for line in text.lines().map(str::trim).filter(|line| !line.is_empty()) {
        let (keyword, rest) = split(text, at(line), line.len(), " ");
        match keyword {
            "system" => d.name = name(rest),
            "constant" => {
                let EquationDeclaration { target, right } = equation(rest);
                d.constants.push(ConstantDeclaration { name: target, value: right });
            }
            "function" => {
                let (head, body) = split(text, at(rest), rest.len(), "=");
                let (called, parameters) = head.split_once('(').expect("a parameter list");
                let parameters = parameters.trim_end_matches(')').split(',').map(|p| name(p.trim()));
                d.functions.push(FunctionDeclaration {
                    name: name(called.trim()),
                    parameters: parameters.collect(),
                    body: expression(body),
                });
            }
            "state" => d.states.push(variable(rest)),
            "input" => d.inputs.push(variable(rest)),
            "output" => d.outputs.push(variable(rest)),
            "unit" => {
                let (of, unit) = split(text, at(rest), rest.len(), "=");
                d.units.push((name(of), name(unit)));
            }
            "initial" => d.initial.push(equation(rest)),
            "start" => d.initial_location = Some(name(rest)),
            "location" => d.locations.push(LocationDeclaration {
                name: name(rest),
                documentation: String::new(),
                dynamics: Vec::new(),
                outputs: Vec::new(),
                transitions: Vec::new(),
            }),
            _ => {
                let location = d.locations.last_mut().expect("a location");
                if keyword == "transition" {
                    let (called, rest) = split(text, at(rest), rest.len(), " when ");
                    let (guard, destination) = split(text, at(rest), rest.len(), " goto ");
                    location.transitions.push(TransitionDeclaration {
                        name: name(called),
                        documentation: String::new(),
                        guard: Some(expression(guard)),
                        destination: name(destination),
                        resets: Vec::new(),
                        input_events: Vec::new(),
                        output_events: Vec::new(),
                    });
                    continue;
                }
                let transition = location.transitions.last_mut();
                match (keyword, transition) {
                    ("der", _) => location.dynamics.push(equation(rest)),
                    ("out", _) => location.outputs.push(equation(rest)),
                    ("reset", Some(transition)) => transition.resets.push(equation(rest)),
                    ("on", Some(transition)) => transition.input_events.push(name(rest)),
                    ("emit", Some(transition)) => transition.output_events.push(name(rest)),
                    _ => panic!("what is `{line}`?"),
                }
            }
        }
    }
    (sources, d)
}

/// The two sides of the first `separator` in a part of `text`, trimmed.
fn split<'t>(text: &'t str, start: usize, length: usize, separator: &str) -> (&'t str, &'t str) {
    let part = &text[start..start + length];
    let (left, right) = part.split_once(separator).unwrap_or((part, &part[length..]));
    (left.trim(), right.trim())
}

fn expression(part: &str, source: SourceId, start: usize) -> ExpressionText {
    ExpressionText {
        text: part.to_owned(),
        parse: parse_expression(part),
        map: TextMap::plain(source, start as u32, part.len() as u32),
    }
}
