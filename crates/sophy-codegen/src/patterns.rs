//! What was gathered becomes tables in which copies of a component stand once: each item is written down with its numbers,
//! and what repeats is read once.

use crate::automata::{Selects, read_automaton};
use crate::blocks::{Entry, Gathered, Rates, Wanted};
use crate::logic::{Leads, read_transition};
use crate::memory::Operand;
use crate::repeats::{Draft, Reading, Repeats};
use crate::shapes::{Answer, Emitter, Programs, RequestIndex};
use crate::watches::{Watched, read_watch};
use sophy_field::{
    Affine, AutomatonCode, Block, Call, Equations, Evaluation, Formula, Influence, RowResult, Site,
    TransitionCode, Turn, WatchCode,
};
use sophy_ir::System;
use std::ops::Range;

/// What stands in a row, one per location: blocks, calls or formulas.
#[derive(Debug, Default)]
struct Groups {
    /// Where each begins among what was gathered.
    starts: Vec<u32>,
    /// Which copy of what pattern each is.
    sites: Vec<Site>,
    /// Per pattern: where it begins in its table.
    first: Vec<u32>,
}

impl Groups {
    /// Writes down all groups of `items`, which begin at `starts`.
    fn add<T>(
        starts: Vec<u32>,
        items: &[T],
        repeats: &mut Repeats,
        mut write: impl FnMut(&T, &mut Draft),
        mut head: impl FnMut(u32, &mut Draft),
    ) -> Self {
        let mut sites = Vec::with_capacity(starts.len());
        for (group, &start) in starts.iter().enumerate() {
            let end = starts.get(group + 1).map_or(items.len(), |&next| next as usize);
            let group = &items[start as usize..end];
            sites.push(repeats.add(|draft| {
                head(start, draft);
                draft.count(group.len());
                group.iter().for_each(|item| write(item, draft));
            }));
        }
        Groups { starts, sites, first: Vec::new() }
    }

    /// Reads what stands once into a table.
    fn read<T>(&mut self, repeats: &Repeats, mut read: impl FnMut(&mut Reading<'_>) -> Vec<T>) -> Vec<T> {
        let mut table = Vec::new();
        let first = repeats.read(|reading| {
            let first = table.len() as u32;
            table.extend(read(reading));
            first
        });
        self.first = first;
        table
    }

    /// Where what was gathered stands now.
    fn turn(&self, asked: Entry) -> Turn {
        let group = self.starts.partition_point(|&start| start < asked.first);
        let Site { pattern, copy } = self.sites[group];
        Turn { first: self.first[pattern as usize], copy, owner: asked.owner }
    }

    fn write(&self, asked: &[Entry], draft: &mut Draft) {
        draft.count(asked.len());
        for &asked in asked {
            let Turn { first, copy, owner } = self.turn(asked);
            draft.form(first);
            draft.number(copy);
            draft.number(owner.0);
        }
    }
}

/// Makes the tables.
pub(crate) struct Tables<'a> {
    system: &'a System,
    gathered: &'a Gathered,
    scribe: Scribe<'a>,
    blocks: Groups,
    calls: Groups,
    pub(crate) equations: Equations,
}

/// Writes down what programs answer.
struct Scribe<'a> {
    emitter: Emitter<'a>,
    answer: Answer,
}

impl Scribe<'_> {
    /// A call; where its values stand is in the answer.
    fn call(&mut self, request: RequestIndex, draft: &mut Draft) {
        self.emitter.answer(request, &mut self.answer);
        draft.form(self.answer.program);
        draft.numbers(self.answer.operands.iter().copied());
    }

    fn formula(&mut self, wanted: &Wanted, gathered: &Gathered, calls: &Groups, draft: &mut Draft) {
        self.call(wanted.request, draft);
        write_place(self.answer.results.first().copied().unwrap_or(Operand::Scalar(0)), draft);
        let sources = &gathered.sources[span(&wanted.sources)];
        draft.numbers(sources.iter().map(|source| source.0));
        calls.write(&gathered.before[span(&wanted.before)], draft);
    }
}

impl<'a> Tables<'a> {
    /// Blocks and calls first: all else refers to them.
    pub(crate) fn new(
        system: &'a System,
        gathered: &'a mut Gathered,
        emitter: Emitter<'a>,
        mut equations: Equations,
    ) -> Self {
        let starts = [&mut gathered.groups, &mut gathered.call_groups].map(std::mem::take);
        let mut scribe = Scribe { emitter, answer: Answer::default() };
        let [block_starts, call_starts] = starts;
        let gathered = &*gathered;

        let mut repeats = Repeats::default();
        let write = |rates: &Rates, draft: &mut Draft| {
            scribe.call(rates.request, draft);
            draft.numbers(gathered.reads_of(rates).iter().map(|source| source.0));
            let rows = gathered.rows_of(rates);
            draft.count(rows.len());
            for (&rate, &result) in rows.iter().zip(&scribe.answer.results) {
                draft.forms(declaration(system, rate.state.position()));
                draft.number(rate.state.0);
                write_place(result, draft);
                draft.form(u32::from(gathered.bends(rate)));
            }
        };
        let mut blocks = Groups::add(block_starts, &gathered.blocks, &mut repeats, write, |start, draft| {
            draft.number(start);
        });
        equations.blocks = blocks.read(&repeats, |reading| {
            let rank = reading.number();
            reading.several(|reading| read_block(reading, rank))
        });

        let mut repeats = Repeats::default();
        let write = |&request: &RequestIndex, draft: &mut Draft| scribe.call(request, draft);
        let mut calls = Groups::add(call_starts, &gathered.calls, &mut repeats, write, |_, _| {});
        equations.calls = calls.read(&repeats, |reading| reading.several(read_call));

        Tables { system, gathered, scribe, blocks, calls, equations }
    }

    /// What sources influence, and what computes the rates of states.
    pub(crate) fn influences(&mut self, influence: &[Range<u32>], own: &[Range<u32>]) {
        let (mut repeats, entries) = (Repeats::default(), &self.gathered.entries);
        self.equations.sites.reserve_exact(influence.len());
        for (source, on_step) in influence.iter().enumerate() {
            let own = own.get(source).cloned().unwrap_or_default();
            self.equations.sites.push(repeats.add(|draft| {
                draft.forms(declaration(self.system, source));
                self.blocks.write(&entries[span(on_step)], draft);
                self.blocks.write(&entries[span(&own)], draft);
            }));
        }
        let e = &mut self.equations;
        e.influences = repeats.read(|reading| {
            let _declaration: [u32; 2] = reading.forms();
            Influence { on_step: read_turns(reading), own: read_turns(reading) }
        });
    }

    /// Outputs, each a formula per location.
    pub(crate) fn outputs(&mut self, outputs: &[Entry]) {
        let (Tables { gathered, scribe, calls, equations: e, .. }, mut repeats) = (self, Repeats::default());
        let starts = outputs.iter().map(|output| output.first).collect();
        let write = |wanted: &Wanted, draft: &mut Draft| scribe.formula(wanted, gathered, calls, draft);
        let mut formulas = Groups::add(starts, &gathered.formulas, &mut repeats, write, |_, _| {});
        e.formulas = formulas.read(&repeats, |reading| reading.several(read_formula));
        e.outputs = outputs.iter().map(|&output| formulas.turn(output)).collect();
    }

    /// Watches, and per watch the entries to evaluate when what it decides changes.
    pub(crate) fn watches(&mut self, watches: &[Watched], on_change: &[Range<u32>]) {
        let (Tables { gathered, scribe, calls, blocks, equations: e, .. }, mut repeats) =
            (self, Repeats::default());
        let sites = watches.iter().zip(on_change).map(|(watch, on_change)| {
            repeats.add(|draft| {
                for formula in [&watch.formula, &watch.left, &watch.right] {
                    scribe.formula(formula, gathered, calls, draft);
                }
                watch.write(draft);
                blocks.write(&gathered.entries[span(on_change)], draft);
            })
        });
        e.watches = sites.collect();
        e.watch_codes = repeats.read(|reading| {
            let [formula, left, right] = [0, 1, 2].map(|_| read_formula(reading));
            let code = WatchCode { formula, left, right, ..read_watch(reading) };
            WatchCode { on_change: read_turns(reading), ..code }
        });
    }

    /// Automata, and per automaton the entries to evaluate when its location changes.
    pub(crate) fn automata(&mut self, automata: &[Selects], on_change: &[Range<u32>]) {
        let (Tables { gathered, blocks, equations: e, .. }, mut repeats) = (self, Repeats::default());
        let sites = automata.iter().zip(on_change).map(|(automaton, on_change)| {
            repeats.add(|draft| {
                blocks.write(&gathered.entries[span(on_change)], draft);
                automaton.write(draft);
            })
        });
        e.automata = sites.collect();
        e.automaton_codes = repeats.read(|reading| {
            let on_change = read_turns(reading);
            AutomatonCode { on_change, ..read_automaton(reading) }
        });
    }

    /// Transitions.
    pub(crate) fn transitions(&mut self, transitions: &[Leads]) -> (Vec<TransitionCode>, Vec<Site>) {
        let (Tables { gathered, scribe, calls, .. }, mut repeats) = (self, Repeats::default());
        let sites = transitions.iter().map(|transition| {
            repeats.add(|draft| {
                transition.write(draft, |wanted, draft| scribe.formula(wanted, gathered, calls, draft));
            })
        });
        let sites = sites.collect();
        (repeats.read(|reading| read_transition(reading, read_formula)), sites)
    }

    /// All tables, and the programs they run.
    pub(crate) fn finish(self) -> (Equations, Programs) {
        (self.equations, self.scribe.emitter.finish())
    }
}

fn read_call(reading: &mut Reading<'_>) -> Call {
    Call { program: reading.form(), operands: reading.numbers().collect() }
}

fn read_block(reading: &mut Reading<'_>, rank: Affine) -> Block {
    let (call, reads) = (read_call(reading), reading.numbers().collect());
    let rows = reading.several(|reading| {
        let _declaration: [u32; 2] = reading.forms();
        let state = reading.number();
        let (is_jet, at) = read_place(reading);
        RowResult { state, at, is_jet, bends: reading.form() != 0 }
    });
    // An algebraic variable, which has no rows, may bend what reads it.
    let bends = rows.is_empty() || rows.iter().any(|row| row.bends);
    Block { call, reads, rows: rows.into(), bends, rank }
}

fn read_formula(reading: &mut Reading<'_>) -> Formula {
    let call = read_call(reading);
    let (is_jet, at) = read_place(reading);
    Formula { call, reads: reading.numbers().collect(), before: read_turns(reading), at, is_jet }
}

/// What [`Groups::write`] wrote.
fn read_turns(reading: &mut Reading<'_>) -> Box<[Evaluation]> {
    let turns = reading.several(|reading| Evaluation {
        first: reading.form(),
        copy: reading.number(),
        owner: reading.number(),
    });
    turns.into()
}

fn write_place(place: Operand, draft: &mut Draft) {
    let (is_jet, at) = match place {
        Operand::Jet(at) => (true, at),
        Operand::Scalar(at) => (false, at),
    };
    draft.form(u32::from(is_jet));
    draft.number(at);
}

/// Whether a jet stands at a place, and where that is.
fn read_place(reading: &mut Reading<'_>) -> (bool, Affine) {
    (reading.form() != 0, reading.number())
}

/// Of what declaration a source is the copy; of those that are no states, nothing.
fn declaration(system: &System, source: usize) -> [u32; 2] {
    let is_state = source < system.states.len();
    let address = if is_state { system.states.pattern(source).declared.address() } else { 0 };
    [address as u32, (address >> 32) as u32]
}

fn span(range: &Range<u32>) -> Range<usize> {
    range.start as usize..range.end as usize
}
