use std::ops::{Deref, DerefMut};

/// Numbers that begin at a cache line, so that a record of 8 lies in one.
#[derive(Clone, Debug, Default)]
pub struct Memory {
    lines: Vec<Line>,
    length: usize,
}

#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
struct Line([f64; 8]);

#[allow(unsafe_code)]
impl Memory {
    /// So many cache lines from the `at`-th group of so many on.
    ///
    /// # Panics
    /// If there are not so many.
    #[inline]
    pub fn lines<const LINES: usize>(&self, at: usize) -> &[[f64; 8]; LINES] {
        let lines = &self.lines.as_chunks::<LINES>().0[at];
        // SAFETY: a line is eight numbers without padding.
        unsafe { &*std::ptr::from_ref(lines).cast() }
    }

    /// The same, to be written.
    ///
    /// # Panics
    /// If there are not so many.
    #[inline]
    pub fn lines_mut<const LINES: usize>(&mut self, at: usize) -> &mut [[f64; 8]; LINES] {
        let lines = &mut self.lines.as_chunks_mut::<LINES>().0[at];
        // SAFETY: as `lines`; they are borrowed as a whole.
        unsafe { &mut *std::ptr::from_mut(lines).cast() }
    }

    /// So many zeros, and then these numbers.
    pub fn behind(zeros: usize, numbers: &[f64]) -> Self {
        let length = zeros + numbers.len();
        let mut memory = Memory { lines: vec![Line([0.0; 8]); length.div_ceil(8)], length };
        memory[zeros..].copy_from_slice(numbers);
        memory
    }
}

#[allow(unsafe_code)]
impl Deref for Memory {
    type Target = [f64];

    #[inline]
    fn deref(&self) -> &[f64] {
        // SAFETY: a line is eight numbers without padding, and there are at least `length` numbers in all lines.
        unsafe { std::slice::from_raw_parts(self.lines.as_ptr().cast::<f64>(), self.length) }
    }
}

#[allow(unsafe_code)]
impl DerefMut for Memory {
    #[inline]
    fn deref_mut(&mut self) -> &mut [f64] {
        // SAFETY: as `deref`; the lines are borrowed as a whole.
        unsafe { std::slice::from_raw_parts_mut(self.lines.as_mut_ptr().cast::<f64>(), self.length) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_kept_and_aligned() {
        for length in [0, 1, 7, 8, 9, 1000] {
            let numbers: Vec<f64> = (0..length).map(f64::from).collect();
            let mut memory = Memory::behind(3, &numbers);
            assert_eq!(memory[..3], [0.0; 3]);
            assert_eq!(memory[3..], numbers[..]);
            assert_eq!(memory.clone()[..], memory[..]);
            assert_eq!(memory.as_ptr() as usize % 64, 0);
            for at in 0..memory.len() / 16 {
                assert_eq!(memory.lines::<2>(at).as_flattened(), &memory[16 * at..][..16]);
                memory.lines_mut::<1>(at)[0][7] += 1.0;
                assert_eq!(memory.lines::<1>(at)[0][..], memory[8 * at..][..8]);
            }
            if let Some(last) = memory.last_mut() {
                *last = -1.0;
                assert_eq!(memory[length as usize + 2], -1.0);
            }
        }
    }
}
