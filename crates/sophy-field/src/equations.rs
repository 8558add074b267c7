use crate::{
    Affine, AutomatonIndex, Ball, Bound, Call, Enclose, Enclosing, Jet, Kernels, Layout, LocationIndex,
    Memory, Program, Run, Site, StateIndex, Table, WatchIndex,
};
use sophy_segment::Interval;
use std::ops::Range;
use std::sync::OnceLock;

/// The callable equations of a flat system: immutable, shared by all runs of a campaign.
///
/// **Sources** are what right-hand sides read: the states, then the inputs, then time (the vector z of the
/// thesis, §3.2.2). Memory holds a record of each; programs read it at the present time ([`Layout`]).
///
/// **Blocks** are rows evaluated together with shared subexpressions. [`Equations::influence`] lists, for
/// each source, the blocks to evaluate when its quantised value changes; an entry of the list names the
/// automaton whose location selects the block, so that switching locations rewrites nothing.
///
/// **Shapes** are programs up to what they read: equal equations share one, and each use has its own operands
/// ([`Call`]), so that code grows with the number of different equations, not with that of states.
///
/// **Copies** have blocks in common, up to numbers that go up by the same from copy to copy ([`Affine`]): operands,
/// sources, the states of rows. So a block stands once for all copies of a component in an array, and what a copy has of
/// its own is its [`Site`].
#[derive(Clone, Debug)]
pub struct Equations {
    /// Where things stand in memory.
    pub layout: Layout,
    /// What stands behind the records at the start of a run: parameters and constants filled in.
    pub image: Vec<f64>,
    /// The function that runs programs.
    pub run: Run,
    /// The function that encloses programs over an interval of time.
    pub enclose: Enclose,
    /// The function that bounds programs over an interval of time.
    pub bound: Bound,
    /// All programs.
    pub programs: Vec<Program>,
    /// Their native code, as soon as there is any: a run may go on while it is made. Whoever changes anything else
    /// here takes it out.
    pub kernels: OnceLock<Kernels>,
    /// Calls that evaluate algebraic variables on the series side: one per location, in a row.
    pub calls: Vec<Call>,
    /// All blocks.
    pub blocks: Vec<Block>,
    /// What sources influence: those of copies have it in common.
    pub influences: Vec<Influence>,
    /// Per source: what it influences.
    pub sites: Vec<Site>,
    /// What automata select and arm.
    pub automaton_codes: Vec<AutomatonCode>,
    /// Per automaton: its code.
    pub automata: Vec<Site>,
    /// What is watched.
    pub watch_codes: Vec<WatchCode>,
    /// Per watch: its code; those that read a truth come after the watch that decides it.
    pub watches: Vec<Site>,
    /// Per stair: what bounds it.
    pub stairs: Vec<StairCode>,
    /// Per source: the watches that read it, directly or through algebraic variables.
    pub watches_of_source: Table<WatchIndex>,
    /// Formulas chosen by a location: those of one quantity in a row.
    pub formulas: Vec<Formula>,
    /// Per output: its value, switches as written, among the formulas.
    pub outputs: Vec<Turn>,
}

/// A source: a state, an input or time, in this order.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct SourceIndex(pub u32);

impl SourceIndex {
    /// Position in the vector z = (x, u, t).
    #[inline]
    pub fn position(self) -> usize {
        self.0 as usize
    }
}

/// Rows that are evaluated together, of a component and its copies.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Block {
    /// What computes its rows.
    pub call: Call,
    /// Whose quantised trajectories it reads: each a [`SourceIndex`].
    pub reads: Box<[Affine]>,
    /// What it computes.
    pub rows: Box<[RowResult]>,
    /// Whether a row bends: then one more order than the engine's is evaluated, to bound its error.
    pub bends: bool,
    /// What reads the result of another block has a higher rank.
    pub rank: Affine,
}

/// A rate computed by a block.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RowResult {
    /// The state: a [`StateIndex`].
    pub state: Affine,
    /// Where its rate stands.
    pub at: Affine,
    /// Whether a jet stands there, not a scalar.
    pub is_jet: bool,
    /// Whether this rate is between events other than the engine takes it for: with order 1 it reads an input
    /// or time, with order 2 it is not affine in the sources.
    pub bends: bool,
}

/// What a source influences, up to the copy.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Influence {
    /// What reads it, in the order of evaluation.
    pub on_step: Box<[Evaluation]>,
    /// What computes its own rate, where it is a state.
    pub own: Box<[Evaluation]>,
}

/// What is to be evaluated of several that stand in a row, one per location of an automaton; up to the copy.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Evaluation {
    /// The block or call for location 0 of the owner.
    pub first: u32,
    /// Which copy of it.
    pub copy: Affine,
    /// The automaton whose location selects: an [`AutomatonIndex`].
    pub owner: Affine,
}

impl Evaluation {
    /// Of a copy of whoever asks for it.
    #[inline]
    pub fn of(self, copy: u32) -> Turn {
        Turn { first: self.first, copy: self.copy.of(copy), owner: AutomatonIndex(self.owner.of(copy)) }
    }
}

/// One of several that stand in a row, by the location of an automaton: the block, call or formula
/// `first + location(owner)`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Turn {
    /// Its position for location 0.
    pub first: u32,
    /// Which copy of it.
    pub copy: u32,
    /// The automaton whose location selects.
    pub owner: AutomatonIndex,
}

impl Turn {
    /// The position in the present locations.
    #[inline]
    pub fn at(self, locations: &[LocationIndex]) -> usize {
        (self.first + locations[self.owner.position()].0) as usize
    }
}

/// What belongs to one automaton, up to the copy.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct AutomatonCode {
    /// What is evaluated when its location changes.
    pub on_change: Box<[Evaluation]>,
    /// States whose rates it selects, if it can change its location: each a [`StateIndex`].
    pub states: Box<[Affine]>,
    /// Watches that read an algebraic variable of this automaton: what they watch jumps with its location.
    pub readers: Box<[Affine]>,
    /// Per location: watches armed there, in the order of watches; each a [`WatchIndex`].
    pub armed: Box<[Box<[Affine]>]>,
    /// Per location, for each of `states`: which right-hand side it has; equal numbers mean equal ones. Nothing where
    /// there is one location only.
    pub row_of: Box<[Box<[u32]>]>,
}

/// The code of a watch, up to the copy.
#[derive(Clone, Debug)]
pub struct WatchCode {
    /// Its value.
    pub formula: Formula,
    /// The same, where it is one source, or one less a number: the source, and where the number stands.
    pub level: Option<(Affine, Option<Affine>)>,
    /// Its two sides, for the comparison within rounding on entry.
    pub left: Formula,
    /// See `left`.
    pub right: Formula,
    /// Whether its polynomial is exact: crossings have a closed form.
    pub affine: bool,
    /// Whether it compares time itself (left) with what does not change between events: it crosses exactly there.
    pub clock: bool,
    /// Whether a transition's guard reads it.
    pub guard: bool,
    /// Truths it decides: index and the signs (bit 0 −, bit 1 zero, bit 2 +) for which each holds.
    pub truths: Box<[(Affine, u8)]>,
    /// The stair it bounds from below (`Some((stair, -1.0))`) or from above (`Some((stair, 1.0))`).
    pub stair: Option<(Affine, f64)>,
    /// Watches that read a truth or stair decided by this one.
    pub dependents: Box<[Affine]>,
    /// What is evaluated when a truth or stair decided by it changes.
    pub on_change: Box<[Evaluation]>,
}

/// The code of a stair.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct StairCode {
    /// The watches that bound it, from below and from above.
    pub watches: [WatchIndex; 2],
    /// Where the knots of a table stand in memory; empty for whole numbers.
    pub knots: Range<u32>,
}

impl StairCode {
    /// The knots, in memory; none for whole numbers.
    #[inline]
    pub fn knots<'a>(&self, memory: &'a [f64]) -> &'a [f64] {
        &memory[self.knots.start as usize..self.knots.end as usize]
    }

    /// The step of an argument.
    pub fn step(&self, memory: &[f64], argument: f64) -> f64 {
        let knots = self.knots(memory);
        if knots.is_empty() {
            return argument.floor();
        }
        knots.partition_point(|&knot| knot <= argument) as f64 - 1.0
    }

    /// Where a step begins; `None` before the first knot of a table, behind its last one and where that is infinite.
    pub fn edge(&self, memory: &[f64], step: f64) -> Option<f64> {
        let knots = self.knots(memory);
        if knots.is_empty() {
            return Some(step);
        }
        let inside = step >= 0.0 && step < knots.len() as f64;
        inside.then(|| knots[step as usize]).filter(|knot| knot.is_finite())
    }
}

/// A value of integrated trajectories at an instant: prerequisites (algebraic variables, by location), then a program;
/// up to the copy.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Formula {
    /// What computes it.
    pub call: Call,
    /// Whose integrated trajectories it reads, prerequisites included: each a [`SourceIndex`].
    pub reads: Box<[Affine]>,
    /// The calls to run first.
    pub before: Box<[Evaluation]>,
    /// Where the value stands.
    pub at: Affine,
    /// Whether a jet stands there, not a scalar.
    pub is_jet: bool,
}

impl Equations {
    /// Equations of nothing, with the functions that run programs.
    pub fn none(run: Run, enclose: Enclose, bound: Bound) -> Self {
        Equations {
            layout: Layout::default(),
            image: Vec::new(),
            run,
            enclose,
            bound,
            programs: Vec::new(),
            kernels: OnceLock::new(),
            calls: Vec::new(),
            blocks: Vec::new(),
            influences: Vec::new(),
            sites: Vec::new(),
            automaton_codes: Vec::new(),
            automata: Vec::new(),
            watch_codes: Vec::new(),
            watches: Vec::new(),
            stairs: Vec::new(),
            watches_of_source: Table::default(),
            formulas: Vec::new(),
            outputs: Vec::new(),
        }
    }

    /// Gives back what tables took to grow.
    pub fn shrink_to_fit(&mut self) {
        self.programs.shrink_to_fit();
        self.calls.shrink_to_fit();
        self.blocks.shrink_to_fit();
        self.influences.shrink_to_fit();
        self.sites.shrink_to_fit();
        self.automata.shrink_to_fit();
        self.watches.shrink_to_fit();
        self.formulas.shrink_to_fit();
    }

    /// Memory at the start of a run; records are to be filled in.
    pub fn memory(&self) -> Memory {
        Memory::behind(self.layout.rest as usize, &self.image)
    }

    /// Whether the rate of a state may bend, in whatever location ([`RowResult::bends`]).
    pub fn may_bend(&self, state: StateIndex) -> bool {
        let (own, copy) = self.own(state.position());
        own.iter().map(|evaluation| evaluation.of(copy)).any(|turn| {
            let locations = self.automaton(turn.owner).0.armed.len();
            let blocks = &self.blocks[turn.first as usize..][..locations];
            let mut rows = blocks.iter().flat_map(|block| &block.rows);
            rows.any(|row| row.bends && row.state.of(turn.copy) == state.0)
        })
    }

    /// Runs a program on its operands, those of a copy.
    #[inline(always)]
    #[allow(unsafe_code)]
    pub fn execute(&self, call: &Call, copy: u32, memory: &mut [f64], orders: usize) {
        let kernel = self.kernels.get().and_then(|kernels| kernels.get(call.program, orders));
        if let Some(kernel) = kernel
            && memory.len() == self.layout.length as usize
        {
            // SAFETY: `kernels` were made for these equations, and memory has their length. Of a copy that is none an
            // operand would lie elsewhere, but copies come from sites only.
            unsafe { kernel(call.operands.as_ptr(), copy, memory.as_mut_ptr()) };
            return;
        }
        self.interpret(call, copy, memory, orders);
    }

    #[inline(never)]
    fn interpret(&self, call: &Call, copy: u32, memory: &mut [f64], orders: usize) {
        (self.run)(&self.programs[call.program as usize], &call.operands, copy, memory, orders);
    }

    #[allow(unsafe_code)]
    fn execute_bounded(&self, call: &Call, copy: u32, memory: &mut Enclosing<'_, Ball>) {
        let Layout { length, rest, .. } = self.layout;
        let kernel = self.kernels.get().and_then(|kernels| kernels.bound(call.program));
        if let Some(kernel) = kernel
            && memory.numbers.len() == length as usize
            && memory.enclosed.len() == (length - rest) as usize
        {
            let (operands, enclosed) = (call.operands.as_ptr(), memory.enclosed.as_mut_ptr());
            // SAFETY: as in `execute`; there are as many balls as numbers behind the records.
            unsafe { kernel(operands, copy, memory.numbers.as_ptr(), enclosed, &raw const memory.now) };
            return;
        }
        (self.bound)(&self.programs[call.program as usize], &call.operands, copy, memory);
    }

    fn execute_enclosed(&self, call: &Call, copy: u32, memory: &mut Enclosing<'_>, orders: usize) {
        (self.enclose)(&self.programs[call.program as usize], &call.operands, copy, memory, orders);
    }

    /// Runs the program of a formula on `memory`, in which the present time and the records of its sources must stand,
    /// and gives its first `orders` coefficients. `locations` are the present locations.
    pub fn formula(
        &self,
        (formula, copy): (&Formula, u32),
        locations: &[LocationIndex],
        memory: &mut [f64],
        orders: usize,
    ) -> Jet {
        self.run_formula((formula, copy), locations, memory, orders);
        let mut coefficients = result(formula.at.of(copy), formula.is_jet, memory);
        coefficients.iter_mut().skip(orders).for_each(|c| *c = 0.0);
        coefficients
    }

    /// Its value alone: what a program has just written is read as it was written, number by number.
    #[inline]
    pub fn value(
        &self,
        (formula, copy): (&Formula, u32),
        locations: &[LocationIndex],
        memory: &mut [f64],
    ) -> f64 {
        self.run_formula((formula, copy), locations, memory, 1);
        memory[formula.at.of(copy) as usize]
    }

    #[inline]
    fn run_formula(
        &self,
        (formula, copy): (&Formula, u32),
        locations: &[LocationIndex],
        memory: &mut [f64],
        orders: usize,
    ) {
        for turn in turns_of(&formula.before, copy) {
            self.execute(&self.calls[turn.at(locations)], turn.copy, memory, orders);
        }
        self.execute(&formula.call, copy, memory, orders);
    }

    /// Enclosures over a stretch of time: of value, derivative and half the second derivative.
    pub fn formula_enclosed(
        &self,
        (formula, copy): (&Formula, u32),
        locations: &[LocationIndex],
        memory: &mut Enclosing<'_>,
    ) -> [Interval; 3] {
        let orders = (self.layout.width as usize).min(3);
        for turn in turns_of(&formula.before, copy) {
            self.execute_enclosed(&self.calls[turn.at(locations)], turn.copy, memory, orders);
        }
        self.execute_enclosed(&formula.call, copy, memory, orders);
        let (at, zero) = (formula.at.of(copy), Interval::point(0.0));
        // What is computed stands behind the records.
        let results = &memory.enclosed[(at - memory.rest) as usize..];
        if !formula.is_jet {
            return [results[0], zero, zero];
        }
        std::array::from_fn(|k| if k < orders { results[k] } else { Interval::ENTIRE })
    }

    /// What the value does not leave over a stretch of time.
    pub fn formula_bounded(
        &self,
        (formula, copy): (&Formula, u32),
        locations: &[LocationIndex],
        memory: &mut Enclosing<'_, Ball>,
    ) -> Ball {
        for turn in turns_of(&formula.before, copy) {
            self.execute_bounded(&self.calls[turn.at(locations)], turn.copy, memory);
        }
        self.execute_bounded(&formula.call, copy, memory);
        memory.enclosed[(formula.at.of(copy) - memory.rest) as usize]
    }

    /// Four numbers at the result of a row, of which so many are its coefficients as its program was asked for.
    #[inline]
    pub fn rate(&self, row: &RowResult, copy: u32, memory: &[f64]) -> Jet {
        result(row.at.of(copy), row.is_jet, memory)
    }

    /// What reads a source, in the order of evaluation, and the copy of it.
    #[inline]
    pub fn influence(&self, source: usize) -> (&[Evaluation], u32) {
        let Site { pattern, copy } = self.sites[source];
        (&self.influences[pattern as usize].on_step, copy)
    }

    /// What evaluates the rate of a state, in the order of evaluation, and the copy of it.
    #[inline]
    pub fn own(&self, state: usize) -> (&[Evaluation], u32) {
        let Site { pattern, copy } = self.sites[state];
        (&self.influences[pattern as usize].own, copy)
    }

    /// The blocks that evaluate the rate of a state in the present locations, and which copy of them.
    pub fn own_blocks<'a>(
        &'a self,
        state: usize,
        locations: &'a [LocationIndex],
    ) -> impl Iterator<Item = (&'a Block, u32)> {
        let (own, copy) = self.own(state);
        turns_of(own, copy).map(move |turn| (self.block(turn, locations), turn.copy))
    }

    /// The block of a turn in the present locations.
    #[inline]
    pub fn block(&self, turn: Turn, locations: &[LocationIndex]) -> &Block {
        &self.blocks[turn.at(locations)]
    }

    /// The rank of a turn: what needs it has a higher one.
    pub fn rank(&self, turn: Turn) -> u32 {
        self.blocks[turn.first as usize].rank.of(turn.copy)
    }

    /// The formula of an output in the present locations, and which copy of it.
    #[inline]
    pub fn output(&self, output: usize, locations: &[LocationIndex]) -> (&Formula, u32) {
        let turn = self.outputs[output];
        (&self.formulas[turn.at(locations)], turn.copy)
    }

    /// The code of a watch, and which copy of it.
    #[inline]
    pub fn watch(&self, watch: WatchIndex) -> (&WatchCode, u32) {
        let Site { pattern, copy } = self.watches[watch.position()];
        (&self.watch_codes[pattern as usize], copy)
    }

    /// The code of an automaton, and which copy of it.
    #[inline]
    pub fn automaton(&self, automaton: AutomatonIndex) -> (&AutomatonCode, u32) {
        let Site { pattern, copy } = self.automata[automaton.position()];
        (&self.automaton_codes[pattern as usize], copy)
    }
}

/// The sources that a copy of a block or formula reads.
#[inline]
pub fn sources_of(reads: &[Affine], copy: u32) -> impl Iterator<Item = SourceIndex> + Clone {
    reads.iter().map(move |source| SourceIndex(source.of(copy)))
}

/// What is to be evaluated for a copy.
#[inline]
pub fn turns_of(evaluations: &[Evaluation], copy: u32) -> impl Iterator<Item = Turn> {
    evaluations.iter().map(move |evaluation| evaluation.of(copy))
}

/// What stands at a place: four numbers, of a scalar the first one. Memory ends with room for a jet.
#[inline]
fn result(at: u32, is_jet: bool, memory: &[f64]) -> Jet {
    if !is_jet {
        return [memory[at as usize], 0.0, 0.0, 0.0];
    }
    match memory[at as usize..] {
        [c0, c1, c2, c3, ..] => [c0, c1, c2, c3],
        _ => [f64::NAN; 4],
    }
}
