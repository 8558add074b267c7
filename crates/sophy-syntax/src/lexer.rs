use crate::error::{SyntaxError, codes};
use crate::kinds::SyntaxKind;
use logos::Logos;
use std::ops::Range;

/// A token and its bytes in the text.
#[derive(Clone, Debug)]
pub(crate) struct Token {
    pub(crate) kind: SyntaxKind,
    pub(crate) range: Range<usize>,
}

/// The tokens of `text`, without a gap, and what is wrong with their spelling.
pub(crate) fn lex(text: &str) -> (Vec<Token>, Vec<SyntaxError>) {
    let mut tokens: Vec<Token> = Vec::new();
    let mut errors = Vec::new();
    for (result, range) in SyntaxKind::lexer(text).spanned() {
        let kind = result.unwrap_or(SyntaxKind::Unknown);
        if kind == SyntaxKind::Unknown
            && let Some(last) = tokens.last_mut()
            && last.kind == SyntaxKind::Unknown
        {
            last.range.end = range.end; // a run of strange characters is one mistake
        } else {
            tokens.push(Token { kind, range });
        }
    }
    for token in &tokens {
        errors.extend(misspelling(token.kind, &text[token.range.clone()], &token.range));
    }
    (tokens, errors)
}

fn misspelling(kind: SyntaxKind, slice: &str, range: &Range<usize>) -> Option<SyntaxError> {
    match kind {
        SyntaxKind::Number => number(slice, range),
        SyntaxKind::QuotedName => quoted_name(slice, range),
        SyntaxKind::String => Some(
            SyntaxError::new(codes::STRING, range.clone(), "a string cannot be part of this expression")
                .help("a name that is not an identifier stands in single quotes: `'Ground Impact'`"),
        ),
        SyntaxKind::Unknown => Some(unknown(slice, range)),
        _ => operator(kind, slice, range),
    }
}

fn number(slice: &str, range: &Range<usize>) -> Option<SyntaxError> {
    let error = |message: String| Some(SyntaxError::new(codes::NUMBER, range.clone(), message));
    let (mantissa, exponent) = match slice.find(['e', 'E']) {
        Some(at) => slice.split_at(at),
        None => (slice, ""),
    };
    let with_exponent = |mantissa: &str| format!("write `{mantissa}{exponent}`");
    if !exponent.is_empty() && !exponent.ends_with(|c: char| c.is_ascii_digit()) {
        return error(format!("the exponent of `{slice}` has no digits"))
            .map(|e| e.help(format!("write for example `{mantissa}e-3`")));
    }
    if mantissa.starts_with('.') {
        return error("a number needs a digit before the point".to_owned())
            .map(|e| e.help(with_exponent(&format!("0{mantissa}"))));
    }
    if mantissa.ends_with('.') {
        return error("a number needs a digit after the point".to_owned())
            .map(|e| e.help(with_exponent(&format!("{mantissa}0"))));
    }
    if slice.parse().is_ok_and(f64::is_infinite) {
        return error(format!("`{slice}` is too large for a number"))
            .map(|e| e.help("the largest is about 1.8e308"));
    }
    None
}

fn quoted_name(slice: &str, range: &Range<usize>) -> Option<SyntaxError> {
    let is_quote = |c: char| matches!(c, '\'' | '‘' | '’');
    let inner = slice.trim_start_matches(is_quote);
    let error = |message: String| SyntaxError::new(codes::QUOTE, range.clone(), message);
    if slice.chars().count() < 2 || !slice.ends_with(is_quote) {
        return Some(
            error("the quote that starts here is never closed".to_owned())
                .help("a quoted name ends with `'` on the same line"),
        );
    }
    if inner.is_empty() {
        return Some(error("there is no name between the quotes".to_owned()));
    }
    if slice.starts_with('\'') && slice.ends_with('\'') {
        return None;
    }
    let name = inner.trim_end_matches(is_quote);
    Some(
        SyntaxError::new(codes::CHARACTER, range.clone(), "typographic quotes do not quote a name")
            .help(format!("type `'{name}'`")),
    )
}

fn unknown(slice: &str, range: &Range<usize>) -> SyntaxError {
    let error = |message: String| SyntaxError::new(codes::CHARACTER, range.clone(), message);
    let advice = match slice {
        "\u{a0}" | "\u{202f}" | "\u{2009}" => {
            return error("this is a no-break space".to_owned()).help("type a plain space");
        }
        "²" => "type `^2`",
        "³" => "type `^3`",
        "√" => "type `sqrt(…)`",
        "∞" => "there is no infinite number; leave the bound out",
        "′" => "a prime is no part of a name; write the derivative as an equation of its own",
        "[" | "]" | "{" | "}" => "use `(` and `)`",
        ";" => "an expression ends by itself; delete it",
        "#" => "a comment starts with `%`",
        _ => "delete it, or put a name that needs it in single quotes: `'Ground Impact'`",
    };
    let shown: String = slice.chars().take(12).collect();
    let kind = if shown.chars().count() == 1 { "is not a character" } else { "are not characters" };
    error(format!("`{shown}` {kind} of an expression")).help(advice)
}

/// Operators that are understood, but are to be typed otherwise.
fn operator(kind: SyntaxKind, slice: &str, range: &Range<usize>) -> Option<SyntaxError> {
    let accepted: &[&str] = match kind {
        SyntaxKind::Minus => &["-"],
        SyntaxKind::Star => &["*"],
        SyntaxKind::Slash => &["/"],
        SyntaxKind::Caret => &["^"],
        SyntaxKind::LessEqual => &["<="],
        SyntaxKind::GreaterEqual => &[">="],
        SyntaxKind::NotEqual => &["<>", "!="],
        SyntaxKind::Not => &["not", "!"],
        SyntaxKind::And => &["and", "&&"],
        SyntaxKind::Or => &["or", "||"],
        SyntaxKind::LeftParenthesis => &["("],
        SyntaxKind::RightParenthesis => &[")"],
        SyntaxKind::Comma => &[","],
        _ => return None,
    };
    if accepted.contains(&slice) {
        return None;
    }
    let (code, what) = if slice.is_ascii() {
        (codes::SPELLING, "is not an operator")
    } else {
        (codes::CHARACTER, "is a typographic character")
    };
    let spellings: Vec<String> = accepted.iter().map(|spelling| format!("`{spelling}`")).collect();
    Some(
        SyntaxError::new(code, range.clone(), format!("`{slice}` {what}"))
            .help(format!("type {}", spellings.join(" or "))),
    )
}
