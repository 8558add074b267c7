//! What declarations, statements and sections are made of, and how reading goes on after a mistake.

use crate::error::{SyntaxError, codes};
use crate::grammar::blocks;
use crate::grammar::expressions::expression;
use crate::kinds::SyntaxKind;
use crate::parser::Parser;
use sophy_diagnostics::closest;

/// The `;` at the end of an item. What stands before it and fits nothing is left out.
pub(crate) fn semicolon(p: &mut Parser<'_>) {
    if p.current() == SyntaxKind::Semicolon {
        p.bump();
        return;
    }
    if ends_item(p) || p.begins_anew() || blocks::ends_here(p) {
        let end = p.end_of_previous();
        let before = p.previous().map_or("", |token| p.text_of(token.range()));
        p.error(
            SyntaxError::new(codes::MISSING_SEMICOLON, end..end, format!("`;` is missing after `{before}`"))
                .help("write `;` there"),
        );
        if ends_item(p) || starts_item(p) {
            return;
        }
    } else {
        unexpected(p);
    }
    skip(p);
}

/// Leaves out what stands here, up to the end of the item.
pub(crate) fn skip(p: &mut Parser<'_>) {
    p.start(SyntaxKind::Error);
    let start = p.position();
    while p.current() != SyntaxKind::Semicolon {
        let taken = p.position() > start;
        if p.current() == SyntaxKind::End || (taken && ends_item(p)) {
            break;
        }
        if taken && p.on_new_line() && starts_item(p) {
            break;
        }
        p.bump();
    }
    if p.current() == SyntaxKind::Semicolon {
        p.bump();
    }
    p.finish_node();
}

/// Leaves out the words of an `end …;` that ends nothing.
pub(crate) fn skip_words(p: &mut Parser<'_>) {
    p.start(SyntaxKind::Error);
    let has_word = p.current() == SyntaxKind::EndKeyword && p.next() != SyntaxKind::Semicolon;
    p.bump();
    if has_word {
        p.bump();
    }
    eat(p, SyntaxKind::Semicolon);
    p.finish_node();
}

/// Whether the current token cannot be in the middle of an item.
fn ends_item(p: &Parser<'_>) -> bool {
    use SyntaxKind as K;
    match p.current() {
        K::End | K::Semicolon | K::Else | K::EndKeyword => true,
        K::InKeyword | K::IsKeyword | K::DoKeyword | K::LoopKeyword | K::GotoKeyword => false,
        kind => kind.word().is_some(),
    }
}

fn starts_item(p: &Parser<'_>) -> bool {
    matches!(p.current(), SyntaxKind::Name | SyntaxKind::QuotedName | SyntaxKind::If)
}

/// Reports what stands here.
pub(crate) fn unexpected(p: &mut Parser<'_>) {
    let range = p.range();
    let message = match p.current() {
        SyntaxKind::End => "the file ends here too early".to_owned(),
        _ => format!("`{}` is not expected here", p.word()),
    };
    p.error(SyntaxError::new(codes::UNEXPECTED, range, message));
}

/// Reports that `what` is missing before the current token.
pub(crate) fn missing(p: &mut Parser<'_>, what: &str, help: &str) {
    let end = p.end_of_previous();
    let range = if p.on_new_line() || p.current() == SyntaxKind::End { end..end } else { p.range() };
    p.error(SyntaxError::new(codes::MISSING_PART, range, format!("{what} is missing here")).help(help));
}

/// Words that other languages begin a declaration with.
const TYPES: &[&str] =
    &["real", "integer", "boolean", "string", "signal", "float", "double", "int", "bool", "var"];

/// Reports that the current word is not one of `known`, of which `place` allows one.
pub(crate) fn unknown_word(p: &mut Parser<'_>, place: &str, known: &[&str]) {
    let word = p.word();
    let range = p.range();
    let error = SyntaxError::new(codes::UNKNOWN_WORD, range, format!("`{word}` does not start {place}"));
    if known.contains(&"state") && TYPES.contains(&word.to_lowercase().as_str()) {
        let help = "the type stands behind the name: `state x : real := 1;`, `local y : real;`";
        return p.error(error.help(help));
    }
    p.error(match closest(word, known.iter().copied()).filter(|_| word.len() > 1) {
        Some(meant) => error.help(format!("did you mean `{meant}`?")),
        None => error.help(format!("it starts with {}", quoted_words(known, "or"))),
    });
}

/// Takes a misspelt `word` for what it should be.
pub(crate) fn eat_misspelt(p: &mut Parser<'_>, word: &'static str) -> bool {
    let is_near = p.current() == SyntaxKind::Name && closest(p.word(), [word]).is_some();
    if is_near {
        misspelt(p, word);
        p.bump();
    }
    is_near
}

/// Says which word is meant in place of the current one.
pub(crate) fn misspelt(p: &mut Parser<'_>, meant: &str) {
    let message = format!("`{}` means nothing here", p.word());
    let error = SyntaxError::new(codes::UNKNOWN_WORD, p.range(), message);
    p.error(error.help(format!("did you mean `{meant}`?")));
}

/// ``a``, ``b`` and ``c``.
pub(crate) fn quoted_words(words: &[&str], conjunction: &str) -> String {
    let mut text = String::new();
    for (index, word) in words.iter().enumerate() {
        match index {
            0 => {}
            _ if index + 1 == words.len() => text.push_str(&format!(" {conjunction} ")),
            _ => text.push_str(", "),
        }
        text.push_str(&format!("`{word}`"));
    }
    text
}

/// Reports what starts here if something of its `kind` was seen before, as written in `seen`.
pub(crate) fn once<T: PartialEq>(p: &mut Parser<'_>, seen: &mut Vec<T>, kind: T, what: &str) {
    if seen.contains(&kind) {
        let range = p.range();
        p.error(
            SyntaxError::new(codes::UNEXPECTED, range, format!("a second {what} is not expected here"))
                .help("delete one of the two"),
        );
    } else {
        seen.push(kind);
    }
}

/// Takes a token of `kind`; `true` if it is there.
pub(crate) fn eat(p: &mut Parser<'_>, kind: SyntaxKind) -> bool {
    let there = p.current() == kind;
    if there {
        p.bump();
    }
    there
}

/// Takes a token of `kind`, or reports that it is missing.
pub(crate) fn expect(p: &mut Parser<'_>, kind: SyntaxKind, what: &str, help: &str) -> bool {
    let there = eat(p, kind);
    if !there {
        missing(p, what, help);
    }
    there
}

/// Takes a token of `kind` before a block, or reports that it is missing; it may come later in the statement.
pub(crate) fn expect_before(p: &mut Parser<'_>, kind: SyntaxKind, what: &str, help: &str) {
    if eat(p, kind) {
        return;
    }
    missing(p, what, help);
    if p.comes(kind) {
        p.start(SyntaxKind::Error);
        while p.current() != kind {
            p.bump();
        }
        p.finish_node();
        p.bump();
    }
}

pub(crate) fn at_name(p: &Parser<'_>) -> bool {
    matches!(p.current(), SyntaxKind::Name | SyntaxKind::QuotedName)
}

/// Takes a name, or reports that `what` is missing. A reserved word is taken for the name it is meant to be.
pub(crate) fn name(p: &mut Parser<'_>, what: &str) -> bool {
    if at_name(p) {
        p.bump();
        return true;
    }
    let reserved = p.current().word().is_some() || is_word_of_expressions(p.current());
    if reserved && !p.on_new_line() {
        let (range, word) = (p.range(), p.word());
        let follows = p.next();
        if matches!(
            follows,
            SyntaxKind::Semicolon
                | SyntaxKind::Comma
                | SyntaxKind::Assign
                | SyntaxKind::Colon
                | SyntaxKind::Equal
                | SyntaxKind::RightParenthesis
        ) {
            p.error(
                SyntaxError::new(codes::MISPLACED, range, format!("`{word}` is a reserved word, not a name"))
                    .help(format!("choose another name, or quote it: `'{word}'`")),
            );
            p.start(SyntaxKind::Error);
            p.bump();
            p.finish_node();
            return true;
        }
    }
    missing(p, what, "write a name there");
    false
}

fn is_word_of_expressions(kind: SyntaxKind) -> bool {
    use SyntaxKind as K;
    matches!(kind, K::If | K::Then | K::Else | K::And | K::Or | K::Not | K::True | K::False)
}

/// `: real[3]`.
pub(crate) fn type_clause(p: &mut Parser<'_>) {
    p.start(SyntaxKind::Type);
    p.bump();
    type_name(p);
    p.finish_node();
}

/// `real[3]`.
pub(crate) fn type_name(p: &mut Parser<'_>) {
    name(p, "a type");
    if p.current() == SyntaxKind::LeftBracket {
        shape(p, SyntaxKind::Shape);
    }
}

/// `[3, n]`.
pub(crate) fn shape(p: &mut Parser<'_>, kind: SyntaxKind) {
    p.start(kind);
    p.bump();
    p.fenced(|p| {
        expression(p);
        while eat(p, SyntaxKind::Comma) {
            expression(p);
        }
    });
    close(p, SyntaxKind::RightBracket);
    p.finish_node();
}

/// `(0, 5)` or `{"high", "low"}`.
pub(crate) fn value_range(p: &mut Parser<'_>) {
    let closing = match p.current() {
        SyntaxKind::LeftParenthesis => SyntaxKind::RightParenthesis,
        SyntaxKind::LeftBrace => SyntaxKind::RightBrace,
        _ => {
            missing(p, "a range", "write `(low, high)` or `{\"first\", \"second\"}`");
            return;
        }
    };
    p.start(SyntaxKind::ValueRange);
    p.bump();
    p.fenced(|p| {
        expression(p);
        while eat(p, SyntaxKind::Comma) {
            expression(p);
        }
    });
    close(p, closing);
    p.finish_node();
}

/// The bracket that closes; that there is none is already reported.
pub(crate) fn close(p: &mut Parser<'_>, kind: SyntaxKind) {
    if !matches!(p.current(), SyntaxKind::Semicolon | SyntaxKind::End) && p.current() != kind {
        unexpected(p);
        p.start(SyntaxKind::Error);
        let mut open = 0;
        p.fenced(|p| {
            while p.current() != SyntaxKind::End && (p.current() != kind || open > 0) {
                match p.current() {
                    SyntaxKind::LeftParenthesis | SyntaxKind::LeftBracket | SyntaxKind::LeftBrace => {
                        open += 1;
                    }
                    SyntaxKind::RightParenthesis | SyntaxKind::RightBracket | SyntaxKind::RightBrace => {
                        open -= 1;
                    }
                    _ => {}
                }
                p.bump();
            }
        });
        p.finish_node();
    }
    eat(p, kind);
}

/// `"m/s"`, if there is one.
pub(crate) fn unit(p: &mut Parser<'_>) {
    if p.current() == SyntaxKind::String {
        p.start(SyntaxKind::Unit);
        p.bump();
        p.finish_node();
    }
}

/// A word and the expression after it, as in `delay 0.5`.
pub(crate) fn clause(p: &mut Parser<'_>, stops: &'static [&'static str]) {
    p.start(SyntaxKind::Clause);
    p.bump();
    p.fenced_before(stops, expression);
    p.finish_node();
}

/// A word that says all, as `latched`.
pub(crate) fn mark(p: &mut Parser<'_>) {
    p.start(SyntaxKind::Clause);
    p.bump();
    p.finish_node();
}
