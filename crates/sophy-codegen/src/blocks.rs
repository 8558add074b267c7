//! Rows gathered into blocks by influence, and formulas on the series side.

use crate::incidence::{Incidence, algebraics, sources};
use crate::memory::{Memory, Side};
use crate::shapes::{RequestIndex, Shapes};
use rustc_hash::{FxHashMap, FxHasher};
use sophy_field::{AutomatonIndex, LocationIndex, SourceIndex, StateIndex, Table};
use sophy_ir::{Leaf, Linearity, Node, NodeId, Row, System, Watch};
use std::hash::{Hash, Hasher};
use std::ops::Range;

/// More rows of one automaton than these are not evaluated together: a program as long as the model could
/// share nothing with others.
const MOST_ROWS: usize = 32;

/// Gathers blocks, formulas and the lists they refer to. What computes them is only asked for.
pub(crate) struct Gather<'a> {
    pub(crate) system: &'a System,
    pub(crate) memory: Memory,
    pub(crate) shapes: Shapes,
    pub(crate) incidence: Incidence<'a>,
    found: Gathered,
    /// Per algebraic variable: the entry of its blocks, and those of its calls, smooth and plain.
    algebraics: [Vec<Option<Entry>>; 3],
    /// Blocks of equal rows are one; by a hash of the rows.
    known: FxHashMap<u64, Entry>,
    /// Per leaf, by its number: the rates that read it, directly or through algebraic variables.
    readers: Table<Selection>,
}

/// What was gathered.
#[derive(Default)]
pub(crate) struct Gathered {
    pub(crate) blocks: Vec<Rates>,
    /// Where the blocks of an entry begin: one per location of its owner.
    pub(crate) groups: Vec<u32>,
    pub(crate) calls: Vec<RequestIndex>,
    /// Where the calls of an algebraic variable begin: one per location of its owner.
    pub(crate) call_groups: Vec<u32>,
    pub(crate) formulas: Vec<Wanted>,
    /// Sources that blocks read, and sources that formulas read.
    pub(crate) reads: Vec<SourceIndex>,
    pub(crate) sources: Vec<SourceIndex>,
    pub(crate) rows: Vec<Selection>,
    /// Entries of blocks, and entries of the calls that formulas need.
    pub(crate) entries: Vec<Entry>,
    pub(crate) before: Vec<Entry>,
    /// Per state and location: where its bend stands.
    first_bend: Vec<u32>,
    bends: Vec<bool>,
}

impl Gathered {
    /// The rates that are computed together.
    pub(crate) fn rows_of(&self, rates: &Rates) -> &[Selection] {
        &self.rows[rates.rows.start as usize..rates.rows.end as usize]
    }

    /// The sources that they read.
    pub(crate) fn reads_of(&self, rates: &Rates) -> &[SourceIndex] {
        &self.reads[rates.reads.start as usize..rates.reads.end as usize]
    }

    /// Whether a rate bends.
    pub(crate) fn bends(&self, rate: Selection) -> bool {
        self.bends[(self.first_bend[rate.state.position()] + rate.location) as usize]
    }
}

/// One of several blocks, calls or formulas that stand in a row, by the location of an automaton.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Entry {
    /// Its position for location 0.
    pub(crate) first: u32,
    /// The automaton whose location selects.
    pub(crate) owner: AutomatonIndex,
}

/// A formula.
#[derive(Clone, Debug)]
pub(crate) struct Wanted {
    /// What computes it.
    pub(crate) request: RequestIndex,
    /// In [`Gathered::sources`]: whose integrated trajectories it reads, prerequisites included.
    pub(crate) sources: Range<u32>,
    /// In [`Gathered::before`]: the calls to run first.
    pub(crate) before: Range<u32>,
}

/// Rates that are evaluated together, of one copy: they become a block.
#[derive(Clone, Debug)]
pub(crate) struct Rates {
    /// What computes them.
    pub(crate) request: RequestIndex,
    /// Whose quantised trajectories it reads.
    pub(crate) reads: Range<u32>,
    /// The rates; none if it computes an algebraic variable.
    pub(crate) rows: Range<u32>,
}

/// A rate in a location of its owner.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(crate) struct Selection {
    owner: AutomatonIndex,
    location: u32,
    pub(crate) state: StateIndex,
}

impl<'a> Gather<'a> {
    /// `order` is that of the engine.
    pub(crate) fn new(system: &'a System, order: u32) -> Self {
        let mut incidence = Incidence::new(system);
        let mut linearity = Linearity::default();
        for (z, algebraic) in system.algebraics.iter().enumerate() {
            let index = sophy_field::AlgebraicIndex::new(z);
            linearity.algebraic(&system.graph, index, system.nodes(algebraic.value));
        }
        let (mut pairs, mut first_bend, mut bends) = (Vec::new(), Vec::new(), Vec::new());
        for (position, state) in system.states.iter().enumerate() {
            first_bend.push(bends.len() as u32);
            for (location, &node) in (0..).zip(system.nodes(state.rate)) {
                let state = StateIndex::new(position);
                let selection = Selection { owner: system.states.at(position).rate.owner, location, state };
                let mut driven = false;
                incidence.closure([node]);
                for &leaf in incidence.found() {
                    driven |= matches!(leaf, Leaf::Input(_) | Leaf::Time);
                    pairs.extend(incidence.number(leaf).map(|number| (number as u32, selection)));
                }
                bends.push(if order == 1 { driven } else { !linearity.is_affine(&system.graph, node) });
            }
        }
        Gather {
            system,
            memory: Memory::new(system, order),
            shapes: Shapes::default(),
            found: Gathered { first_bend, bends, ..Gathered::default() },
            algebraics: std::array::from_fn(|_| vec![None; system.algebraics.len()]),
            known: FxHashMap::default(),
            readers: Table::from_pairs(incidence.leaves(), &pairs),
            incidence,
        }
    }

    /// What becomes of it; all else is let go.
    pub(crate) fn finish(self) -> (Memory, Shapes, Gathered) {
        (self.memory, self.shapes.finish(), self.found)
    }

    /// The rates that read a leaf, directly or through algebraic variables.
    pub(crate) fn readers(&self, leaf: Leaf) -> &[Selection] {
        self.incidence.number(leaf).map_or(&[], |number| self.readers.row(number))
    }

    /// The entries that evaluate, in every combination of locations, the rates that read one of `leaves`.
    pub(crate) fn influence(&mut self, leaves: &[Leaf]) -> Range<u32> {
        let selected = leaves.iter().flat_map(|&leaf| self.readers(leaf)).copied().collect();
        self.entries_for(selected, MOST_ROWS)
    }

    /// The entries that evaluate the rates of some states.
    pub(crate) fn all_of(&mut self, states: impl IntoIterator<Item = StateIndex>) -> Range<u32> {
        let selected = self.rates_of(states);
        self.entries_for(selected, MOST_ROWS)
    }

    fn rates_of(&self, states: impl IntoIterator<Item = StateIndex>) -> Vec<Selection> {
        let mut selected = Vec::new();
        for state in states {
            let row = self.system.states.at(state.position()).rate;
            selected.extend((0..row.locations).map(|location| Selection {
                owner: row.owner,
                location,
                state,
            }));
        }
        selected
    }

    /// At most `most` rows of an automaton are evaluated together.
    fn entries_for(&mut self, mut selected: Vec<Selection>, most: usize) -> Range<u32> {
        selected.sort_unstable();
        selected.dedup();
        let nodes = selected.iter().map(|s| rate(self.system, *s));
        let needed = self.incidence.algebraics_below(nodes);
        let mut entries: Vec<Entry> = needed.into_iter().map(|z| self.algebraic_block(z)).collect();
        for of_owner in selected.chunk_by_mut(|a, b| a.owner == b.owner) {
            let locations = of_owner.chunk_by(|a, b| a.location == b.location);
            if locations.map(<[_]>::len).max() <= Some(most) {
                entries.push(self.block(of_owner));
            } else {
                of_owner.sort_unstable_by_key(|s| (s.state, s.location));
                entries.extend(of_owner.chunk_by(|a, b| a.state == b.state).map(|one| self.block(one)));
            }
        }
        let start = self.found.entries.len() as u32;
        self.found.entries.extend(entries);
        start..self.found.entries.len() as u32
    }

    /// The blocks, one per location in a row, of some rates of one automaton, ordered by location.
    fn block(&mut self, selected: &[Selection]) -> Entry {
        let owner = selected[0].owner;
        let mut hasher = FxHasher::default();
        selected.hash(&mut hasher);
        let mut hash = hasher.finish();
        while let Some(&known) = self.known.get(&hash) {
            if known.owner == owner && self.holds(known, selected) {
                return known;
            }
            hash = hash.wrapping_add(1);
        }
        let entry = self.group(owner);
        let mut rest = selected;
        for location in 0..self.system.automata.at(owner.position()).kind.locations.len() as u32 {
            let (here, others) = rest.split_at(rest.partition_point(|s| s.location == location));
            rest = others;
            let nodes: Vec<NodeId> = here.iter().map(|s| rate(self.system, *s)).collect();
            let request = self.request(Side::Quantised, &nodes, None);
            let reads = sources(self.shapes.leaves(), self.memory.layout, &mut self.found.reads);
            let start = self.found.rows.len() as u32;
            self.found.rows.extend_from_slice(here);
            self.found.blocks.push(Rates { request, reads, rows: start..self.found.rows.len() as u32 });
        }
        self.known.insert(hash, entry);
        entry
    }

    /// The blocks of an entry begin here.
    fn group(&mut self, owner: AutomatonIndex) -> Entry {
        let first = self.found.blocks.len() as u32;
        self.found.groups.push(first);
        Entry { owner, first }
    }

    /// Whether the blocks of an entry hold exactly these rates.
    fn holds(&self, entry: Entry, selected: &[Selection]) -> bool {
        let locations = self.system.automata.at(entry.owner.position()).kind.locations.len() as u32;
        let held = (0..locations).flat_map(|location| {
            let block = &self.found.blocks[(entry.first + location) as usize];
            let rows = &self.found.rows[block.rows.start as usize..block.rows.end as usize];
            rows.iter().map(move |row| (location, row.state))
        });
        held.eq(selected.iter().map(|s| (s.location, s.state)))
    }

    /// The entry that evaluates an algebraic variable on the quantised side.
    fn algebraic_block(&mut self, z: usize) -> Entry {
        if let Some(known) = self.algebraics[0][z] {
            return known;
        }
        let row = self.system.algebraics.at(z).value;
        let to = self.memory.algebraic(Side::Quantised, z);
        let entry = self.group(row.owner);
        for &node in self.system.nodes(row) {
            let request = self.request(Side::Quantised, &[node], Some(to));
            let reads = sources(self.shapes.leaves(), self.memory.layout, &mut self.found.reads);
            self.found.blocks.push(Rates { request, reads, rows: 0..0 });
        }
        self.algebraics[0][z] = Some(entry);
        entry
    }

    /// The calls, one per location in a row, that evaluate an algebraic variable on the series side.
    fn algebraic_calls(&mut self, z: usize, plain: bool) -> Entry {
        if let Some(known) = self.algebraics[1 + usize::from(plain)][z] {
            return known;
        }
        let algebraic = self.system.algebraics.at(z);
        let row = if plain { algebraic.plain } else { algebraic.value };
        let to = self.memory.algebraic(Side::Series, z);
        let entry = Entry { owner: row.owner, first: self.found.calls.len() as u32 };
        self.found.call_groups.push(entry.first);
        for &node in self.system.nodes(row) {
            let request = self.request(Side::Series, &[node], Some(to));
            self.found.calls.push(request);
        }
        self.algebraics[1 + usize::from(plain)][z] = Some(entry);
        entry
    }

    /// A formula on the series side. `plain` formulas (outputs, resets) read switches as written.
    pub(crate) fn formula(&mut self, node: NodeId, plain: bool) -> Wanted {
        let request = self.request(Side::Series, &[node], None);
        let leaves = self.incidence.closure_of(self.shapes.leaves(), plain);
        let sources = sources(leaves, self.memory.layout, &mut self.found.sources);
        let needed = algebraics(leaves);
        let before: Vec<Entry> = needed.into_iter().map(|z| self.algebraic_calls(z, plain)).collect();
        let start = self.found.before.len() as u32;
        self.found.before.extend(before);
        Wanted { request, sources, before: start..self.found.before.len() as u32 }
    }

    /// Whether a watch compares time itself with what does not change between events.
    pub(crate) fn is_clock(&mut self, watch: &Watch) -> bool {
        let time = self.system.graph.node(watch.left) == Node::Leaf(Leaf::Time);
        time && {
            self.incidence.direct_leaves(watch.right);
            self.incidence.found().iter().all(|leaf| matches!(leaf, Leaf::Truth(_) | Leaf::Stair(_)))
        }
    }

    /// A formula per location, in a row.
    pub(crate) fn selected(&mut self, row: Row, plain: bool) -> Entry {
        let entry = Entry { owner: row.owner, first: self.found.formulas.len() as u32 };
        for &node in self.system.nodes(row) {
            let formula = self.formula(node, plain);
            self.found.formulas.push(formula);
        }
        entry
    }

    fn request(&mut self, side: Side, roots: &[NodeId], to: Option<u32>) -> RequestIndex {
        self.shapes.request(self.system, &mut self.memory, side, roots, to)
    }
}

fn rate(system: &System, selection: Selection) -> NodeId {
    system.at(system.states.at(selection.state.position()).rate, LocationIndex(selection.location))
}
