//! Equal equations are compiled once: what is to be computed is first written down by its *shape*, and becomes
//! programs only when it is known how often each shape occurs.

use crate::memory::{Memory, Operand, Place, Side};
use crate::programs::Compiler;
use rustc_hash::FxHashMap;
use sophy_field::Program;
use sophy_ir::{Leaf, Node, NodeId, System};
use std::ops::Range;

/// When equal equations share a program.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Sharing {
    /// Where there are several copies; a few of them keep programs of their own, which gather no operands.
    #[default]
    Usual,
    /// As soon as there are two.
    Always,
    /// Never.
    Never,
}

impl Sharing {
    /// From how many uses on a program is shared.
    fn least_uses(self) -> u32 {
        match self {
            Sharing::Usual => 8,
            Sharing::Always => 2,
            Sharing::Never => u32::MAX,
        }
    }
}

/// What was asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct RequestIndex(pub(crate) u32);

/// Values to be computed together, by one call.
#[derive(Clone, Copy)]
struct Request {
    /// Its shape; `TRIVIAL` if everything stands somewhere already.
    shape: u32,
    side: Side,
    /// Whether the value is to be stored; its last operand is where.
    stored: bool,
    /// Its first root, and its first operand; they end where those of the next request begin.
    first_root: u32,
    first_operand: u32,
}

/// What is known of a shape.
struct Shape {
    uses: u32,
    /// Where the operands of its first use begin.
    first: u32,
    /// From the second use on, per operand: whether it is not the same in all. What is the same belongs to the program.
    varies: Box<[bool]>,
}

const TRIVIAL: u32 = u32::MAX;

/// All requests, by shape.
#[derive(Default)]
pub(crate) struct Shapes {
    reader: Reader,
    known: FxHashMap<Box<[u32]>, u32>,
    shapes: Vec<Shape>,
    requests: Vec<Request>,
    roots: Vec<NodeId>,
    operands: Vec<u32>,
}

impl Shapes {
    /// Asks for the values of `roots`, or that of one root to be stored at `to`. The leaves that it reads are
    /// in [`Shapes::leaves`] until the next request.
    pub(crate) fn request(
        &mut self,
        system: &System,
        memory: &mut Memory,
        side: Side,
        roots: &[NodeId],
        to: Option<u32>,
    ) -> RequestIndex {
        let (first_root, first_operand) = (self.roots.len() as u32, self.operands.len() as u32);
        self.roots.extend_from_slice(roots);
        self.reader.read(system, memory, side, roots, to.is_some());
        let mut shape = TRIVIAL;
        if self.reader.computes {
            shape = match self.known.get(self.reader.key.as_slice()) {
                Some(&known) => known,
                None => {
                    let fresh = self.shapes.len() as u32;
                    self.known.insert(self.reader.key.as_slice().into(), fresh);
                    fresh
                }
            };
        }
        // Also what becomes no operand gets its place now: temporaries begin behind all of them.
        for &literal in &self.reader.literals {
            memory.place(system, side, literal);
        }
        for &operand in &self.reader.operands {
            let place = memory.place(system, side, operand).map(Place::offset);
            self.operands.extend(place.filter(|_| shape != TRIVIAL));
        }
        self.operands.extend(to);
        if shape != TRIVIAL {
            self.count(shape as usize, first_operand as usize, to.is_some());
        }
        self.requests.push(Request { shape, side, stored: to.is_some(), first_root, first_operand });
        RequestIndex(self.requests.len() as u32 - 1)
    }

    /// Counts a use of a shape, whose operands are those from `first` on; the last is where it is `stored`.
    fn count(&mut self, shape: usize, first: usize, stored: bool) {
        let (before, operands) = self.operands.split_at(first);
        let Some(known) = self.shapes.get_mut(shape) else {
            self.shapes.push(Shape { uses: 1, first: first as u32, varies: Box::default() });
            return;
        };
        known.uses += 1;
        if known.uses == 2 {
            known.varies = (1..=operands.len()).map(|behind| stored && behind == operands.len()).collect();
        }
        let others = &before[known.first as usize..];
        for ((varies, operand), other) in known.varies.iter_mut().zip(operands).zip(others) {
            *varies |= operand != other;
        }
    }

    /// A request with its roots and operands.
    fn of(&self, RequestIndex(index): RequestIndex) -> (Request, Range<usize>, Range<usize>) {
        let (request, next) = (self.requests[index as usize], self.requests.get(index as usize + 1));
        let roots = next.map_or(self.roots.len(), |next| next.first_root as usize);
        let operands = next.map_or(self.operands.len(), |next| next.first_operand as usize);
        (request, request.first_root as usize..roots, request.first_operand as usize..operands)
    }

    /// All requests were made: they are read once more, and none is looked for.
    pub(crate) fn finish(mut self) -> Self {
        self.known = FxHashMap::default();
        self.requests.shrink_to_fit();
        self.roots.shrink_to_fit();
        self.operands.shrink_to_fit();
        self
    }

    /// The leaves, other than parameters, that the last request reads, each once.
    pub(crate) fn leaves(&self) -> &[Leaf] {
        &self.reader.leaves
    }
}

/// Reads expressions into keys. Two of one side have one key if they are the same up to which jets, scalars and numbers
/// (but 0, ±1, 2 and ½) they read; what one of them reads twice the other does too.
#[derive(Default)]
struct Reader {
    round: u32,
    /// Per node: the round in which it was read last, and its number then.
    numbers: Vec<(u32, u32)>,
    pending: Vec<(NodeId, bool)>,
    count: u32,
    key: Vec<u32>,
    /// Nodes that stand somewhere, in the order in which they are met.
    operands: Vec<NodeId>,
    /// Numbers that belong to the shape.
    literals: Vec<NodeId>,
    leaves: Vec<Leaf>,
    /// Whether anything must be computed at all.
    computes: bool,
}

/// Kinds of items in a key; what follows each has a fixed length.
mod kind {
    pub(super) const NUMBER: u32 = 0;
    pub(super) const SCALAR: u32 = 1;
    pub(super) const JET: u32 = 2;
    pub(super) const UNARY: u32 = 3;
    pub(super) const BINARY: u32 = 4;
    pub(super) const INTEGER_POWER: u32 = 5;
    pub(super) const COMPARE: u32 = 6;
    pub(super) const NOT: u32 = 7;
    pub(super) const AND: u32 = 8;
    pub(super) const OR: u32 = 9;
    pub(super) const SELECT: u32 = 10;
    pub(super) const RESULT: u32 = 11;
    pub(super) const STORED: u32 = 12;
    pub(super) const LOCATE: u32 = 13;
    pub(super) const LOOKUP: u32 = 14;
    pub(super) const TRAJECTORY: u32 = 15;
}

impl Reader {
    fn read(&mut self, system: &System, memory: &Memory, side: Side, roots: &[NodeId], stored: bool) {
        if self.numbers.len() < system.graph.len() {
            self.numbers.resize(system.graph.len(), (0, 0));
        }
        self.round += 1;
        self.count = 0;
        self.key.clear();
        self.operands.clear();
        self.literals.clear();
        self.leaves.clear();
        self.computes = stored;
        // The trajectories of both sides have different lengths.
        self.key.push(side as u32);
        for &root in roots {
            self.pending.push((root, false));
            while let Some((node, operands_read)) = self.pending.pop() {
                self.visit(system, memory, node, operands_read);
            }
        }
        for root in roots {
            self.key.extend([kind::RESULT, self.numbers[root.position()].1]);
        }
        self.key.push(if stored { kind::STORED } else { kind::RESULT });
    }

    fn visit(&mut self, system: &System, memory: &Memory, id: NodeId, operands_read: bool) {
        if self.numbers[id.position()].0 == self.round {
            return;
        }
        let node = system.graph.node(id);
        let stands = matches!(node, Node::Leaf(_)) || memory.is_parametric(id);
        if !stands && !operands_read {
            // Taken from the end: the first operand is read first, then the node itself.
            self.pending.push((id, true));
            let first = self.pending.len();
            system.graph.operands(id, |operand| self.pending.push((operand, false)));
            self.pending[first..].reverse();
            return;
        }
        self.numbers[id.position()] = (self.round, self.count);
        self.count += 1;
        if stands {
            self.stands(id, node);
        } else {
            self.computes = true;
            self.operation(node);
        }
    }

    fn stands(&mut self, id: NodeId, node: Node) {
        if let Some(number) = literal(node) {
            self.key.extend([kind::NUMBER, number]);
            self.literals.push(id);
            return;
        }
        self.operands.push(id);
        match node {
            Node::Leaf(leaf) => {
                let followed = matches!(leaf, Leaf::State(_) | Leaf::Input(_) | Leaf::Time);
                self.computes |= followed;
                self.key.push(match leaf {
                    _ if followed => kind::TRAJECTORY,
                    Leaf::Algebraic(_) => kind::JET,
                    _ => kind::SCALAR,
                });
                if !matches!(leaf, Leaf::Parameter(_)) {
                    self.leaves.push(leaf);
                }
            }
            _ => self.key.push(kind::SCALAR),
        }
    }

    fn operation(&mut self, node: Node) {
        let of = |operand: NodeId| self.numbers[operand.position()].1;
        match node {
            Node::Number(_) | Node::Boolean(_) | Node::Leaf(_) => {}
            Node::Unary(function, a) => self.key.extend([kind::UNARY, function as u32, of(a)]),
            Node::Binary(function, a, b) => self.key.extend([kind::BINARY, function as u32, of(a), of(b)]),
            Node::IntegerPower(a, n) => self.key.extend([kind::INTEGER_POWER, of(a), n as u32]),
            Node::Compare(comparison, a, b) => {
                self.key.extend([kind::COMPARE, comparison as u32, of(a), of(b)]);
            }
            // A column belongs to the shape: copies of a component read the same one.
            Node::Locate(column, a) => self.key.extend([kind::LOCATE, column.0, of(a)]),
            Node::Lookup(column, a) => self.key.extend([kind::LOOKUP, column.0, of(a)]),
            Node::Not(a) => self.key.extend([kind::NOT, of(a)]),
            Node::And(a, b) => self.key.extend([kind::AND, of(a), of(b)]),
            Node::Or(a, b) => self.key.extend([kind::OR, of(a), of(b)]),
            Node::Select(c, a, b) => self.key.extend([kind::SELECT, of(c), of(a), of(b)]),
        }
    }
}

/// Numbers that belong to a shape; all others are operands.
fn literal(node: Node) -> Option<u32> {
    match node {
        Node::Number(bits) => {
            let position = [0.0f64, 1.0, -1.0, 2.0, 0.5].iter().position(|n| n.to_bits() == bits);
            position.map(|position| position as u32)
        }
        Node::Boolean(value) => Some(8 + u32::from(value)),
        _ => None,
    }
}

/// What became of a request.
#[derive(Debug, Default)]
pub(crate) struct Answer {
    pub(crate) program: u32,
    pub(crate) operands: Vec<u32>,
    /// Where its values stand.
    pub(crate) results: Vec<Operand>,
}

/// What all requests became.
#[derive(Default)]
pub(crate) struct Programs {
    pub(crate) programs: Vec<Program>,
    /// The most temporaries (numbers) any program needs.
    pub(crate) temporaries: u32,
    /// Whether switches nest too deep somewhere.
    pub(crate) too_deep: bool,
}

/// Turns requests into calls.
pub(crate) struct Emitter<'a> {
    system: &'a System,
    memory: &'a mut Memory,
    shapes: Shapes,
    compiler: Compiler<'a>,
    least_uses: u32,
    /// Per shape: its shared program and where the results stand.
    shared: Vec<Option<(u32, Vec<Operand>)>>,
    made: Programs,
}

impl<'a> Emitter<'a> {
    /// All requests must have been made.
    pub(crate) fn new(system: &'a System, memory: &'a mut Memory, shapes: Shapes, sharing: Sharing) -> Self {
        Emitter {
            compiler: Compiler::new(system, memory.layout.width, memory.end()),
            shared: vec![None; shapes.shapes.len()],
            made: Programs { programs: vec![Program::default()], ..Programs::default() },
            least_uses: sharing.least_uses(),
            system,
            memory,
            shapes,
        }
    }

    /// Answers a request.
    pub(crate) fn answer(&mut self, request: RequestIndex, answer: &mut Answer) {
        answer.operands.clear();
        answer.results.clear();
        answer.program = 0;
        let (request, roots, operands) = self.shapes.of(request);
        let (roots, operands) = (&self.shapes.roots[roots], &self.shapes.operands[operands]);
        if request.shape == TRIVIAL {
            let (system, side) = (self.system, request.side);
            answer.results.extend(roots.iter().filter_map(|&root| {
                match self.memory.place(system, side, root)? {
                    Place::Jet(at) => Some(Operand::Jet(at)),
                    Place::Scalar(at) => Some(Operand::Scalar(at)),
                    Place::Trajectory(..) => None,
                }
            }));
            return;
        }
        let shape = &self.shapes.shapes[request.shape as usize];
        if shape.uses < self.least_uses {
            let to = operands.last().copied().filter(|_| request.stored);
            self.compiler.begin(0);
            answer.results.extend(self.compiler.compile(self.memory, request.side, roots, to));
            answer.program = self.made.add(self.compiler.finish());
            return;
        }
        let varying = operands.iter().zip(&shape.varies).filter(|(_, varies)| **varies);
        answer.operands.extend(varying.map(|(operand, _)| operand));
        let (program, places) = match &mut self.shared[request.shape as usize] {
            Some(known) => known,
            missing => {
                let count = answer.operands.len() as u32;
                self.compiler.begin(count);
                self.shapes.reader.read(self.system, self.memory, request.side, roots, request.stored);
                let varying = self.shapes.reader.operands.iter().zip(&shape.varies);
                for (number, (&operand, _)) in (0..).zip(varying.filter(|(_, varies)| **varies)) {
                    if let Some(place) = self.memory.place(self.system, request.side, operand) {
                        self.compiler.gathered(operand, number, place);
                    }
                }
                let places = if request.stored {
                    self.compiler.compile_stored(self.memory, request.side, roots, count - 1)
                } else {
                    self.compiler.compile(self.memory, request.side, roots, None)
                };
                let program = self.made.add(self.compiler.finish());
                missing.insert((program, places))
            }
        };
        answer.results.extend_from_slice(places);
        answer.program = *program;
    }

    /// Everything made.
    pub(crate) fn finish(self) -> Programs {
        Programs { temporaries: self.compiler.temporaries, too_deep: self.compiler.too_deep, ..self.made }
    }
}

impl Programs {
    fn add(&mut self, program: Program) -> u32 {
        self.programs.push(program);
        self.programs.len() as u32 - 1
    }
}
