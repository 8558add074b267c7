//! Rows gathered into blocks by influence, and formulas on the series side.

use crate::programs::{Compiler, Memory, Side, source_of};
use sophy_field::{
    AutomatonIndex, Block, Entry, Formula, LocationIndex, Program, RowResult, Selected, SourceIndex,
    StateIndex, WatchIndex,
};
use sophy_ir::{Leaf, NodeId, Row, System};
use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::ops::Range;

/// Gathers programs, blocks and the lists they refer to.
pub(crate) struct Gather<'a> {
    pub(crate) system: &'a System,
    pub(crate) memory: Memory,
    pub(crate) programs: Vec<Program>,
    pub(crate) blocks: Vec<Block>,
    pub(crate) sources: Vec<SourceIndex>,
    pub(crate) rows: Vec<RowResult>,
    pub(crate) entries: Vec<Entry>,
    /// Per side, per algebraic variable: its entry (on the series side an entry of programs).
    algebraic_entries: HashMap<(Side, usize, bool), Entry>,
    /// Blocks of equal rows are one.
    known: HashMap<(AutomatonIndex, Vec<Vec<StateIndex>>), Entry>,
    /// Per state, per location of its owner: whether the rate bends there.
    bends: Vec<Vec<bool>>,
    /// Per leaf: the rates that read it, directly or through algebraic variables, as state and location.
    pub(crate) readers: HashMap<Leaf, Vec<(StateIndex, usize)>>,
}

impl<'a> Gather<'a> {
    pub(crate) fn new(system: &'a System, width: u32, bends: Vec<Vec<bool>>) -> Self {
        let mut gather = Gather {
            system,
            memory: Memory::new(system, width),
            programs: vec![Program::default()],
            blocks: Vec::new(),
            sources: Vec::new(),
            rows: Vec::new(),
            entries: Vec::new(),
            algebraic_entries: HashMap::new(),
            known: HashMap::new(),
            bends,
            readers: HashMap::new(),
        };
        for (position, state) in system.states.iter().enumerate() {
            for (location, &node) in state.rate.by_location.iter().enumerate() {
                for leaf in gather.closure([node]) {
                    gather.readers.entry(leaf).or_default().push((StateIndex::new(position), location));
                }
            }
        }
        gather
    }

    /// The entries that evaluate, in every combination of locations, the rates that read one of `leaves`.
    pub(crate) fn influence(&mut self, leaves: &[Leaf]) -> Range<u32> {
        let mut selected: BTreeMap<AutomatonIndex, Vec<Vec<StateIndex>>> = BTreeMap::new();
        for (state, location) in leaves.iter().filter_map(|leaf| self.readers.get(leaf)).flatten() {
            let row = &self.system.states[state.position()].rate;
            let rows = selected.entry(row.owner).or_insert_with(|| vec![Vec::new(); row.by_location.len()]);
            rows[*location].push(*state);
        }
        for states in selected.values_mut().flatten() {
            states.sort_unstable();
            states.dedup();
        }
        self.entries_for(selected)
    }

    /// The entries that evaluate the rates of some states, given in order.
    pub(crate) fn all_of(&mut self, states: impl IntoIterator<Item = StateIndex>) -> Range<u32> {
        let mut selected: BTreeMap<AutomatonIndex, Vec<Vec<StateIndex>>> = BTreeMap::new();
        for state in states {
            let row = &self.system.states[state.position()].rate;
            let rows = selected.entry(row.owner).or_insert_with(|| vec![Vec::new(); row.by_location.len()]);
            rows.iter_mut().for_each(|rows| rows.push(state));
        }
        self.entries_for(selected)
    }

    fn entries_for(&mut self, selected: BTreeMap<AutomatonIndex, Vec<Vec<StateIndex>>>) -> Range<u32> {
        let mut nodes = Vec::new();
        for by_location in selected.values() {
            for (location, states) in by_location.iter().enumerate() {
                nodes.extend(self.rate_nodes(states, location));
            }
        }
        let needed = self.algebraics_below(nodes, false);
        let mut entries: Vec<Entry> = needed.into_iter().map(|z| self.algebraic_block(z)).collect();
        for (owner, rows) in selected {
            entries.push(self.block(owner, rows));
        }
        let start = self.entries.len() as u32;
        self.entries.extend(entries);
        start..self.entries.len() as u32
    }

    fn rate_nodes(&self, states: &[StateIndex], location: usize) -> Vec<NodeId> {
        let location = LocationIndex::new(location);
        states.iter().map(|s| self.system.states[s.position()].rate.at(location)).collect()
    }

    fn block(&mut self, owner: AutomatonIndex, rows: Vec<Vec<StateIndex>>) -> Entry {
        let key = (owner, rows);
        if let Some(&known) = self.known.get(&key) {
            return known;
        }
        let mut made = Vec::new();
        for (location, states) in key.1.iter().enumerate() {
            let nodes = self.rate_nodes(states, location);
            let (program, results) = self.program(Side::Quantised, &nodes);
            let sources = self.direct_sources(&nodes);
            let start = self.rows.len() as u32;
            let mut bends = false;
            for (&state, result) in states.iter().zip(results) {
                let row_bends = self.bends[state.position()][location];
                bends |= row_bends;
                self.rows.push(RowResult { state, result, bends: row_bends });
            }
            made.push(Block { program, sources, rows: start..self.rows.len() as u32, bends });
        }
        let entry = Entry { owner, first: self.blocks.len() as u32 };
        self.blocks.extend(made);
        self.known.insert(key, entry);
        entry
    }

    /// The entry that evaluates an algebraic variable on the quantised side.
    fn algebraic_block(&mut self, z: usize) -> Entry {
        if let Some(&known) = self.algebraic_entries.get(&(Side::Quantised, z, false)) {
            return known;
        }
        let row = self.system.algebraics[z].value.clone();
        let to = self.memory.algebraic(Side::Quantised, z);
        let mut made = Vec::new();
        for &node in &row.by_location {
            let program = self.storing(Side::Quantised, node, to);
            let sources = self.direct_sources(&[node]);
            made.push(Block { program, sources, rows: 0..0, bends: true });
        }
        let entry = Entry { owner: row.owner, first: self.blocks.len() as u32 };
        self.blocks.extend(made);
        self.algebraic_entries.insert((Side::Quantised, z, false), entry);
        entry
    }

    /// The programs, one per location in a row, that evaluate an algebraic variable on the series side.
    fn algebraic_programs(&mut self, z: usize, plain: bool) -> Entry {
        if let Some(&known) = self.algebraic_entries.get(&(Side::Series, z, plain)) {
            return known;
        }
        let algebraic = &self.system.algebraics[z];
        let row = if plain { algebraic.plain.clone() } else { algebraic.value.clone() };
        let to = self.memory.algebraic(Side::Series, z);
        // Made first, appended last: they must stand in a row.
        let mut made = Vec::new();
        for &node in &row.by_location {
            let mut compiler = Compiler::new(self.system, &mut self.memory, Side::Series);
            compiler.store(node, to);
            made.push(compiler.finish());
        }
        let entry = Entry { owner: row.owner, first: self.programs.len() as u32 };
        self.programs.extend(made);
        self.algebraic_entries.insert((Side::Series, z, plain), entry);
        entry
    }

    /// A formula on the series side. `plain` formulas (outputs, resets) read switches as written.
    pub(crate) fn formula(&mut self, node: NodeId, plain: bool) -> Formula {
        let needed = self.algebraics_below([node], plain);
        let before = needed.iter().map(|&z| self.algebraic_programs(z, plain)).collect();
        let (program, results) = self.program(Side::Series, &[node]);
        let mut leaves = self.system.graph.dependencies([node]);
        for z in needed {
            let algebraic = &self.system.algebraics[z];
            let row = if plain { &algebraic.plain } else { &algebraic.value };
            leaves.extend(self.system.graph.dependencies(row.by_location.iter().copied()));
        }
        let sources = self.source_range(&leaves);
        Formula { program, sources, before, result: results[0] }
    }

    /// A formula per location.
    pub(crate) fn selected(&mut self, row: &Row, plain: bool) -> Selected {
        let by_location = row.by_location.iter().map(|&node| self.formula(node, plain)).collect();
        Selected { owner: row.owner, by_location }
    }

    fn program(&mut self, side: Side, nodes: &[NodeId]) -> (u32, Vec<sophy_field::Operand>) {
        let mut compiler = Compiler::new(self.system, &mut self.memory, side);
        let results: Vec<_> = nodes.iter().map(|&node| compiler.expression(node)).collect();
        let program = compiler.finish();
        (self.add(program), results)
    }

    fn storing(&mut self, side: Side, node: NodeId, to: u32) -> u32 {
        let mut compiler = Compiler::new(self.system, &mut self.memory, side);
        compiler.store(node, to);
        let program = compiler.finish();
        self.add(program)
    }

    /// Program 0 is the empty one.
    fn add(&mut self, program: Program) -> u32 {
        if program.instructions.is_empty() {
            return 0;
        }
        self.programs.push(program);
        self.programs.len() as u32 - 1
    }

    /// Leaves of expressions, through algebraic variables in whatever location.
    pub(crate) fn closure(&self, nodes: impl IntoIterator<Item = NodeId>) -> BTreeSet<Leaf> {
        let mut found = BTreeSet::new();
        let mut pending: Vec<Leaf> = self.system.graph.dependencies(nodes).into_iter().collect();
        while let Some(leaf) = pending.pop() {
            if found.insert(leaf)
                && let Leaf::Algebraic(z) = leaf
            {
                let row = &self.system.algebraics[z.position()].value;
                pending.extend(self.system.graph.dependencies(row.by_location.iter().copied()));
            }
        }
        found
    }

    /// Algebraic variables below expressions, in the order of evaluation (that of their table).
    fn algebraics_below(&self, nodes: impl IntoIterator<Item = NodeId>, plain: bool) -> BTreeSet<usize> {
        let mut found = BTreeSet::new();
        let mut pending: Vec<Leaf> = self.system.graph.dependencies(nodes).into_iter().collect();
        while let Some(leaf) = pending.pop() {
            if let Leaf::Algebraic(z) = leaf
                && found.insert(z.position())
            {
                let algebraic = &self.system.algebraics[z.position()];
                let row = if plain { &algebraic.plain } else { &algebraic.value };
                pending.extend(self.system.graph.dependencies(row.by_location.iter().copied()));
            }
        }
        found
    }

    fn direct_sources(&mut self, nodes: &[NodeId]) -> Range<u32> {
        let leaves = self.system.graph.dependencies(nodes.iter().copied());
        self.source_range(&leaves)
    }

    fn source_range(&mut self, leaves: &BTreeSet<Leaf>) -> Range<u32> {
        let layout = self.memory.layout;
        let start = self.sources.len() as u32;
        self.sources.extend(leaves.iter().filter_map(|&leaf| source_of(leaf, layout)));
        start..self.sources.len() as u32
    }

    /// The watches whose truths or stairs expressions read, and those that these need in turn.
    pub(crate) fn watches_below(&self, nodes: impl IntoIterator<Item = NodeId>) -> BTreeSet<WatchIndex> {
        let mut found = BTreeSet::new();
        let mut pending: Vec<Leaf> = self.closure(nodes).into_iter().collect();
        while let Some(leaf) = pending.pop() {
            let watches: Vec<WatchIndex> = match leaf {
                Leaf::Truth(i) => vec![self.system.truths[i.position()].watch],
                Leaf::Stair(i) => {
                    let stair = &self.system.stairs[i.position()];
                    vec![stair.lower, stair.upper]
                }
                _ => continue,
            };
            for watch in watches {
                if found.insert(watch) {
                    pending.extend(self.closure([self.system.watches[watch.position()].difference]));
                }
            }
        }
        found
    }
}
