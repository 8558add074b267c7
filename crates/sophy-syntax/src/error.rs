use sophy_diagnostics::Code;
use std::ops::Range;

/// A mistake of grammar: what is wrong, where in the text, and the way out.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SyntaxError {
    /// Kind of message.
    pub code: Code,
    /// One sentence without a full stop.
    pub message: String,
    /// Where, in bytes of the text; empty where something is missing.
    pub range: Range<usize>,
    /// Ways out.
    pub helps: Vec<String>,
    /// Further places and what is to be said of them.
    pub related: Vec<(Range<usize>, String)>,
}

impl SyntaxError {
    pub(crate) fn new(code: Code, range: Range<usize>, message: impl Into<String>) -> Self {
        SyntaxError { code, message: message.into(), range, helps: Vec::new(), related: Vec::new() }
    }

    pub(crate) fn help(mut self, help: impl Into<String>) -> Self {
        self.helps.reserve_exact(1);
        self.helps.push(help.into());
        self
    }

    pub(crate) fn related(mut self, range: Range<usize>, message: impl Into<String>) -> Self {
        self.related.reserve_exact(1);
        self.related.push((range, message.into()));
        self
    }
}

/// The mistakes of a text: not more than anybody reads, and none longer than that. What is kept so stays in proportion
/// to the text, whatever it is.
#[derive(Default)]
pub(crate) struct Errors(Vec<SyntaxError>);

impl Errors {
    /// After so many mistakes of a text the others are not reported.
    const MOST: usize = 500;

    pub(crate) fn push(&mut self, mut error: SyntaxError) {
        if self.0.len() < Self::MOST {
            shorten(&mut error.message);
            error.helps.iter_mut().for_each(shorten);
            self.0.push(error);
        }
    }

    pub(crate) fn len(&self) -> usize {
        self.0.len()
    }

    pub(crate) fn iter(&self) -> impl Iterator<Item = &SyntaxError> {
        self.0.iter()
    }

    /// The mistakes in the order of their places.
    pub(crate) fn sorted(mut self) -> Vec<SyntaxError> {
        self.0.sort_by_key(|error| (error.range.start, error.range.end));
        self.0
    }
}

/// Leaves out the middle of a message that quotes too much of the text.
fn shorten(text: &mut String) {
    const HEAD: usize = 300;
    const TAIL: usize = 60;
    if text.len() > 2 * (HEAD + TAIL) {
        let head = text.floor_char_boundary(HEAD);
        let tail = text.ceil_char_boundary(text.len() - TAIL);
        *text = format!("{}…{}", &text[..head], &text[tail..]);
    }
}

/// Every code of this crate with the kind of mistake it names.
pub const CODES: &[(Code, &str)] = &[
    (codes::CHARACTER, "a character that an expression cannot have"),
    (codes::NUMBER, "a malformed number"),
    (codes::QUOTE, "a quoted name that does not end, or is empty"),
    (codes::UNMATCHED, "a `)` that closes nothing"),
    (codes::UNCLOSED, "a `(` that is never closed"),
    (codes::MISSING_EXPRESSION, "an expression is missing"),
    (codes::MISSING_OPERATOR, "an operator is missing"),
    (codes::CHAINED_COMPARISON, "comparisons in a chain"),
    (codes::INCOMPLETE_IF, "an `if` without `then` or `else`"),
    (codes::PARENTHESES_NEEDED, "an `if` or `not` that needs parentheses"),
    (codes::TOO_DEEP, "an expression nested too deeply"),
    (codes::UNEXPECTED, "something stands where it does not belong"),
    (codes::SPELLING, "an operator spelt as in another language"),
    (codes::STRING, "a string in an expression of numbers"),
    (codes::MISSING_END, "an `end` is missing"),
    (codes::WRONG_END, "an `end` that closes nothing, or something else"),
    (codes::MISSING_SEMICOLON, "a `;` is missing"),
    (codes::UNKNOWN_WORD, "a word that means nothing here, perhaps misspelt"),
    (codes::MISSING_PART, "a part of a declaration, statement or section is missing"),
    (codes::MISPLACED, "something that belongs to another section"),
    (codes::EQUALITY, "`=`, `:=` and `:` mixed up"),
    (codes::COMPARISON_IN_EQUATION, "a comparison in an equation without parentheses"),
    (codes::LEFT_SIDE, "a left side that is no variable"),
];

pub(crate) mod codes {
    use sophy_diagnostics::Code;

    pub(crate) const CHARACTER: Code = Code("HS0001");
    pub(crate) const NUMBER: Code = Code("HS0002");
    pub(crate) const QUOTE: Code = Code("HS0003");
    pub(crate) const UNMATCHED: Code = Code("HS0004");
    pub(crate) const UNCLOSED: Code = Code("HS0005");
    pub(crate) const MISSING_EXPRESSION: Code = Code("HS0006");
    pub(crate) const MISSING_OPERATOR: Code = Code("HS0007");
    pub(crate) const CHAINED_COMPARISON: Code = Code("HS0008");
    pub(crate) const INCOMPLETE_IF: Code = Code("HS0009");
    pub(crate) const PARENTHESES_NEEDED: Code = Code("HS0010");
    pub(crate) const TOO_DEEP: Code = Code("HS0011");
    pub(crate) const UNEXPECTED: Code = Code("HS0012");
    pub(crate) const SPELLING: Code = Code("HS0013");
    pub(crate) const STRING: Code = Code("HS0014");
    pub(crate) const MISSING_END: Code = Code("HS0015");
    pub(crate) const WRONG_END: Code = Code("HS0016");
    pub(crate) const MISSING_SEMICOLON: Code = Code("HS0017");
    pub(crate) const UNKNOWN_WORD: Code = Code("HS0018");
    pub(crate) const MISSING_PART: Code = Code("HS0019");
    pub(crate) const MISPLACED: Code = Code("HS0020");
    pub(crate) const EQUALITY: Code = Code("HS0021");
    pub(crate) const COMPARISON_IN_EQUATION: Code = Code("HS0022");
    pub(crate) const LEFT_SIDE: Code = Code("HS0023");
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::parse_expression;

    #[test]
    fn what_is_reported_has_an_end() {
        let characters = "§ a ".repeat(10_000);
        let parse = parse_expression(&characters);
        assert_eq!(parse.errors().len(), Errors::MOST);
        assert_eq!(parse.errors()[1].range, "§ a ".len().."§ a §".len());

        let name = "é".repeat(10_000);
        let text = format!("{name} b");
        let parse = parse_expression(&text);
        let [error] = parse.errors() else { unreachable!("{:?}", parse.errors()) };
        assert!(error.message.starts_with("an operator is missing between `éé"), "{}", error.message);
        assert!(error.message.ends_with("é` and `b`"), "{}", error.message);
        assert!(error.message.len() < 400 && error.helps[0].len() < 400);
    }
}
