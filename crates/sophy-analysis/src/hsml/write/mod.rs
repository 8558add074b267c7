//! [`Declarations`] → HSML text.
//!
//! - `file`: imports, constants, functions, components with their interfaces;
//! - `body`: sections, declarations, events, rules, members, connections;
//! - `locations`: locations with their transitions;
//! - `statements`: statements and equations;
//! - `words`: names, strings, documentation and expressions;
//! - `from_xml`: what SOPHY XML says otherwise.

mod body;
mod file;
mod from_xml;
mod locations;
mod statements;
mod words;

use crate::declarations::Declarations;
use sophy_syntax::format;
use std::collections::HashMap;

/// HSML that declares `declarations`, in the canonical layout.
///
/// Expressions stay as they are, names that are no identifiers stand in single quotes, documentation in `%%` lines.
/// What [`read_hsml`](crate::read_hsml) makes of the text equals `declarations` but for places, if these are complete.
/// Of a component that was SOPHY XML
///
/// - units and initial values stand with what is declared, event labels are declared,
/// - a transition that waits for a condition or an event becomes two,
/// - an output that is a state needs no equation,
/// - hints for other tools become comments.
///
/// A quote inside of a name and a line break in it, which HSML lacks, become `′` and a blank.
pub fn write_hsml(declarations: &Declarations) -> String {
    let mut writer = Writer::default();
    writer.file(declarations);
    // Incomplete declarations may make no file that could be laid out.
    format(&writer.text).unwrap_or(writer.text)
}

/// The text so far, and how deep it is nested.
#[derive(Debug, Default)]
struct Writer {
    text: String,
    depth: usize,
    /// Whether a name needs quotes, as far as it was asked.
    quoted: HashMap<String, bool>,
}

impl Writer {
    fn line(&mut self, line: &str) {
        if !line.is_empty() {
            self.text.extend(std::iter::repeat_n("  ", self.depth));
            self.text.push_str(line);
        }
        self.text.push('\n');
    }

    /// An empty line, unless nothing stands before it.
    fn gap(&mut self) {
        if !self.text.is_empty() && !self.text.ends_with("\n\n") {
            self.text.push('\n');
        }
    }

    /// `opening … end word;` around what `content` writes.
    fn block(&mut self, opening: &str, word: &str, content: impl FnOnce(&mut Self)) {
        self.line(opening);
        self.depth += 1;
        content(self);
        self.depth -= 1;
        self.line(&format!("end {word};"));
    }

    /// A section around `items`, if there are any.
    fn section<T>(&mut self, word: &str, items: &[T], mut item: impl FnMut(&mut Self, &T)) {
        if !items.is_empty() {
            self.block(word, word, |writer| items.iter().for_each(|each| item(writer, each)));
        }
    }
}
