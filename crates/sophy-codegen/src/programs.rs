//! One expression (or several that share subexpressions) → one program.

use sophy_field::{Code, Instruction, Layout, Operand, Program, SourceIndex};
use sophy_ir::{Binary, Comparison, Leaf, Node, NodeId, System, Unary};
use std::collections::{BTreeSet, HashMap};

/// Marks an offset into the temporaries, whose place in memory is known only when all is compiled.
const TEMPORARY: u32 = 1 << 31;

/// Which jets a program reads: q for rates, x for guards, resets and outputs.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum Side {
    Quantised,
    Series,
}

/// Where everything that outlives a program stands.
pub(crate) struct Memory {
    pub(crate) layout: Layout,
    /// First jet of the algebraic variables, per side.
    pub(crate) algebraics: [u32; 2],
    /// First parameter.
    pub(crate) parameters: u32,
    /// First of the pool of numbers and parametric expressions.
    pub(crate) pool: u32,
    /// Parametric expressions and numbers in the pool, in order.
    pub(crate) pooled: Vec<NodeId>,
    known: HashMap<NodeId, u32>,
    /// Whether an expression is over parameters only, remembered.
    parametric: HashMap<NodeId, bool>,
    /// The most temporaries (numbers) any program needs.
    pub(crate) temporaries: u32,
    /// Whether switches nest deeper than [`DEEPEST`] or a program with them is longer than [`LONGEST`].
    pub(crate) too_deep: bool,
}

/// How deep switches may nest: each level is one of recursion.
const DEEPEST: usize = 256;

/// How long a program with switches may become: what branches of branches share is written more than once.
const LONGEST: usize = 1 << 20;

impl Memory {
    pub(crate) fn new(system: &System, width: u32) -> Self {
        let count = |n: usize| u32::try_from(n).unwrap_or(u32::MAX / 8);
        let (states, inputs) = (count(system.states.len()), count(system.inputs.len()));
        let sources = (states + inputs + 1) * width;
        let algebraics = count(system.algebraics.len()) * width;
        let truths = 2 * sources + 2 * algebraics;
        let stairs = truths + count(system.truths.len());
        let parameters = stairs + count(system.stairs.len());
        Memory {
            layout: Layout {
                width,
                states,
                inputs,
                quantised: 0,
                series: sources,
                truths,
                stairs,
                length: 0,
            },
            algebraics: [2 * sources, 2 * sources + algebraics],
            parameters,
            pool: parameters + count(system.parameters.len()),
            pooled: Vec::new(),
            known: HashMap::new(),
            parametric: HashMap::new(),
            temporaries: 0,
            too_deep: false,
        }
    }

    /// The scalar that holds a parametric expression.
    fn pooled(&mut self, node: NodeId) -> u32 {
        if let Some(&known) = self.known.get(&node) {
            return known;
        }
        let at = self.pool + self.pooled.len() as u32;
        self.pooled.push(node);
        self.known.insert(node, at);
        at
    }

    /// The jet of an algebraic variable.
    pub(crate) fn algebraic(&self, side: Side, index: usize) -> u32 {
        self.algebraics[side as usize] + index as u32 * self.layout.width
    }

    /// Temporaries start behind the pool; memory ends behind them.
    pub(crate) fn finish(&mut self, programs: &mut [Program]) {
        let base = self.pool + self.pooled.len() as u32;
        let place = |at: &mut u32| {
            if *at & TEMPORARY != 0 {
                *at = (*at & !TEMPORARY) + base;
            }
        };
        for instruction in programs.iter_mut().flat_map(|p| &mut p.instructions) {
            place(&mut instruction.to);
            place(&mut instruction.a);
            if !matches!(instruction.code, Code::IntegerPower | Code::Jump | Code::JumpIfZero) {
                place(&mut instruction.b);
            }
        }
        self.layout.length = base + self.temporaries;
    }

    /// Gives a result its place in memory.
    pub(crate) fn place(&self, operand: Operand) -> Operand {
        let base = self.pool + self.pooled.len() as u32;
        let place = |at: u32| if at & TEMPORARY != 0 { (at & !TEMPORARY) + base } else { at };
        match operand {
            Operand::Jet(at) => Operand::Jet(place(at)),
            Operand::Scalar(at) => Operand::Scalar(place(at)),
        }
    }
}

/// Compiles expressions of one program.
pub(crate) struct Compiler<'a> {
    system: &'a System,
    memory: &'a mut Memory,
    side: Side,
    program: Program,
    /// What is computed so far, innermost branch last.
    scopes: Vec<HashMap<NodeId, Operand>>,
    used: u32,
}

impl<'a> Compiler<'a> {
    pub(crate) fn new(system: &'a System, memory: &'a mut Memory, side: Side) -> Self {
        Compiler { system, memory, side, program: Program::default(), scopes: vec![HashMap::new()], used: 0 }
    }

    /// The finished program.
    pub(crate) fn finish(self) -> Program {
        self.memory.temporaries = self.memory.temporaries.max(self.used);
        self.program
    }

    /// Computes `root` and then copies it to the jet at `to`.
    pub(crate) fn store(&mut self, root: NodeId, to: u32) {
        let value = self.expression(root);
        self.copy(value, to);
    }

    /// Where the value of `root` stands once the program has run.
    pub(crate) fn expression(&mut self, root: NodeId) -> Operand {
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
        let operand = self.node(id);
        if let Some(scope) = self.scopes.last_mut() {
            scope.insert(id, operand);
        }
    }

    fn known(&self, node: NodeId) -> Option<Operand> {
        self.scopes.iter().rev().find_map(|scope| scope.get(&node)).copied()
    }

    /// What must be computed for `root` whatever its switches say, operands before users, without what is
    /// known and what lies below parametric expressions.
    fn unconditional(&mut self, root: NodeId) -> BTreeSet<NodeId> {
        let mut found = BTreeSet::new();
        let mut pending = vec![root];
        while let Some(id) = pending.pop() {
            if self.known(id).is_some() || !found.insert(id) || self.is_parametric(id) {
                continue;
            }
            match self.system.graph.node(id) {
                Node::Select(condition, ..) => pending.push(condition),
                _ => self.system.graph.operands(id, |operand| pending.push(operand)),
            }
        }
        found
    }

    fn node(&mut self, id: NodeId) -> Operand {
        if self.is_parametric(id) {
            return Operand::Scalar(self.memory.pooled(id));
        }
        match self.system.graph.node(id) {
            Node::Number(_) | Node::Boolean(_) => Operand::Scalar(self.memory.pooled(id)),
            Node::Leaf(leaf) => self.leaf(leaf),
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

    fn leaf(&mut self, leaf: Leaf) -> Operand {
        let layout = self.memory.layout;
        let source = |index: u32| {
            let first = if self.side == Side::Quantised { layout.quantised } else { layout.series };
            Operand::Jet(first + index * layout.width)
        };
        match leaf {
            Leaf::State(i) => source(i.0),
            Leaf::Input(i) => source(layout.states + i.0),
            Leaf::Time => source(layout.states + layout.inputs),
            Leaf::Parameter(i) => Operand::Scalar(self.memory.parameters + i.0),
            Leaf::Truth(i) => Operand::Scalar(layout.truths + i.0),
            Leaf::Stair(i) => Operand::Scalar(layout.stairs + i.0),
            Leaf::Algebraic(i) => Operand::Jet(self.memory.algebraic(self.side, i.position())),
            // Only models refer to variables; the verifier has seen to it.
            Leaf::Variable(_) | Leaf::Special(_) => Operand::Scalar(self.memory.parameters),
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
        let to = self.temporary();
        let fits = self.scopes.len() <= DEEPEST && self.program.instructions.len() <= LONGEST;
        self.memory.too_deep |= !fits;
        if self.memory.too_deep {
            return Operand::Jet(to);
        }
        // What both branches need is computed once, before.
        let (then, otherwise) = (self.unconditional(a), self.unconditional(b));
        for &id in then.intersection(&otherwise) {
            self.compute(id);
        }
        let condition = self.scalar(condition);
        let branch = self.program.instructions.len();
        self.push(Code::JumpIfZero, 0, condition, 0);
        self.branch(a, to);
        let end = self.program.instructions.len();
        self.push(Code::Jump, 0, 0, 0);
        self.program.instructions[branch].b = self.program.instructions.len() as u32;
        self.branch(b, to);
        self.program.instructions[end].b = self.program.instructions.len() as u32;
        Operand::Jet(to)
    }

    fn branch(&mut self, root: NodeId, to: u32) {
        self.scopes.push(HashMap::new());
        self.store(root, to);
        self.scopes.pop();
    }

    fn copy(&mut self, from: Operand, to: u32) {
        match from {
            Operand::Jet(at) if at == to => {}
            Operand::Jet(at) => self.push(Code::CopyJ, to, at, 0),
            Operand::Scalar(at) => self.push(Code::Spread, to, at, 0),
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
                let to = self.temporary();
                self.push(Code::Spread, to, at, 0);
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

    fn temporary(&mut self) -> u32 {
        let at = self.used | TEMPORARY;
        self.used += self.memory.layout.width;
        at
    }

    fn emit(&mut self, code: Code, a: u32, b: u32) -> Operand {
        let to = self.temporary();
        self.push(code, to, a, b);
        Operand::Jet(to)
    }

    fn emit_scalar(&mut self, code: Code, a: u32, b: u32) -> Operand {
        match self.emit(code, a, b) {
            Operand::Jet(at) | Operand::Scalar(at) => Operand::Scalar(at),
        }
    }

    fn push(&mut self, code: Code, to: u32, a: u32, b: u32) {
        self.program.instructions.push(Instruction { code, to, a, b });
    }

    fn is_parametric(&mut self, node: NodeId) -> bool {
        if let Some(&known) = self.memory.parametric.get(&node) {
            return known;
        }
        for id in self.system.graph.reachable([node]) {
            let known = match self.system.graph.node(id) {
                Node::Leaf(leaf) => matches!(leaf, Leaf::Parameter(_)),
                _ => {
                    let mut all = true;
                    let parametric = &self.memory.parametric;
                    self.system.graph.operands(id, |operand| all &= parametric[&operand]);
                    all
                }
            };
            self.memory.parametric.insert(id, known);
        }
        self.memory.parametric[&node]
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

/// The sources among leaves: states, inputs and time.
pub(crate) fn source_of(leaf: Leaf, layout: Layout) -> Option<SourceIndex> {
    match leaf {
        Leaf::State(i) => Some(SourceIndex(i.0)),
        Leaf::Input(i) => Some(SourceIndex(layout.states + i.0)),
        Leaf::Time => Some(layout.time()),
        _ => None,
    }
}
