//! Bodies and their sections: declarations, events, rules, assignments.

use crate::error::{SyntaxError, codes};
use crate::grammar::blocks::{self, Holds};
use crate::grammar::expressions::expression;
use crate::grammar::items::{
    at_name, clause, close, eat, expect, expect_before, mark, missing, name, once, semicolon, shape, skip,
    type_clause, unit, unknown_word, value_range,
};
use crate::grammar::{composition, locations, statements};
use crate::kinds::SyntaxKind;
use crate::parser::Parser;
use sophy_diagnostics::closest;

const SECTIONS: &[&str] = &[
    "declarations",
    "initial",
    "update",
    "dynamics",
    "constraints",
    "output",
    "event",
    "rules",
    "location",
    "components",
    "connections",
    "assignments",
];
const DECLARATIONS: &[&str] = &["state", "local", "mode", "flag", "tsample", "tdelay", "priority"];

/// `body … end body;`.
pub(crate) fn body(p: &mut Parser<'_>) {
    p.start(SyntaxKind::Body);
    let opening = p.range();
    p.bump();
    blocks::open(p, "body", Holds::Body, opening);
    blocks::content(p, &[], section);
    blocks::close(p);
    p.finish_node();
}

/// A body whose first word is forgotten.
pub(crate) fn body_without_word(p: &mut Parser<'_>) {
    if !blocks::has_errors(p) {
        missing(p, "`body`", "the sections of a component stand between `body` and `end body;`");
    }
    p.start(SyntaxKind::Body);
    let opening = p.range();
    blocks::open(p, "body", Holds::Body, opening);
    blocks::content(p, &[], section);
    blocks::close(p);
    p.finish_node();
}

/// A section of a body.
fn section(p: &mut Parser<'_>) {
    let kind = meant_section(p, SECTIONS);
    if let Some(kind) = kind {
        section_of(p, kind);
    } else {
        misplaced(p, "a body", "sections");
    }
}

/// A section that a location may have, or another one.
pub(crate) fn section_of(p: &mut Parser<'_>, kind: SyntaxKind) {
    use SyntaxKind as K;
    match kind {
        K::DeclarationsKeyword => simple(p, K::Declarations, "declarations", declaration),
        K::InitialKeyword
            if p.next() == K::LocationKeyword
                || matches!(p.next(), K::Name | K::QuotedName) && p.after_next() == K::Semicolon =>
        {
            locations::initial_location(p);
        }
        K::InitialKeyword => simple(p, K::StatementSection, "initial", statements::statement),
        K::UpdateKeyword => simple(p, K::StatementSection, "update", statements::statement),
        K::DynamicsKeyword => simple(p, K::EquationSection, "dynamics", statements::explicit_equation),
        K::ConstraintsKeyword => simple(p, K::EquationSection, "constraints", statements::equation),
        K::OutputKeyword => simple(p, K::EquationSection, "output", statements::explicit_equation),
        K::EventKeyword | K::EventsKeyword => event(p),
        K::RulesKeyword => holding(p, K::Rules, "rules", Holds::Rules, rule),
        K::LocationKeyword => locations::location(p),
        K::ComponentsKeyword => simple(p, K::ComponentsSection, "components", composition::instance),
        K::ConnectionsKeyword => simple(p, K::ConnectionsSection, "connections", composition::connection),
        K::AssignmentsKeyword => simple(p, K::AssignmentsSection, "assignments", assignment),
        _ => {}
    }
}

/// The section that starts here. A word that is nearly one of `known` is reported and taken for it.
pub(crate) fn meant_section(p: &mut Parser<'_>, known: &[&str]) -> Option<SyntaxKind> {
    use SyntaxKind as K;
    if p.current().word().is_some_and(|word| SECTIONS.contains(&word) || word == "events") {
        return Some(p.current());
    }
    if p.current() != K::Name || p.word().len() < 3 {
        return None;
    }
    match p.next() {
        K::Equal | K::Assign | K::Colon | K::LeftBracket | K::Arrow | K::Dot | K::Semicolon => return None,
        K::LeftParenthesis if closest(p.word(), ["event"]).is_none() => return None,
        _ => {}
    }
    let meant = SyntaxKind::of_word(closest(p.word(), known.iter().copied())?)?;
    unknown_word(p, "a section", known);
    Some(meant)
}

/// Something that does not belong directly in `place`, which holds `content`.
pub(crate) fn misplaced(p: &mut Parser<'_>, place: &str, content: &str) {
    let (range, word) = (p.range(), p.word());
    let home = match p.current() {
        SyntaxKind::WhenKeyword => "a rule stands between `rules` and `end rules;`",
        SyntaxKind::NegativeToPositiveKeyword | SyntaxKind::PositiveToNegativeKeyword => {
            "it stands between `event(S)` and `end event;`"
        }
        SyntaxKind::Name if word == "transition" || word == "invariant" => "it stands in a `location`",
        SyntaxKind::Name if DECLARATIONS.contains(&word) => {
            "it stands between `declarations` and `end declarations;`"
        }
        SyntaxKind::InterfaceKeyword => "the interface stands before the body",
        _ => match p.next() {
            SyntaxKind::Assign => {
                "assignments at an instant stand in `initial`, `update`, `event` or `rules`"
            }
            SyntaxKind::Equal | SyntaxKind::LeftParenthesis => {
                "equations stand in `dynamics`, `constraints` or `output`"
            }
            SyntaxKind::Colon => "values of parameters stand in `assignments`",
            SyntaxKind::Arrow | SyntaxKind::Dot => "connections stand in `connections`",
            _ => "delete it, or put it into its section",
        },
    };
    p.error(
        SyntaxError::new(codes::MISPLACED, range, format!("`{word}` does not stand directly in {place}"))
            .help(if home.starts_with("delete") {
                format!("{place} holds {content}; {home}")
            } else {
                home.to_owned()
            }),
    );
    blocks::skip_misplaced(p);
}

/// `word … end word;` around items.
fn simple(p: &mut Parser<'_>, node: SyntaxKind, word: &'static str, item: fn(&mut Parser<'_>)) {
    holding(p, node, word, Holds::Items, item);
}

fn holding(
    p: &mut Parser<'_>,
    node: SyntaxKind,
    word: &'static str,
    holds: Holds,
    item: fn(&mut Parser<'_>),
) {
    p.start(node);
    let opening = p.range();
    p.bump();
    blocks::open(p, word, holds, opening);
    blocks::content(p, &[], item);
    blocks::close(p);
    p.finish_node();
}

/// An item of `declarations`.
fn declaration(p: &mut Parser<'_>) {
    use SyntaxKind as K;
    if p.current() != K::Name {
        return;
    }
    let word = p.word();
    let known = DECLARATIONS.contains(&word);
    let meant = if known { Some(word) } else { closest(word, DECLARATIONS.iter().copied()) };
    if !known {
        unknown_word(p, "a declaration", DECLARATIONS);
    }
    let item_follows = matches!(p.next(), K::Name | K::QuotedName | K::Number);
    let Some(meant) = meant.filter(|_| known || item_follows) else { return skip(p) };
    match meant {
        "tsample" => clock(p),
        "tdelay" => quantity(p, K::ComputationDelay),
        "priority" => quantity(p, K::Priority),
        _ => variable(p),
    }
}

/// `state x, y : real[3] in (0, 1) := 0 "m";`.
fn variable(p: &mut Parser<'_>) {
    p.start(SyntaxKind::Variable);
    p.bump();
    if name(p, "a name") {
        extents(p);
        while eat(p, SyntaxKind::Comma) {
            name(p, "a name");
            extents(p);
        }
    }
    attributes(p);
    semicolon(p);
    p.finish_node();
}

/// Extents behind a name, as other languages have them.
fn extents(p: &mut Parser<'_>) {
    if p.current() != SyntaxKind::LeftBracket {
        return;
    }
    let (name, start) = (p.previous().map_or("", |token| p.text_of(token.range())), p.range().start);
    let first = p.error_count();
    p.start(SyntaxKind::Type);
    shape(p, SyntaxKind::Shape);
    p.finish_node();
    if p.error_count() == first {
        let range = start..p.end_of_previous();
        let written = p.text_of(range.clone());
        p.error(
            SyntaxError::new(codes::MISPLACED, range, "the extents of a variable stand behind its type")
                .help(format!("write `{name} : real{written}`")),
        );
    }
}

/// The type, range, value and unit of a variable, in any order.
fn attributes(p: &mut Parser<'_>) {
    use SyntaxKind as K;
    let mut seen = Vec::new();
    loop {
        match p.current() {
            K::Colon => {
                once(p, &mut seen, K::Type, "type");
                type_clause(p);
            }
            K::InKeyword => {
                once(p, &mut seen, K::ValueRange, "range");
                p.bump();
                value_range(p);
            }
            K::Assign | K::Equal => {
                once(p, &mut seen, K::InitialValue, "value");
                if p.current() == K::Equal {
                    let range = p.range();
                    p.error(
                        SyntaxError::new(codes::EQUALITY, range, "an initial value is given with `:=`")
                            .help("write `:=`"),
                    );
                }
                p.start(K::InitialValue);
                p.bump();
                p.fenced(expression);
                p.finish_node();
            }
            K::String => {
                once(p, &mut seen, K::Unit, "unit");
                unit(p);
            }
            _ => return,
        }
    }
}

/// `tsample t_next := 0;` or `tsample every Ts from t0;`.
fn clock(p: &mut Parser<'_>) {
    p.start(SyntaxKind::Clock);
    p.bump();
    let is_variable = matches!(
        p.next(),
        SyntaxKind::Assign
            | SyntaxKind::Semicolon
            | SyntaxKind::Colon
            | SyntaxKind::Equal
            | SyntaxKind::String
    );
    let is_misspelt =
        p.word() != "every" && p.next() != SyntaxKind::Comma && closest(p.word(), ["every"]).is_some();
    if at_name(p) && !is_variable && (p.word() == "every" || is_misspelt) {
        if is_misspelt {
            unknown_word(p, "a clock", &["every"]);
        }
        clause(p, &["from"]);
        if p.at_word("from") {
            clause(p, &[]);
        }
        unit(p);
    } else {
        name(p, "a name, or `every` and a period,");
        attributes(p);
    }
    semicolon(p);
    p.finish_node();
}

/// `tdelay 2e-4;`, `priority 1;`.
fn quantity(p: &mut Parser<'_>, node: SyntaxKind) {
    p.start(node);
    p.bump();
    p.fenced(expression);
    unit(p);
    semicolon(p);
    p.finish_node();
}

/// `event(S) priority 1 … end event;`.
fn event(p: &mut Parser<'_>) {
    p.start(SyntaxKind::EventSection);
    let opening = p.range();
    p.bump();
    if expect(p, SyntaxKind::LeftParenthesis, "`(`", "write `event(S)`") {
        p.fenced(expression);
        close(p, SyntaxKind::RightParenthesis);
    } else if at_name(p) && !p.on_new_line() {
        p.bump();
    }
    if p.at_word("priority") {
        clause(p, &[]);
    }
    blocks::open(p, "event", Holds::Event, opening);
    blocks::content(p, &[], direction);
    blocks::close(p);
    p.finish_node();
}

/// `negative-to-positive … end negative-to-positive;`.
fn direction(p: &mut Parser<'_>) {
    match p.current() {
        SyntaxKind::NegativeToPositiveKeyword => {
            simple(p, SyntaxKind::Direction, "negative-to-positive", statements::statement);
        }
        SyntaxKind::PositiveToNegativeKeyword => {
            simple(p, SyntaxKind::Direction, "positive-to-negative", statements::statement);
        }
        SyntaxKind::Name if p.next() == SyntaxKind::Minus => misspelt_direction(p),
        _ => {
            let (range, word) = (p.range(), p.word());
            p.error(
                SyntaxError::new(
                    codes::MISPLACED,
                    range,
                    format!("`{word}` does not stand directly in an event"),
                )
                .help("say when it happens: `negative-to-positive … end negative-to-positive;`, or the other way"),
            );
            blocks::skip_misplaced(p);
        }
    }
}

/// `negative-to-postive …`.
fn misspelt_direction(p: &mut Parser<'_>) {
    let negative = closest(p.word(), ["positive", "negative"]) == Some("negative") || p.word() == "negative";
    let meant = if negative { "negative-to-positive" } else { "positive-to-negative" };
    let opening = p.range();
    p.error(
        SyntaxError::new(
            codes::UNKNOWN_WORD,
            opening.clone(),
            "this is not a direction in which a flag crosses zero",
        )
        .help(format!("did you mean `{meant}`?")),
    );
    p.start(SyntaxKind::Direction);
    p.bump();
    while matches!(p.current(), SyntaxKind::Minus | SyntaxKind::Name) && !p.on_new_line() {
        p.bump();
    }
    blocks::open(p, meant, Holds::Items, opening);
    blocks::content(p, &[], statements::statement);
    blocks::close(p);
    p.finish_node();
}

/// The words of clauses of a rule.
const CLAUSES: &[&str] = &["initially", "delay", "latched", "cancellable", "priority"];

/// `when c delay 0.5 latched do … end when;`.
fn rule(p: &mut Parser<'_>) {
    if p.current() != SyntaxKind::WhenKeyword {
        if closest(p.word(), ["when"]).is_none() || p.next() == SyntaxKind::Assign {
            let (range, word) = (p.range(), p.word());
            p.error(
                SyntaxError::new(codes::MISPLACED, range, format!("`{word}` does not start a rule"))
                    .help("a rule is `when condition do statements end when;`"),
            );
            blocks::skip_misplaced(p);
            return;
        }
        unknown_word(p, "a rule", &["when"]);
    }
    p.start(SyntaxKind::Rule);
    let opening = p.range();
    p.bump();
    p.fenced_before(CLAUSES, expression);
    let mut seen = Vec::new();
    while p.current() == SyntaxKind::Name {
        let is_statement =
            p.on_new_line() || matches!(p.next(), SyntaxKind::Assign | SyntaxKind::LeftBracket);
        if CLAUSES.contains(&p.word()) {
            let word = p.word();
            once(p, &mut seen, word, &format!("`{word}`"));
        }
        match p.word() {
            "delay" | "priority" => clause(p, CLAUSES),
            "initially" | "latched" | "cancellable" => mark(p),
            _ if is_statement => break,
            _ => {
                unknown_word(p, "a clause of a rule", CLAUSES);
                mark(p);
            }
        }
    }
    expect_before(p, SyntaxKind::DoKeyword, "`do`", "write `when condition do statements end when;`");
    blocks::open(p, "when", Holds::Items, opening);
    blocks::content(p, &[], statements::statement);
    blocks::close(p);
    p.finish_node();
}

/// `g : 9.82 "m/s2";`.
fn assignment(p: &mut Parser<'_>) {
    if !at_name(p) {
        return;
    }
    p.start(SyntaxKind::Assignment);
    p.bump();
    let range = p.range();
    match p.current() {
        SyntaxKind::Colon => {}
        SyntaxKind::Assign | SyntaxKind::Equal => p.error(
            SyntaxError::new(codes::EQUALITY, range, "`:` gives a parameter its value").help("write `:`"),
        ),
        _ => {
            missing(p, "`:`", "write `name : value;`");
            semicolon(p);
            p.finish_node();
            return;
        }
    }
    p.bump();
    p.fenced(expression);
    unit(p);
    semicolon(p);
    p.finish_node();
}
