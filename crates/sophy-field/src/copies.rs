//! What copies of a component have in common stands once.

/// A number that each copy has for itself, from copy to copy at the same distance: `first + copy · stride`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(C)]
pub struct Affine {
    /// That of copy 0.
    pub first: u32,
    /// From one copy to the next, modulo 2³².
    pub stride: u32,
}

impl Affine {
    /// The same number for all copies.
    pub const fn fixed(number: u32) -> Self {
        Affine { first: number, stride: 0 }
    }

    /// The number of a copy.
    #[inline]
    pub const fn of(self, copy: u32) -> u32 {
        self.first.wrapping_add(copy.wrapping_mul(self.stride))
    }
}

/// Something that stands once for all its copies, and which of them is meant.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Site {
    /// What stands once.
    pub pattern: u32,
    /// Which copy, from 0.
    pub copy: u32,
}

#[cfg(test)]
mod tests {
    use super::Affine;

    #[test]
    fn numbers_may_fall_from_copy_to_copy() {
        let falling = Affine { first: 10, stride: 2_u32.wrapping_neg() };
        assert_eq!([0, 1, 5].map(|copy| falling.of(copy)), [10, 8, 0]);
        assert_eq!(Affine::fixed(7).of(1000), 7);
    }
}
