//! What copies of a component repeat stands once: blocks, and what sources influence, up to numbers that go up by the same
//! from copy to copy.

use crate::blocks::{Gathered, Rates};
use crate::shapes::{Answer, Emitter};
use rustc_hash::FxHashMap;
use sophy_field::{
    Affine, Block, Call, Entry, Equations, Evaluation, Influence, Operand, RowResult, Site, Turn,
};
use sophy_ir::System;
use std::ops::Range;
use std::sync::Arc;

/// Finds what repeats. Two items have the same *form* if they are equal up to their numbers.
#[derive(Default)]
struct Repeats {
    /// By form: the pattern that the next item of this form may repeat.
    open: FxHashMap<Box<[u32]>, u32>,
    patterns: Vec<Pattern>,
    numbers: Vec<Affine>,
}

struct Pattern {
    /// How many copies there are.
    copies: u32,
    /// Where its numbers begin.
    numbers: usize,
}

impl Repeats {
    /// The next item: a copy of the last one of its form, if its numbers go on as they have begun.
    fn place(&mut self, form: &[u32], numbers: &[u32]) -> Site {
        if let Some(&pattern) = self.open.get(form) {
            let Pattern { copies, numbers: first } = &mut self.patterns[pattern as usize];
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
        self.patterns.push(Pattern { copies: 1, numbers: self.numbers.len() });
        self.numbers.extend(numbers.iter().map(|&number| Affine::fixed(number)));
        self.open.insert(form.into(), pattern);
        Site { pattern, copy: 0 }
    }

    /// The numbers of a pattern, in the order in which they were given.
    fn numbers(&self, pattern: usize) -> impl Iterator<Item = Affine> {
        self.numbers[self.patterns[pattern].numbers..].iter().copied()
    }
}

/// The blocks, as they stand once, with what computes them.
pub(crate) struct Blocks {
    /// Where each group of blocks begins that was gathered.
    groups: Vec<u32>,
    /// Which copy of what each is.
    sites: Vec<Site>,
    /// Where the blocks of each pattern begin.
    first: Vec<u32>,
}

impl Blocks {
    /// Fills the tables of blocks.
    pub(crate) fn new(
        system: &System,
        gathered: &mut Gathered,
        emitter: &mut Emitter<'_>,
        e: &mut Equations,
    ) -> Self {
        let groups = std::mem::take(&mut gathered.groups);
        let mut blocks = Blocks { sites: Vec::with_capacity(groups.len()), groups, first: Vec::new() };
        let (mut repeats, mut form, mut numbers) = (Repeats::default(), Vec::new(), Vec::new());
        let mut answers: Vec<Answer> = Vec::new();
        for (group, &first) in blocks.groups.iter().enumerate() {
            let end = blocks.groups.get(group + 1).map_or(gathered.blocks.len(), |&next| next as usize);
            let members = &gathered.blocks[first as usize..end];
            answers.resize_with(answers.len().max(members.len()), Answer::default);
            form.clear();
            numbers.clear();
            numbers.push(first);
            for (rates, answer) in members.iter().zip(&mut answers) {
                emitter.answer(rates.request, answer);
                let (rows, reads) = (gathered.rows_of(rates), gathered.reads_of(rates));
                let lengths = [answer.operands.len(), reads.len(), rows.len()];
                form.push(answer.program);
                form.extend(lengths.map(|length| length as u32));
                numbers.extend_from_slice(&answer.operands);
                numbers.extend(reads.iter().map(|source| source.0));
                for (&rate, &result) in rows.iter().zip(&answer.results) {
                    let (is_jet, at) = place(result);
                    form.extend(declaration(system, rate.state.position()));
                    form.push(u32::from(is_jet) | u32::from(gathered.bends(rate)) << 1);
                    numbers.extend([rate.state.0, at]);
                }
            }
            let site = repeats.place(&form, &numbers);
            blocks.sites.push(site);
            if site.copy == 0 {
                blocks.first.push(e.blocks.len() as u32);
                for (rates, answer) in members.iter().zip(&answers) {
                    let block = block(gathered, rates, answer, e);
                    e.blocks.push(block);
                }
            }
        }
        blocks.number(&repeats, e);
        blocks
    }

    /// Gives all blocks their numbers.
    fn number(&self, repeats: &Repeats, e: &mut Equations) {
        for (pattern, &first) in self.first.iter().enumerate() {
            let end = self.first.get(pattern + 1).map_or(e.blocks.len(), |&next| next as usize);
            let mut numbers = repeats.numbers(pattern);
            let mut next = || numbers.next().unwrap_or_default();
            let rank = next();
            for block in &mut e.blocks[first as usize..end] {
                block.rank = rank;
                e.operands[span(&block.call.operands)].fill_with(&mut next);
                e.reads[span(&block.reads)].fill_with(&mut next);
                for row in &mut e.rows[span(&block.rows)] {
                    (row.state, row.at) = (next(), next());
                }
            }
        }
    }

    /// The turn of an entry.
    fn turn(&self, entry: Entry) -> Turn {
        let group = self.groups.partition_point(|&first| first < entry.first);
        let Site { pattern, copy } = self.sites[group];
        Turn { first: self.first[pattern as usize], copy, owner: entry.owner }
    }

    /// The turns of ranges of entries, in a row, and their ranges.
    pub(crate) fn turns(
        &self,
        entries: &[Entry],
        ranges: Vec<Range<u32>>,
        turns: &mut Vec<Turn>,
    ) -> Vec<Range<u32>> {
        let turns_of = |range: Range<u32>| {
            let start = turns.len() as u32;
            turns.extend(entries[span(&range)].iter().map(|&entry| self.turn(entry)));
            start..turns.len() as u32
        };
        ranges.into_iter().map(turns_of).collect()
    }

    /// Fills the tables of what sources influence, from the entries that they influence and, of states, their own.
    pub(crate) fn influences(
        &self,
        system: &System,
        entries: &[Entry],
        influence: &[Range<u32>],
        own: &[Range<u32>],
        e: &mut Equations,
    ) {
        let (mut repeats, mut form, mut numbers) = (Repeats::default(), Vec::new(), Vec::new());
        e.sites.reserve_exact(influence.len());
        for (source, on_step) in influence.iter().enumerate() {
            let own = own.get(source).cloned().unwrap_or_default();
            form.clear();
            numbers.clear();
            form.extend(declaration(system, source));
            form.push(on_step.len() as u32);
            for range in [on_step, &own] {
                for &entry in &entries[span(range)] {
                    let Turn { first, copy, owner } = self.turn(entry);
                    form.push(first);
                    numbers.extend([copy, owner.0]);
                }
            }
            let site = repeats.place(&form, &numbers);
            e.sites.push(site);
            if site.copy == 0 {
                let [on_step, own] = [on_step, &own].map(|range| {
                    let start = e.evaluations.len() as u32;
                    let zero = Affine::default();
                    let evaluations = entries[span(range)].iter().map(|&entry| Evaluation {
                        first: self.turn(entry).first,
                        copy: zero,
                        owner: zero,
                    });
                    e.evaluations.extend(evaluations);
                    start..e.evaluations.len() as u32
                });
                e.influences.push(Influence { on_step, own });
            }
        }
        for (pattern, influence) in e.influences.iter().enumerate() {
            let mut numbers = repeats.numbers(pattern);
            let mut next = || numbers.next().unwrap_or_default();
            let evaluations = influence.on_step.start as usize..influence.own.end as usize;
            for evaluation in &mut e.evaluations[evaluations] {
                (evaluation.copy, evaluation.owner) = (next(), next());
            }
        }
    }
}

/// A block whose numbers are still to come.
fn block(gathered: &Gathered, rates: &Rates, answer: &Answer, e: &mut Equations) -> Block {
    let (rows, zero) = (gathered.rows_of(rates), Affine::default());
    let operands = more(&mut e.operands, answer.operands.iter().map(|_| zero));
    let reads = more(&mut e.reads, gathered.reads_of(rates).iter().map(|_| zero));
    let results = rows.iter().zip(&answer.results).map(|(&rate, &result)| RowResult {
        state: zero,
        at: zero,
        is_jet: place(result).0,
        bends: gathered.bends(rate),
    });
    let call = Call { program: answer.program, operands };
    // An algebraic variable, which has no rows, may bend what reads it.
    let bends = rows.is_empty() || rows.iter().any(|&rate| gathered.bends(rate));
    Block { call, reads, rows: more(&mut e.rows, results), bends, rank: zero }
}

/// Whether a result is a jet, and where it stands.
fn place(result: Operand) -> (bool, u32) {
    match result {
        Operand::Jet(at) => (true, at),
        Operand::Scalar(at) => (false, at),
    }
}

/// Of what declaration a source is the copy: two numbers; of those that are no states, none.
fn declaration(system: &System, source: usize) -> [u32; 2] {
    let address = system.states.get(source).map_or(0, |state| Arc::as_ptr(&state.declared).addr());
    [address as u32, (address >> 32) as u32]
}

/// Appends to a table; what was appended.
fn more<T>(table: &mut Vec<T>, items: impl Iterator<Item = T>) -> Range<u32> {
    let start = table.len() as u32;
    table.extend(items);
    start..table.len() as u32
}

fn span(range: &Range<u32>) -> Range<usize> {
    range.start as usize..range.end as usize
}

#[cfg(test)]
mod tests {
    use super::Repeats;
    use proptest::prelude::*;
    use sophy_field::Site;

    proptest! {
        /// Whatever comes, the numbers of a site are those that were given for it.
        #[test]
        fn every_item_keeps_its_numbers(items in prop::collection::vec((0..3_u32, 0..3_u32, any::<bool>()), 1..60)) {
            let mut repeats = Repeats::default();
            let items: Vec<[u32; 3]> = (0_u32..)
                .zip(items)
                .map(|(k, (form, odd, goes_on))| if goes_on { [form, 7 * k, 100 - k] } else { [form, odd, odd] })
                .collect();
            let sites: Vec<Site> = items.iter().map(|[form, numbers @ ..]| repeats.place(&[*form], numbers)).collect();
            for ([_, a, b], site) in items.iter().zip(sites) {
                let mut numbers = repeats.numbers(site.pattern as usize).map(|number| number.of(site.copy));
                prop_assert_eq!([numbers.next(), numbers.next()], [Some(*a), Some(*b)]);
            }
        }
    }

    #[test]
    fn what_goes_on_evenly_stands_once() {
        let mut repeats = Repeats::default();
        for k in 0..1000_u32 {
            let site = repeats.place(&[1], &[5 * k, 3000 - k, 7]);
            assert_eq!((site.pattern, site.copy), (0, k));
        }
        assert_eq!(repeats.numbers.len(), 3);
    }
}
