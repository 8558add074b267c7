//! Hints with a meaning: what a model needs and the definition has no element for.
//!
//! | `hintname` | text | |
//! | --- | --- | --- |
//! | `initial location` | name of a location | where a run starts |
//! | `initial NAME` | expression | value of the state at the start |
//! | `unit NAME` | unit | of a state, input, output or constant |
//! | `function f(a, b)` | expression | a function for the expressions of the file |
//! | `knob NAME` | range or nothing | an experiment is meant to set the constant |
//! | `view NAME` | nothing | to be recorded and displayed |
//! | `documentation NAME` | text | of a constant or function |
//!
//! The first one wins over a state called `location`, which is a reserved word.
//! All others are for other tools (thesis, A.4: "meta information to the Sophy environment") and are kept.

use crate::codes::{BAD_HINT, NEAR_HINT, SECOND_INITIAL_LOCATION};
use crate::declarations::{Reader, whole};
use crate::document::{Element, Text};
use sophy_analysis::{
    ComponentDeclaration, ExpressionText, FunctionDeclaration, KnobDeclaration, RangeText, Spanned, Statement,
};
use sophy_diagnostics::{Diagnostic, closest};
use std::collections::HashMap;

const KEYWORDS: [&str; 3] = ["initial", "unit", "function"];

/// Adds what `hints` declare to `component`; returns the functions.
pub(crate) fn declare<'a>(
    hints: impl Iterator<Item = &'a Element>,
    component: &mut ComponentDeclaration,
    reader: &mut Reader<'_>,
) -> Vec<FunctionDeclaration> {
    let mut functions = Vec::new();
    let mut documentation = Vec::new();
    for hint in hints {
        // A hint without a name has been complained about.
        let Some(hintname) = hint.required_attribute("hintname") else { continue };
        let (keyword, argument) = split(hintname);
        match (keyword.value.as_str(), argument) {
            ("initial", Some(argument)) if argument.value == "location" => {
                initial_location(hint, component, reader);
            }
            ("initial", Some(name)) => {
                let right = reader.expression(&hint.text());
                component.initial.push(Statement::Assign { target: whole(name), right });
            }
            ("unit", Some(name)) => component.units.push((name, value(hint))),
            ("function", Some(argument)) => match signature(hintname, &argument) {
                Some((name, parameters)) => functions.push(FunctionDeclaration {
                    name,
                    documentation: String::new(),
                    parameters: parameters.into_iter().map(|name| (name, None)).collect(),
                    result: None,
                    body: reader.expression(&hint.text()),
                }),
                None => {
                    not_understood(
                        &argument,
                        "is not the head of a function",
                        "write function f(a, b)",
                        reader,
                    );
                    keep(hint, hintname, component);
                }
            },
            ("knob", Some(name)) => match range(hint, reader) {
                Ok(range) => component.knobs.push(KnobDeclaration {
                    name,
                    documentation: String::new(),
                    range,
                    unit: None,
                }),
                Err(text) => {
                    not_understood(
                        &text,
                        "is not a range",
                        "write (low, high) or {a, b, c}, or nothing",
                        reader,
                    );
                    keep(hint, hintname, component);
                }
            },
            ("view", Some(name)) => component.views.push(name),
            ("documentation", Some(name)) => documentation.push((name, hint, hintname)),
            (word, None) if KEYWORDS.contains(&word) => {
                let help = match word {
                    "function" => "write function f(a, b)".to_owned(),
                    _ => format!("write {word} NAME"),
                };
                not_understood(&keyword, "needs a name after it", &help, reader);
                keep(hint, hintname, component);
            }
            (_, argument) => {
                near_miss(&keyword, argument.as_ref(), reader);
                keep(hint, hintname, component);
            }
        }
    }
    document(documentation, component, &mut functions);
    functions
}

/// What a hint is about, the hint, and its name in full.
type HintAbout<'a> = (Spanned<String>, &'a Element, &'a Text);

/// Gives knobs, constants and functions the documentation that stands in hints; what fits none is kept as it is.
fn document(
    hints: Vec<HintAbout<'_>>,
    component: &mut ComponentDeclaration,
    functions: &mut [FunctionDeclaration],
) {
    let mut texts: HashMap<String, (usize, String)> = HashMap::new();
    for (position, (name, hint, _)) in hints.iter().enumerate() {
        texts.entry(name.value.clone()).or_insert_with(|| (position, value(hint).value));
    }
    let mut used = vec![false; hints.len()];
    let mut find = |name: &Spanned<String>, documentation: &mut String| {
        if let Some((position, text)) = texts.remove(&name.value) {
            *documentation = text;
            used.iter_mut().skip(position).take(1).for_each(|used| *used = true);
        }
    };
    component.knobs.iter_mut().for_each(|knob| find(&knob.name, &mut knob.documentation));
    component.parameters.iter_mut().for_each(|constant| find(&constant.name, &mut constant.documentation));
    functions.iter_mut().for_each(|function| find(&function.name, &mut function.documentation));
    for ((_, hint, hintname), used) in hints.into_iter().zip(used) {
        if !used {
            keep(hint, hintname, component);
        }
    }
}

/// `(low, high)`, `{a, b, c}` or nothing; whatever else stands there is the error.
fn range(hint: &Element, reader: &mut Reader<'_>) -> Result<Option<RangeText>, Spanned<String>> {
    let text = hint.text();
    let decoded = &text.decoded;
    let start = decoded.len() - decoded.trim_start().len();
    let trimmed = decoded.trim();
    let Some(inner) = trimmed.get(1..trimmed.len().saturating_sub(1)) else {
        return if trimmed.is_empty() { Ok(None) } else { Err(value(hint)) };
    };
    let mut expressions = Vec::new();
    let mut from = start + 1;
    for piece in pieces(inner) {
        let blanks = piece.len() - piece.trim_start().len();
        let part = from + blanks..from + blanks + piece.trim().len();
        expressions.push((piece.trim(), part));
        from += piece.len() + 1;
    }
    let mut read = |(piece, part): (&str, std::ops::Range<usize>)| -> ExpressionText {
        reader.expression_at(piece, text.map(part), text.damaged)
    };
    match (trimmed.starts_with('{') && trimmed.ends_with('}'), expressions.as_slice()) {
        (true, _) => Ok(Some(RangeText::Set(expressions.into_iter().map(read).collect()))),
        (false, [low, high]) if trimmed.starts_with('(') && trimmed.ends_with(')') => {
            let low = read(low.clone());
            Ok(Some(RangeText::Bounds(low, read(high.clone()))))
        }
        _ => Err(value(hint)),
    }
}

/// The pieces of a text between the commas that stand in no bracket.
fn pieces(text: &str) -> Vec<&str> {
    let mut depth = 0_i64;
    let mut pieces = Vec::new();
    let mut start = 0;
    for (at, c) in text.char_indices() {
        match c {
            '(' | '[' | '{' => depth += 1,
            ')' | ']' | '}' => depth -= 1,
            ',' if depth == 0 => {
                pieces.push(&text[start..at]);
                start = at + 1;
            }
            _ => {}
        }
    }
    pieces.push(&text[start..]);
    pieces
}

/// The first word of a hint's name, and the rest.
fn split(hintname: &Text) -> (Spanned<String>, Option<Spanned<String>>) {
    let text = &hintname.decoded;
    let start = text.len() - text.trim_start().len();
    let length = text[start..].find(char::is_whitespace).unwrap_or(text.len() - start);
    let argument = part(hintname, start + length, text.len());
    (part(hintname, start, start + length), Some(argument).filter(|argument| !argument.value.is_empty()))
}

/// The bytes `start..end` of a text without the blanks around them.
fn part(text: &Text, start: usize, end: usize) -> Spanned<String> {
    let slice = &text.decoded[start..end];
    let trimmed = slice.trim();
    let start = start + (slice.len() - slice.trim_start().len());
    Spanned::new(trimmed.to_owned(), text.map(start..start + trimmed.len()).whole())
}

fn value(hint: &Element) -> Spanned<String> {
    let text = hint.text();
    let (value, map) = text.trimmed();
    Spanned::new(value.to_owned(), map.whole())
}

fn keep(hint: &Element, hintname: &Text, component: &mut ComponentDeclaration) {
    let (name, map) = hintname.trimmed();
    component.hints.push((Spanned::new(name.to_owned(), map.whole()), value(hint)));
}

fn initial_location(hint: &Element, component: &mut ComponentDeclaration, reader: &mut Reader<'_>) {
    let name = reader.name(&hint.text(), hint);
    if let Some(first) = &component.initial_location {
        reader.diagnostics.push(
            Diagnostic::error(SECOND_INITIAL_LOCATION, name.span, "the first location is named twice")
                .label(first.span, "the first time")
                .help("delete one of the two hints"),
        );
    } else {
        component.initial_location = Some(name);
    }
}

/// `f(a, b)`: the name and the parameters.
fn signature(hintname: &Text, argument: &Spanned<String>) -> Option<(Spanned<String>, Vec<Spanned<String>>)> {
    let text = &hintname.decoded;
    let start = text.find("function")? + "function".len();
    let (open, close) = (text.find('(')?, text.rfind(')')?);
    if open < start || close < open || !argument.value.ends_with(')') {
        return None;
    }
    let name = part(hintname, start, open);
    let mut parameters = Vec::new();
    let mut from = open + 1;
    for parameter in text[open + 1..close].split(',') {
        parameters.push(part(hintname, from, from + parameter.len()));
        from += parameter.len() + 1;
    }
    // `f()` has no parameter.
    if let [only] = parameters.as_slice()
        && only.value.is_empty()
    {
        parameters.clear();
    }
    let names = std::iter::once(&name).chain(&parameters);
    names.into_iter().all(|name| is_identifier(&name.value)).then_some((name, parameters))
}

pub(crate) fn is_identifier(name: &str) -> bool {
    let mut characters = name.chars();
    characters.next().is_some_and(|c| c.is_alphabetic() || c == '_')
        && characters.all(|c| c.is_alphanumeric() || c == '_')
}

fn not_understood(place: &Spanned<String>, what: &str, help: &str, reader: &mut Reader<'_>) {
    reader.diagnostics.push(
        Diagnostic::warning(BAD_HINT, place.span, format!("`{}` {what}", place.value))
            .note("it is kept, and has no effect")
            .help(help),
    );
}

/// Warns about `inital Position`: free hints are rarely so close to one with a meaning.
fn near_miss(keyword: &Spanned<String>, argument: Option<&Spanned<String>>, reader: &mut Reader<'_>) {
    // Abbreviations and prefixes are close to a name, but no typing error.
    let likely = |meant: &&str| keyword.value.chars().count().abs_diff(meant.len()) <= 2;
    if let Some(argument) = argument
        && let Some(meant) = closest(&keyword.value, KEYWORDS).filter(likely)
    {
        let message = format!("the hint `{} {}` has no meaning", keyword.value, argument.value);
        reader.diagnostics.push(
            Diagnostic::warning(NEAR_HINT, keyword.span, message)
                .note("it is kept, and has no effect")
                .help(format!("did you mean `{meant} {}`?", argument.value)),
        );
    }
}
