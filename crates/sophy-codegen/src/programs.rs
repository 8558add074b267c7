//! One expression (or several that share subexpressions) → one program.

use crate::memory::{Memory, Operand, Place, Side};
use sophy_field::{Code, Instruction, Program};
use sophy_ir::{Binary, Comparison, Node, NodeId, System, Unary};

/// How deep switches may nest: each level is one of recursion.
const DEEPEST: usize = 256;

/// How long a program with switches may become: what branches of branches share is written more than once.
const LONGEST: usize = 1 << 20;

/// Compiles programs, one after the other.
pub(crate) struct Compiler<'a> {
    system: &'a System,
    /// Numbers per jet.
    width: u32,
    /// First temporary.
    base: u32,
    program: Program,
    /// Per node: where its value stands, if it is computed so far.
    known: Vec<Option<Operand>>,
    /// The nodes that are known, in the order in which they became so: what a branch computes is forgotten
    /// when it ends.
    log: Vec<NodeId>,
    /// How many branches enclose what is compiled.
    depth: usize,
    /// Per node: the last walk that found it.
    seen: Vec<u32>,
    walk: u32,
    used: u32,
    /// The most temporaries (numbers) any program needs.
    pub(crate) temporaries: u32,
    /// Whether switches nest deeper than [`DEEPEST`] or a program with them is longer than [`LONGEST`].
    pub(crate) too_deep: bool,
}

impl<'a> Compiler<'a> {
    pub(crate) fn new(system: &'a System, width: u32, base: u32) -> Self {
        Compiler {
            system,
            width,
            base,
            program: Program::default(),
            known: vec![None; system.graph.len()],
            log: Vec::new(),
            depth: 0,
            seen: vec![0; system.graph.len()],
            walk: 0,
            used: 0,
            temporaries: 0,
            too_deep: false,
        }
    }

    /// Begins a program that gathers this many operands.
    pub(crate) fn begin(&mut self, operands: u32) {
        self.forget(0);
        self.program = Program { instructions: Vec::new(), gather: self.base, stride: self.width };
        self.used = operands * self.width;
    }

    /// Says that the operand of this number, which stands at places like `place`, is the value of `node`.
    pub(crate) fn gathered(&mut self, node: NodeId, number: u32, place: Place) {
        let at = self.base + number * self.width;
        let operand = match place {
            Place::Scalar(_) => Operand::Scalar(at),
            Place::Jet(_) => Operand::Jet(at),
            Place::Trajectory(_, coefficients) => {
                self.push(Code::FollowOperand, at, number, coefficients);
                Operand::Jet(at)
            }
        };
        self.remember(node, operand);
    }

    /// Computes `roots`; where their values stand once the program has run. One root may be stored in the jet
    /// at `to`.
    pub(crate) fn compile(
        &mut self,
        memory: &mut Memory,
        side: Side,
        roots: &[NodeId],
        to: Option<u32>,
    ) -> Vec<Operand> {
        let mut step = Step { memory, side, compiler: self };
        if let Some(to) = to {
            roots.iter().for_each(|&root| step.store(root, to));
            return Vec::new();
        }
        roots.iter().map(|&root| step.expression(root)).collect()
    }

    /// Computes a root and stores it in the operand of this number.
    pub(crate) fn compile_stored(
        &mut self,
        memory: &mut Memory,
        side: Side,
        roots: &[NodeId],
        number: u32,
    ) -> Vec<Operand> {
        for &root in roots {
            let mut step = Step { memory, side, compiler: self };
            let value = step.jet(root);
            self.push(Code::Store, number, value, 0);
        }
        Vec::new()
    }

    /// The finished program.
    pub(crate) fn finish(&mut self) -> Program {
        self.temporaries = self.temporaries.max(self.used);
        std::mem::take(&mut self.program)
    }

    fn remember(&mut self, node: NodeId, operand: Operand) {
        self.known[node.position()] = Some(operand);
        self.log.push(node);
    }

    fn forget(&mut self, since: usize) {
        for node in self.log.drain(since..) {
            self.known[node.position()] = None;
        }
    }

    fn temporary(&mut self) -> u32 {
        let at = self.base + self.used;
        self.used += self.width;
        at
    }

    fn push(&mut self, code: Code, to: u32, a: u32, b: u32) {
        self.program.instructions.push(Instruction { code, to, a, b });
    }
}

/// A compiler at work on one side.
struct Step<'a, 'b> {
    compiler: &'b mut Compiler<'a>,
    memory: &'b mut Memory,
    side: Side,
}

impl Step<'_, '_> {
    /// Computes `root` and then copies it to the jet at `to`.
    fn store(&mut self, root: NodeId, to: u32) {
        let value = self.expression(root);
        self.copy(value, to);
    }

    /// Where the value of `root` stands once the program has run.
    fn expression(&mut self, root: NodeId) -> Operand {
        if let Some(known) = self.known(root) {
            return known;
        }
        // Operands first, in order, so that long chains need no stack; branches of a switch belong to it.
        for id in self.unconditional(root) {
            self.compute(id);
        }
        self.known(root).unwrap_or(Operand::Scalar(self.memory.parameters))
    }

    /// Computes a node whose operands are known.
    fn compute(&mut self, id: NodeId) {
        if self.known(id).is_none() {
            let operand = self.node(id);
            self.compiler.remember(id, operand);
        }
    }

    fn known(&self, node: NodeId) -> Option<Operand> {
        self.compiler.known[node.position()]
    }

    /// What must be computed for `root` whatever its switches say, operands before users, without what is
    /// known and what lies below parametric expressions.
    fn unconditional(&mut self, root: NodeId) -> Vec<NodeId> {
        let compiler = &mut *self.compiler;
        compiler.walk += 1;
        let mut found = Vec::new();
        let mut pending = vec![root];
        while let Some(id) = pending.pop() {
            let seen = &mut compiler.seen[id.position()];
            if *seen == compiler.walk || compiler.known[id.position()].is_some() {
                continue;
            }
            *seen = compiler.walk;
            found.push(id);
            if self.memory.is_parametric(id) {
                continue;
            }
            match compiler.system.graph.node(id) {
                Node::Select(condition, ..) => pending.push(condition),
                _ => compiler.system.graph.operands(id, |operand| pending.push(operand)),
            }
        }
        found.sort_unstable();
        found
    }

    fn node(&mut self, id: NodeId) -> Operand {
        match self.memory.place(self.compiler.system, self.side, id) {
            Some(Place::Scalar(at)) => return Operand::Scalar(at),
            Some(Place::Jet(at)) => return Operand::Jet(at),
            Some(Place::Trajectory(at, coefficients)) => return self.emit(Code::Follow, at, coefficients),
            None => {}
        }
        match self.compiler.system.graph.node(id) {
            // These have a place.
            Node::Number(_) | Node::Boolean(_) | Node::Leaf(_) => Operand::Scalar(self.memory.parameters),
            Node::Unary(function, a) => {
                let a = self.jet(a);
                self.emit(unary_code(function), a, 0)
            }
            Node::IntegerPower(a, n) => {
                let a = self.jet(a);
                if n == 2 {
                    self.emit(Code::Square, a, 0)
                } else {
                    self.emit(Code::IntegerPower, a, n as u32)
                }
            }
            Node::Binary(function, a, b) => self.binary(function, a, b),
            Node::Compare(comparison, a, b) => self.compare(comparison, a, b),
            Node::Locate(column, a) => {
                let (a, column) = (self.scalar(a), self.memory.column(column));
                self.emit_scalar(Code::Locate, a, column)
            }
            Node::Lookup(column, a) => {
                let (a, column) = (self.scalar(a), self.memory.column(column));
                self.emit_scalar(Code::Lookup, a, column)
            }
            Node::Not(a) => {
                let a = self.scalar(a);
                self.emit_scalar(Code::Not, a, 0)
            }
            Node::And(a, b) => {
                let (a, b) = (self.scalar(a), self.scalar(b));
                self.emit_scalar(Code::And, a, b)
            }
            Node::Or(a, b) => {
                let (a, b) = (self.scalar(a), self.scalar(b));
                self.emit_scalar(Code::Or, a, b)
            }
            Node::Select(condition, a, b) => self.select(condition, a, b),
        }
    }

    fn binary(&mut self, function: Binary, a: NodeId, b: NodeId) -> Operand {
        use Operand::{Jet, Scalar};
        let (a, b) = (self.expression(a), self.expression(b));
        let (a, b) = match (a, b) {
            (Scalar(_), Scalar(_)) => (Jet(self.spread(a)), b),
            both => both,
        };
        match (function, a, b) {
            (Binary::Add, Jet(a), Jet(b)) => self.emit(Code::AddJJ, a, b),
            (Binary::Add, Jet(a), Scalar(b)) | (Binary::Add, Scalar(b), Jet(a)) => {
                self.emit(Code::AddJS, a, b)
            }
            (Binary::Subtract, Jet(a), Jet(b)) => self.emit(Code::SubJJ, a, b),
            (Binary::Subtract, Jet(a), Scalar(b)) => self.emit(Code::SubJS, a, b),
            (Binary::Subtract, Scalar(a), Jet(b)) => self.emit(Code::SubSJ, a, b),
            (Binary::Multiply, Jet(a), Jet(b)) if a == b => self.emit(Code::Square, a, 0),
            (Binary::Multiply, Jet(a), Jet(b)) => self.emit(Code::MulJJ, a, b),
            (Binary::Multiply, Jet(a), Scalar(b)) | (Binary::Multiply, Scalar(b), Jet(a)) => {
                self.emit(Code::MulJS, a, b)
            }
            (Binary::Divide, Jet(a), Jet(b)) => self.emit(Code::DivJJ, a, b),
            (Binary::Divide, Jet(a), Scalar(b)) => self.emit(Code::DivJS, a, b),
            (Binary::Divide, Scalar(a), Jet(b)) => self.emit(Code::DivSJ, a, b),
            (Binary::Power, Jet(a), Jet(b)) => self.emit(Code::PowJJ, a, b),
            (Binary::Power, Jet(a), Scalar(b)) => self.emit(Code::PowJS, a, b),
            (Binary::Power, Scalar(a), Jet(b)) => self.emit(Code::PowSJ, a, b),
            (function, a, b) => {
                let (a, b) = (self.spread(a), self.spread(b));
                let code = match function {
                    Binary::Min => Code::Min,
                    Binary::Max => Code::Max,
                    _ => Code::Atan2,
                };
                self.emit(code, a, b)
            }
        }
    }

    fn compare(&mut self, comparison: Comparison, a: NodeId, b: NodeId) -> Operand {
        // The value of a jet is its first coefficient, so both kinds are read as scalars.
        let (a, b) = (self.scalar(a), self.scalar(b));
        let (code, a, b, negate) = match comparison {
            Comparison::Less => (Code::Less, a, b, false),
            Comparison::LessEqual => (Code::LessEqual, a, b, false),
            Comparison::Greater => (Code::Less, b, a, false),
            Comparison::GreaterEqual => (Code::LessEqual, b, a, false),
            Comparison::Equal => (Code::Equal, a, b, false),
            Comparison::NotEqual => (Code::Equal, a, b, true),
        };
        let holds = self.emit_scalar(code, a, b);
        match holds {
            Operand::Scalar(at) if negate => self.emit_scalar(Code::Not, at, 0),
            plain => plain,
        }
    }

    /// Only the branch taken is evaluated.
    fn select(&mut self, condition: NodeId, a: NodeId, b: NodeId) -> Operand {
        let to = self.compiler.temporary();
        let fits = self.compiler.depth < DEEPEST && self.length() <= LONGEST;
        self.compiler.too_deep |= !fits;
        if self.compiler.too_deep {
            return Operand::Jet(to);
        }
        // What both branches need is computed once, before.
        let (then, otherwise) = (self.unconditional(a), self.unconditional(b));
        for id in then {
            if otherwise.binary_search(&id).is_ok() {
                self.compute(id);
            }
        }
        let condition = self.scalar(condition);
        let branch = self.length();
        self.compiler.push(Code::JumpIfZero, 0, condition, 0);
        self.branch(a, to);
        let end = self.length();
        self.compiler.push(Code::Jump, 0, 0, 0);
        self.compiler.program.instructions[branch].b = self.length() as u32;
        self.branch(b, to);
        self.compiler.program.instructions[end].b = self.length() as u32;
        Operand::Jet(to)
    }

    fn length(&self) -> usize {
        self.compiler.program.instructions.len()
    }

    fn branch(&mut self, root: NodeId, to: u32) {
        let before = self.compiler.log.len();
        self.compiler.depth += 1;
        self.store(root, to);
        self.compiler.depth -= 1;
        self.compiler.forget(before);
    }

    fn copy(&mut self, from: Operand, to: u32) {
        match from {
            Operand::Jet(at) if at == to => {}
            Operand::Jet(at) => self.compiler.push(Code::CopyJ, to, at, 0),
            Operand::Scalar(at) => self.compiler.push(Code::Spread, to, at, 0),
        }
    }

    fn jet(&mut self, node: NodeId) -> u32 {
        let operand = self.expression(node);
        self.spread(operand)
    }

    fn spread(&mut self, operand: Operand) -> u32 {
        match operand {
            Operand::Jet(at) => at,
            Operand::Scalar(at) => {
                let to = self.compiler.temporary();
                self.compiler.push(Code::Spread, to, at, 0);
                to
            }
        }
    }

    /// The first coefficient of whatever it is.
    fn scalar(&mut self, node: NodeId) -> u32 {
        match self.expression(node) {
            Operand::Jet(at) | Operand::Scalar(at) => at,
        }
    }

    fn emit(&mut self, code: Code, a: u32, b: u32) -> Operand {
        let to = self.compiler.temporary();
        self.compiler.push(code, to, a, b);
        Operand::Jet(to)
    }

    fn emit_scalar(&mut self, code: Code, a: u32, b: u32) -> Operand {
        match self.emit(code, a, b) {
            Operand::Jet(at) | Operand::Scalar(at) => Operand::Scalar(at),
        }
    }
}

fn unary_code(function: Unary) -> Code {
    match function {
        Unary::Negate => Code::Negate,
        Unary::Sin => Code::Sin,
        Unary::Cos => Code::Cos,
        Unary::Tan => Code::Tan,
        Unary::Asin => Code::Asin,
        Unary::Acos => Code::Acos,
        Unary::Atan => Code::Atan,
        Unary::Sinh => Code::Sinh,
        Unary::Cosh => Code::Cosh,
        Unary::Tanh => Code::Tanh,
        Unary::Asinh => Code::Asinh,
        Unary::Acosh => Code::Acosh,
        Unary::Atanh => Code::Atanh,
        Unary::Exp => Code::Exp,
        Unary::Ln => Code::Ln,
        Unary::Log10 => Code::Log10,
        Unary::Sqrt => Code::Sqrt,
        Unary::Abs => Code::Abs,
        Unary::Sign => Code::Sign,
        Unary::Floor => Code::Floor,
        Unary::Smooth => Code::CopyJ,
    }
}
