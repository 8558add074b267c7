//! Watches: who decides what, and who reads it.

use crate::blocks::Gather;
use crate::blocks::Wanted;
use crate::memory::{Place, Side, source_of};
use crate::repeats::{Draft, Reading};
use sophy_field::{Formula, SourceIndex, StairIndex, Table, TruthIndex, WatchCode, WatchIndex, sign_bit};
use sophy_ir::{Binary, Comparison, Leaf, Node, NodeId, System};
use sophy_segment::Sign;

/// A watch, as [`WatchCode`] has it.
#[derive(Clone, Debug)]
pub(crate) struct Watched {
    pub(crate) formula: Wanted,
    level: Option<(SourceIndex, Option<u32>)>,
    pub(crate) left: Wanted,
    pub(crate) right: Wanted,
    affine: bool,
    clock: bool,
    guard: bool,
    truths: Box<[(u32, u8)]>,
    /// The stair that it bounds, and whether from below.
    stair: Option<(u32, bool)>,
    dependents: Box<[WatchIndex]>,
}

impl Watched {
    /// Writes down all but the formulas.
    pub(crate) fn write(&self, draft: &mut Draft) {
        draft.forms([self.affine, self.clock, self.guard].map(u32::from));
        draft.count(usize::from(self.level.is_some()));
        if let Some((source, number)) = self.level {
            draft.number(source.0);
            draft.count(usize::from(number.is_some()));
            number.into_iter().for_each(|number| draft.number(number));
        }
        draft.count(self.truths.len());
        for &(truth, signs) in &self.truths {
            draft.number(truth);
            draft.form(u32::from(signs));
        }
        draft.count(usize::from(self.stair.is_some()));
        if let Some((stair, below)) = self.stair {
            draft.number(stair);
            draft.form(u32::from(below));
        }
        draft.numbers(self.dependents.iter().map(|watch| watch.0));
    }
}

/// What [`Watched::write`] wrote.
pub(crate) fn read_watch(reading: &mut Reading<'_>) -> WatchCode {
    let [affine, clock, guard] = reading.forms().map(|holds| holds != 0);
    WatchCode {
        formula: Formula::default(),
        left: Formula::default(),
        right: Formula::default(),
        on_change: Box::default(),
        level: reading.several(|reading| (reading.number(), reading.several(Reading::number).pop())).pop(),
        affine,
        clock,
        guard,
        truths: reading.several(|reading| (reading.number(), reading.form() as u8)).into(),
        stair: reading
            .several(|reading| (reading.number(), if reading.form() != 0 { -1.0 } else { 1.0 }))
            .pop(),
        dependents: reading.numbers().collect(),
    }
}

/// The web of watches, truths and stairs of a system.
pub(crate) struct Watching {
    /// Per watch: the truths and stairs it decides.
    decided: Table<Leaf>,
    /// Per watch: the watches that read what it decides.
    dependents: Table<WatchIndex>,
    /// Per watch: whether a guard reads what it decides.
    guards: Vec<bool>,
    /// Pairs of a source and a watch that reads it, and of an automaton and a watch that reads one of its
    /// algebraic variables.
    sources: Table<WatchIndex>,
    automata: Table<WatchIndex>,
}

impl Watching {
    pub(crate) fn new(gather: &mut Gather<'_>) -> Self {
        let system = gather.system;
        let (layout, count) = (gather.memory.layout, system.watches.len());
        let (mut dependents, mut sources, mut automata) = (Vec::new(), Vec::new(), Vec::new());
        for (position, watch) in system.watches.iter().enumerate() {
            let reader = WatchIndex::new(position);
            gather.incidence.closure([watch.difference]);
            for &leaf in gather.incidence.found() {
                sources.extend(source_of(leaf, layout).map(|source| (source.0, reader)));
                if let Leaf::Algebraic(z) = leaf {
                    automata.push((system.algebraics.at(z.position()).value.owner.0, reader));
                }
                let deciders = gather.incidence.deciders(leaf).into_iter().flatten();
                dependents.extend(deciders.map(|decider| (decider.0, reader)));
            }
        }
        let mut guards = vec![false; count];
        for guard in system.transitions.iter().filter_map(|t| t.trigger.guard()) {
            gather.incidence.direct_leaves(guard);
            for &leaf in gather.incidence.found() {
                for decider in gather.incidence.deciders(leaf).into_iter().flatten() {
                    guards[decider.position()] = true;
                }
            }
        }
        Watching {
            decided: Table::from_pairs(count, &decided(system)),
            dependents: once(count, dependents),
            guards,
            sources: once(layout.sources(), sources),
            automata: once(system.automata.len(), automata),
        }
    }

    /// Per watch: the truths and stairs it decides.
    pub(crate) fn decided(&self) -> impl Iterator<Item = &[Leaf]> {
        (0..self.guards.len()).map(|watch| self.decided.row(watch))
    }

    /// Per source: the watches that read it, directly or through algebraic variables.
    pub(crate) fn of_sources(&self) -> Table<WatchIndex> {
        self.sources.clone()
    }

    /// Per automaton: the watches that read one of its algebraic variables.
    pub(crate) fn of_automata(&self) -> &Table<WatchIndex> {
        &self.automata
    }

    pub(crate) fn watched(&self, gather: &mut Gather<'_>) -> Vec<Watched> {
        (0..self.guards.len()).map(|watch| self.one(gather, WatchIndex::new(watch))).collect()
    }

    fn one(&self, gather: &mut Gather<'_>, index: WatchIndex) -> Watched {
        let system = gather.system;
        let watch = system.watches.at(index.position());
        let decided = self.decided.row(index.position());
        let truths = decided.iter().filter_map(|leaf| match leaf {
            Leaf::Truth(i) => Some((i.0, signs_of(system.truths.at(i.position()).comparison))),
            _ => None,
        });
        let stair = decided.iter().find_map(|leaf| match leaf {
            Leaf::Stair(i) => Some((i.0, system.stairs[i.position()].lower == index)),
            _ => None,
        });
        Watched {
            truths: truths.collect(),
            stair,
            dependents: self.dependents.row(index.position()).into(),
            guard: self.guards[index.position()],
            affine: watch.affine,
            clock: gather.is_clock(&watch),
            formula: gather.formula(watch.difference, false),
            level: level(gather, watch.difference),
            left: gather.formula(watch.left, false),
            right: gather.formula(watch.right, false),
        }
    }
}

/// A source, or a source less what is a number between events.
fn level(gather: &mut Gather<'_>, difference: NodeId) -> Option<(SourceIndex, Option<u32>)> {
    let (system, layout) = (gather.system, gather.memory.layout);
    let source = |node: NodeId| match system.graph.node(node) {
        Node::Leaf(leaf) => source_of(leaf, layout),
        _ => None,
    };
    match system.graph.node(difference) {
        Node::Binary(Binary::Subtract, a, b) => {
            match (source(a)?, gather.memory.place(system, Side::Series, b)?) {
                (source, Place::Scalar(at)) => Some((source, Some(at))),
                _ => None,
            }
        }
        _ => source(difference).map(|source| (source, None)),
    }
}

/// Pairs of a watch and what it decides: truths, then stairs.
fn decided(system: &System) -> Vec<(u32, Leaf)> {
    let truths = system.truths.iter().enumerate();
    let mut pairs: Vec<_> =
        truths.map(|(i, truth)| (truth.watch.0, Leaf::Truth(TruthIndex::new(i)))).collect();
    for (i, stair) in system.stairs.iter().enumerate() {
        let leaf = Leaf::Stair(StairIndex::new(i));
        pairs.extend([(stair.lower.0, leaf), (stair.upper.0, leaf)]);
    }
    pairs
}

/// A table of pairs, each counted once, rows in the order of watches.
fn once(rows: usize, mut pairs: Vec<(u32, WatchIndex)>) -> Table<WatchIndex> {
    pairs.sort_unstable();
    pairs.dedup();
    Table::from_pairs(rows, &pairs)
}

/// The signs of `left − right` for which a comparison holds.
pub(crate) fn signs_of(comparison: Comparison) -> u8 {
    let (minus, zero, plus) = (sign_bit(Sign::Negative), sign_bit(Sign::Zero), sign_bit(Sign::Positive));
    match comparison {
        Comparison::Less => minus,
        Comparison::LessEqual => minus | zero,
        Comparison::Greater => plus,
        Comparison::GreaterEqual => plus | zero,
        Comparison::Equal => zero,
        Comparison::NotEqual => minus | plus,
    }
}
