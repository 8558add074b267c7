use crate::codes::{BAD_CHARACTER, TOO_MANY_NODES};
use crate::document::{Element, Node, Place, Text};
use crate::limits::{MAX_MESSAGES, MAX_NODES};
use crate::tag;
use sophy_diagnostics::{Diagnostic, Diagnostics, SourceId, Span};
use std::collections::BTreeMap;
use std::ops::Range;

/// The root element of `text`, and every mistake of XML in it.
///
/// Goes on after a mistake with what was most likely meant: a bare `<` is text, a closing tag closes the
/// elements inside, an unknown entity is its name. Reading stops early only at a limit, and then there is no
/// root. What is accepted here is confirmed by the [judge](crate::judge).
pub(crate) fn parse(source: SourceId, text: &str) -> (Option<Element>, Diagnostics) {
    let mut parser = Parser::new(source, text);
    parser.check_characters(text);
    while !parser.stopped && parser.step() {}
    if !parser.stopped {
        parser.finish(text);
    }
    (parser.root.filter(|_| !parser.stopped), parser.diagnostics)
}

pub(crate) struct Parser<'a> {
    pub(crate) source: SourceId,
    /// The file, and the texts of the entities that are being read.
    pub(crate) inputs: Vec<Input<'a>>,
    /// The elements that are open, the innermost last.
    pub(crate) open: Vec<Element>,
    pub(crate) root: Option<Element>,
    /// Names and texts of the declared entities.
    pub(crate) entities: BTreeMap<&'a str, &'a str>,
    /// Bytes that references have expanded to.
    pub(crate) expanded: usize,
    nodes: usize,
    pub(crate) diagnostics: Diagnostics,
    /// A limit was passed.
    pub(crate) stopped: bool,
}

/// A text and how far it is read.
pub(crate) struct Input<'a> {
    pub(crate) text: &'a str,
    pub(crate) position: usize,
    pub(crate) place: Place,
    /// Its name, if it is the text of an entity.
    pub(crate) entity: Option<&'a str>,
    /// Number of elements that were open where it began.
    pub(crate) depth: usize,
}

impl<'a> Input<'a> {
    pub(crate) fn rest(&self) -> &'a str {
        self.text.get(self.position..).unwrap_or("")
    }
}

impl<'a> Parser<'a> {
    fn new(source: SourceId, text: &'a str) -> Self {
        let byte_order_mark = if text.starts_with('\u{FEFF}') { 3 } else { 0 };
        Parser {
            source,
            inputs: vec![Input {
                text,
                position: byte_order_mark,
                place: Place::From(0),
                entity: None,
                depth: 0,
            }],
            open: Vec::new(),
            root: None,
            entities: BTreeMap::new(),
            expanded: 0,
            nodes: 0,
            diagnostics: Diagnostics::default(),
            stopped: false,
        }
    }

    /// Reads one tag, comment, instruction, section or run of text; false at the end of the file.
    fn step(&mut self) -> bool {
        let rest = self.rest();
        if rest.is_empty() {
            return self.leave_entity();
        }
        if self.has_said_enough() {
            return false;
        }
        let said = self.diagnostics.len();
        match rest.as_bytes() {
            [b'<', b'!', b'-', b'-', ..] => self.comment(),
            [b'<', b'!', b'[', ..] if rest.starts_with("<![CDATA[") => self.section(),
            [b'<', b'!', ..] if rest.starts_with("<!DOCTYPE") => self.doctype(),
            [b'<', b'?', ..] => self.instruction(),
            [b'<', b'/', ..] => self.closing_tag(),
            [b'<', ..] if tag::starts_tag(rest) => self.opening_tag(),
            _ if self.open.is_empty() => self.outside(),
            [b'<', ..] => self.bare_less_than(),
            [b'&', ..] => self.reference(),
            _ => self.text(),
        }
        if self.inputs.len() > 1 && self.diagnostics.len() > said {
            // The text of an entity is read as often as it is referred to; its mistakes are told once.
            self.diagnostics.leave_out_repetitions(said);
        }
        true
    }

    /// Whether there are so many messages that reading stops here.
    pub(crate) fn has_said_enough(&mut self) -> bool {
        self.stopped |= self.diagnostics.len() >= MAX_MESSAGES;
        self.stopped
    }

    /// The unread part of the current text.
    pub(crate) fn rest(&self) -> &'a str {
        self.inputs.last().map_or("", Input::rest)
    }

    /// Moves on by `length` bytes and returns where they are.
    pub(crate) fn take(&mut self, length: usize) -> Range<usize> {
        let Some(input) = self.inputs.last_mut() else { return 0..0 };
        let start = input.position;
        input.position = (start + length).min(input.text.len());
        input.place.of(start..input.position)
    }

    /// Where the unread part of the current text stands.
    pub(crate) fn here(&self) -> Place {
        self.inputs.last().map_or(Place::From(0), |input| input.place.after(input.position))
    }

    pub(crate) fn span(&self, range: Range<usize>) -> Span {
        Span::new(self.source, range)
    }

    /// Enters the text of an entity whose reference stands at `reference`.
    pub(crate) fn enter_entity(&mut self, name: &'a str, text: &'a str, reference: Range<usize>) {
        let depth = self.open.len();
        self.inputs.push(Input {
            text,
            position: 0,
            place: Place::Reference(reference),
            entity: Some(name),
            depth,
        });
    }

    /// Goes back to the text that refers to the entity; false if this is the file.
    fn leave_entity(&mut self) -> bool {
        if self.inputs.len() < 2 {
            return false;
        }
        let Some(Input { depth, place, entity: Some(name), .. }) = self.inputs.pop() else { return true };
        if self.open.len() > depth {
            self.unbalanced_entity(name, place.of(0..0));
            while self.open.len() > depth {
                self.close(None);
            }
        }
        true
    }

    /// Puts text into the innermost element.
    pub(crate) fn add_text(&mut self, text: Text) {
        match self.open.last_mut().map(|element| &mut element.children) {
            None => {}
            Some(children) => match children.last_mut() {
                Some(Node::Text(last)) => last.append(&text),
                _ => {
                    children.push(Node::Text(text));
                    self.count_node();
                }
            },
        }
    }

    /// Puts a part of the current text, as it stands, into the innermost element.
    pub(crate) fn add_plain(&mut self, length: usize) {
        let (plain, place) = (&self.rest()[..length], self.here());
        let mut text = Text::empty(self.source, self.take(length).start);
        text.push_plain(plain, &place);
        self.add_text(text);
    }

    /// Puts `decoded` into the innermost element for the next `length` bytes.
    pub(crate) fn add_replaced(&mut self, decoded: &str, length: usize) {
        let range = self.take(length);
        let mut text = Text::empty(self.source, range.start);
        text.push_reference(decoded, range);
        self.add_text(text);
    }

    /// Leaves out the next `length` bytes, which mean nothing.
    pub(crate) fn add_damage(&mut self, length: usize) {
        let mut text = Text::empty(self.source, self.take(length).start);
        text.damaged = true;
        self.add_text(text);
    }

    pub(crate) fn count_node(&mut self) {
        self.nodes += 1;
        if self.nodes > MAX_NODES && !self.stopped {
            self.stopped = true;
            let place = self.take(0);
            let message = format!("the file has more than {MAX_NODES} elements, attributes and texts");
            self.diagnostics.push(
                Diagnostic::error(TOO_MANY_NODES, self.span(place), message)
                    .help("split the system into several models"),
            );
        }
    }

    fn check_characters(&mut self, text: &str) {
        let mut wrong = text.char_indices().filter(|(_, c)| !is_xml_character(*c));
        let Some((start, c)) = wrong.next() else { return };
        let more = wrong.count();
        let message = format!("the character U+{:04X} is not allowed in XML", u32::from(c));
        let mut diagnostic =
            Diagnostic::error(BAD_CHARACTER, self.span(start..start + c.len_utf8()), message)
                .help("delete it");
        if more > 0 {
            diagnostic = diagnostic.note(format!("there are {more} more such characters in the file"));
        }
        self.diagnostics.push(diagnostic);
    }
}

/// XML 1.0, production 2.
pub(crate) fn is_xml_character(c: char) -> bool {
    matches!(c, '\t' | '\n' | '\r' | ' '..='\u{FFFD}' | '\u{10000}'..='\u{10FFFF}')
}
