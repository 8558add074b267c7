use crate::codes::{BAD_CHARACTER, BARE_AMPERSAND, BARE_LESS_THAN, EXPANSION, UNKNOWN_ENTITY};
use crate::document::{Place, Text};
use crate::limits::{MAX_ENTITY_DEPTH, max_expansion};
use crate::parser::{Parser, is_xml_character};
use crate::tag;
use sophy_diagnostics::{Diagnostic, closest};
use std::ops::Range;

/// The entities that XML itself declares.
const PREDEFINED: [(&str, &str); 5] = [("lt", "<"), ("gt", ">"), ("amp", "&"), ("apos", "'"), ("quot", "\"")];

/// What stands at an `&`, and how many bytes it takes.
enum Reference<'a> {
    Character(char),
    Predefined(&'static str),
    Declared {
        name: &'a str,
        text: &'a str,
    },
    /// Said to be a mistake; what was meant.
    Mistake(&'a str),
    /// Said to be a mistake, and nobody knows what was meant.
    Damage,
}

impl<'a> Parser<'a> {
    /// A reference in the text of an element.
    pub(crate) fn reference(&mut self) {
        let (reference, length) = self.resolve(self.rest(), &self.here());
        match reference {
            Reference::Character(c) => self.add_replaced(c.encode_utf8(&mut [0; 4]), length),
            Reference::Predefined(text) | Reference::Mistake(text) => self.add_replaced(text, length),
            Reference::Damage => self.add_damage(length),
            Reference::Declared { name, text } => {
                let place = self.take(length);
                let again = self.inputs.iter().any(|input| input.entity == Some(name));
                if self.may_expand(name, text, &place, self.inputs.len(), again) {
                    self.enter_entity(name, text, place);
                }
            }
        }
    }

    /// The value of an attribute that takes the next `length` bytes: references resolved, line ends and tabs
    /// made blanks (XML 1.0, section 3.3.3).
    pub(crate) fn attribute_value(&mut self, length: usize) -> Text {
        let (raw, place) = (&self.rest()[..length], self.here());
        let mut value = Text::empty(self.source, self.take(length).start);
        self.resolve_value(raw, place, &mut Vec::new(), &mut value);
        value
    }

    /// Appends `raw`, which stands at `place`, to `value`. `entities` are those it is the text of.
    fn resolve_value(&mut self, raw: &'a str, place: Place, entities: &mut Vec<&'a str>, value: &mut Text) {
        let (mut rest, mut place) = (raw, place);
        while !rest.is_empty() && !self.has_said_enough() {
            let length = match rest.find(['&', '\r', '\n', '\t']).unwrap_or(rest.len()) {
                0 if rest.starts_with('&') => self.resolve_value_reference(rest, &place, entities, value),
                0 => {
                    let length = if rest.starts_with("\r\n") { 2 } else { 1 };
                    value.push_reference(" ", place.of(0..length));
                    length
                }
                plain => {
                    value.push_plain(&rest[..plain], &place);
                    plain
                }
            };
            (rest, place) = (&rest[length..], place.after(length));
        }
    }

    /// Appends what the `&` at the start of `rest` stands for; returns the length of the reference.
    fn resolve_value_reference(
        &mut self,
        rest: &'a str,
        place: &Place,
        entities: &mut Vec<&'a str>,
        value: &mut Text,
    ) -> usize {
        let (reference, length) = self.resolve(rest, place);
        let here = place.of(0..length);
        match reference {
            Reference::Character(c) => value.push_reference(c.encode_utf8(&mut [0; 4]), here),
            Reference::Predefined(text) | Reference::Mistake(text) => value.push_reference(text, here),
            Reference::Damage => value.damaged = true,
            Reference::Declared { name, text } => {
                if text.contains('<') {
                    let message =
                        format!("the entity `{name}` contains `<`, which must not be in an attribute");
                    self.diagnostics.push(Diagnostic::error(
                        BARE_LESS_THAN,
                        self.span(here.clone()),
                        message,
                    ));
                }
                let (depth, again) = (1 + entities.len(), entities.contains(&name));
                if self.may_expand(name, text, &here, depth, again) {
                    entities.push(name);
                    self.resolve_value(text, Place::Reference(here), entities, value);
                    entities.pop();
                }
            }
        }
        length
    }

    /// Whether the entity may be expanded at `place`; counts what it adds.
    fn may_expand(
        &mut self,
        name: &str,
        text: &str,
        place: &Range<usize>,
        depth: usize,
        again: bool,
    ) -> bool {
        if self.stopped {
            return false;
        }
        self.expanded = self.expanded.saturating_add(text.len().max(1));
        let most = max_expansion(self.inputs.first().map_or(0, |file| file.text.len()));
        let message = if again {
            format!("the entity `{name}` contains itself")
        } else if depth > MAX_ENTITY_DEPTH {
            format!("entities refer to one another more than {MAX_ENTITY_DEPTH} deep")
        } else if self.expanded > most {
            format!("the entities of the file expand to more than {most} bytes")
        } else {
            return true;
        };
        // Going on would repeat the message for every reference.
        self.stopped = true;
        self.diagnostics.push(
            Diagnostic::error(EXPANSION, self.span(place.clone()), message)
                .help("write the text where it is needed, instead of entities"),
        );
        false
    }

    /// What the `&` at the start of `rest`, which stands at `place`, refers to. Says what is wrong with it.
    fn resolve(&mut self, rest: &'a str, place: &Place) -> (Reference<'a>, usize) {
        if rest.starts_with("&#") {
            return self.character_reference(rest, place);
        }
        let name = tag::name(&rest[1..]);
        let predefined = PREDEFINED.iter().find(|(known, _)| *known == name).map(|(_, text)| *text);
        let length = 1 + name.len();
        if !rest[length..].starts_with(';') {
            let end = if rest.starts_with("&&") { 2 } else { 1 };
            return match predefined {
                Some(text) => {
                    self.mistake(
                        place.of(0..length),
                        "a reference ends with a semicolon",
                        &format!("write `&{name};`"),
                    );
                    (Reference::Predefined(text), length)
                }
                None if end == 2 => {
                    self.mistake(place.of(0..2), AMPERSAND, "write `&amp;&amp;`, or `and`");
                    (Reference::Mistake(&rest[..2]), 2)
                }
                None => {
                    self.mistake(place.of(0..1), AMPERSAND, "write `&amp;`");
                    (Reference::Mistake(&rest[..1]), 1)
                }
            };
        }
        let length = length + 1;
        if let Some(text) = predefined {
            return (Reference::Predefined(text), length);
        }
        if let Some(text) = self.entities.get(name) {
            return (Reference::Declared { name, text }, length);
        }
        self.unknown_entity(name, place.of(0..length));
        (Reference::Mistake(name), length)
    }

    fn mistake(&mut self, place: Range<usize>, message: &str, help: &str) {
        self.diagnostics.push(Diagnostic::error(BARE_AMPERSAND, self.span(place), message).help(help));
    }

    fn unknown_entity(&mut self, name: &str, place: Range<usize>) {
        let known = self.entities.keys().copied().chain(PREDEFINED.iter().map(|(known, _)| *known));
        let help = match closest(name, known) {
            Some(known) => format!("did you mean `&{known};`?"),
            None => "write the character itself: the file is UTF-8".to_owned(),
        };
        self.diagnostics.push(
            Diagnostic::error(
                UNKNOWN_ENTITY,
                self.span(place),
                format!("the entity `&{name};` is not declared"),
            )
            .help(help)
            .note("XML itself knows `&lt;` `&gt;` `&amp;` `&apos;` `&quot;` only"),
        );
    }

    /// `&#60;` or `&#x3C;`
    fn character_reference(&mut self, rest: &'a str, place: &Place) -> (Reference<'a>, usize) {
        let (digits_at, radix) = if rest.starts_with("&#x") { (3, 16) } else { (2, 10) };
        let digits =
            rest[digits_at..].len() - rest[digits_at..].trim_start_matches(|c: char| c.is_digit(radix)).len();
        let end = digits_at + digits;
        let finished = rest[end..].starts_with(';');
        // What goes on like a name belongs to the attempt.
        let odd = rest[end..].len() - rest[end..].trim_start_matches(|c: char| c.is_alphanumeric()).len();
        let length = end + odd + usize::from(rest[end + odd..].starts_with(';'));
        let place = place.of(0..length);
        if digits == 0 || !finished {
            self.diagnostics.push(
                Diagnostic::error(BARE_AMPERSAND, self.span(place), "this is not a character reference")
                    .help("write `&#`, the number of the character, and `;`; for `&` itself write `&amp;`"),
            );
            return (Reference::Damage, length);
        }
        let character = u32::from_str_radix(&rest[digits_at..end], radix).ok().and_then(char::from_u32);
        match character.filter(|c| is_xml_character(*c)) {
            Some(c) => (Reference::Character(c), length),
            None => {
                let message = format!("`{}` is not a character of XML", &rest[..length]);
                self.diagnostics
                    .push(Diagnostic::error(BAD_CHARACTER, self.span(place), message).help("delete it"));
                (Reference::Damage, length)
            }
        }
    }
}

const AMPERSAND: &str = "`&` begins a reference in XML; in text it is written `&amp;`";
