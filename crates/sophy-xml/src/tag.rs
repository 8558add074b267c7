use crate::codes::{BARE_LESS_THAN, DUPLICATE_ATTRIBUTE, MALFORMED_TAG};
use crate::document::{Attribute, Element, Text};
use crate::parser::Parser;
use crate::schema;
use sophy_diagnostics::Diagnostic;

/// The name that `text` begins with; empty if it begins with none (XML 1.0, production 5).
pub(crate) fn name(text: &str) -> &str {
    let end =
        text.char_indices().find(|(at, c)| !is_name_character(*c, *at == 0)).map_or(text.len(), |(at, _)| at);
    &text[..end]
}

fn is_name_character(c: char, first: bool) -> bool {
    let start = matches!(c,
        ':' | '_' | 'A'..='Z' | 'a'..='z' | '\u{C0}'..='\u{D6}' | '\u{D8}'..='\u{F6}' | '\u{F8}'..='\u{2FF}'
        | '\u{370}'..='\u{37D}' | '\u{37F}'..='\u{1FFF}' | '\u{200C}'..='\u{200D}' | '\u{2070}'..='\u{218F}'
        | '\u{2C00}'..='\u{2FEF}' | '\u{3001}'..='\u{D7FF}' | '\u{F900}'..='\u{FDCF}' | '\u{FDF0}'..='\u{FFFD}'
        | '\u{10000}'..='\u{EFFFF}');
    start
        || (!first
            && matches!(c, '-' | '.' | '0'..='9' | '\u{B7}' | '\u{300}'..='\u{36F}' | '\u{203F}'..='\u{2040}'))
}

/// Whether the `<` at the start of `rest` begins a tag, possibly a malformed one, and is not a `<` of an
/// expression: `Position <L` is none, because no tag continues or ends after `<L`.
pub(crate) fn starts_tag(rest: &str) -> bool {
    let name = name(&rest[1..]);
    if name.is_empty() {
        return false;
    }
    schema::element(name).is_some() || ends_as_tag(&rest[1 + name.len()..])
}

/// Whether `rest` consists of attributes and `>` or `/>`.
fn ends_as_tag(rest: &str) -> bool {
    let end = rest.find(['<', '>']).unwrap_or(rest.len());
    if rest[end..].starts_with('>') {
        let inside = rest[..end].trim_end_matches('/');
        return inside.trim().is_empty() || (inside.starts_with(char::is_whitespace) && inside.contains('='));
    }
    false
}

impl Parser<'_> {
    /// `<name attribute="value" …>` or `…/>`
    pub(crate) fn opening_tag(&mut self) {
        let start = self.take(1).start;
        let element_name = name(self.rest());
        let name_place = self.take(element_name.len());
        let mut element = Element {
            name: element_name.to_owned(),
            name_span: self.span(name_place.clone()),
            tag: self.span(start..name_place.end),
            attributes: Vec::new(),
            children: Vec::new(),
            closed: false,
            meant: None,
        };
        let (mut complained, mut repeated) = (false, false);
        loop {
            let rest = self.rest();
            let blanks = rest.len() - rest.trim_start().len();
            self.take(blanks);
            let rest = self.rest();
            let attribute_name = name(rest);
            if rest.starts_with('>') || rest.starts_with("/>") {
                element.closed = rest.starts_with('/');
                let end = self.take(if element.closed { 2 } else { 1 }).end;
                element.tag = self.span(start..end);
                break;
            }
            if rest.is_empty() || rest.starts_with('<') {
                if !complained {
                    self.malformed(
                        &element,
                        "does not end with `>`",
                        &format!("add the `>` of `<{element_name}`"),
                    );
                }
                break;
            }
            if attribute_name.is_empty() {
                if !complained {
                    let c = rest.chars().next().unwrap_or(' ');
                    self.malformed(
                        &element,
                        &format!("contains `{c}`, which has no place there"),
                        "delete it",
                    );
                    complained = true;
                }
                let next = rest.char_indices().skip(1).find(|(_, c)| {
                    c.is_whitespace() || matches!(c, '<' | '>') || is_name_character(*c, true)
                });
                self.take(next.map_or(rest.len(), |(at, _)| at));
                continue;
            }
            if blanks == 0 && !complained {
                let help = format!("put a blank before `{attribute_name}`");
                self.malformed(&element, "has no blank before an attribute", &help);
                complained = true;
            }
            let attribute = self.attribute(&element, &mut complained);
            self.add_attribute(&mut element, attribute, &mut repeated);
        }
        let empty = element.closed;
        self.open(element, empty);
    }

    /// Says once for each tag what is wrong with its form.
    fn malformed(&mut self, element: &Element, what: &str, help: &str) {
        let length = self.rest().chars().next().map_or(0, char::len_utf8);
        let message = format!("the tag `<{}` {what}", element.name);
        self.diagnostics.push(
            Diagnostic::error(MALFORMED_TAG, self.span(self.here().of(0..length)), message)
                .label(element.name_span, "this tag")
                .help(help),
        );
    }

    /// Says once for each tag that an attribute stands twice.
    fn add_attribute(&mut self, element: &mut Element, attribute: Attribute, repeated: &mut bool) {
        self.count_node();
        // One attribute is the most an element has: looking through them stays cheap by leaving out the rest.
        match element.attributes.iter().find(|other| other.name == attribute.name) {
            Some(_) if *repeated => {}
            Some(first) => {
                *repeated = true;
                let message = format!("the attribute `{}` stands twice", attribute.name);
                self.diagnostics.push(
                    Diagnostic::error(DUPLICATE_ATTRIBUTE, attribute.name_span, message)
                        .label(first.name_span, "the first one")
                        .help("delete one of them"),
                );
            }
            None if element.attributes.len() < 100 => element.attributes.push(attribute),
            None => {}
        }
    }

    /// `name="value"`
    fn attribute(&mut self, element: &Element, complained: &mut bool) -> Attribute {
        let attribute_name = name(self.rest()).to_owned();
        let name_place = self.take(attribute_name.len());
        let name_span = self.span(name_place);
        let rest = self.rest();
        let after = rest.trim_start();
        if !after.starts_with('=') {
            if !*complained {
                let help = format!("write {attribute_name}=\"…\"");
                self.malformed(
                    element,
                    &format!("has an attribute `{attribute_name}` without a value"),
                    &help,
                );
                *complained = true;
            }
            let mut value = Text::empty(self.source, name_span.end as usize);
            value.damaged = true;
            return Attribute { name: attribute_name, name_span, value };
        }
        let to_value = rest.len() - after.len() + 1 + (after.len() - 1 - after[1..].trim_start().len());
        self.take(to_value);
        let rest = self.rest();
        let quote = rest.chars().next().filter(|c| matches!(c, '"' | '\''));
        let length = match quote {
            Some(quote) => {
                self.take(1);
                self.quoted_length(element, quote, complained)
            }
            None => {
                if !*complained {
                    let value: String = rest
                        .chars()
                        .take_while(|c| !c.is_whitespace() && !matches!(c, '<' | '>' | '/'))
                        .collect();
                    let help = format!("write {attribute_name}=\"{value}\"");
                    self.malformed(
                        element,
                        &format!("has a value without quotes for `{attribute_name}`"),
                        &help,
                    );
                    *complained = true;
                }
                rest.find(|c: char| c.is_whitespace() || matches!(c, '<' | '>' | '/')).unwrap_or(rest.len())
            }
        };
        let value = self.attribute_value(length);
        if let Some(quote) = quote
            && self.rest().starts_with(quote)
        {
            self.take(1);
        }
        Attribute { name: attribute_name, name_span, value }
    }

    /// Length of the value up to the closing `quote`. If a `<` comes first, the value ends at a `>` before it
    /// (the quote was forgotten), or goes on to a quote in the same line (the `<` was meant as such).
    fn quoted_length(&mut self, element: &Element, quote: char, complained: &mut bool) -> usize {
        let rest = self.rest();
        let end = rest.find([quote, '<']).unwrap_or(rest.len());
        if rest[end..].starts_with(quote) {
            return end;
        }
        if !rest[..end].contains('>') && rest[end..].starts_with('<') {
            let line = &rest[..end + rest[end..].find(['\n', '>']).unwrap_or(rest.len() - end)];
            if let Some(close) = line.find(quote) {
                let span = self.span(self.here().of(end..end + 1));
                self.diagnostics.push(
                    Diagnostic::error(BARE_LESS_THAN, span, "`<` must not stand in an attribute")
                        .help("write `&lt;`"),
                );
                return close;
            }
        }
        if !*complained {
            self.malformed(
                element,
                "has a value whose closing quote is missing",
                &format!("add the `{quote}`"),
            );
            *complained = true;
        }
        rest[..end].find(['>', '\n']).unwrap_or(end)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_tag_or_a_comparison() {
        for tag in ["<domain>", "<b>", "<b x='1'>", "<a/>", "<domain Position"] {
            assert!(starts_tag(tag), "{tag}");
        }
        for text in ["<", "< L", "<L</domain>", "<L && x > 3", "<=3", "<a b c>"] {
            assert!(!starts_tag(text), "{text}");
        }
    }
}
