//! Straight-line programs over Taylor coefficients: what the equations of a system are compiled to.

use crate::Affine;
use sophy_segment::Interval;
use std::any::Any;
use std::fmt;
use std::sync::Arc;

/// One operation on memory. Operands and result are offsets: a *jet* is `width` consecutive numbers (value
/// and scaled derivatives `x⁽ᵏ⁾/k!`), a *scalar* is one number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Instruction {
    /// What to do.
    pub code: Code,
    /// Where the result goes.
    pub to: u32,
    /// First operand.
    pub a: u32,
    /// Second operand, a whole exponent (as `i32`), or a jump target.
    pub b: u32,
}

/// Operations. In names, `J` is a jet operand, `S` a scalar one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs)] // each name is the operation and the kinds of its operands
pub enum Code {
    AddJJ,
    AddJS,
    SubJJ,
    SubJS,
    SubSJ,
    MulJJ,
    MulJS,
    DivJJ,
    DivJS,
    DivSJ,
    Negate,
    Square,
    IntegerPower,
    PowJS,
    PowSJ,
    PowJJ,
    Min,
    Max,
    Atan2,
    Sin,
    Cos,
    Tan,
    Asin,
    Acos,
    Atan,
    Sinh,
    Cosh,
    Tanh,
    Asinh,
    Acosh,
    Atanh,
    Exp,
    Ln,
    Log10,
    Sqrt,
    Abs,
    Sign,
    Floor,
    /// A jet from a jet.
    CopyJ,
    /// A jet from a scalar: its derivatives are zero.
    Spread,
    /// Comparisons of the values of two jets; the result is a scalar 1 or 0.
    Less,
    LessEqual,
    Equal,
    /// The position of scalar `a` among the knots of the column at `b`, a scalar.
    Locate,
    /// The number at position `a` (a scalar) of the column at `b`, a scalar.
    Lookup,
    /// Logic on scalars.
    Not,
    And,
    Or,
    /// Continues at instruction `b` if scalar `a` is 0.
    JumpIfZero,
    /// Continues at instruction `b`.
    Jump,
    /// Copies jet `a` to the operand of number `to`.
    Store,
    /// The jet, at the present time, of the trajectory at `a`: `b` coefficients, then their start.
    Follow,
    /// The same of the operand of number `a`.
    FollowOperand,
}

/// What an instruction reads at one of its operands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reads {
    /// A jet.
    Jet,
    /// A scalar.
    Scalar,
    /// Nothing of memory: it is an exponent, a column, a jump target, or unused.
    Nothing,
}

impl Code {
    /// What stands at `a` and at `b`.
    pub fn reads(self) -> [Reads; 2] {
        use Reads::{Jet, Nothing, Scalar};
        match self {
            Code::AddJJ
            | Code::SubJJ
            | Code::MulJJ
            | Code::DivJJ
            | Code::PowJJ
            | Code::Min
            | Code::Max
            | Code::Atan2 => [Jet, Jet],
            Code::AddJS | Code::SubJS | Code::MulJS | Code::DivJS | Code::PowJS => [Jet, Scalar],
            Code::SubSJ | Code::DivSJ | Code::PowSJ => [Scalar, Jet],
            Code::Less | Code::LessEqual | Code::Equal | Code::And | Code::Or => [Scalar, Scalar],
            Code::Not | Code::Spread | Code::Locate | Code::Lookup | Code::JumpIfZero => [Scalar, Nothing],
            Code::Jump | Code::Follow | Code::FollowOperand => [Nothing, Nothing],
            _ => [Jet, Nothing],
        }
    }

    /// Whether the result is a jet; else it is a scalar, or there is none.
    pub fn writes_jet(self) -> bool {
        !matches!(
            self,
            Code::Less
                | Code::LessEqual
                | Code::Equal
                | Code::Locate
                | Code::Lookup
                | Code::Not
                | Code::And
                | Code::Or
                | Code::JumpIfZero
                | Code::Jump
        )
    }
}

/// A program, absolute or shared.
///
/// An *absolute* one names in its instructions the memory it reads. A *shared* one stands for all equations of
/// one shape, a thousand copies of a component say: each use brings its own operands (offsets of trajectories, jets
/// and scalars), which are gathered into temporaries before the first instruction.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Program {
    /// Executed from the first on; jumps lead forwards only.
    pub instructions: Vec<Instruction>,
    /// Where operands are gathered: the first here, each `stride` behind the one before.
    pub gather: u32,
    /// See `gather`.
    pub stride: u32,
}

/// A program and what it is run on.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Call {
    /// Index of the program; an empty one where there is nothing to compute.
    pub program: u32,
    /// Its operands, none if it is absolute.
    pub operands: Box<[Affine]>,
}

/// Taylor coefficients `x⁽ᵏ⁾/k!` of a quantity, as many as any engine of this family reads: order 3, and one more to bound
/// its error. Engines of lower order leave the last ones 0.
pub type Jet = [f64; 4];

/// Runs a program on memory, computing `orders` coefficients (1 … width) of every jet.
///
/// Both back ends fill the same pointer, so that nothing above is generic over them.
pub type Run = fn(program: &Program, operands: &[Affine], copy: u32, memory: &mut [f64], orders: usize);

/// The same over a stretch of time: every coefficient becomes an enclosure.
pub type Enclose =
    fn(program: &Program, operands: &[Affine], copy: u32, memory: &mut Enclosing<'_>, orders: usize);

/// All numbers that are not farther from the first of these two than the second: a middle and a radius, infinite or NaN
/// where nothing is known.
pub type Ball = [f64; 2];

/// Values over a stretch of time as balls: coarser, but quicker.
pub type Bound = fn(program: &Program, operands: &[Affine], copy: u32, memory: &mut Enclosing<'_, Ball>);

/// Memory over a stretch of time: what programs write is enclosed, the records of sources are numbers.
#[derive(Debug)]
pub struct Enclosing<'a, E = Interval> {
    /// Memory. Of its numbers only the records and, by [`Bound`], the columns are read.
    pub numbers: &'a [f64],
    /// What stands behind the records.
    pub enclosed: &'a mut [E],
    /// Where that begins ([`Layout::rest`](crate::Layout::rest)).
    pub rest: u32,
    /// The stretch of time, s.
    pub now: E,
}

/// Native code of programs: for each number of coefficients, one function per program that has it.
///
/// Programs without it are interpreted; the bits are the same.
#[derive(Clone)]
pub struct Kernels {
    /// By program, then by orders − 1.
    of: Vec<[Option<Kernel>; 4]>,
    /// By program.
    bounds: Vec<Option<BoundKernel>>,
    /// Keeps the machine code alive.
    _code: Arc<dyn Any + Send + Sync>,
}

/// Machine code of one program: its operands, for which copy, and memory.
///
/// # Safety
/// As [`Kernels::new`] says.
pub type Kernel = unsafe extern "C" fn(operands: *const Affine, copy: u32, memory: *mut f64);

/// Machine code that bounds a program: its operands, for which copy, memory, what stands behind the records, and the
/// stretch of time.
///
/// # Safety
/// As [`Kernels::new`] says.
pub type BoundKernel = unsafe extern "C" fn(
    operands: *const Affine,
    copy: u32,
    numbers: *const f64,
    enclosed: *mut Ball,
    now: *const Ball,
);

impl Kernels {
    /// Kernels by program and then by orders − 1, and those that bound, by program; `code` is what they live in.
    ///
    /// # Safety
    /// A kernel lives as long as `code`. Run with operands of a [`Call`] of its program, one of the copies, memory as long as
    /// its [`Equations`](crate::Equations) say, and a ball for each number behind the records, it stays inside of them.
    #[allow(unsafe_code)]
    pub unsafe fn new(
        of: Vec<[Option<Kernel>; 4]>,
        bounds: Vec<Option<BoundKernel>>,
        code: Arc<dyn Any + Send + Sync>,
    ) -> Self {
        Kernels { of, bounds, _code: code }
    }

    /// The kernel of a program, if it has one.
    #[inline]
    pub fn get(&self, program: u32, orders: usize) -> Option<Kernel> {
        self.of.get(program as usize)?[(orders - 1) % 4]
    }

    /// The kernel that bounds a program, if it has one.
    pub fn bound(&self, program: u32) -> Option<BoundKernel> {
        *self.bounds.get(program as usize)?
    }

    /// How many kernels there are.
    pub fn count(&self) -> usize {
        self.of.iter().flatten().flatten().count() + self.bounds.iter().flatten().count()
    }
}

impl fmt::Debug for Kernels {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Kernels({})", self.count())
    }
}
