use crate::error::{Errors, SyntaxError, codes};
use crate::kinds::SyntaxKind;
use logos::Logos;
use std::ops::Range;

/// A token and its bytes in the text.
#[derive(Clone, Debug)]
pub(crate) struct Token {
    pub(crate) kind: SyntaxKind,
    start: u32,
    end: u32,
}

impl Token {
    /// Trees count in 32 bits, too.
    fn new(kind: SyntaxKind, range: Range<usize>) -> Self {
        let narrow = |offset: usize| u32::try_from(offset).unwrap_or(u32::MAX);
        Token { kind, start: narrow(range.start), end: narrow(range.end) }
    }

    pub(crate) fn range(&self) -> Range<usize> {
        self.start as usize..self.end as usize
    }
}

/// What a text is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Mode {
    /// One expression: the words of [`SyntaxKind::of_word`] are plain names, and there are no strings.
    Expression,
    /// A file of components, functions and constants.
    File,
}

/// The tokens of `text`, without a gap, and what is wrong with their spelling.
pub(crate) fn lex(text: &str, mode: Mode) -> (Vec<Token>, Errors) {
    let mut tokens: Vec<Token> = Vec::new();
    let mut errors = Errors::default();
    for (result, range) in SyntaxKind::lexer(text).spanned() {
        let kind = in_mode(result.unwrap_or(SyntaxKind::Unknown), &text[range.clone()], mode);
        if kind == SyntaxKind::Unknown
            && let Some(last) = tokens.last_mut()
            && last.kind == SyntaxKind::Unknown
        {
            *last = Token::new(kind, last.range().start..range.end); // a run of strange characters is one mistake
        } else {
            tokens.push(Token::new(kind, range));
            if mode == Mode::File {
                join_hyphenated(text, &mut tokens);
            }
        }
    }
    if mode == Mode::File {
        words_in_place(&mut tokens);
    }
    let mut before = None;
    for token in &tokens {
        if let Some(error) = misspelling(token.kind, &text[token.range()], &token.range(), mode) {
            let primed =
                before.filter(|_| token.kind == SyntaxKind::QuotedName && error.code == codes::QUOTE);
            errors.push(match primed {
                Some(name) => error.help(format!("the derivative of `{name}` is `der({name})`")),
                None => error,
            });
        }
        before = (token.kind == SyntaxKind::Name).then(|| &text[token.range()]);
    }
    (tokens, errors)
}

fn in_mode(kind: SyntaxKind, slice: &str, mode: Mode) -> SyntaxKind {
    use SyntaxKind as K;
    match (mode, kind) {
        (Mode::File, K::Name) => SyntaxKind::of_word(slice).unwrap_or(kind),
        (Mode::Expression, K::DocComment) => K::Comment,
        (Mode::Expression, K::LeftBrace | K::RightBrace) => K::Unknown,
        _ => kind,
    }
}

/// `event` is also a type and `location` a variable: they are keywords where their sections start and end.
fn words_in_place(tokens: &mut [Token]) {
    use SyntaxKind as K;
    let (mut before, mut after) = (K::End, K::End);
    let mut undecided: Option<usize> = None;
    for index in 0..=tokens.len() {
        let kind = tokens.get(index).map_or(K::End, |token| token.kind);
        if kind.is_trivia() {
            continue;
        }
        if let Some(word) = undecided.take() {
            let opens = match tokens[word].kind {
                K::LocationKeyword => matches!(kind, K::Name | K::QuotedName),
                _ => kind == K::LeftParenthesis,
            };
            if !opens && !matches!(before, K::EndKeyword | K::InitialKeyword | K::Semicolon) {
                tokens[word].kind = K::Name;
            }
        }
        if matches!(kind, K::LocationKeyword | K::EventKeyword | K::EventsKeyword) {
            undecided = Some(index);
            before = after;
        }
        after = kind;
    }
}

/// Makes one keyword of `negative - to - positive` without spaces.
fn join_hyphenated(text: &str, tokens: &mut Vec<Token>) {
    let [.., first, minus, to, other, last] = tokens.as_slice() else { return };
    let parts = [first, minus, to, other, last].map(|token| token.kind);
    use SyntaxKind::{Minus, Name};
    let range = first.range().start..last.range().end;
    if parts == [Name, Minus, Name, Minus, Name]
        && let Some(kind) = SyntaxKind::of_word(&text[range.clone()])
    {
        tokens.truncate(tokens.len() - 5);
        tokens.push(Token::new(kind, range));
    }
}

fn misspelling(kind: SyntaxKind, slice: &str, range: &Range<usize>, mode: Mode) -> Option<SyntaxError> {
    match kind {
        SyntaxKind::String if mode == Mode::File => string(slice, range),
        SyntaxKind::Number => number(slice, range),
        SyntaxKind::QuotedName => quoted_name(slice, range),
        SyntaxKind::String => Some(
            SyntaxError::new(codes::STRING, range.clone(), "a string cannot be part of this expression")
                .help("a name that is not an identifier stands in single quotes: `'Ground Impact'`"),
        ),
        SyntaxKind::Unknown => Some(unknown(slice, range, mode)),
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

fn string(slice: &str, range: &Range<usize>) -> Option<SyntaxError> {
    let is_quote = |c: char| matches!(c, '"' | '“' | '”' | '„');
    if slice.chars().count() < 2 || !slice.ends_with(is_quote) {
        return Some(
            SyntaxError::new(codes::QUOTE, range.clone(), "the string that starts here is never closed")
                .help("a string ends with `\"` on the same line"),
        );
    }
    if slice.starts_with('"') && slice.ends_with('"') {
        return None;
    }
    Some(
        SyntaxError::new(codes::CHARACTER, range.clone(), "typographic quotes do not make a string")
            .help(format!("type `\"{}\"`", slice.trim_matches(is_quote))),
    )
}

pub(crate) fn unknown(slice: &str, range: &Range<usize>, mode: Mode) -> SyntaxError {
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
        "{" | "}" => "use `(` and `)`",
        ";" => "an expression ends by itself; delete it",
        "#" => "a comment starts with `%`",
        _ => "delete it, or put a name that needs it in single quotes: `'Ground Impact'`",
    };
    let shown: String = slice.chars().take(12).collect();
    let kind = if shown.chars().count() == 1 { "is not a character" } else { "are not characters" };
    let whole = if mode == Mode::File { "a model" } else { "an expression" };
    error(format!("`{shown}` {kind} of {whole}")).help(advice)
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
