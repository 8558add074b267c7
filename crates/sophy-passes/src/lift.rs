//! Kinks are events: every comparison over continuous quantities that a rate or a guard reads, also those
//! inside `abs min max sign floor if`, becomes a truth (or a stair) decided by a watch, so that what engines
//! read is smooth between crossings. Equal arguments share one watch. The knots of a table are the edges of a
//! stair: two watches move with its step, however many knots there are.

use rustc_hash::FxHashMap;
use sophy_field::{AlgebraicIndex, ColumnIndex, StairIndex, TruthIndex, WatchIndex};
use sophy_ir::{
    Allowed, Binary, Column, Comparison, FlatTrigger, Leaf, Linearity, Node, NodeId, Range, Ranged, Reach,
    Row, Stair, System, Truth, Unary, Watch,
};

/// Lifts the kinks of rates, algebraic variables and guards. Outputs and resets keep theirs: they are read
/// at instants only. But an output must not leave the range of its tables unnoticed: a stair watches it.
pub fn lift_kinks(system: &mut System) {
    let mut lifter = Lifter {
        reach: Reach::default(),
        lifted: Vec::new(),
        linearity: Linearity::default(),
        watches: FxHashMap::default(),
        truths: FxHashMap::default(),
        stairs: FxHashMap::default(),
        system,
    };
    lifter.system();
}

/// What a watch is known by: its affine form if it has one, else its two sides.
#[derive(Clone, PartialEq, Eq, Hash)]
enum Key {
    Affine(Vec<(Leaf, NodeId)>, Option<NodeId>),
    Sides(NodeId, NodeId),
}

struct Lifter<'a> {
    system: &'a mut System,
    reach: Reach,
    /// Per node: what it became, and whether it depends on parameters and numbers only.
    lifted: Vec<Option<Lifted>>,
    linearity: Linearity,
    watches: FxHashMap<Key, WatchIndex>,
    truths: FxHashMap<(WatchIndex, Comparison), TruthIndex>,
    /// By the knots of a table, if it is one, and the argument.
    stairs: FxHashMap<(Option<ColumnIndex>, NodeId), StairIndex>,
}

#[derive(Clone, Copy)]
struct Lifted {
    node: NodeId,
    parametric: bool,
}

impl Lifter<'_> {
    fn system(&mut self) {
        for z in 0..self.system.algebraics.len() {
            let row = self.system.algebraics.at(z).value;
            self.row(row);
            let nodes = self.system.nodes(row);
            self.linearity.algebraic(&self.system.graph, AlgebraicIndex::new(z), nodes);
        }
        for x in 0..self.system.states.len() {
            self.row(self.system.states.at(x).rate);
        }
        for t in 0..self.system.transitions.len() {
            let trigger = match self.system.transitions.at(t).trigger {
                FlatTrigger::When(guard) => FlatTrigger::When(self.lift(guard)),
                FlatTrigger::On { events, guard } => {
                    FlatTrigger::On { events, guard: guard.map(|g| self.lift(g)) }
                }
            };
            self.system.transitions.unfinished()[t].trigger = trigger;
        }
        self.outputs();
        self.ranges();
    }

    /// Watches the ends of the ranges of what moves between events. The bounds follow when a run starts.
    fn ranges(&mut self) {
        let mut columns: FxHashMap<[NodeId; 2], ColumnIndex> = FxHashMap::default();
        for k in 0..self.system.ranges.len() {
            let Range { of, allowed: Allowed::Between(bounds), .. } = &self.system.ranges[k] else {
                continue;
            };
            let (row, mut nodes) = match of {
                Ranged::State(state) if !self.system.states.at(state.position()).discrete => {
                    let leaf = self.system.graph.leaf(Leaf::State(*state));
                    let row = self.system.states.at(state.position()).rate;
                    (row, vec![leaf; row.locations as usize])
                }
                Ranged::Value { value, .. } => (*value, self.system.nodes(*value).to_vec()),
                Ranged::State(_) | Ranged::Parameter(_) => continue,
            };
            // Copies of a component share their bounds, and so the code that watches them.
            let column = *columns.entry(*bounds).or_insert_with_key(|bounds| {
                let name = format!("range {}", bounds.map(|bound| bound.position().to_string()).join(" … "));
                self.system.graph.column(Column { name, numbers: vec![f64::MIN, f64::INFINITY] })
            });
            let mut stairs = Vec::new();
            for node in &mut nodes {
                let value = self.lift(*node);
                *node = self.stair(value, Some(column));
                if let Node::Leaf(Leaf::Stair(stair)) = self.system.graph.node(*node) {
                    stairs.push(stair);
                }
            }
            stairs.dedup();
            self.system.ranges[k].stairs = stairs;
            self.guard(row, &nodes);
        }
    }

    /// Watches the ends of the tables that outputs read, where no rate watches their knots.
    fn outputs(&mut self) {
        if self.system.graph.columns().is_empty() {
            return;
        }
        for y in 0..self.system.outputs.len() {
            let row = self.system.outputs.at(y).value;
            let (mut nodes, mut any) = (self.system.nodes(row).to_vec(), false);
            for node in &mut nodes {
                let below = self.system.graph.reachable([*node]);
                *node = self.system.graph.number(0.0);
                for id in below {
                    if let Node::Locate(column, at) = self.system.graph.node(id)
                        && !self.system.is_parametric(at)
                    {
                        let at = self.lift(at);
                        let stair = self.ends(column, at);
                        *node = self.system.graph.add(*node, stair);
                        any = true;
                    }
                }
            }
            if any {
                self.guard(row, &nodes);
            }
        }
    }

    /// Has expressions watched that stand where those of a row stand.
    fn guard(&mut self, row: Row, nodes: &[NodeId]) {
        let row = self.system.row(row.owner, nodes, row.spans);
        self.system.guarded.push(row);
    }

    /// The stair of a table if there is one, else one with the ends of its range only.
    fn ends(&mut self, column: ColumnIndex, at: NodeId) -> NodeId {
        if self.stairs.contains_key(&(Some(column), at)) {
            return self.stair(at, Some(column));
        }
        let Some(whole) = self.system.graph.columns().get(column.position()) else { return at };
        let mut numbers = whole.numbers.clone();
        // An infinite end stays with the knot before it.
        let (first, last) = (1, numbers.len().saturating_sub(1));
        let kept =
            if numbers.last().is_some_and(|end| end.is_finite()) { last } else { last.saturating_sub(1) };
        if first < kept {
            numbers.drain(first..kept);
        }
        let name = whole.name.clone();
        let ends = self.system.graph.column(Column { name, numbers });
        self.stair(at, Some(ends))
    }

    fn row(&mut self, row: Row) {
        for at in row.range() {
            self.system.rows[at] = self.lift(self.system.rows[at]);
        }
    }

    fn lift(&mut self, root: NodeId) -> NodeId {
        // Lifting makes new nodes; those below `root` are older.
        self.lifted.resize(self.system.graph.len(), None);
        let mut reach = std::mem::take(&mut self.reach);
        let graph = &self.system.graph;
        let known = |id: NodeId| self.lifted[id.position()].is_some();
        let missing = reach
            .entering(graph, [root], known, |id| !matches!(graph.node(id), Node::Unary(Unary::Smooth, _)));
        for &id in missing {
            let lifted = self.node(id);
            self.lifted[id.position()] = Some(lifted);
        }
        self.reach = reach;
        self.of(root)
    }

    /// What an operand became; operands are lifted before users.
    fn of(&self, operand: NodeId) -> NodeId {
        self.lifted[operand.position()].map_or(operand, |lifted| lifted.node)
    }

    fn node(&mut self, id: NodeId) -> Lifted {
        let parametric = self.is_parametric(id);
        Lifted { node: if parametric { id } else { self.smooth(id) }, parametric }
    }

    fn smooth(&mut self, id: NodeId) -> NodeId {
        match self.system.graph.node(id) {
            Node::Compare(comparison, a, b) => {
                let (a, b) = (self.of(a), self.of(b));
                self.compare(comparison, a, b)
            }
            Node::Unary(Unary::Smooth, _) => id,
            Node::Unary(Unary::Abs, a) => {
                let a = self.of(a);
                let zero = self.system.graph.number(0.0);
                let below = self.compare(Comparison::Less, a, zero);
                let opposite = self.system.graph.unary(Unary::Negate, a);
                self.system.graph.select(below, opposite, a)
            }
            Node::Unary(Unary::Sign, a) => {
                let a = self.of(a);
                let [zero, one, minus] = [0.0, 1.0, -1.0].map(|n| self.system.graph.number(n));
                let above = self.compare(Comparison::Greater, a, zero);
                let below = self.compare(Comparison::Less, a, zero);
                let rest = self.system.graph.select(below, minus, zero);
                self.system.graph.select(above, one, rest)
            }
            Node::Unary(Unary::Floor, a) => {
                let a = self.of(a);
                self.stair(a, None)
            }
            Node::Locate(column, a) => {
                let a = self.of(a);
                self.stair(a, Some(column))
            }
            Node::Binary(function @ (Binary::Min | Binary::Max), a, b) => {
                let (a, b) = (self.of(a), self.of(b));
                let less = self.compare(Comparison::Less, a, b);
                let (then, otherwise) = if function == Binary::Min { (a, b) } else { (b, a) };
                self.system.graph.select(less, then, otherwise)
            }
            other => {
                let mapped = other.map(|operand| self.of(operand));
                self.system.graph.rebuild(mapped)
            }
        }
    }

    fn is_parametric(&self, id: NodeId) -> bool {
        match self.system.graph.node(id) {
            Node::Leaf(leaf) => matches!(leaf, Leaf::Parameter(_)),
            // What is inside was not looked at.
            Node::Unary(Unary::Smooth, _) => false,
            _ => {
                let mut all = true;
                self.system.graph.operands(id, |operand| {
                    all &= self.lifted[operand.position()].is_some_and(|lifted| lifted.parametric);
                });
                all
            }
        }
    }

    fn compare(&mut self, comparison: Comparison, a: NodeId, b: NodeId) -> NodeId {
        // Nothing to watch; a value that is not a number stops the run elsewhere.
        if a == b {
            return self.system.graph.boolean(comparison.holds(0.0, 0.0));
        }
        let (watch, mirrored) = self.watch(a, b);
        let comparison = if mirrored { comparison.mirrored() } else { comparison };
        let truths = &mut self.system.truths;
        let truth = *self.truths.entry((watch, comparison)).or_insert_with(|| {
            truths.push(Truth { watch, comparison });
            TruthIndex::new(truths.len() - 1)
        });
        self.system.graph.leaf(Leaf::Truth(truth))
    }

    /// The watch of `a − b`, or of `b − a` (`true`): the orientation in which the first coefficient is
    /// positive, so that `x < L`, `L > x` and `x − L < 0` share one.
    fn watch(&mut self, a: NodeId, b: NodeId) -> (WatchIndex, bool) {
        let difference = self.difference(a, b);
        let form = self.form(difference);
        let mut mirrored = false;
        let key = match &form {
            Some(affine) => {
                let first = affine.terms.values().next();
                mirrored = first.is_some_and(|&c| self.system.graph.as_number(c).is_some_and(|c| c < 0.0));
                let oriented = if mirrored {
                    let other = self.difference(b, a);
                    self.form(other).unwrap_or_else(|| affine.clone())
                } else {
                    affine.clone()
                };
                Key::Affine(oriented.terms.into_iter().collect(), oriented.constant)
            }
            None if self.watches.contains_key(&Key::Sides(b, a)) => {
                mirrored = true;
                Key::Sides(b, a)
            }
            None => Key::Sides(a, b),
        };
        if let Some(&known) = self.watches.get(&key) {
            return (known, mirrored);
        }
        let (left, right) = if mirrored { (b, a) } else { (a, b) };
        let difference = self.difference(left, right);
        let watch = WatchIndex::new(self.system.watches.len());
        self.system.watches.push(Watch { left, right, difference, affine: form.is_some() });
        self.watches.insert(key, watch);
        (watch, mirrored)
    }

    fn difference(&mut self, a: NodeId, b: NodeId) -> NodeId {
        if self.system.graph.as_number(b) == Some(0.0) { a } else { self.system.graph.subtract(a, b) }
    }

    /// The affine form of a difference, if it and the algebraic variables that it reads are affine.
    fn form(&mut self, difference: NodeId) -> Option<sophy_ir::Affine> {
        if !self.linearity.is_affine(&self.system.graph, difference) {
            return None;
        }
        let variable =
            |leaf: Leaf| matches!(leaf, Leaf::State(_) | Leaf::Input(_) | Leaf::Time | Leaf::Algebraic(_));
        self.system.graph.affine(difference, &variable)
    }

    /// `floor(a)` as a stair n, bounded by the watches a − n and a − (n + 1); for a table its piece n, bounded by
    /// a − knot n and a − knot n + 1.
    fn stair(&mut self, a: NodeId, knots: Option<ColumnIndex>) -> NodeId {
        if let Some(&known) = self.stairs.get(&(knots, a)) {
            return self.system.graph.leaf(Leaf::Stair(known));
        }
        let index = StairIndex::new(self.system.stairs.len());
        // The stair must exist before its watches are made: they read it.
        let stair = Stair { argument: a, knots, lower: WatchIndex(0), upper: WatchIndex(0) };
        self.system.stairs.push(stair);
        self.stairs.insert((knots, a), index);
        let n = self.system.graph.leaf(Leaf::Stair(index));
        let one = self.system.graph.number(1.0);
        let next = self.system.graph.add(n, one);
        let [below, above] = [n, next].map(|step| match knots {
            Some(column) => self.system.graph.lookup(column, step),
            None => step,
        });
        let lower = self.fresh_watch(a, below);
        let upper = self.fresh_watch(a, above);
        self.system.stairs[index.position()] = Stair { lower, upper, ..stair };
        n
    }

    fn fresh_watch(&mut self, left: NodeId, right: NodeId) -> WatchIndex {
        let difference = self.system.graph.subtract(left, right);
        let affine = self.linearity.is_affine(&self.system.graph, difference);
        self.system.watches.push(Watch { left, right, difference, affine });
        WatchIndex::new(self.system.watches.len() - 1)
    }
}
