//! `dynamics … end dynamics;`: what opens and closes blocks, also where an `end` is missing or wrong.

use crate::error::{SyntaxError, codes};
use crate::grammar::file;
use crate::grammar::items::{self, quoted_words};
use crate::kinds::SyntaxKind;
use crate::parser::Parser;
use sophy_diagnostics::closest;
use std::ops::Range;

/// A block that is open.
pub(crate) struct Block<'t> {
    /// The word after its `end`; of a component its name.
    word: &'t str,
    /// As it is misspelt where the block opens.
    spelt: Option<&'t str>,
    holds: Holds,
    opening: Range<usize>,
    /// How many mistakes were known when it was opened.
    errors: usize,
    /// The parts of a component that were read. After its body it may end without an `end`.
    parts: Vec<&'static str>,
}

/// What starts with the current token, if it can end blocks that are open.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Starter {
    /// A component, function, constant or import.
    FileItem,
    Interface,
    Body,
    Section(SyntaxKind),
    Direction,
    Rule,
    /// A transition or invariant.
    OfLocation,
}

/// What a block holds, beside what cannot be mistaken for the start of something else.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Holds {
    /// A component holds its interface, its body, and (the word `body` forgotten) sections.
    Component,
    /// An interface holds items, of which some start with `output`.
    Interface,
    Body,
    Location,
    Event,
    Rules,
    /// Declarations, statements or equations.
    Items,
}

impl Block<'_> {
    /// Whether `end word;` ends it.
    fn ends_with(&self, word: &str) -> bool {
        let word = word.trim_matches(['\'', '‘', '’']);
        self.word == word || self.spelt == Some(word) || (self.word == "event" && word == "events")
    }
}

impl Holds {
    fn may_start(self, starter: Starter) -> bool {
        use SyntaxKind as K;
        match self {
            Holds::Component => matches!(starter, Starter::Interface | Starter::Body | Starter::Section(_)),
            Holds::Body => matches!(starter, Starter::Section(_)),
            Holds::Location => matches!(
                starter,
                Starter::OfLocation
                    | Starter::Section(
                        K::DeclarationsKeyword
                            | K::DynamicsKeyword
                            | K::ConstraintsKeyword
                            | K::OutputKeyword
                    )
            ),
            Holds::Event => starter == Starter::Direction,
            Holds::Rules => starter == Starter::Rule,
            Holds::Interface | Holds::Items => false,
        }
    }
}

/// The words that stand after an `end`, beside names of components.
const CLOSING: &[&str] = &[
    "interface",
    "body",
    "declarations",
    "initial",
    "update",
    "dynamics",
    "constraints",
    "output",
    "event",
    "rules",
    "location",
    "transition",
    "components",
    "connections",
    "assignments",
    "negative-to-positive",
    "positive-to-negative",
    "when",
    "if",
    "loop",
];

/// Opens a block that ends with `end word;`; `opening` is the place of its first word.
pub(crate) fn open<'t>(p: &mut Parser<'t>, word: &'t str, holds: Holds, opening: Range<usize>) {
    let spelt = Some(p.text_of(opening.clone())).filter(|spelt| closest(spelt, [word]).is_some());
    let errors = p.error_count();
    p.blocks.push(Block { word, spelt, holds, opening, errors, parts: Vec::new() });
}

/// The innermost block, a component, has this part now; returns those it had before.
pub(crate) fn add_part(p: &mut Parser<'_>, part: &'static str) -> Vec<&'static str> {
    let Some(block) = p.blocks.last_mut() else { return Vec::new() };
    let before = block.parts.clone();
    if !before.contains(&part) {
        block.parts.push(part);
    }
    before
}

/// Whether a mistake is known in the innermost block.
pub(crate) fn has_errors(p: &Parser<'_>) -> bool {
    p.blocks.last().is_some_and(|block| block.errors < p.error_count())
}

/// Reads what stands in the innermost block, item by item, up to its end or to one of `stops`.
pub(crate) fn content(p: &mut Parser<'_>, stops: &[SyntaxKind], item: fn(&mut Parser<'_>)) {
    let holds = p.blocks.last().map_or(Holds::Items, |block| block.holds);
    while p.unwinding.is_none() {
        if p.current() == SyntaxKind::End || stops.contains(&p.current()) {
            return;
        }
        if p.blocks.last().is_some_and(|block| block.parts.contains(&"body")) && !may_follow_body(p) {
            return;
        }
        p.begin_item();
        if p.current() == SyntaxKind::EndKeyword
            && p.next() == SyntaxKind::EndKeyword
            && !p.breaks_line_after()
        {
            items::unexpected(p);
            p.start(SyntaxKind::Error);
            p.bump();
            p.finish_node();
        }
        if at_end(p) {
            match closed_by_end(p) {
                Closes::Nothing => stray_end(p),
                _ => return,
            }
            continue;
        }
        let is_port = holds == Holds::Interface && p.current() == SyntaxKind::OutputKeyword;
        if let Some(starter) = starter(p)
            && !is_port
            && !holds.may_start(starter)
            && kept_by(p, starter).is_some()
        {
            return;
        }
        let before = p.position();
        item(p);
        if p.position() == before {
            items::unexpected(p);
            items::skip(p);
        }
    }
}

/// Whether something that belongs to a component stands here, although its body is complete.
fn may_follow_body(p: &Parser<'_>) -> bool {
    at_end(p) || starter(p).is_some_and(|starter| Holds::Component.may_start(starter))
}

/// Takes the `end` of the innermost block, or reports that it is missing.
pub(crate) fn close(p: &mut Parser<'_>) {
    if p.unwinding.is_none() {
        let optional = p.blocks.last().is_some_and(|block| block.holds == Holds::Component);
        if at_end(p) && closed_by_end(p) == Closes::Innermost {
            p.begin_item();
            take_end(p);
        } else if !optional {
            missing_end(p);
        }
    }
    p.blocks.pop();
    if p.unwinding == Some(p.blocks.len()) {
        p.unwinding = None;
    }
    p.begin_item();
}

/// What an `end` closes.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Closes {
    Innermost,
    /// An outer block, after which so many are open.
    Outer(usize),
    Nothing,
}

/// Whether an `end` stands here: also misspelt, or forgotten before its word.
fn at_end(p: &Parser<'_>) -> bool {
    match p.current() {
        SyntaxKind::EndKeyword | SyntaxKind::EndifKeyword => true,
        SyntaxKind::Name => {
            let (next, text) = p.ahead(1);
            let closing = next.word().is_some()
                || next == SyntaxKind::If
                || text == "transition"
                || p.blocks.iter().any(|block| block.word == text);
            closing && p.ahead(2).0 == SyntaxKind::Semicolon && closest(p.word(), ["end"]).is_some()
        }
        _ => end_forgotten(p),
    }
}

/// `dynamics;` or `dynamics end;`.
fn end_forgotten(p: &Parser<'_>) -> bool {
    let word = p.word();
    let after = p.ahead(2).0;
    (p.next() == SyntaxKind::Semicolon
        || (p.next() == SyntaxKind::EndKeyword && after == SyntaxKind::Semicolon))
        && CLOSING.contains(&word)
        && p.blocks.iter().any(|block| block.word == word)
}

/// The word after the `end`; empty if there is none.
fn end_word<'t>(p: &Parser<'t>) -> &'t str {
    if p.current() == SyntaxKind::EndifKeyword {
        return "if";
    }
    if end_forgotten(p) {
        return p.word();
    }
    let (kind, text) = p.ahead(1);
    match kind {
        _ if kind.word().is_some() || kind == SyntaxKind::If => {}
        SyntaxKind::Name | SyntaxKind::QuotedName => {}
        _ => return "",
    }
    if p.ahead(2).0 == SyntaxKind::Semicolon || !p.breaks_line_after() { text } else { "" }
}

fn closed_by_end(p: &Parser<'_>) -> Closes {
    let word = end_word(p);
    if word.is_empty() {
        return Closes::Innermost;
    }
    let innermost = p.blocks.len().saturating_sub(1);
    match p.blocks.iter().rposition(|block| block.ends_with(word)) {
        Some(level) if level == innermost => Closes::Innermost,
        Some(level) => Closes::Outer(level + 1),
        None if CLOSING.contains(&word) && (!is_alike(p, word) || goes_on_after_end(p)) => Closes::Nothing,
        None if p.blocks.is_empty() => Closes::Nothing,
        None => Closes::Innermost,
    }
}

/// Whether `word` ends blocks of the rank of the innermost one.
fn is_alike(p: &Parser<'_>, word: &str) -> bool {
    let rank = |word: &str| match word {
        "if" | "loop" | "when" | "transition" => 0,
        "negative-to-positive" | "positive-to-negative" => 1,
        "interface" | "body" => 2,
        "location" => 3,
        _ => 4,
    };
    p.blocks.last().is_some_and(|block| block.holds != Holds::Component && rank(block.word) == rank(word))
}

/// Leaves out what does not belong into the innermost block, up to something that does, or ends it.
pub(crate) fn skip_misplaced(p: &mut Parser<'_>) {
    loop {
        if at_end(p) {
            items::skip_words(p);
        } else {
            items::skip(p);
        }
        let goes_on = if at_end(p) {
            closed_by_end(p) == Closes::Nothing
        } else {
            starter(p).is_none_or(|starter| kept_by(p, starter).is_none())
        };
        if p.current() == SyntaxKind::End || !goes_on {
            return;
        }
    }
}

/// Whether after the `end …;` here more of the innermost block follows.
fn goes_on_after_end(p: &Parser<'_>) -> bool {
    let Some(block) = p.blocks.last() else { return true };
    let after = if p.ahead(2).0 == SyntaxKind::Semicolon { 3 } else { 2 };
    match p.ahead(after).0 {
        SyntaxKind::EndKeyword => {
            let (_, word) = p.ahead(after + 1);
            block.ends_with(word)
        }
        SyntaxKind::Name | SyntaxKind::QuotedName | SyntaxKind::If | SyntaxKind::ForKeyword => {
            block.holds == Holds::Items
        }
        SyntaxKind::WhenKeyword => block.holds == Holds::Rules,
        kind if kind.word().is_some() => matches!(block.holds, Holds::Body | Holds::Location),
        _ => false,
    }
}

/// `end dynamics;`, perhaps with a mistake.
fn take_end(p: &mut Parser<'_>) {
    let Some(block) = p.blocks.last() else { return };
    let (expected, opening) = (block.word, block.opening.clone());
    let word = end_word(p);
    let fits = block.ends_with(word);
    let help = format!("write `end {expected};`");
    p.start(SyntaxKind::BlockEnd);
    let here = p.range();
    if end_forgotten(p) {
        let message = format!("`end` is missing before `{word}`");
        p.error(SyntaxError::new(codes::MISSING_END, here, message).help(help));
        p.bump();
        items::eat(p, SyntaxKind::EndKeyword);
        items::semicolon(p);
        p.finish_node();
        return;
    }
    if p.current() == SyntaxKind::Name {
        items::unknown_word(p, "an `end`", &["end"]);
    }
    let is_one_word = p.current() == SyntaxKind::EndifKeyword;
    p.bump();
    if word.is_empty() {
        let message = "this `end` does not say what it ends";
        p.error(
            SyntaxError::new(codes::WRONG_END, here, message).related(opening, "this is open").help(help),
        );
    } else if !is_one_word {
        if !fits {
            let message = format!("`{expected}` is open, but `{word}` is ended here");
            let range = p.range();
            p.error(
                SyntaxError::new(codes::WRONG_END, range, message)
                    .related(opening, "this is open")
                    .help(help),
            );
        }
        p.bump();
    }
    items::semicolon(p);
    p.finish_node();
}

/// An `end …;` of something that is not open.
fn stray_end(p: &mut Parser<'_>) {
    let word = end_word(p);
    let range = p.range();
    p.error(
        SyntaxError::new(
            codes::WRONG_END,
            range,
            format!("this `end {word}` closes nothing: no `{word}` is open"),
        )
        .help("delete it, or add what it should end"),
    );
    items::skip_words(p);
}

/// What starts with the current token, at the start of an item.
fn starter(p: &Parser<'_>) -> Option<Starter> {
    use SyntaxKind as K;
    let kind = p.current();
    match kind {
        K::InterfaceKeyword => Some(Starter::Interface),
        K::BodyKeyword => Some(Starter::Body),
        K::NegativeToPositiveKeyword | K::PositiveToNegativeKeyword => Some(Starter::Direction),
        K::WhenKeyword => Some(Starter::Rule),
        K::DeclarationsKeyword
        | K::InitialKeyword
        | K::UpdateKeyword
        | K::DynamicsKeyword
        | K::ConstraintsKeyword
        | K::OutputKeyword
        | K::EventKeyword
        | K::EventsKeyword
        | K::RulesKeyword
        | K::LocationKeyword
        | K::ComponentsKeyword
        | K::ConnectionsKeyword
        | K::AssignmentsKeyword => Some(Starter::Section(kind)),
        K::Name if file::at_item(p) => Some(Starter::FileItem),
        K::Name => {
            let next = p.next();
            match p.word() {
                "transition" if matches!(next, K::Name | K::QuotedName | K::WhenKeyword) => {
                    Some(Starter::OfLocation)
                }
                "invariant" if matches!(next, K::Name | K::Number | K::Not | K::LeftParenthesis) => {
                    Some(Starter::OfLocation)
                }
                _ => None,
            }
        }
        _ => None,
    }
}

/// How many blocks stay open when `starter` comes; `None` if it belongs to none of them.
fn kept_by(p: &Parser<'_>, starter: Starter) -> Option<usize> {
    if starter == Starter::FileItem {
        return Some(0);
    }
    p.blocks.iter().rposition(|block| block.holds.may_start(starter)).map(|level| level + 1)
}

/// Whether what starts here ends the innermost block, which has no other end.
pub(crate) fn ends_here(p: &Parser<'_>) -> bool {
    starter(p).is_some_and(|starter| kept_by(p, starter).is_some_and(|kept| kept < p.blocks.len()))
}

/// The innermost block is left without its `end`, and so may be some of those around it.
fn missing_end(p: &mut Parser<'_>) {
    let kept = if p.current() == SyntaxKind::End {
        0
    } else if at_end(p) {
        match closed_by_end(p) {
            Closes::Outer(kept) => kept,
            _ => p.blocks.len().saturating_sub(1),
        }
    } else {
        starter(p).and_then(|starter| kept_by(p, starter)).unwrap_or(0)
    };
    let kept = kept.min(p.blocks.len().saturating_sub(1));
    p.unwinding = Some(kept);
    let missing: Vec<(String, Range<usize>)> = p.blocks[kept..]
        .iter()
        .rev()
        .filter(|block| block.holds != Holds::Component)
        .map(|block| (format!("end {}", block.word), block.opening.clone()))
        .collect();
    let ends: Vec<&str> = missing.iter().map(|(end, _)| end.as_str()).collect();
    let verb = if ends.len() == 1 { "is" } else { "are" };
    let names = quoted_words(&ends, "and");
    let (range, place) = if p.current() == SyntaxKind::End {
        let end = p.end_of_previous();
        (end..end, "at the end of the file".to_owned())
    } else {
        let before = if at_end(p) { format!("end {}", end_word(p)) } else { p.word().to_owned() };
        (p.range(), format!("before `{before}`"))
    };
    let mut error = SyntaxError::new(codes::MISSING_END, range, format!("{names} {verb} missing {place}"));
    for (end, opening) in missing.iter().take(4) {
        error = error.related(opening.clone(), format!("`{end};` belongs to this"));
    }
    if let [end] = ends.as_slice() {
        error = error.help(format!("write `{end};`"));
    }
    p.error_outside(error);
}
