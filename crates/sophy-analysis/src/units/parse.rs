//! Unit strings: `m/s2`, `kg*m^2`, `N.m`, `W/(m2.K)`, `ft-lbf`, `m·s⁻²`, `V/sqrt(Hz)`.
//!
//! - A product is written with `.` `*` `·` `×`, a space or a hyphen.
//! - `/` divides by the factor after it only, from left to right: `m/s/s` is m/s², and `W/m2.K` is (W/m²)·K,
//!   with a note, because the standards forbid it and most who write it mean `W/(m2.K)`.
//! - A hyphen binds more tightly than `/`, as those who use it mean it: `lbf/ft-s` is lbf/(ft·s).
//! - A power is `^2`, `**2`, `²`, `^(1/2)`, `^0.5` or digits after the unit: `s-1`, `m2`. `sqrt(…)` and `√` are
//!   roots.
//! - A number may stand first: `1/s`, `1000 kg`.
//! - The empty string, `-` and `1` are the unit of numbers.

use super::table::{self, Relation, Row};
use super::{Dimension, Unit};
use std::fmt;
use std::ops::Range;

/// Parentheses and roots within one another; deeper is no unit.
const DEEPEST: usize = 32;

/// What a string says.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct ParsedUnit {
    /// The unit.
    pub(crate) unit: Unit,
    /// What a reader of it should know.
    pub(crate) notes: Vec<Note>,
}

/// Something about a unit string that may surprise, and its bytes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Note {
    /// What it is.
    pub(crate) kind: NoteKind,
    /// Where it stands in the string.
    pub(crate) range: Range<usize>,
}

/// What may surprise.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum NoteKind {
    /// A temperature with another zero than the kelvin. It has the scale of a difference of temperatures; the
    /// 273.15 is the modeller's. In a compound (`W/(m2.degC)`) only differences count, and nothing is to be noted.
    Offset,
    /// A logarithmic number, taken as a number of unknown scale.
    Logarithm,
    /// `a/b.c`, read as (a/b)·c.
    ProductAfterDivision,
}

impl fmt::Display for NoteKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            NoteKind::Offset => "its zero is not converted: it is checked as a difference of temperatures",
            NoteKind::Logarithm => "a logarithmic unit is not converted: it is checked as a number",
            NoteKind::ProductAfterDivision => {
                "this factor stands above the line: write `a/(b.c)` if it belongs below"
            }
        })
    }
}

/// A string that is no unit.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct UnitError {
    /// What is wrong.
    pub(crate) kind: UnitErrorKind,
    /// The bytes of the string that are wrong; empty at its end.
    pub(crate) range: Range<usize>,
}

/// What is wrong with a unit string.
#[derive(Clone, Debug, PartialEq, Eq)]
#[allow(missing_docs)] // the texts are below
pub(crate) enum UnitErrorKind {
    Unknown { word: String, suggestion: Option<String> },
    Missing,
    Unexpected(char),
    Unclosed,
    NumberNotFirst,
    Number,
    Exponent,
    TooDeep,
}

impl fmt::Display for UnitErrorKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            UnitErrorKind::Unknown { word, .. } => write!(f, "`{word}` is not a unit"),
            UnitErrorKind::Missing => f.write_str("a unit is missing here"),
            UnitErrorKind::Unexpected(found) => write!(f, "`{found}` has no meaning in a unit"),
            UnitErrorKind::Unclosed => f.write_str("this parenthesis is not closed"),
            UnitErrorKind::NumberNotFirst => {
                f.write_str("a number in a unit stands first; a root is written `^(1/2)`")
            }
            UnitErrorKind::Number => f.write_str("a unit is a positive number of other units"),
            UnitErrorKind::Exponent => f.write_str("no unit has this exponent"),
            UnitErrorKind::TooDeep => f.write_str("this unit is too deeply nested"),
        }
    }
}

impl fmt::Display for UnitError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.kind.fmt(f)
    }
}

impl std::error::Error for UnitError {}

/// The unit that `text` means; see the head of this file for what is read how.
///
/// # Errors
/// [`UnitError`] says which bytes are no unit and, for a word, which may have been meant.
pub(crate) fn parse(text: &str) -> Result<ParsedUnit, UnitError> {
    let plain = text.trim();
    if plain.is_empty() || plain == "-" {
        return Ok(ParsedUnit { unit: Unit::ONE, notes: Vec::new() });
    }
    let mut parser = Parser { text, at: 0, depth: 0, offset: None, notes: Vec::new() };
    let unit = parser.product()?;
    if let Some(found) = parser.peek() {
        return Err(parser.error_at_char(UnitErrorKind::Unexpected(found)));
    }
    // A temperature by itself has a zero; in a compound it is a difference.
    if let Some(range) = parser.offset
        && text.get(range.clone()) == Some(plain)
    {
        parser.notes.push(Note { kind: NoteKind::Offset, range });
    }
    Ok(ParsedUnit { unit: unit.written(plain), notes: parser.notes })
}

struct Parser<'a> {
    text: &'a str,
    at: usize,
    depth: usize,
    /// The last temperature with an offset.
    offset: Option<Range<usize>>,
    notes: Vec<Note>,
}

impl<'a> Parser<'a> {
    /// `[number] factor { ("/" | "." | "*" | " " …) factor }`
    fn product(&mut self) -> Result<Unit, UnitError> {
        self.skip_spaces();
        let mut unit = match self.number()? {
            Some(number) => number,
            None => self.hyphenated()?,
        };
        let mut divided = false;
        loop {
            self.skip_spaces();
            let start = self.at;
            let divides = match self.peek() {
                None | Some(')') => return Ok(unit),
                Some('/') => true,
                Some(_) => false,
            };
            self.eat(|c| matches!(c, '/' | '.' | '*' | '·' | '⋅' | '•' | '×'));
            self.skip_spaces();
            let factor = self.hyphenated()?;
            let range = start..self.at;
            let result = if divides { unit.over(factor) } else { unit.times(factor) };
            unit = result.ok_or_else(|| error(UnitErrorKind::Exponent, range.clone()))?;
            if divided && !divides && self.notes.iter().all(|n| n.kind != NoteKind::ProductAfterDivision) {
                self.notes.push(Note { kind: NoteKind::ProductAfterDivision, range });
            }
            divided |= divides;
        }
    }

    /// `power { "-" power }`
    fn hyphenated(&mut self) -> Result<Unit, UnitError> {
        let mut unit = self.power()?;
        while self.eat(|c| matches!(c, '-' | '‐' | '‑')) {
            let start = self.at;
            let factor = self.power()?;
            unit = unit.times(factor).ok_or_else(|| error(UnitErrorKind::Exponent, start..self.at))?;
        }
        Ok(unit)
    }

    /// `atom [exponent]`
    fn power(&mut self) -> Result<Unit, UnitError> {
        let start = self.at;
        let base = self.atom()?;
        let Some(exponent) = self.exponent()? else { return Ok(base) };
        base.power(exponent).ok_or_else(|| error(UnitErrorKind::Exponent, start..self.at))
    }

    /// A word, `(product)`, `sqrt(product)` or `√ atom`.
    fn atom(&mut self) -> Result<Unit, UnitError> {
        let start = self.at;
        if self.eat(|c| c == '√') {
            self.skip_spaces();
            let radicand = self.nested(Self::atom)?;
            return radicand.sqrt().ok_or_else(|| error(UnitErrorKind::Exponent, start..self.at));
        }
        if self.peek() == Some('(') {
            return self.parenthesised();
        }
        if let Some(symbol) = self.not_one_word() {
            self.at += symbol.len();
            return self.known(symbol, start);
        }
        let word = self.word();
        match self.text.get(self.at..).and_then(|rest| rest.chars().next()) {
            _ if !word.is_empty() => {}
            None | Some(')') => return Err(error(UnitErrorKind::Missing, self.at..self.at)),
            Some(c) if c.is_ascii_digit() => {
                self.eat_while(|c| c.is_ascii_digit());
                return Err(error(UnitErrorKind::NumberNotFirst, start..self.at));
            }
            // Two operators in a row.
            Some(c) => return Err(self.error_at_char(UnitErrorKind::Unexpected(c))),
        }
        if word == "sqrt" && self.peek() == Some('(') {
            let radicand = self.parenthesised()?;
            return radicand.sqrt().ok_or_else(|| error(UnitErrorKind::Exponent, start..self.at));
        }
        self.known(word, start)
    }

    fn parenthesised(&mut self) -> Result<Unit, UnitError> {
        let start = self.at;
        self.eat(|c| c == '(');
        let unit = self.nested(Self::product)?;
        if self.eat(|c| c == ')') { Ok(unit) } else { Err(error(UnitErrorKind::Unclosed, start..start + 1)) }
    }

    fn nested(&mut self, inner: fn(&mut Self) -> Result<Unit, UnitError>) -> Result<Unit, UnitError> {
        if self.depth == DEEPEST {
            return Err(error(UnitErrorKind::TooDeep, self.at..self.text.len()));
        }
        self.depth += 1;
        let unit = inner(self);
        self.depth -= 1;
        unit
    }

    /// A symbol with a space or hyphen in it that stands here with no exponent after it: in `lb-ft2` the hyphen
    /// is an ordinary product.
    fn not_one_word(&self) -> Option<&'static str> {
        let rest = self.text.get(self.at..)?;
        table::NOT_ONE_WORD.into_iter().find(|symbol| {
            let next = rest.strip_prefix(symbol).map(|after| after.chars().next());
            next.is_some_and(|next| next.is_none_or(|c| !is_letter(c) && !starts_exponent(c)))
        })
    }

    /// The longest word here that may have a digit in it (`g0`) if that is a unit, else its letters.
    fn word(&mut self) -> &'a str {
        let rest = self.text.get(self.at..).unwrap_or_default();
        let upto = |end: Option<usize>| rest.get(..end.unwrap_or(rest.len())).unwrap_or_default();
        let letters = upto(rest.find(|c| !is_letter(c)));
        let longer = upto(rest.find(|c: char| !is_letter(c) && !c.is_ascii_digit()));
        let known = longer.len() > letters.len() && !letters.is_empty() && table::find(longer).is_some();
        let word = if known { longer } else { letters };
        self.at += word.len();
        word
    }

    fn known(&mut self, word: &str, start: usize) -> Result<Unit, UnitError> {
        let range = start..self.at;
        let Some((Row { dimension, factor, relation, .. }, prefix)) = table::find(word) else {
            let kind = UnitErrorKind::Unknown { word: word.to_owned(), suggestion: table::closest(word) };
            return Err(error(kind, range));
        };
        let unit = Unit::new(*dimension, prefix * factor);
        match relation {
            Relation::Factor => Ok(unit),
            Relation::Offset => {
                self.offset = Some(range);
                Ok(unit)
            }
            Relation::Logarithm => {
                self.notes.push(Note { kind: NoteKind::Logarithm, range });
                Ok(unit.of_unknown_scale())
            }
        }
    }

    /// A number with its exponent: `1`, `1000`, `0.5`, `1e-3`, `10^-3`.
    fn number(&mut self) -> Result<Option<Unit>, UnitError> {
        let start = self.at;
        if !self.eat_while(|c| c.is_ascii_digit()) {
            return Ok(None);
        }
        self.eat_after('.');
        let mantissa = self.at;
        // `1eV` is one electronvolt.
        if self.eat(|c| matches!(c, 'e' | 'E')) {
            self.eat(|c| matches!(c, '+' | '-'));
            if !self.eat_while(|c| c.is_ascii_digit()) {
                self.at = mantissa;
            }
        }
        let value: Option<f64> = self.text.get(start..self.at).and_then(|digits| digits.parse().ok());
        let number = Unit::new(Dimension::ONE, value.unwrap_or_default());
        let exponent = self.exponent()?.unwrap_or(1.0);
        let power = number.power(exponent).filter(|power| power.factor.is_some());
        power.map(Some).ok_or_else(|| error(UnitErrorKind::Number, start..self.at))
    }

    /// `^2`, `^-0.5`, `^(1/2)`, `**2`, `²`, `⁻¹`, or a whole number right after the unit.
    fn exponent(&mut self) -> Result<Option<f64>, UnitError> {
        let start = self.at;
        let rest = self.text.get(start..).unwrap_or_default();
        let wrong = |this: &Self| error(UnitErrorKind::Exponent, start..this.at);
        let operator = ["^", "**"].into_iter().find(|operator| rest.trim_start().starts_with(operator));
        if let Some(operator) = operator {
            self.skip_spaces();
            self.at += operator.len();
            self.skip_spaces();
            let parenthesis = self.eat(|c| c == '(');
            let mut value = self.signed().ok_or_else(|| wrong(self))?;
            if parenthesis {
                if self.eat(|c| c == '/') {
                    value /= self.signed().ok_or_else(|| wrong(self))?;
                }
                if !self.eat(|c| c == ')') {
                    return Err(wrong(self));
                }
            }
            return Ok(Some(value));
        }
        let length = rest.find(|c| superscript(c).is_none()).unwrap_or(rest.len());
        if length > 0 {
            self.at += length;
            let digits: String = rest.chars().map_while(superscript).collect();
            return digits.parse().map(Some).map_err(|_| wrong(self));
        }
        let unsigned = rest.strip_prefix(['-', '+', '−']).unwrap_or(rest);
        if unsigned.starts_with(|c: char| c.is_ascii_digit()) {
            let sign = if rest.starts_with(['-', '−']) { -1.0 } else { 1.0 };
            let digits = unsigned.find(|c: char| !c.is_ascii_digit()).unwrap_or(unsigned.len());
            self.at += rest.len() - unsigned.len() + digits;
            let value: Option<f64> = unsigned.get(..digits).and_then(|digits| digits.parse().ok());
            return value.map(|value| Some(sign * value)).ok_or_else(|| wrong(self));
        }
        Ok(None)
    }

    fn signed(&mut self) -> Option<f64> {
        let negative = self.eat(|c| matches!(c, '-' | '−'));
        if !negative {
            self.eat(|c| c == '+');
        }
        let start = self.at;
        self.eat_while(|c| c.is_ascii_digit());
        self.eat_after('.');
        let value: f64 = self.text.get(start..self.at)?.parse().ok()?;
        Some(if negative { -value } else { value })
    }

    /// A point with digits after it; a point alone is a product.
    fn eat_after(&mut self, point: char) {
        let start = self.at;
        if self.eat(|c| c == point) && !self.eat_while(|c| c.is_ascii_digit()) {
            self.at = start;
        }
    }

    fn peek(&self) -> Option<char> {
        self.text.get(self.at..)?.chars().next()
    }

    fn eat(&mut self, wanted: impl Fn(char) -> bool) -> bool {
        let found = self.peek().filter(|c| wanted(*c));
        self.at += found.map_or(0, char::len_utf8);
        found.is_some()
    }

    fn eat_while(&mut self, wanted: impl Fn(char) -> bool) -> bool {
        let start = self.at;
        while self.eat(&wanted) {}
        self.at > start
    }

    fn skip_spaces(&mut self) {
        self.eat_while(char::is_whitespace);
    }

    fn error_at_char(&self, kind: UnitErrorKind) -> UnitError {
        let length = self.peek().map_or(0, char::len_utf8);
        error(kind, self.at..self.at + length)
    }
}

fn error(kind: UnitErrorKind, range: Range<usize>) -> UnitError {
    UnitError { kind, range }
}

fn is_letter(c: char) -> bool {
    c.is_alphabetic() || matches!(c, '°' | '℃' | '℉' | '%' | '‰' | '_' | '$' | '€' | '#')
}

fn starts_exponent(c: char) -> bool {
    c.is_ascii_digit() || matches!(c, '^' | '*') || superscript(c).is_some()
}

fn superscript(c: char) -> Option<char> {
    let digits = [('⁻', '-'), ('⁺', '+'), ('¹', '1'), ('²', '2'), ('³', '3'), ('⁰', '0')];
    let beyond = || ('⁴'..='⁹').contains(&c).then(|| char::from_digit(c as u32 - '⁰' as u32, 10)).flatten();
    digits.iter().find(|(raised, _)| *raised == c).map(|(_, plain)| *plain).or_else(beyond)
}

#[cfg(test)]
mod tests;
