//! Finds what copies of a component repeat.
//!
//! What is to be kept is written down in two streams: its *form*, which copies have in common, and its *numbers*, which go
//! up by the same from copy to copy. Whatever repeats stands once, and is read from the streams again when all is known.

use rustc_hash::FxHashMap;
use sophy_field::{Affine, Site};

/// One item, written down.
#[derive(Debug, Default)]
pub(crate) struct Draft {
    form: Vec<u32>,
    numbers: Vec<u32>,
}

impl Draft {
    /// Something that copies have in common.
    pub(crate) fn form(&mut self, word: u32) {
        self.form.push(word);
    }

    /// Several of these.
    pub(crate) fn forms(&mut self, words: impl IntoIterator<Item = u32>) {
        self.form.extend(words);
    }

    /// How many there are of what follows.
    pub(crate) fn count(&mut self, count: usize) {
        self.form.push(count as u32);
    }

    /// A number that copies have for themselves.
    pub(crate) fn number(&mut self, number: u32) {
        self.numbers.push(number);
    }

    /// So many numbers.
    pub(crate) fn numbers(&mut self, numbers: impl ExactSizeIterator<Item = u32>) {
        self.count(numbers.len());
        self.numbers.extend(numbers);
    }
}

/// What has been written down so far.
#[derive(Debug, Default)]
pub(crate) struct Repeats {
    /// By form: the pattern that the next item of this form may repeat.
    open: FxHashMap<Box<[u32]>, u32>,
    patterns: Vec<Pattern>,
    forms: Vec<u32>,
    numbers: Vec<Affine>,
    draft: Draft,
}

#[derive(Debug)]
struct Pattern {
    /// How many copies there are.
    copies: u32,
    /// Where its form and its numbers begin.
    form: usize,
    numbers: usize,
}

impl Repeats {
    /// Writes down an item: a copy of the last one of its form, if its numbers go on as they have begun.
    pub(crate) fn add(&mut self, write: impl FnOnce(&mut Draft)) -> Site {
        self.draft.form.clear();
        self.draft.numbers.clear();
        write(&mut self.draft);
        let Draft { form, numbers } = &self.draft;
        if let Some(&pattern) = self.open.get(form.as_slice()) {
            let Pattern { copies, numbers: first, .. } = &mut self.patterns[pattern as usize];
            let known = &mut self.numbers[*first..][..numbers.len()];
            if *copies == 1 {
                for (known, number) in known.iter_mut().zip(numbers) {
                    known.stride = number.wrapping_sub(known.first);
                }
            }
            if known.iter().zip(numbers).all(|(known, &number)| known.of(*copies) == number) {
                *copies += 1;
                return Site { pattern, copy: *copies - 1 };
            }
        }
        let pattern = self.patterns.len() as u32;
        self.patterns.push(Pattern { copies: 1, form: self.forms.len(), numbers: self.numbers.len() });
        self.forms.extend_from_slice(form);
        self.numbers.extend(numbers.iter().map(|&number| Affine::fixed(number)));
        self.open.insert(form.as_slice().into(), pattern);
        Site { pattern, copy: 0 }
    }

    /// What stands once, in the order of [`Site::pattern`].
    pub(crate) fn read<'a, T>(&'a self, mut read: impl FnMut(&mut Reading<'a>) -> T) -> Vec<T> {
        let readings = self.patterns.iter().map(|pattern| Reading {
            form: self.forms[pattern.form..].iter(),
            numbers: self.numbers[pattern.numbers..].iter(),
        });
        readings.map(|mut reading| read(&mut reading)).collect()
    }
}

/// What stands once, to be read as it was written.
pub(crate) struct Reading<'a> {
    form: std::slice::Iter<'a, u32>,
    numbers: std::slice::Iter<'a, Affine>,
}

impl Reading<'_> {
    /// What [`Draft::form`] wrote.
    pub(crate) fn form(&mut self) -> u32 {
        self.form.next().copied().unwrap_or_default()
    }

    /// What [`Draft::forms`] wrote, so many.
    pub(crate) fn forms<const N: usize>(&mut self) -> [u32; N] {
        std::array::from_fn(|_| self.form())
    }

    /// What [`Draft::number`] wrote.
    pub(crate) fn number(&mut self) -> Affine {
        self.numbers.next().copied().unwrap_or_default()
    }

    /// What [`Draft::numbers`] wrote.
    pub(crate) fn numbers(&mut self) -> impl Iterator<Item = Affine> {
        let count = self.form() as usize;
        self.numbers.by_ref().take(count).copied()
    }

    /// So many things as [`Draft::count`] wrote.
    pub(crate) fn several<T>(&mut self, mut read: impl FnMut(&mut Self) -> T) -> Vec<T> {
        (0..self.form()).map(|_| read(self)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        /// Whatever comes, an item is read as it was written.
        #[test]
        fn every_item_keeps_its_numbers(
            items in prop::collection::vec((0..3_u32, 0..3_u32, any::<bool>()), 1..60)
        ) {
            let mut repeats = Repeats::default();
            let items: Vec<[u32; 3]> = (0_u32..)
                .zip(items)
                .map(|(k, (form, odd, goes_on))| if goes_on { [form, 7 * k, 100 - k] } else { [form, odd, odd] })
                .collect();
            let sites: Vec<Site> = items
                .iter()
                .map(|&[form, a, b]| {
                    repeats.add(|draft| {
                        draft.form(form);
                        draft.numbers([a, b].into_iter());
                    })
                })
                .collect();
            let patterns = repeats.read(|reading| (reading.form(), reading.numbers().collect::<Vec<_>>()));
            for ([form, a, b], Site { pattern, copy }) in items.iter().zip(sites) {
                let (known, numbers) = &patterns[pattern as usize];
                prop_assert_eq!(known, form);
                prop_assert_eq!(numbers.iter().map(|n| n.of(copy)).collect::<Vec<_>>(), [*a, *b]);
            }
        }
    }

    #[test]
    fn what_goes_on_evenly_stands_once() {
        let mut repeats = Repeats::default();
        for k in 0..1000_u32 {
            let site = repeats.add(|draft| draft.numbers([5 * k, 3000 - k, 7].into_iter()));
            assert_eq!((site.pattern, site.copy), (0, k));
        }
        assert_eq!(repeats.numbers.len(), 3);
    }
}
