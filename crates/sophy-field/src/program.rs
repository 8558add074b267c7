//! Straight-line programs over Taylor coefficients: what the equations of a system are compiled to.

use sophy_segment::Interval;

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
    /// Logic on scalars.
    Not,
    And,
    Or,
    /// Continues at instruction `b` if scalar `a` is 0.
    JumpIfZero,
    /// Continues at instruction `b`.
    Jump,
}

/// A program and how much memory it needs.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Program {
    /// Executed from the first on; jumps lead forwards only.
    pub instructions: Vec<Instruction>,
}

/// Runs a program on memory, computing `orders` coefficients (1 … width) of every jet.
///
/// Both back ends fill the same pointer, so that nothing above is generic over them.
pub type Run = fn(program: &Program, memory: &mut [f64], orders: usize);

/// The same over intervals: every coefficient becomes an enclosure.
pub type Enclose = fn(program: &Program, memory: &mut [Interval], orders: usize);

/// Where the result of a formula stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Operand {
    /// A jet at this offset.
    Jet(u32),
    /// A scalar at this offset.
    Scalar(u32),
}
