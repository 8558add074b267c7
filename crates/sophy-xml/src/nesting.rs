//! Which tag opens and closes which element.

use crate::codes::{
    MALFORMED_TAG, MISMATCHED_TAG, NO_ROOT, OUTSIDE_ROOT, STRAY_CLOSING_TAG, TOO_DEEP, UNBALANCED_ENTITY,
    UNCLOSED_ELEMENT,
};
use crate::document::{Element, Node};
use crate::limits::MAX_DEPTH;
use crate::parser::Parser;
use crate::schema::{self, Content, ROOT};
use crate::tag;
use sophy_diagnostics::{Diagnostic, Span, closest};
use std::ops::Range;

impl Parser<'_> {
    /// Opens `element`, or takes it as a whole if its tag is `empty` (`<a/>`).
    pub(crate) fn open(&mut self, element: Element, empty: bool) {
        self.count_node();
        if self.open.len() >= MAX_DEPTH {
            self.stopped = true;
            let message = format!("elements are nested more than {MAX_DEPTH} deep");
            let mut diagnostic = Diagnostic::error(TOO_DEEP, element.name_span, message);
            if let Some(parent) = self.open.last() {
                diagnostic = diagnostic.label(parent.name_span, "inside this and others");
            }
            self.diagnostics
                .push(diagnostic.help("a SOPHY file is seven deep; a closing tag may be missing"));
            return;
        }
        if self.open.is_empty()
            && let Some(root) = &self.root
        {
            let message = format!("`{}` stands after the end of the root element", element.name);
            self.diagnostics.push(
                Diagnostic::error(OUTSIDE_ROOT, element.name_span, message)
                    .label(root.name_span, "the root element begins here")
                    .help("a file has one root element: one file for each system"),
            );
        }
        self.open.push(element);
        if empty {
            self.close(None);
        }
    }

    /// Closes the innermost element, with its closing tag or without.
    pub(crate) fn close(&mut self, tag: Option<Span>) {
        let Some(mut element) = self.open.pop() else { return };
        // An element of a single tag is closed by it.
        element.closed = tag.is_some() || element.closed;
        let Some(parent) = self.open.last_mut() else {
            self.root.get_or_insert(element);
            return;
        };
        // Elements in an unclosed one that has text only were meant to follow it.
        let follow = if element.closed || !holds_text(&element.name) { None } else { element.first_child() };
        let following = follow.map_or_else(Vec::new, |at| element.children.split_off(at));
        parent.children.push(Node::Element(element));
        parent.children.extend(following);
    }

    /// `</name>`
    pub(crate) fn closing_tag(&mut self) {
        let rest = self.rest();
        let name = tag::name(&rest[2..]);
        let after = &rest[2 + name.len()..];
        let blanks = after.len() - after.trim_start().len();
        let finished = after[blanks..].starts_with('>');
        if name.is_empty() && !finished && !self.open.is_empty() {
            return self.bare_less_than();
        }
        let place = self.take(2 + name.len() + if finished { blanks + 1 } else { 0 });
        let span = self.span(place);
        if !finished {
            self.diagnostics.push(
                Diagnostic::error(MALFORMED_TAG, span, format!("the closing tag `</{name}` does not end"))
                    .help(format!("write `</{name}>`")),
            );
        }
        self.close_named(name, span);
    }

    fn close_named(&mut self, name: &str, span: Span) {
        // A text of an entity cannot close what was open before it.
        let floor = self.inputs.last().map_or(0, |input| input.depth);
        let inside = self.open.get(floor..).unwrap_or(&[]);
        let Some(innermost) = inside.last() else {
            if let Some(entity) = self.inputs.last().and_then(|input| input.entity) {
                let place = self.here().of(0..0);
                return self.unbalanced_entity(entity, place);
            }
            return self.stray_closing_tag(name, span);
        };
        if innermost.name == name {
            return self.close(Some(span));
        }
        if let Some(at) = inside.iter().rposition(|element| element.name == name) {
            return self.close_outer(floor + at, name, span);
        }
        // A typing error in the name of one of the two tags, or a tag too many?
        let typo = closest(name, [innermost.name.as_str()]).is_some();
        if holds_text(&innermost.name) || typo || schema::element(name).is_none() {
            let message = format!("`{}` is closed by `</{name}>`", innermost.name);
            let opening_is_wrong =
                schema::element(name).is_some() && schema::element(&innermost.name).is_none();
            let help = if opening_is_wrong {
                format!("did you mean `<{name}>` in the opening tag?")
            } else {
                format!("write `</{}>`", innermost.name)
            };
            self.diagnostics.push(
                Diagnostic::error(MISMATCHED_TAG, span, message)
                    .label(innermost.name_span, "opened here")
                    .help(help),
            );
            if opening_is_wrong && let Some(element) = self.open.last_mut() {
                name.clone_into(&mut element.name);
            }
            return self.close(Some(span));
        }
        self.stray_closing_tag(name, span);
    }

    /// Closes the element at `index`, and those inside it, which lack their closing tags.
    fn close_outer(&mut self, index: usize, name: &str, span: Span) {
        while self.open.len() > index + 1 {
            if let Some(unclosed) = self.open.last() {
                self.diagnostics.push(
                    Diagnostic::error(
                        UNCLOSED_ELEMENT,
                        unclosed.name_span,
                        format!("`{}` is not closed", unclosed.name),
                    )
                    .label(span, format!("`{name}` ends here, with `{}` still open", unclosed.name))
                    .help(format!("add `</{}>`", unclosed.name)),
                );
            }
            self.close(None);
        }
        self.close(Some(span));
    }

    fn stray_closing_tag(&mut self, name: &str, span: Span) {
        let mut diagnostic = Diagnostic::error(
            STRAY_CLOSING_TAG,
            span,
            format!("`</{name}>` closes nothing: no `{name}` is open here"),
        );
        if let Some(innermost) = self.open.last() {
            diagnostic = diagnostic.label(innermost.name_span, format!("`{}` is open", innermost.name));
        }
        self.diagnostics.push(diagnostic.help("delete it, or add the opening tag"));
    }

    pub(crate) fn unbalanced_entity(&mut self, name: &str, place: Range<usize>) {
        let message = format!("the text of the entity `{name}` opens and closes different elements");
        self.diagnostics.push(
            Diagnostic::error(UNBALANCED_ENTITY, self.span(place), message)
                .help("an element that begins in an entity must end in it"),
        );
    }

    /// The end of the file.
    pub(crate) fn finish(&mut self, text: &str) {
        if !self.open.is_empty() {
            self.unclosed_at_end(text);
        }
        while !self.open.is_empty() {
            self.close(None);
        }
        if self.root.is_none() {
            let message =
                if text.trim().is_empty() { "the file is empty" } else { "the file has no element" };
            self.diagnostics.push(
                Diagnostic::error(NO_ROOT, self.span(text.len()..text.len()), message)
                    .help(format!("a SOPHY file consists of one element <{ROOT}> … </{ROOT}>")),
            );
        }
    }

    fn unclosed_at_end(&mut self, text: &str) {
        let names: Vec<_> = self.open.iter().map(|element| format!("`{}`", element.name)).collect();
        let closing: String = self.open.iter().rev().map(|element| format!("</{}>", element.name)).collect();
        let (verb, list) = (if names.len() == 1 { "is" } else { "are" }, names.join(", "));
        let end = text.trim_end().len();
        let mut diagnostic = Diagnostic::error(
            UNCLOSED_ELEMENT,
            self.span(end..end),
            format!("the file ends before {list} {verb} closed"),
        );
        for element in self.open.iter().rev().take(3) {
            diagnostic = diagnostic.label(element.name_span, "opened here");
        }
        self.diagnostics
            .push(diagnostic.help(format!("is the file complete? If so, end it with `{closing}`")));
    }
}

/// Whether the definition gives `name` text and no elements.
fn holds_text(name: &str) -> bool {
    schema::element(name).is_some_and(|model| matches!(model.content, Content::Text))
}
