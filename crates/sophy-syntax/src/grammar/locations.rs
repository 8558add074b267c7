//! Locations and their transitions.

use crate::error::{SyntaxError, codes};
use crate::grammar::blocks::{self, Holds};
use crate::grammar::body::{meant_section, misplaced, section_of};
use crate::grammar::expressions::expression;
use crate::grammar::items::{
    at_name, clause, eat, expect, missing, name, once, semicolon, skip_words, unexpected, unknown_word,
};
use crate::grammar::statements;
use crate::kinds::SyntaxKind;
use crate::parser::Parser;
use sophy_diagnostics::closest;

const CONTENT: &[&str] = &["declarations", "dynamics", "constraints", "output", "invariant", "transition"];
const TRIGGERS: &[&str] = &["when", "on", "rate", "sync"];
const CLAUSES: &[&str] = &["priority", "goto"];

/// `initial location Flight;`.
pub(crate) fn initial_location(p: &mut Parser<'_>) {
    p.start(SyntaxKind::InitialLocation);
    p.bump();
    if !eat(p, SyntaxKind::LocationKeyword) {
        missing(p, "`location`", &format!("write `initial location {};`", p.word()));
    }
    name(p, "the name of a location");
    semicolon(p);
    p.finish_node();
}

/// `location Flight … end location;`.
pub(crate) fn location(p: &mut Parser<'_>) {
    p.start(SyntaxKind::Location);
    let opening = p.range();
    p.bump();
    name(p, "the name of the location");
    blocks::open(p, "location", Holds::Location, opening);
    blocks::content(p, &[], content);
    blocks::close(p);
    p.finish_node();
}

fn content(p: &mut Parser<'_>) {
    use SyntaxKind as K;
    if p.current() == K::Name {
        let word = p.word();
        match word {
            "transition" => return transition(p),
            "invariant" => return invariant(p),
            _ => {}
        }
        let named = matches!(p.next(), K::Name | K::QuotedName | K::WhenKeyword);
        match closest(word, CONTENT.iter().copied()) {
            Some("transition") if named => {
                unknown_word(p, "a part of a location", CONTENT);
                return transition(p);
            }
            Some("invariant") if named => {
                unknown_word(p, "a part of a location", CONTENT);
                return invariant(p);
            }
            _ => {}
        }
    }
    match meant_section(p, CONTENT) {
        Some(kind) => section_of(p, kind),
        None => misplaced(p, "a location", "sections, transitions and an invariant"),
    }
}

/// `invariant x < 1;`.
fn invariant(p: &mut Parser<'_>) {
    p.start(SyntaxKind::Invariant);
    p.bump();
    p.fenced(expression);
    semicolon(p);
    p.finish_node();
}

/// `transition name when g goto Thrust do … end transition;`.
fn transition(p: &mut Parser<'_>) {
    p.start(SyntaxKind::Transition);
    let opening = p.range();
    p.bump();
    name(p, "the name of the transition");
    trigger(p);
    let mut seen = Vec::new();
    priority(p, &mut seen);
    if p.current() == SyntaxKind::Name && closest(p.word(), ["goto"]).is_some() {
        unknown_word(p, "the target of a transition", &["goto"]);
        p.bump();
        name(p, "the name of a location");
    } else if expect(p, SyntaxKind::GotoKeyword, "`goto`", "write `goto Location`") {
        name(p, "the name of a location");
    }
    priority(p, &mut seen);
    if p.current() != SyntaxKind::Semicolon
        && p.current() != SyntaxKind::DoKeyword
        && p.comes(SyntaxKind::DoKeyword)
    {
        unexpected(p);
        p.start(SyntaxKind::Error);
        while p.current() != SyntaxKind::DoKeyword {
            p.bump();
        }
        p.finish_node();
    }
    let is_statement = at_name(p)
        && (p.word() == "emit" || matches!(p.next(), SyntaxKind::Assign | SyntaxKind::LeftBracket));
    if is_statement {
        missing(p, "`do`", "write `goto Location do statements end transition;`");
    }
    if eat(p, SyntaxKind::DoKeyword) || is_statement {
        blocks::open(p, "transition", Holds::Items, opening);
        blocks::content(p, &[], statements::statement);
        blocks::close(p);
    } else {
        semicolon(p);
        if p.current() == SyntaxKind::EndKeyword && p.word_behind() == "transition" {
            let range = p.range();
            p.error(
                SyntaxError::new(codes::WRONG_END, range, "a transition without `do` ends with its `;`")
                    .help("delete this `end transition;`"),
            );
            skip_words(p);
        }
    }
    p.finish_node();
}

fn priority(p: &mut Parser<'_>, seen: &mut Vec<&'static str>) {
    if p.at_word("priority") {
        once(p, seen, "priority", "`priority`");
        clause(p, CLAUSES);
    }
}

/// What a transition waits for.
fn trigger(p: &mut Parser<'_>) {
    p.start(SyntaxKind::Trigger);
    match p.current() {
        SyntaxKind::WhenKeyword => {}
        SyntaxKind::Name => match p.word() {
            "on" => {
                p.bump();
                if name(p, "the name of an event") {
                    while eat(p, SyntaxKind::Comma) {
                        name(p, "the name of an event");
                    }
                }
            }
            "sync" => {
                p.bump();
                name(p, "the name of a label");
            }
            "rate" => {
                p.bump();
                p.fenced_before(CLAUSES, expression);
            }
            _ => {
                unknown_word(p, "the trigger of a transition", TRIGGERS);
                p.bump();
                p.fenced_before(CLAUSES, expression);
            }
        },
        _ => missing(
            p,
            "what the transition waits for",
            "write `when condition`, `on event`, `rate r`, `on invariant` or `sync label`",
        ),
    }
    if p.current() == SyntaxKind::WhenKeyword {
        clause(p, CLAUSES);
    }
    p.finish_node();
}
