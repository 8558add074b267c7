use crate::{SourceId, Span};
use std::ops::Range;

/// Where each byte of a decoded text stands in its source.
///
/// An expression inside XML is read after entities are resolved (`&gt;` is `>`); the grammar sees the decoded
/// text and its offsets, messages need those of the file. A piece maps a run of decoded bytes to a run of
/// source bytes: one to one if both have equal length, else as a whole (an entity reference).
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TextMap {
    source: SourceId,
    /// Sorted by `decoded.start`, without gaps.
    pieces: Vec<Piece>,
    /// Where an empty text would stand.
    anchor: u32,
}

#[derive(Clone, Debug, PartialEq, Eq)]
struct Piece {
    decoded: Range<u32>,
    source: Range<u32>,
}

impl TextMap {
    /// The map of an empty text that stands at `anchor`.
    pub fn empty(source: SourceId, anchor: u32) -> Self {
        TextMap { source, pieces: Vec::new(), anchor }
    }

    /// The map of a text of `length` bytes that stands in `source` as it is, from byte `start`.
    pub fn plain(source: SourceId, start: u32, length: u32) -> Self {
        let mut map = TextMap::empty(source, start);
        map.push(length, start..start + length);
        map
    }

    /// Appends `decoded_length` decoded bytes that come from `source` bytes.
    pub fn push(&mut self, decoded_length: u32, source: Range<u32>) {
        let start = self.pieces.last().map_or(0, |piece| piece.decoded.end);
        if decoded_length == 0 {
            return;
        }
        let exact = source.end - source.start == decoded_length;
        if let Some(last) = self.pieces.last_mut()
            && exact
            && last.source.end == source.start
            && last.source.end - last.source.start == last.decoded.end - last.decoded.start
        {
            last.decoded.end += decoded_length;
            last.source.end = source.end;
            return;
        }
        self.pieces.push(Piece { decoded: start..start + decoded_length, source });
    }

    /// The source of all pieces.
    pub fn source(&self) -> SourceId {
        self.source
    }

    /// The span of a range of the decoded text. An empty range at the end is the end.
    pub fn span(&self, decoded: Range<usize>) -> Span {
        let clamp = |offset: usize| u32::try_from(offset).unwrap_or(u32::MAX);
        let start = self.source_offset(clamp(decoded.start), false);
        let end = if decoded.is_empty() { start } else { self.source_offset(clamp(decoded.end), true) };
        Span { source: self.source, start, end: end.max(start) }
    }

    /// The span of the whole text.
    pub fn whole(&self) -> Span {
        let start = self.pieces.first().map_or(self.anchor, |piece| piece.source.start);
        let end = self.pieces.last().map_or(self.anchor, |piece| piece.source.end);
        Span { source: self.source, start, end: end.max(start) }
    }

    /// Offset in the source of decoded `offset`; `as_end` takes it as the end of a range.
    fn source_offset(&self, offset: u32, as_end: bool) -> u32 {
        let inside = |piece: &&Piece| {
            if as_end {
                piece.decoded.start < offset && offset <= piece.decoded.end
            } else {
                piece.decoded.start <= offset && offset < piece.decoded.end
            }
        };
        let Some(piece) = self.pieces.iter().find(inside) else {
            return self.pieces.last().map_or(self.anchor, |piece| piece.source.end);
        };
        let one_to_one = piece.source.end - piece.source.start == piece.decoded.end - piece.decoded.start;
        match (one_to_one, as_end) {
            (true, _) => piece.source.start + (offset - piece.decoded.start),
            (false, true) => piece.source.end,
            (false, false) => piece.source.start,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Sources;

    #[test]
    fn an_entity_maps_as_a_whole() {
        let mut sources = Sources::default();
        let text = "<domain>C &gt; HFull)</domain>";
        let id = sources.add("b.xml", text);
        let mut map = TextMap::empty(id, 8);
        map.push(2, 8..10); // "C "
        map.push(1, 10..14); // ">"
        map.push(7, 14..21); // " HFull)"
        let under = |range| sources.excerpt(map.span(range)).to_owned();
        assert_eq!(under(0..1), "C");
        assert_eq!(under(2..3), "&gt;");
        assert_eq!(under(4..9), "HFull");
        assert_eq!(under(0..10), "C &gt; HFull)");
        assert_eq!(map.span(10..10).start, 21);
        assert_eq!(sources.excerpt(map.whole()), "C &gt; HFull)");
    }
}
