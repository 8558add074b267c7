//! TOML values of the types an experiment has, every wrong one with a message at its place.

use sophy_diagnostics::{Code, Diagnostic, Diagnostics, SourceId, Span, closest};
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// A value at its place.
pub(super) type Value<'t> = Spanned<DeValue<'t>>;

/// A key at its place.
pub(super) type Key<'t> = Spanned<std::borrow::Cow<'t, str>>;

pub(super) const SYNTAX: Code = Code("EX0101");
pub(super) const UNKNOWN_KEY: Code = Code("EX0102");
pub(super) const WRONG_TYPE: Code = Code("EX0103");
pub(super) const MISSING_KEY: Code = Code("EX0104");
pub(super) const WRONG_VALUE: Code = Code("EX0105");
pub(super) const INPUT_FILE: Code = Code("EX0106");

/// Reads values out of one source and collects what is wrong with them.
pub(super) struct Values {
    pub(super) source: SourceId,
    pub(super) diagnostics: Diagnostics,
}

impl Values {
    pub(super) fn span<T>(&self, spanned: &Spanned<T>) -> Span {
        Span::new(self.source, spanned.span())
    }

    pub(super) fn table<'t>(&mut self, value: &'t Value<'t>) -> Option<&'t DeTable<'t>> {
        let table = value.get_ref().as_table();
        if table.is_none() {
            self.wrong_type(value, "a table of keys and values");
        }
        table
    }

    pub(super) fn number(&mut self, value: &Value<'_>) -> Option<f64> {
        let number = match value.get_ref() {
            DeValue::Integer(integer) => {
                i64::from_str_radix(integer.as_str(), integer.radix()).ok().map(|n| n as f64)
            }
            DeValue::Float(float) => float.as_str().parse().ok(),
            _ => None,
        };
        let number = number.filter(|number: &f64| number.is_finite());
        if number.is_none() {
            self.wrong_type(value, "a finite number");
        }
        number
    }

    pub(super) fn whole_number(&mut self, value: &Value<'_>) -> Option<u64> {
        let integer = value.get_ref().as_integer();
        let number = integer.and_then(|n| u64::from_str_radix(n.as_str(), n.radix()).ok());
        if number.is_none() {
            self.wrong_type(value, "a whole number from 0 on");
        }
        number
    }

    pub(super) fn text(&mut self, value: &Value<'_>) -> Option<String> {
        let text = value.get_ref().as_str().map(str::to_owned);
        if text.is_none() {
            self.wrong_type(value, "text in quotes");
        }
        text
    }

    pub(super) fn truth(&mut self, value: &Value<'_>) -> Option<bool> {
        let truth = value.get_ref().as_bool();
        if truth.is_none() {
            self.wrong_type(value, "`true` or `false`");
        }
        truth
    }

    /// One text or a list of them, each with its place.
    pub(super) fn texts(&mut self, value: &Value<'_>) -> Vec<(String, Span)> {
        let Some(array) = value.get_ref().as_array() else {
            return match value.get_ref().as_str() {
                Some(text) => vec![(text.to_owned(), self.span(value))],
                None => {
                    self.wrong_type(value, "text in quotes, or a list of texts");
                    Vec::new()
                }
            };
        };
        array.iter().filter_map(|item| Some((self.text(item)?, self.span(item)))).collect()
    }

    /// A word out of a few.
    pub(super) fn word<T>(
        &mut self,
        value: &Value<'_>,
        words: &[&str],
        meaning: impl FnOnce(&str) -> Option<T>,
    ) -> Option<T> {
        let text = self.text(value)?;
        let found = meaning(&text);
        if found.is_none() {
            let message = format!("`{text}` is not known here");
            let help = format!("known are {}", list(words));
            let diagnostic = Diagnostic::error(WRONG_VALUE, self.span(value), message);
            self.diagnostics.push(with_suggestion(diagnostic, &text, words).help(help));
        }
        found
    }

    pub(super) fn unknown_key(&mut self, section: &str, key: &Key<'_>, known: &[&str]) {
        let name = key.get_ref();
        let place = if section.is_empty() { "an experiment".to_owned() } else { format!("[{section}]") };
        let diagnostic =
            Diagnostic::error(UNKNOWN_KEY, self.span(key), format!("{place} has no key `{name}`"));
        let help = format!("known are {}", list(known));
        self.diagnostics.push(with_suggestion(diagnostic, name, known).help(help));
    }

    pub(super) fn wrong_type(&mut self, value: &Value<'_>, expected: &str) {
        let found = value.get_ref().type_str();
        let diagnostic = Diagnostic::error(WRONG_TYPE, self.span(value), format!("expected {expected}"))
            .label_main(format!("this is of TOML's type {found}"));
        self.diagnostics.push(diagnostic);
    }
}

fn with_suggestion(diagnostic: Diagnostic, name: &str, known: &[&str]) -> Diagnostic {
    match closest(name, known.iter().copied()) {
        Some(meant) => diagnostic.help(format!("did you mean `{meant}`?")),
        None => diagnostic,
    }
}

fn list(words: &[&str]) -> String {
    words.iter().map(|word| format!("`{word}`")).collect::<Vec<_>>().join(", ")
}
