//! Who reads what: leaves of expressions, through algebraic variables.

use crate::memory::source_of;
use sophy_field::{Layout, Table, WatchIndex};
use sophy_ir::{Leaf, Node, NodeId, Reach, System};

/// Finds the leaves of expressions, again and again, without allocating.
pub(crate) struct Incidence<'a> {
    system: &'a System,
    reach: Reach,
    /// Per leaf, by its number: the round in which it was found last.
    seen: Vec<u32>,
    round: u32,
    /// Leaves of algebraic variables in whatever location: smooth, and as written.
    smooth: Table<Leaf>,
    plain: Table<Leaf>,
    found: Vec<Leaf>,
}

impl<'a> Incidence<'a> {
    pub(crate) fn new(system: &'a System) -> Self {
        let mut incidence = Incidence {
            system,
            reach: Reach::default(),
            seen: Vec::new(),
            round: 0,
            smooth: Table::default(),
            plain: Table::default(),
            found: Vec::new(),
        };
        incidence.seen = vec![0; incidence.leaves()];
        for algebraic in system.algebraics.iter() {
            incidence.begin();
            incidence.direct(system.nodes(algebraic.value).iter().copied());
            incidence.smooth.push(incidence.found.iter().copied());
            incidence.begin();
            incidence.direct(system.nodes(algebraic.plain).iter().copied());
            incidence.plain.push(incidence.found.iter().copied());
        }
        incidence
    }

    /// How many leaves there may be, parameters and variables of models left out.
    pub(crate) fn leaves(&self) -> usize {
        let s = self.system;
        s.states.len() + s.inputs.len() + 1 + s.algebraics.len() + s.truths.len() + s.stairs.len()
    }

    /// The number of a leaf: sources first, in their order.
    pub(crate) fn number(&self, leaf: Leaf) -> Option<usize> {
        let s = self.system;
        let (inputs, time) = (s.states.len(), s.states.len() + s.inputs.len());
        let algebraics = time + 1;
        let truths = algebraics + s.algebraics.len();
        Some(match leaf {
            Leaf::State(i) => i.position(),
            Leaf::Input(i) => inputs + i.position(),
            Leaf::Time => time,
            Leaf::Algebraic(i) => algebraics + i.position(),
            Leaf::Truth(i) => truths + i.position(),
            Leaf::Stair(i) => truths + s.truths.len() + i.position(),
            Leaf::Parameter(_) | Leaf::Variable(_) | Leaf::Special(_) => return None,
        })
    }

    fn begin(&mut self) {
        self.round += 1;
        self.found.clear();
    }

    fn add(&mut self, leaf: Leaf) {
        if let Some(number) = self.number(leaf)
            && self.seen[number] != self.round
        {
            self.seen[number] = self.round;
            self.found.push(leaf);
        }
    }

    fn direct(&mut self, nodes: impl IntoIterator<Item = NodeId>) {
        let mut reach = std::mem::take(&mut self.reach);
        for &id in reach.of(&self.system.graph, nodes) {
            if let Node::Leaf(leaf) = self.system.graph.node(id) {
                self.add(leaf);
            }
        }
        self.reach = reach;
    }

    /// Adds what the algebraic variables among the leaves found so far read.
    fn through_algebraics(&mut self, plain: bool) {
        let mut next = 0;
        while let Some(&leaf) = self.found.get(next) {
            next += 1;
            self.through(leaf, plain);
        }
    }

    /// Adds what a leaf reads, if it is an algebraic variable.
    fn through(&mut self, leaf: Leaf, plain: bool) {
        if let Leaf::Algebraic(z) = leaf {
            let count = self.table(plain).row(z.position()).len();
            for k in 0..count {
                let leaf = self.table(plain).row(z.position())[k];
                self.add(leaf);
            }
        }
    }

    fn table(&self, plain: bool) -> &Table<Leaf> {
        if plain { &self.plain } else { &self.smooth }
    }

    /// Leaves of expressions, through algebraic variables in whatever location; parameters are left out.
    pub(crate) fn closure(&mut self, nodes: impl IntoIterator<Item = NodeId>) -> &[Leaf] {
        self.begin();
        self.direct(nodes);
        self.through_algebraics(false);
        &self.found
    }

    /// Leaves of an expression itself.
    pub(crate) fn direct_leaves(&mut self, node: NodeId) {
        self.begin();
        self.direct([node]);
    }

    /// What the last question found.
    pub(crate) fn found(&self) -> &[Leaf] {
        &self.found
    }

    /// The same, beginning with leaves instead of expressions; `plain` is as switches are written.
    pub(crate) fn closure_of(&mut self, leaves: &[Leaf], plain: bool) -> &[Leaf] {
        self.begin();
        leaves.iter().for_each(|&leaf| self.add(leaf));
        self.through_algebraics(plain);
        &self.found
    }

    /// Algebraic variables below expressions, in the order of evaluation (that of their table).
    pub(crate) fn algebraics_below(&mut self, nodes: impl IntoIterator<Item = NodeId>) -> Vec<usize> {
        if self.system.algebraics.is_empty() {
            return Vec::new();
        }
        algebraics(self.closure(nodes))
    }

    /// The watches whose truths or stairs expressions read, and those that these need in turn, in order.
    pub(crate) fn watches_below(&mut self, nodes: impl IntoIterator<Item = NodeId>) -> Vec<WatchIndex> {
        if self.system.watches.is_empty() {
            return Vec::new();
        }
        self.begin();
        self.direct(nodes);
        let mut watches = Vec::new();
        let mut next = 0;
        // What was found is not found again: this ends.
        while let Some(&leaf) = self.found.get(next) {
            next += 1;
            self.through(leaf, false);
            for watch in self.deciders(leaf).into_iter().flatten() {
                watches.push(watch);
                self.direct([self.system.watches.at(watch.position()).difference]);
            }
        }
        watches.sort_unstable();
        watches.dedup();
        watches
    }

    /// The watches that decide a truth or stair.
    pub(crate) fn deciders(&self, leaf: Leaf) -> [Option<WatchIndex>; 2] {
        match leaf {
            Leaf::Truth(i) => [Some(self.system.truths.at(i.position()).watch), None],
            Leaf::Stair(i) => {
                let stair = &self.system.stairs[i.position()];
                [Some(stair.lower), Some(stair.upper)]
            }
            _ => [None; 2],
        }
    }
}

/// The algebraic variables among leaves, in order.
pub(crate) fn algebraics(leaves: &[Leaf]) -> Vec<usize> {
    let positions = leaves.iter().filter_map(|leaf| match leaf {
        Leaf::Algebraic(z) => Some(z.position()),
        _ => None,
    });
    let mut found: Vec<usize> = positions.collect();
    found.sort_unstable();
    found
}

/// Appends the sources among leaves, in order; the range they fill.
pub(crate) fn sources(
    leaves: &[Leaf],
    layout: Layout,
    into: &mut Vec<sophy_field::SourceIndex>,
) -> std::ops::Range<u32> {
    let start = into.len();
    into.extend(leaves.iter().filter_map(|&leaf| source_of(leaf, layout)));
    into[start..].sort_unstable();
    start as u32..into.len() as u32
}
