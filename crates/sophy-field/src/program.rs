//! Straight-line programs over Taylor coefficients: what the equations of a system are compiled to.

use sophy_segment::Interval;
use std::ops::Range;

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
}

/// A program, absolute or shared.
///
/// An *absolute* one names in its instructions the memory it reads. A *shared* one stands for all equations of
/// one shape, a thousand copies of a component say: each use brings its own table of operands (offsets of
/// jets and scalars), which are gathered into temporaries before the first instruction.
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
    /// In [`crate::Equations::operands`]: its operands, none if it is absolute.
    pub operands: Range<u32>,
}

/// Runs a program on memory, computing `orders` coefficients (1 … width) of every jet.
///
/// Both back ends fill the same pointer, so that nothing above is generic over them.
pub type Run = fn(program: &Program, operands: &[u32], memory: &mut [f64], orders: usize);

/// The same over intervals: every coefficient becomes an enclosure.
pub type Enclose = fn(program: &Program, operands: &[u32], memory: &mut [Interval], orders: usize);

/// Where the result of a formula stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Operand {
    /// A jet at this offset.
    Jet(u32),
    /// A scalar at this offset.
    Scalar(u32),
}
