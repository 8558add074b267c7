use sophy_diagnostics::{SourceId, Span, TextMap};
use std::ops::Range;

/// An element as written, with the place of everything.
#[derive(Debug)]
pub(crate) struct Element {
    /// The name as written.
    pub(crate) name: String,
    /// The name in the opening tag.
    pub(crate) name_span: Span,
    /// The opening tag.
    pub(crate) tag: Span,
    pub(crate) attributes: Vec<Attribute>,
    pub(crate) children: Vec<Node>,
    /// Whether its closing tag was found: if not, what it lacks may stand elsewhere.
    pub(crate) closed: bool,
    /// The element of the definition that was meant: the content check finds it.
    pub(crate) meant: Option<&'static str>,
}

#[derive(Debug)]
pub(crate) struct Attribute {
    pub(crate) name: String,
    pub(crate) name_span: Span,
    pub(crate) value: Text,
}

#[derive(Debug)]
pub(crate) enum Node {
    Element(Element),
    Text(Text),
}

impl Element {
    /// Index of the first child that is an element.
    pub(crate) fn first_child(&self) -> Option<usize> {
        self.children.iter().position(|node| matches!(node, Node::Element(_)))
    }

    /// The child elements, in written order.
    pub(crate) fn elements(&self) -> impl Iterator<Item = &Element> {
        self.children.iter().filter_map(|node| match node {
            Node::Element(element) => Some(element),
            Node::Text(_) => None,
        })
    }

    /// The child elements that are meant to be a `name`.
    pub(crate) fn all<'a>(&'a self, name: &'a str) -> impl Iterator<Item = &'a Element> {
        self.elements().filter(move |element| element.meant == Some(name))
    }

    /// The first child element that is meant to be a `name`.
    pub(crate) fn first(&self, name: &str) -> Option<&Element> {
        self.elements().find(|element| element.meant == Some(name))
    }

    /// The value of an attribute.
    pub(crate) fn attribute(&self, name: &str) -> Option<&Text> {
        self.attributes.iter().find(|attribute| attribute.name == name).map(|attribute| &attribute.value)
    }

    /// The value of the attribute that it must have. An attribute of another name is taken for it, which the
    /// content check has said.
    pub(crate) fn required_attribute(&self, name: &str) -> Option<&Text> {
        self.attribute(name).or_else(|| self.attributes.first().map(|attribute| &attribute.value))
    }

    /// All text between its tags, comments and child elements left out.
    pub(crate) fn text(&self) -> Text {
        // An empty text stands behind the opening tag.
        let mut text = Text::empty(self.tag.source, self.tag.end as usize);
        for node in &self.children {
            if let Node::Text(part) = node {
                text.append(part);
            }
        }
        text
    }
}

/// Where a text that is being read stands in the file.
#[derive(Clone, Debug)]
pub(crate) enum Place {
    /// Byte for byte from here.
    From(usize),
    /// It is the text of an entity; the reference to it stands here.
    Reference(Range<usize>),
}

impl Place {
    /// Where the part `range` of the text is.
    pub(crate) fn of(&self, range: Range<usize>) -> Range<usize> {
        match self {
            Place::From(start) => start + range.start..start + range.end,
            Place::Reference(reference) => reference.clone(),
        }
    }

    /// The place of the text without its first `length` bytes.
    pub(crate) fn after(&self, length: usize) -> Place {
        match self {
            Place::From(start) => Place::From(start + length),
            Place::Reference(reference) => Place::Reference(reference.clone()),
        }
    }
}

/// Text after references, sections and line ends are resolved, with the place of each of its bytes.
#[derive(Clone, Debug)]
pub(crate) struct Text {
    pub(crate) decoded: String,
    source: SourceId,
    /// Where the text would stand if it is empty.
    anchor: usize,
    pieces: Vec<Piece>,
    /// Something in it could not be understood and is left out; that has been said.
    pub(crate) damaged: bool,
}

#[derive(Clone, Debug)]
struct Piece {
    /// Number of decoded bytes.
    length: usize,
    /// The bytes of the source they come from.
    range: Range<usize>,
    /// Byte for byte, or as a whole (a reference)?
    exact: bool,
}

impl Text {
    pub(crate) fn empty(source: SourceId, anchor: usize) -> Self {
        Text { decoded: String::new(), source, anchor, pieces: Vec::new(), damaged: false }
    }

    /// Appends `text`, which is read as it stands at `place`.
    pub(crate) fn push_plain(&mut self, text: &str, place: &Place) {
        self.push(text, place.of(0..text.len()), matches!(place, Place::From(_)));
    }

    /// Appends `text`, which the source bytes `range` stand for as a whole.
    pub(crate) fn push_reference(&mut self, text: &str, range: Range<usize>) {
        self.push(text, range, false);
    }

    fn push(&mut self, text: &str, range: Range<usize>, exact: bool) {
        self.decoded.push_str(text);
        match self.pieces.last_mut() {
            Some(last) if exact && last.exact && last.range.end == range.start => {
                last.length += text.len();
                last.range.end = range.end;
            }
            Some(last) if !exact && !last.exact && last.range == range => last.length += text.len(),
            _ => self.pieces.push(Piece { length: text.len(), range, exact }),
        }
    }

    pub(crate) fn append(&mut self, other: &Text) {
        self.decoded.push_str(&other.decoded);
        self.pieces.extend(other.pieces.iter().cloned());
        self.damaged |= other.damaged;
    }

    pub(crate) fn is_blank(&self) -> bool {
        self.decoded.trim().is_empty()
    }

    /// The text without blanks around it, and its map.
    pub(crate) fn trimmed(&self) -> (&str, TextMap) {
        let trimmed = self.decoded.trim();
        let start = self.decoded.len() - self.decoded.trim_start().len();
        (trimmed, self.map(start..start + trimmed.len()))
    }

    /// The map of a part of the text.
    pub(crate) fn map(&self, part: Range<usize>) -> TextMap {
        let offset = |n: usize| u32::try_from(n).unwrap_or(u32::MAX);
        let mut map = TextMap::empty(self.source, offset(self.source_offset(part.start)));
        let mut start = 0;
        for Piece { length, range, exact } in &self.pieces {
            let (from, to) = (start.max(part.start), (start + length).min(part.end));
            if from < to && *exact {
                map.push(
                    offset(to - from),
                    offset(range.start + (from - start))..offset(range.start + (to - start)),
                );
            } else if from < to {
                // A map takes equal lengths as byte for byte. A reference that happens to be as long as what it
                // stands for goes in by two pieces, each of another length.
                let first = if to - from == range.len() { 1 } else { to - from };
                map.push(offset(first), offset(range.start)..offset(range.end));
                map.push(offset(to - from - first), offset(range.start)..offset(range.end));
            }
            start += length;
        }
        map
    }

    fn source_offset(&self, decoded: usize) -> usize {
        let mut start = 0;
        for Piece { length, range, exact } in &self.pieces {
            if decoded < start + length {
                return if *exact { range.start + (decoded - start) } else { range.start };
            }
            start += length;
        }
        self.pieces.last().map_or(self.anchor, |piece| piece.range.end)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use sophy_diagnostics::Sources;

    #[test]
    fn a_trimmed_text_knows_its_places() {
        let mut sources = Sources::default();
        let id = sources.add("a.xml", "<d> C &gt; H) </d>");
        let mut text = Text::empty(id, 3);
        text.push_plain(" C ", &Place::From(3));
        text.push_reference(">", 6..10);
        text.push_plain(" H) ", &Place::From(10));
        let (trimmed, map) = text.trimmed();
        assert_eq!(trimmed, "C > H)");
        assert_eq!(sources.excerpt(map.span(2..3)), "&gt;");
        assert_eq!(sources.excerpt(map.span(5..6)), ")");
        assert_eq!(sources.excerpt(map.whole()), "C &gt; H)");
    }

    #[test]
    fn a_reference_as_long_as_its_text_is_still_a_whole() {
        let mut sources = Sources::default();
        let id = sources.add("a.xml", "&é;");
        let mut text = Text::empty(id, 0);
        text.push_reference("abcd", 0..4);
        let map = text.map(0..4);
        for part in [0..1, 1..3, 2..4, 3..4] {
            assert_eq!(sources.excerpt(map.span(part)), "&é;");
        }
    }
}
