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
    ComponentDeclaration, ComponentKind, Declarations, Dialect, Direction, EquationDeclaration, EquationItem,
    Equations, ExpressionText, FunctionDeclaration, LocationDeclaration, ParameterDeclaration,
    PortDeclaration, Spanned, Statement, Target, TransitionDeclaration, TriggerDeclaration,
    VariableDeclaration, VariableRole,
};
use sophy_diagnostics::{Diagnostic, Diagnostics, MemoryWorld, Severity, SourceId, Sources, Span, TextMap};
use sophy_ir::Model;

/// Analyses `text` and compares all diagnostics, sorted by place, with `expected` (indentation aside).
pub(crate) fn check(text: &str, expected: &str) {
    let (sources, declarations) = read(text);
    let (model, diagnostics) = analysed(&sources, &declarations);
    assert!(model.is_none() || !diagnostics.has_errors(), "a model with errors");
    let expected: Vec<&str> = expected.lines().map(str::trim).collect();
    assert_eq!(rendered(diagnostics, &sources), expected.join("\n"));
}

/// The same for a system without errors.
pub(crate) fn check_model(text: &str, expected: &str) -> Model {
    check(text, expected);
    let (sources, declarations) = read(text);
    analysed(&sources, &declarations).0.expect("there are no errors")
}

/// The model of a system without anything to complain of.
pub(crate) fn model_of(text: &str) -> Model {
    check_model(text, "")
}

/// The automaton of a model that is one component.
pub(crate) fn automaton(model: &Model) -> &sophy_ir::HybridAutomaton {
    match &model.root().body {
        sophy_ir::Body::Automaton(automaton) => automaton,
        other => panic!("{other:?} is no automaton"),
    }
}

/// All diagnostics of `text`.
pub(crate) fn diagnostics_of(text: &str) -> Vec<Diagnostic> {
    let (sources, declarations) = read(text);
    analysed(&sources, &declarations).1.iter().cloned().collect()
}

/// Codes of the errors in `text`.
pub(crate) fn errors_of(text: &str) -> Vec<&'static str> {
    let errors = diagnostics_of(text).into_iter().filter(|d| d.severity == Severity::Error);
    errors.map(|diagnostic| diagnostic.code.0).collect()
}

pub(crate) fn analysed(sources: &Sources, declarations: &Declarations) -> (Option<Model>, Diagnostics) {
    let main = declarations.components[0].name.span.source;
    crate::analyse(declarations, crate::Root::Implied, main, sources, &MemoryWorld::default())
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
    let equation = |rest: &str, derivative: bool| {
        let (target, right) = split(text, at(rest), rest.len(), "=");
        let target = Target { name: name(target), indices: Vec::new() };
        EquationDeclaration { derivative, target, right: expression(right) }
    };
    let assignment = |rest: &str| {
        let EquationDeclaration { target, right, .. } = equation(rest, false);
        Statement::Assign { target, right }
    };
    let port = |rest: &str, direction| PortDeclaration {
        name: name(rest),
        documentation: String::new(),
        direction,
        kind: None,
        range: None,
        unit: None,
    };
    let mut functions = Vec::new();
    let nameless = Spanned::new("test".to_owned(), Span::new(source, 0..0));
    let mut d = ComponentDeclaration::new(ComponentKind::Ctc, nameless, Dialect::Xml);
    for line in text.lines().map(str::trim).filter(|line| !line.is_empty()) {
        let (keyword, rest) = split(text, at(line), line.len(), " ");
        match keyword {
            "system" => d.name = name(rest),
            "constant" => {
                let EquationDeclaration { target, right, .. } = equation(rest, false);
                d.parameters.push(ParameterDeclaration {
                    name: target.name,
                    documentation: String::new(),
                    kind: None,
                    value: right,
                    unit: None,
                });
            }
            "function" => {
                let (head, body) = split(text, at(rest), rest.len(), "=");
                let (called, parameters) = head.split_once('(').expect("a parameter list");
                let parameters = parameters.trim_end_matches(')').split(',').map(|p| (name(p.trim()), None));
                functions.push(FunctionDeclaration {
                    name: name(called.trim()),
                    documentation: String::new(),
                    parameters: parameters.collect(),
                    result: None,
                    body: expression(body),
                });
            }
            "state" => d.variables.push(VariableDeclaration {
                role: VariableRole::State,
                name: name(rest),
                documentation: String::new(),
                kind: None,
                range: None,
                initial: None,
                unit: None,
            }),
            "input" => d.ports.push(port(rest, Direction::Input)),
            "output" => d.ports.push(port(rest, Direction::Output)),
            "unit" => {
                let (of, unit) = split(text, at(rest), rest.len(), "=");
                d.units.push((name(of), name(unit)));
            }
            "initial" => d.initial.push(assignment(rest)),
            "start" => d.initial_location = Some(name(rest)),
            "location" => d.locations.push(LocationDeclaration {
                name: name(rest),
                documentation: String::new(),
                variables: Vec::new(),
                equations: Equations::default(),
                invariant: None,
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
                        trigger: TriggerDeclaration::WhenOrOn(Some(expression(guard)), Vec::new()),
                        priority: None,
                        destination: name(destination),
                        actions: Vec::new(),
                    });
                    continue;
                }
                let transition = location.transitions.last_mut();
                match (keyword, transition) {
                    ("der", _) => {
                        location.equations.dynamics.push(EquationItem::Equation(equation(rest, true)));
                    }
                    ("out", _) => {
                        location.equations.output.push(EquationItem::Equation(equation(rest, false)));
                    }
                    ("reset", Some(transition)) => transition.actions.push(assignment(rest)),
                    ("on", Some(transition)) => match &mut transition.trigger {
                        TriggerDeclaration::WhenOrOn(_, events) => events.push(name(rest)),
                        _ => panic!("no such trigger"),
                    },
                    ("emit", Some(transition)) => transition.actions.push(Statement::Emit(name(rest))),
                    _ => panic!("what is `{line}`?"),
                }
            }
        }
    }
    let declarations = Declarations { functions, components: vec![d], ..Declarations::default() };
    (sources, declarations)
}

/// The two sides of the first `separator` in a part of `text`, trimmed.
fn split<'t>(text: &'t str, start: usize, length: usize, separator: &str) -> (&'t str, &'t str) {
    let part = &text[start..start + length];
    let (left, right) = part.split_once(separator).unwrap_or((part, &part[length..]));
    (left.trim(), right.trim())
}

fn expression(part: &str, source: SourceId, start: usize) -> ExpressionText {
    ExpressionText::parse(part, TextMap::plain(source, start as u32, part.len() as u32)).0
}
