//! Hints with a meaning: what a model needs and the definition has no element for.
//!
//! | `hintname` | text | |
//! | --- | --- | --- |
//! | `initial location` | name of a location | where a run starts |
//! | `initial NAME` | expression | value of the state at the start |
//! | `unit NAME` | unit | of a state, input, output or constant |
//! | `function f(a, b)` | expression | a function for the expressions of the file |
//!
//! The first one wins over a state called `location`, which is a reserved word.
//! All others are for other tools (thesis, A.4: "meta information to the Sophy environment") and are kept.

use crate::codes::{BAD_HINT, NEAR_HINT, SECOND_INITIAL_LOCATION};
use crate::declarations::Reader;
use crate::document::{Element, Text};
use sophy_analysis::{Declarations, EquationDeclaration, FunctionDeclaration, Spanned};
use sophy_diagnostics::{Diagnostic, closest};

const KEYWORDS: [&str; 3] = ["initial", "unit", "function"];

/// Adds what `hints` declare to `declarations`.
pub(crate) fn declare<'a>(
    hints: impl Iterator<Item = &'a Element>,
    declarations: &mut Declarations,
    reader: &mut Reader<'_>,
) {
    for hint in hints {
        // A hint without a name has been complained about.
        let Some(hintname) = hint.required_attribute("hintname") else { continue };
        let (keyword, argument) = split(hintname);
        match (keyword.value.as_str(), argument) {
            ("initial", Some(argument)) if argument.value == "location" => {
                initial_location(hint, declarations, reader);
            }
            ("initial", Some(target)) => {
                let right = reader.expression(&hint.text());
                declarations.initial.push(EquationDeclaration { target, right });
            }
            ("unit", Some(name)) => declarations.units.push((name, value(hint))),
            ("function", Some(argument)) => match signature(hintname, &argument) {
                Some((name, parameters)) => {
                    let body = reader.expression(&hint.text());
                    declarations.functions.push(FunctionDeclaration { name, parameters, body });
                }
                None => {
                    not_understood(
                        &argument,
                        "is not the head of a function",
                        "write function f(a, b)",
                        reader,
                    );
                    keep(hint, hintname, declarations);
                }
            },
            (word, None) if KEYWORDS.contains(&word) => {
                let help = match word {
                    "function" => "write function f(a, b)".to_owned(),
                    _ => format!("write {word} NAME"),
                };
                not_understood(&keyword, "needs a name after it", &help, reader);
                keep(hint, hintname, declarations);
            }
            (_, argument) => {
                near_miss(&keyword, argument.as_ref(), reader);
                keep(hint, hintname, declarations);
            }
        }
    }
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

fn keep(hint: &Element, hintname: &Text, declarations: &mut Declarations) {
    let (name, map) = hintname.trimmed();
    declarations.hints.push((Spanned::new(name.to_owned(), map.whole()), value(hint)));
}

fn initial_location(hint: &Element, declarations: &mut Declarations, reader: &mut Reader<'_>) {
    let name = reader.name(&hint.text(), hint);
    if let Some(first) = &declarations.initial_location {
        reader.diagnostics.push(
            Diagnostic::error(SECOND_INITIAL_LOCATION, name.span, "the first location is named twice")
                .label(first.span, "the first time")
                .help("delete one of the two hints"),
        );
    } else {
        declarations.initial_location = Some(name);
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

fn is_identifier(name: &str) -> bool {
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
