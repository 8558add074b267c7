//! Kinks are events: every comparison over continuous quantities that a rate or a guard reads, also those
//! inside `abs min max sign floor if`, becomes a truth (or a stair) decided by a watch, so that what engines
//! read is smooth between crossings. Equal arguments share one watch.

use sophy_field::{StairIndex, WatchIndex};
use sophy_ir::{Binary, Comparison, FlatTrigger, Leaf, Node, NodeId, Row, Stair, System, Unary, Watch};
use std::collections::HashMap;

/// Lifts the kinks of rates, algebraic variables and guards. Outputs and resets keep theirs: they are read
/// at instants only.
pub fn lift_kinks(system: &mut System) {
    let mut lifter =
        Lifter { lifted: HashMap::new(), parametric: HashMap::new(), watches: HashMap::new(), system };
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
    lifted: HashMap<NodeId, NodeId>,
    /// Whether a node depends on parameters and numbers only.
    parametric: HashMap<NodeId, bool>,
    watches: HashMap<Key, WatchIndex>,
}

impl Lifter<'_> {
    fn system(&mut self) {
        for z in 0..self.system.algebraics.len() {
            let row = self.system.algebraics[z].value.clone();
            self.system.algebraics[z].value = self.row(row);
        }
        for x in 0..self.system.states.len() {
            let row = self.system.states[x].rate.clone();
            self.system.states[x].rate = self.row(row);
        }
        for t in 0..self.system.transitions.len() {
            self.system.transitions[t].trigger = match self.system.transitions[t].trigger.clone() {
                FlatTrigger::When(guard) => FlatTrigger::When(self.lift(guard)),
                FlatTrigger::On { events, guard } => {
                    FlatTrigger::On { events, guard: guard.map(|g| self.lift(g)) }
                }
            };
        }
    }

    fn row(&mut self, mut row: Row) -> Row {
        for node in &mut row.by_location {
            *node = self.lift(*node);
        }
        row
    }

    fn lift(&mut self, root: NodeId) -> NodeId {
        for id in self.system.graph.reachable_switches([root]) {
            if !self.lifted.contains_key(&id) {
                let lifted = self.node(id);
                self.lifted.insert(id, lifted);
            }
        }
        self.lifted[&root]
    }

    fn node(&mut self, id: NodeId) -> NodeId {
        if self.is_parametric(id) {
            return id;
        }
        let of = |lifter: &Self, operand: NodeId| lifter.lifted[&operand];
        match self.system.graph.node(id) {
            Node::Compare(comparison, a, b) => {
                let (a, b) = (of(self, a), of(self, b));
                self.compare(comparison, a, b)
            }
            Node::Unary(Unary::Smooth, _) => id,
            Node::Unary(Unary::Abs, a) => {
                let a = of(self, a);
                let zero = self.system.graph.number(0.0);
                let below = self.compare(Comparison::Less, a, zero);
                let opposite = self.system.graph.unary(Unary::Negate, a);
                self.system.graph.select(below, opposite, a)
            }
            Node::Unary(Unary::Sign, a) => {
                let a = of(self, a);
                let [zero, one, minus] = [0.0, 1.0, -1.0].map(|n| self.system.graph.number(n));
                let above = self.compare(Comparison::Greater, a, zero);
                let below = self.compare(Comparison::Less, a, zero);
                let rest = self.system.graph.select(below, minus, zero);
                self.system.graph.select(above, one, rest)
            }
            Node::Unary(Unary::Floor, a) => {
                let a = of(self, a);
                self.floor(a)
            }
            Node::Binary(function @ (Binary::Min | Binary::Max), a, b) => {
                let (a, b) = (of(self, a), of(self, b));
                let less = self.compare(Comparison::Less, a, b);
                let (then, otherwise) = if function == Binary::Min { (a, b) } else { (b, a) };
                self.system.graph.select(less, then, otherwise)
            }
            other => {
                let mapped = other.map(|operand| self.lifted[&operand]);
                self.system.graph.rebuild(mapped)
            }
        }
    }

    /// Asked of operands before users.
    fn is_parametric(&mut self, id: NodeId) -> bool {
        let known = match self.system.graph.node(id) {
            Node::Leaf(leaf) => matches!(leaf, Leaf::Parameter(_)),
            // What is inside was not looked at.
            Node::Unary(Unary::Smooth, _) => false,
            _ => {
                let mut all = true;
                self.system.graph.operands(id, |operand| all &= self.parametric[&operand]);
                all
            }
        };
        self.parametric.insert(id, known);
        known
    }

    fn compare(&mut self, comparison: Comparison, a: NodeId, b: NodeId) -> NodeId {
        let (watch, mirrored) = self.watch(a, b);
        let comparison = if mirrored { comparison.mirrored() } else { comparison };
        let truth = self.system.truth(watch, comparison);
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

    fn form(&mut self, difference: NodeId) -> Option<sophy_ir::Affine> {
        let affine_algebraics = self.affine_algebraics(difference);
        let variable = move |leaf: Leaf| match leaf {
            Leaf::State(_) | Leaf::Input(_) | Leaf::Time => true,
            Leaf::Algebraic(_) => affine_algebraics,
            _ => false,
        };
        let form = self.system.graph.affine(difference, &variable)?;
        let reads_algebraic = || {
            let leaves = self.system.graph.dependencies([difference]);
            leaves.iter().any(|leaf| matches!(leaf, Leaf::Algebraic(_)))
        };
        (affine_algebraics || !reads_algebraic()).then_some(form)
    }

    /// Whether every algebraic variable below is itself affine in every location.
    fn affine_algebraics(&mut self, root: NodeId) -> bool {
        let leaves = self.system.graph.dependencies([root]);
        leaves.into_iter().all(|leaf| match leaf {
            Leaf::Algebraic(z) => {
                let nodes = self.system.algebraics[z.position()].value.by_location.clone();
                nodes.into_iter().all(|node| self.form(node).is_some())
            }
            _ => true,
        })
    }

    /// `floor(a)` as a stair n, bounded by the watches a − n and a − (n + 1).
    fn floor(&mut self, a: NodeId) -> NodeId {
        if let Some(known) = self.system.stairs.iter().position(|s| s.argument == a) {
            return self.system.graph.leaf(Leaf::Stair(StairIndex::new(known)));
        }
        let index = StairIndex::new(self.system.stairs.len());
        // The stair must exist before its watches are made: they read it.
        self.system.stairs.push(Stair { argument: a, lower: WatchIndex(0), upper: WatchIndex(0) });
        let n = self.system.graph.leaf(Leaf::Stair(index));
        let one = self.system.graph.number(1.0);
        let next = self.system.graph.add(n, one);
        let lower = self.fresh_watch(a, n);
        let upper = self.fresh_watch(a, next);
        self.system.stairs[index.position()] = Stair { argument: a, lower, upper };
        n
    }

    fn fresh_watch(&mut self, left: NodeId, right: NodeId) -> WatchIndex {
        let difference = self.system.graph.subtract(left, right);
        let affine = self.form(difference).is_some();
        self.system.watches.push(Watch { left, right, difference, affine });
        WatchIndex::new(self.system.watches.len() - 1)
    }
}
