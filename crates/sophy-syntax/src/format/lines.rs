use super::WIDTH;

/// A token on a line.
pub(super) struct Piece<'t> {
    pub(super) text: &'t str,
    /// Whether a space stands before it.
    pub(super) space: bool,
    /// Whether a line that is too long may go on here; breaks of less depth are taken first.
    pub(super) depth: Option<u16>,
    /// Whether all breaks of this depth are taken: the rows of a matrix.
    pub(super) all: bool,
    /// Whether comments come after it, inside of an item.
    pub(super) commented: bool,
}

impl Piece<'_> {
    fn width(&self) -> usize {
        self.text.chars().count() + usize::from(self.space)
    }
}

/// A comment.
pub(super) struct Comment<'t> {
    pub(super) text: &'t str,
    /// Whether it stands on a line of its own.
    pub(super) own_line: bool,
    /// Whether a blank line stands before it.
    pub(super) after_blank: bool,
}

/// Writes the pieces of an item, on as many lines as they need; the last line is not ended. `comments` are those after
/// each piece that has some, in order.
pub(super) fn write(out: &mut String, pieces: &[Piece<'_>], comments: &[Vec<Comment<'_>>], indent: usize) {
    let further = indent + 4;
    let mut comments = comments.iter();
    let chunks = pieces.split_inclusive(|piece| piece.commented);
    for (index, chunk) in chunks.enumerate() {
        if index > 0 {
            out.push('\n');
        }
        fit(out, chunk, if index == 0 { indent } else { further }, further);
        let commented = chunk.last().is_some_and(|piece| piece.commented);
        for comment in commented.then(|| comments.next()).flatten().into_iter().flatten() {
            if comment.own_line {
                out.push('\n');
                spaces(out, further);
            } else {
                out.push_str("  ");
            }
            out.push_str(comment.text);
        }
    }
}

pub(super) fn spaces(out: &mut String, number: usize) {
    out.extend(std::iter::repeat_n(' ', number));
}

fn width(pieces: &[Piece<'_>]) -> usize {
    pieces.iter().map(Piece::width).sum()
}

/// Writes `pieces`, the first line with `indent`, those after it with `further`.
fn fit(out: &mut String, pieces: &[Piece<'_>], indent: usize, further: usize) {
    let breaks = pieces.iter().skip(1).filter_map(|piece| piece.depth);
    let Some(depth) = breaks.min().filter(|_| indent + width(pieces) > WIDTH) else {
        line(out, pieces, indent);
        return;
    };
    let here = |piece: &Piece<'_>| piece.depth == Some(depth);
    let all = pieces.iter().skip(1).any(|piece| here(piece) && piece.all);
    let (mut start, mut end, mut used, mut indent) = (0, 0, 0, indent);
    while end < pieces.len() {
        let part = end + 1 + pieces.iter().skip(end + 1).position(here).unwrap_or(pieces.len() - end - 1);
        let part_width = width(pieces.get(end..part).unwrap_or(&[]));
        if end > start && (all || indent + used + part_width > WIDTH) {
            fit(out, pieces.get(start..end).unwrap_or(&[]), indent, further);
            out.push('\n');
            indent = if all { indent.max(further) + usize::from(start == 0) } else { further };
            (start, used) = (end, 0);
        }
        used += part_width;
        end = part;
    }
    fit(out, pieces.get(start..).unwrap_or(&[]), indent, further);
}

fn line(out: &mut String, pieces: &[Piece<'_>], indent: usize) {
    spaces(out, indent);
    for (index, piece) in pieces.iter().enumerate() {
        if piece.space && index > 0 {
            out.push(' ');
        }
        out.push_str(piece.text);
    }
}
