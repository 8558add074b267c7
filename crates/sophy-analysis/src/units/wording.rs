use std::fmt;

/// Bytes kept of a unit string; few are longer.
const LONGEST: usize = 22;

/// A unit in the modeller's words: as written, or put together of written ones.
///
/// It is kept in place, so that units stay small values; what is too long is forgotten, and messages make a name
/// of the dimension.
#[derive(Clone, Copy)]
pub(crate) struct Wording {
    bytes: [u8; LONGEST],
    length: u8,
    /// Whether products or quotients were made of what was written.
    derived: bool,
}

impl Wording {
    /// No words.
    pub(super) const NONE: Wording = Wording { bytes: [0; LONGEST], length: 0, derived: false };

    /// As written.
    pub(super) fn of(text: &str) -> Wording {
        let mut wording = Wording::NONE;
        if let Some(bytes) = wording.bytes.get_mut(..text.len()) {
            bytes.copy_from_slice(text.as_bytes());
            wording.length = text.len() as u8;
        }
        wording
    }

    /// A product or quotient of two.
    pub(super) fn combined(left: Wording, right: Wording, operator: &str) -> Wording {
        let (Some(a), Some(b)) = (left.text(), right.text()) else { return Wording::NONE };
        let single = |text: &str| text.chars().all(char::is_alphanumeric);
        let text = match (operator, single(b)) {
            (_, true) => format!("{a}{operator}{b}"),
            _ => format!("{a}{operator}({b})"),
        };
        Wording { derived: true, ..Wording::of(&text) }
    }

    /// The words, if there are any.
    pub(super) fn text(&self) -> Option<&str> {
        let bytes = self.bytes.get(..usize::from(self.length))?;
        std::str::from_utf8(bytes).ok().filter(|text| !text.is_empty())
    }

    /// The words, if they stand so in the model.
    pub(super) fn as_written(&self) -> Option<&str> {
        self.text().filter(|_| !self.derived)
    }
}

impl fmt::Debug for Wording {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:?}", self.text())
    }
}
