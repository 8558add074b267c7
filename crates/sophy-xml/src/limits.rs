//! What a file may cost. A model of ten thousand locations stays far below all of these.

/// Largest file, in bytes.
pub(crate) const MAX_BYTES: usize = 16 << 20;

/// Deepest nesting of elements; the definition needs seven.
pub(crate) const MAX_DEPTH: usize = 64;

/// Most elements, attributes and pieces of text together.
pub(crate) const MAX_NODES: usize = 1 << 20;

/// Most bytes that the references to declared entities may expand to, all together: in proportion to the file, so
/// that a few lines do not grow into a large document.
pub(crate) fn max_expansion(file: usize) -> usize {
    (8 * file).clamp(1 << 9, 1 << 20)
}

/// Most messages about one file; one with more is hardly what it was taken for.
pub(crate) const MAX_MESSAGES: usize = 250;

/// Deepest nesting of references to declared entities.
pub(crate) const MAX_ENTITY_DEPTH: usize = 10;
