use crate::error::{Errors, SyntaxError, codes};
use crate::kinds::SyntaxKind;
use crate::lexer::{Mode, Token, unknown};
use std::ops::Range;

/// Reports brackets without partner; one that closes nothing becomes trivia.
///
/// Returns the tokens that end a statement, in order: in a file, brackets do not reach beyond.
pub(crate) fn match_brackets(
    text: &str,
    mode: Mode,
    tokens: &mut [Token],
    errors: &mut Errors,
) -> Vec<usize> {
    let mut open: Vec<(SyntaxKind, Range<usize>)> = Vec::new();
    let mut first: Option<Range<usize>> = None;
    let mut ends = Vec::new();
    // Braces of blocks that are still open.
    let mut blocks = 0;
    for index in 0..tokens.len() {
        let (kind, range) = (tokens[index].kind, tokens[index].range());
        if kind.is_trivia() {
            continue;
        }
        let in_vector = matches!(open.last(), Some((SyntaxKind::LeftBracket, _)));
        if mode == Mode::File && ends_statement(kind) && !(in_vector && is_row_end(&tokens[index..])) {
            if kind == SyntaxKind::Semicolon
                && let Some((SyntaxKind::LeftBrace, brace)) = open.last().cloned()
                && let Some(at) = tokens[..index].iter().rposition(|token| token.range() == brace)
            {
                // As in C.
                open.pop();
                blocks += 1;
                let behind = tokens[..at].iter().rfind(|token| !token.kind.is_trivia());
                let is_else = behind.is_some_and(|token| token.kind == SyntaxKind::Else);
                tokens[at].kind = if is_else { SyntaxKind::Unknown } else { SyntaxKind::Then };
                if !is_else {
                    errors.push(
                        SyntaxError::new(codes::UNEXPECTED, brace, "`{` does not begin a block")
                            .help("write `if condition then … else … end if;`, without braces"),
                    );
                }
            }
            unclosed(text, open.drain(..), errors);
            ends.push(index);
            first = None;
            continue;
        }
        let start = first.get_or_insert_with(|| range.clone()).clone();
        match kind {
            SyntaxKind::Semicolon if mode == Mode::Expression && !in_vector => {
                tokens[index].kind = SyntaxKind::Unknown;
                errors.push(unknown(";", &range, mode));
            }
            SyntaxKind::LeftParenthesis | SyntaxKind::LeftBracket | SyntaxKind::LeftBrace => {
                open.push((kind, range));
            }
            _ => {
                let Some(opening) = opening_of(kind) else { continue };
                match open.iter().rposition(|(kind, _)| *kind == opening) {
                    Some(at) => {
                        unclosed(text, open.drain(at + 1..), errors);
                        open.truncate(at);
                    }
                    None if kind == SyntaxKind::RightBrace && blocks > 0 => {
                        tokens[index].kind = SyntaxKind::Unknown;
                        blocks -= 1;
                    }
                    None => {
                        tokens[index].kind = SyntaxKind::Unknown;
                        errors.push(unmatched(text, range, start));
                    }
                }
            }
        }
    }
    unclosed(text, open.drain(..), errors);
    ends
}

/// `;` and the words that cannot be part of an expression.
fn ends_statement(kind: SyntaxKind) -> bool {
    kind == SyntaxKind::Semicolon || (kind.word().is_some() && kind != SyntaxKind::InKeyword)
}

/// Whether the `;` at the start of `tokens`, after an open `[`, is meant to end a row of a matrix, as in other
/// languages, rather than a statement.
fn is_row_end(tokens: &[Token]) -> bool {
    use SyntaxKind as K;
    let mut kinds = tokens.iter().map(|token| token.kind).filter(|kind| !kind.is_trivia());
    if kinds.next() != Some(K::Semicolon) {
        return false;
    }
    match (kinds.next(), kinds.next()) {
        (Some(K::Number | K::Minus | K::Plus | K::LeftParenthesis | K::LeftBracket), _) => true,
        (Some(K::Name), Some(next)) => {
            matches!(next, K::Comma | K::RightBracket | K::Plus | K::Minus | K::Star | K::Slash | K::Caret)
        }
        _ => false,
    }
}

fn opening_of(kind: SyntaxKind) -> Option<SyntaxKind> {
    match kind {
        SyntaxKind::RightParenthesis => Some(SyntaxKind::LeftParenthesis),
        SyntaxKind::RightBracket => Some(SyntaxKind::LeftBracket),
        SyntaxKind::RightBrace => Some(SyntaxKind::LeftBrace),
        _ => None,
    }
}

/// The bracket at `range` closes nothing; what it could belong to starts at `first`.
fn unmatched(text: &str, range: Range<usize>, first: Range<usize>) -> SyntaxError {
    let bracket = &text[range.clone()];
    let opening = match bracket {
        "]" => "[",
        "}" => "{",
        _ => "(",
    };
    let before = if first.start < range.start {
        format!(", or add a `{opening}` before `{}`", &text[first])
    } else {
        String::new()
    };
    SyntaxError::new(codes::UNMATCHED, range, format!("unmatched `{bracket}`"))
        .help(format!("delete it{before}"))
}

fn unclosed(text: &str, mut open: impl Iterator<Item = (SyntaxKind, Range<usize>)>, errors: &mut Errors) {
    let Some((kind, range)) = open.next() else { return };
    let closing = match kind {
        SyntaxKind::LeftBracket => ']',
        SyntaxKind::LeftBrace => '}',
        _ => ')',
    };
    let bracket = &text[range.clone()];
    let mut error = SyntaxError::new(codes::UNCLOSED, range, format!("`{bracket}` is never closed"))
        .help(format!("add a `{closing}` where the part ends, or delete the `{bracket}`"));
    for (_, further) in open.take(3) {
        error = error.related(further, "nor is this one");
    }
    errors.push(error);
}
