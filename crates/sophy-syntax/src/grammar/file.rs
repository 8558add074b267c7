//! Files: imports, constants, functions and components with their interfaces.

use crate::error::{SyntaxError, codes};
use crate::grammar::blocks::{self, Holds};
use crate::grammar::body;
use crate::grammar::expressions::expression;
use crate::grammar::items::{
    at_name, close, eat, expect, expect_before, missing, name, once, quoted_words, semicolon, skip,
    type_clause, type_name, unexpected, unit, unknown_word, value_range,
};
use crate::kinds::SyntaxKind;
use crate::parser::Parser;
use sophy_diagnostics::closest;

const KINDS: &[&str] = &["CTC", "DTC", "LBC", "CC", "SYSTEM"];
const ITEMS: &[&str] = &["import", "constant", "function", "CTC", "DTC", "LBC", "CC", "SYSTEM"];
const PORTS: &[&str] = &["input", "output", "knob", "view", "scope", "sync"];

/// A whole file.
pub(crate) fn root(p: &mut Parser<'_>) {
    p.start(SyntaxKind::Root);
    let mut lost = false;
    while p.current() != SyntaxKind::End {
        p.begin_item();
        let found = at_item(p) || meant_item(p);
        match () {
            () if found => {
                lost = false;
                item(p);
            }
            () => {
                if !lost {
                    outside(p);
                }
                lost = true;
                skip(p);
            }
        }
    }
    p.take_rest();
    p.finish_node();
}

/// Whether an item of a file starts here, wherever it stands.
pub(crate) fn at_item(p: &Parser<'_>) -> bool {
    use SyntaxKind as K;
    let (next, after) = (p.next(), p.ahead(2).0);
    let named = matches!(next, K::Name | K::QuotedName);
    match p.word() {
        _ if p.current() != K::Name => false,
        "import" => next == K::String,
        "constant" => named && matches!(after, K::Equal | K::Colon),
        "function" => named && after == K::LeftParenthesis,
        word => next == K::IsKeyword || (named && (after == K::IsKeyword || is_kind(word))),
    }
}

fn is_kind(word: &str) -> bool {
    KINDS.contains(&word) || word == "System"
}

/// Whether the current word is nearly one that starts an item.
fn meant_item(p: &Parser<'_>) -> bool {
    p.current() == SyntaxKind::Name
        && (is_kind(p.word())
            || ITEMS.contains(&p.word())
            || matches!(p.next(), SyntaxKind::Name | SyntaxKind::QuotedName | SyntaxKind::String)
                && closest(p.word(), ITEMS.iter().copied()).is_some())
}

fn item(p: &mut Parser<'_>) {
    let word = p.word();
    let meant = match closest(word, ITEMS.iter().copied()) {
        _ if ITEMS.contains(&word) || is_kind(word) => word,
        _ if p.next() == SyntaxKind::IsKeyword || p.ahead(2).0 == SyntaxKind::IsKeyword => "CTC",
        meant => meant.unwrap_or(word),
    };
    match meant {
        "import" => import(p),
        "constant" => constant(p),
        "function" => function(p),
        _ => component(p),
    }
}

/// Something that stands in no component.
fn outside(p: &mut Parser<'_>) {
    let (range, word) = (p.range(), p.word());
    if p.current() == SyntaxKind::Name && matches!(p.next(), SyntaxKind::Name | SyntaxKind::String) {
        unknown_word(p, "an item of a file", ITEMS);
        return;
    }
    p.error(
        SyntaxError::new(codes::MISPLACED, range, format!("`{word}` stands outside of a component"))
            .help(format!("a file holds items that start with {}", quoted_words(ITEMS, "or"))),
    );
}

/// Takes the word an item starts with; reports it if it is not one of `known`.
fn keyword(p: &mut Parser<'_>, place: &str, known: &[&str]) {
    if !known.contains(&p.word()) && !is_kind(p.word()) {
        unknown_word(p, place, known);
    }
    p.bump();
}

/// `import "other.hsml";`.
fn import(p: &mut Parser<'_>) {
    p.start(SyntaxKind::Import);
    keyword(p, "an item of a file", ITEMS);
    expect(p, SyntaxKind::String, "the name of a file", "write `import \"other.hsml\";`");
    semicolon(p);
    p.finish_node();
}

/// `constant g = 9.82 "m/s2";`.
fn constant(p: &mut Parser<'_>) {
    p.start(SyntaxKind::Constant);
    keyword(p, "an item of a file", ITEMS);
    name(p, "the name of the constant");
    if p.current() == SyntaxKind::Colon {
        type_clause(p);
    }
    definition(p);
    unit(p);
    semicolon(p);
    p.finish_node();
}

/// `= e`.
fn definition(p: &mut Parser<'_>) {
    let range = p.range();
    match p.current() {
        SyntaxKind::Equal => {}
        SyntaxKind::Assign => p.error(
            SyntaxError::new(codes::EQUALITY, range, "`:=` assigns at an instant; this holds always")
                .help("write `=`"),
        ),
        _ => {
            missing(p, "`=`", "write `= e`");
            return;
        }
    }
    p.bump();
    p.fenced(expression);
}

/// `function f(a, b : real[3]) : real = e;`.
fn function(p: &mut Parser<'_>) {
    p.start(SyntaxKind::Function);
    keyword(p, "an item of a file", ITEMS);
    name(p, "the name of the function");
    if p.current() == SyntaxKind::LeftParenthesis {
        p.start(SyntaxKind::FunctionParameters);
        p.bump();
        while at_name(p) {
            p.start(SyntaxKind::FunctionParameter);
            p.bump();
            if p.current() == SyntaxKind::Colon {
                type_clause(p);
            }
            p.finish_node();
            if !eat(p, SyntaxKind::Comma) {
                break;
            }
            if !at_name(p) {
                missing(p, "a parameter", "write a name there, or delete the `,`");
            }
        }
        close(p, SyntaxKind::RightParenthesis);
        p.finish_node();
    } else {
        missing(p, "the list of parameters", "write `function f(x) = …;`");
    }
    if p.current() == SyntaxKind::Colon {
        type_clause(p);
    }
    definition(p);
    semicolon(p);
    p.finish_node();
}

/// `CTC Name is interface … end interface; body … end body; end Name;`.
fn component(p: &mut Parser<'_>) {
    p.start(SyntaxKind::Component);
    if p.next() == SyntaxKind::IsKeyword && !is_kind(p.word()) {
        missing(p, "the kind of the component", "write for example `CTC Name is`");
    } else {
        keyword(p, "a component", KINDS);
    }
    let named = at_name(p);
    let opening = p.range();
    let word = if named { p.word().trim_matches(['\'', '‘', '’']) } else { "component" };
    name(p, "the name of the component");
    expect_before(p, SyntaxKind::IsKeyword, "`is`", "write `CTC Name is`");
    if at_name(p)
        && matches!(p.next(), SyntaxKind::InterfaceKeyword | SyntaxKind::BodyKeyword | SyntaxKind::IsKeyword)
    {
        unexpected(p);
        p.start(SyntaxKind::Error);
        p.bump();
        eat(p, SyntaxKind::IsKeyword);
        p.finish_node();
    }
    blocks::open(p, word, Holds::Component, opening.clone());
    p.begin_item();
    let errors = p.error_count();
    let start = p.position();
    blocks::content(p, &[], part);
    if p.position() == start && p.error_count() == errors {
        p.error(
            SyntaxError::new(codes::MISSING_PART, opening, format!("`{word}` has no body"))
                .help("write `body … end body;` after `is`"),
        );
    }
    blocks::close(p);
    p.finish_node();
}

/// The interface or the body of a component.
fn part(p: &mut Parser<'_>) {
    match p.current() {
        SyntaxKind::InterfaceKeyword => {
            if !blocks::add_part(p, "interface").is_empty() {
                repeated(p, "a component has one interface, before its body");
            }
            interface(p);
        }
        SyntaxKind::BodyKeyword => {
            if blocks::add_part(p, "body").contains(&"body") {
                repeated(p, "a component has one body");
            }
            body::body(p);
        }
        SyntaxKind::Name | SyntaxKind::OutputKeyword
            if PORTS.contains(&p.word()) && p.next() == SyntaxKind::LeftParenthesis =>
        {
            missing(p, "`interface`", "inputs and outputs stand between `interface` and `end interface;`");
            p.start(SyntaxKind::Interface);
            interface_items(p);
        }
        SyntaxKind::Name => {
            let words = ["interface", "body"];
            let meant = closest(p.word(), words);
            match meant {
                Some(meant) => {
                    unknown_word(p, "a part of a component", &words);
                    if meant == "body" { body::body(p) } else { interface(p) }
                }
                None => body::body_without_word(p),
            }
        }
        kind if kind.word().is_some() => body::body_without_word(p),
        _ => {}
    }
}

fn repeated(p: &mut Parser<'_>, message: &str) {
    let range = p.range();
    p.error(SyntaxError::new(codes::MISPLACED, range, message).help("put it all into the first one"));
}

/// `interface … end interface;`.
fn interface(p: &mut Parser<'_>) {
    p.start(SyntaxKind::Interface);
    p.bump();
    interface_items(p);
}

fn interface_items(p: &mut Parser<'_>) {
    let opening = p.range();
    blocks::open(p, "interface", Holds::Interface, opening);
    blocks::content(p, &[], port);
    blocks::close(p);
    p.finish_node();
}

/// `input(u, signal[3], (0, 1), "N");`.
fn port(p: &mut Parser<'_>) {
    if !matches!(p.current(), SyntaxKind::Name | SyntaxKind::OutputKeyword) {
        return;
    }
    let known = PORTS.contains(&p.word());
    if !known && p.next() != SyntaxKind::LeftParenthesis {
        unknown_word(p, "an item of an interface", PORTS);
        skip(p);
        return;
    }
    p.start(SyntaxKind::InterfaceItem);
    if !known {
        unknown_word(p, "an item of an interface", PORTS);
    }
    p.bump();
    if expect(p, SyntaxKind::LeftParenthesis, "`(`", "write `input(name, signal);`") {
        let is_type = ["signal", "real", "integer", "boolean", "string", "event"].contains(&p.word());
        if is_type && matches!(p.next(), SyntaxKind::Name | SyntaxKind::QuotedName) {
            let (range, kind, named) = (p.range(), p.word(), p.word_behind());
            p.error(
                SyntaxError::new(codes::MISPLACED, range, format!("`{kind}` stands before the name"))
                    .help(format!("write `({named}, {kind})`")),
            );
            p.start(SyntaxKind::Type);
            name(p, "a type");
            p.finish_node();
        }
        name(p, "a name");
        let mut seen = Vec::new();
        while eat(p, SyntaxKind::Comma) {
            attribute(p, &mut seen);
        }
        close(p, SyntaxKind::RightParenthesis);
    }
    semicolon(p);
    p.finish_node();
}

/// A type, a range or a unit.
fn attribute(p: &mut Parser<'_>, seen: &mut Vec<&'static str>) {
    match p.current() {
        SyntaxKind::Name | SyntaxKind::QuotedName => {
            once(p, seen, "type", "type");
            p.start(SyntaxKind::Type);
            type_name(p);
            p.finish_node();
        }
        SyntaxKind::LeftParenthesis | SyntaxKind::LeftBrace => {
            once(p, seen, "range", "range");
            value_range(p);
        }
        SyntaxKind::String => {
            once(p, seen, "unit", "unit");
            unit(p);
        }
        SyntaxKind::Comma | SyntaxKind::RightParenthesis => {
            missing(p, "a type, a range or a unit", "write it there, or delete the `,`");
        }
        _ => unexpected(p),
    }
}
