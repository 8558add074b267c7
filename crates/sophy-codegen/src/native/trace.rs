//! The interpreter's arithmetic, written down instead of done: what one instruction computes, operation by
//! operation, in the same order, so that native code has the same bits.

use crate::ball::BallOf;
use crate::interpreter::{Numbers, execute};
use crate::scalar::Scalar;
use sophy_field::{Code, Instruction, Program};
use std::cell::RefCell;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// A value on the tape: the position of the operation that makes it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Traced(u32);

/// An operation; operands are positions of earlier ones.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Operation {
    /// A part of what is read, as [`Trace::of`] counts them.
    Input(u32),
    Number(f64),
    Add(u32, u32),
    Subtract(u32, u32),
    Multiply(u32, u32),
    Divide(u32, u32),
    Negate(u32),
    Absolute(u32),
    Sqrt(u32),
    Floor(u32),
    Less(u32, u32),
    Equal(u32, u32),
    /// The second operand if the first, a comparison, holds, else the third.
    Choose(u32, u32, u32),
    Call(Function, u32),
    CallTwo(FunctionOfTwo, u32, u32),
}

/// An elementary function of one number.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) enum Function {
    Exp,
    Ln,
    Log10,
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
}

/// An elementary function of two numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) enum FunctionOfTwo {
    Atan2,
    Pow,
}

/// What one instruction computes.
#[derive(Debug, Default)]
pub(super) struct Trace {
    pub(super) operations: Vec<Operation>,
    /// Where the coefficients of the result stand on the tape, all parts of each.
    pub(super) results: Vec<u32>,
}

thread_local! {
    static TAPE: RefCell<Vec<Operation>> = const { RefCell::new(Vec::new()) };
}

impl Trace {
    /// What `instruction` (neither a jump nor one that reads columns) does to jets of `orders` coefficients.
    ///
    /// What it reads is counted so: the numbers of the first jet or scalar, then those of the second. Of a trajectory: its
    /// coefficients, its start, the present time.
    pub(super) fn of(instruction: &Instruction, orders: usize) -> Self {
        match orders {
            1 => trace::<Traced, 1>(instruction),
            2 => trace::<Traced, 2>(instruction),
            3 => trace::<Traced, 3>(instruction),
            _ => trace::<Traced, 4>(instruction),
        }
    }

    /// What it does to balls: of each the middle is counted first, then the radius.
    pub(super) fn of_balls(instruction: &Instruction) -> Self {
        trace::<BallOf<Traced>, 1>(instruction)
    }
}

/// What is made of numbers on the tape.
trait Parts: Scalar {
    /// What is read as the `k`-th.
    fn input(k: u32) -> Self;
    /// Its parts.
    fn parts(self) -> impl Iterator<Item = Traced>;
}

impl Parts for Traced {
    fn input(k: u32) -> Self {
        note(Operation::Input(k))
    }
    fn parts(self) -> impl Iterator<Item = Traced> {
        [self].into_iter()
    }
}

impl Parts for BallOf<Traced> {
    fn input(k: u32) -> Self {
        BallOf { middle: Traced::input(2 * k), radius: Traced::input(2 * k + 1) }
    }
    fn parts(self) -> impl Iterator<Item = Traced> {
        [self.middle, self.radius].into_iter()
    }
}

fn trace<T: Parts, const N: usize>(instruction: &Instruction) -> Trace {
    TAPE.with_borrow_mut(Vec::clear);
    let n = N as u32;
    let input = T::input;
    let (alone, mut memory): (_, Vec<T>) = match instruction.code {
        Code::Follow | Code::FollowOperand => {
            // The present time stands first.
            let count = instruction.b;
            let memory = std::iter::once(count + 1).chain(0..=count).map(input).collect();
            (Instruction { code: Code::Follow, to: count + 2, a: 1, b: count }, memory)
        }
        code => {
            // An exponent is no operand.
            let b = if code == Code::IntegerPower { instruction.b } else { n };
            (Instruction { code, to: 2 * n, a: 0, b }, (0..2 * n).map(input).collect())
        }
    };
    memory.extend((0..n).map(|_| T::of(0.0)));
    let program = Program { instructions: vec![alone], gather: 0, stride: 0 };
    execute::<T, _, N>(&program, (&[], 0), &mut Numbers(&mut memory));
    let written = if instruction.code.writes_jet() { N } else { 1 };
    let results = memory[alone.to as usize..][..written].iter().flat_map(|result| result.parts());
    let results = results.map(|traced| traced.0).collect();
    Trace { operations: TAPE.with_borrow_mut(std::mem::take), results }
}

fn note(operation: Operation) -> Traced {
    TAPE.with_borrow_mut(|tape| {
        tape.push(operation);
        Traced(tape.len() as u32 - 1)
    })
}

impl Traced {
    fn is_one(self) -> bool {
        TAPE.with_borrow(|tape| tape.get(self.0 as usize) == Some(&Operation::Number(1.0)))
    }
}

impl Add for Traced {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        note(Operation::Add(self.0, other.0))
    }
}

impl Sub for Traced {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        note(Operation::Subtract(self.0, other.0))
    }
}

// Recurrences multiply and divide by 1 often; that changes no bit.
impl Mul for Traced {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        match (self.is_one(), other.is_one()) {
            (true, _) => other,
            (_, true) => self,
            _ => note(Operation::Multiply(self.0, other.0)),
        }
    }
}

impl Div for Traced {
    type Output = Self;
    fn div(self, other: Self) -> Self {
        if other.is_one() { self } else { note(Operation::Divide(self.0, other.0)) }
    }
}

impl Neg for Traced {
    type Output = Self;
    fn neg(self) -> Self {
        note(Operation::Negate(self.0))
    }
}

macro_rules! calls {
    ($($name:ident $function:ident),*) => {$(
        fn $name(self) -> Self {
            note(Operation::Call(Function::$function, self.0))
        }
    )*};
}

impl Scalar for Traced {
    calls!(
        exp Exp, ln Ln, log10 Log10, sin Sin, cos Cos, tan Tan, asin Asin, acos Acos, atan Atan, sinh Sinh,
        cosh Cosh, tanh Tanh, asinh Asinh, acosh Acosh, atanh Atanh
    );

    type Truth = Traced;

    fn of(value: f64) -> Self {
        note(Operation::Number(value))
    }
    fn abs(self) -> Self {
        note(Operation::Absolute(self.0))
    }
    fn square(self) -> Self {
        self * self
    }
    fn sqrt(self) -> Self {
        note(Operation::Sqrt(self.0))
    }
    fn floor(self) -> Self {
        note(Operation::Floor(self.0))
    }
    fn atan2(self, x: Self) -> Self {
        note(Operation::CallTwo(FunctionOfTwo::Atan2, self.0, x.0))
    }
    fn pow(self, exponent: Self) -> Self {
        note(Operation::CallTwo(FunctionOfTwo::Pow, self.0, exponent.0))
    }

    /// [`sophy_ir::arithmetic::sign`].
    fn sign(self) -> Self {
        let zero = Self::of(0.0);
        let zero_or_nan = || Self::choose(self.equal(self), || [zero], || [self]);
        let not_positive = || Self::choose(self.less(zero), || [Self::of(-1.0)], zero_or_nan);
        Self::choose(zero.less(self), || [Self::of(1.0)], not_positive)[0]
    }

    fn less(self, other: Self) -> Self {
        note(Operation::Less(self.0, other.0))
    }
    fn equal(self, other: Self) -> Self {
        note(Operation::Equal(self.0, other.0))
    }
    fn choose<const N: usize>(
        truth: Self,
        yes: impl FnOnce() -> [Self; N],
        no: impl FnOnce() -> [Self; N],
    ) -> [Self; N] {
        let (yes, no) = (yes(), no());
        std::array::from_fn(|k| note(Operation::Choose(truth.0, yes[k].0, no[k].0)))
    }

    // Jumps and columns are not traced.
    fn decided(_: Self) -> bool {
        false
    }
    fn count(self) -> usize {
        0
    }
    fn locate(self, _: &[Self]) -> Self {
        self
    }
    fn lookup(self, _: &[Self]) -> Self {
        self
    }
}

impl Operation {
    /// The operations whose values it needs.
    pub(super) fn operands(&self, mut visit: impl FnMut(u32)) {
        match *self {
            Operation::Input(_) | Operation::Number(_) => {}
            Operation::Negate(a)
            | Operation::Absolute(a)
            | Operation::Sqrt(a)
            | Operation::Floor(a)
            | Operation::Call(_, a) => visit(a),
            Operation::Add(a, b)
            | Operation::Subtract(a, b)
            | Operation::Multiply(a, b)
            | Operation::Divide(a, b)
            | Operation::Less(a, b)
            | Operation::Equal(a, b)
            | Operation::CallTwo(_, a, b) => [a, b].into_iter().for_each(visit),
            Operation::Choose(condition, a, b) => [condition, a, b].into_iter().for_each(visit),
        }
    }
}
