use super::{Asked, compile};
use crate::interpreter::{bound, run};
use proptest::prelude::*;
use sophy_field::{Affine, Ball, Code, Enclosing, Instruction, Kernels, Program};

const WIDTH: usize = 4;

/// Numbers in memory that programs only read, a column behind them, then temporaries.
const READ: u32 = 10 * WIDTH as u32;
const COLUMN: u32 = READ;
const TEMPORARIES: u32 = COLUMN + 5;
const LENGTH: usize = TEMPORARIES as usize + 20 * WIDTH;

const ARITHMETIC: [Code; 38] = [
    Code::AddJJ,
    Code::AddJS,
    Code::SubJJ,
    Code::SubJS,
    Code::SubSJ,
    Code::MulJJ,
    Code::MulJS,
    Code::DivJJ,
    Code::DivJS,
    Code::DivSJ,
    Code::Negate,
    Code::Square,
    Code::IntegerPower,
    Code::PowJS,
    Code::PowSJ,
    Code::PowJJ,
    Code::Min,
    Code::Max,
    Code::Atan2,
    Code::Sin,
    Code::Cos,
    Code::Tan,
    Code::Asin,
    Code::Acos,
    Code::Atan,
    Code::Sinh,
    Code::Cosh,
    Code::Tanh,
    Code::Asinh,
    Code::Acosh,
    Code::Atanh,
    Code::Exp,
    Code::Ln,
    Code::Log10,
    Code::Sqrt,
    Code::Abs,
    Code::Sign,
    Code::Floor,
];

const OTHERS: [Code; 10] = [
    Code::CopyJ,
    Code::Spread,
    Code::Less,
    Code::LessEqual,
    Code::Equal,
    Code::Not,
    Code::And,
    Code::Or,
    Code::Locate,
    Code::Lookup,
];

fn memory(numbers: &[f64]) -> Vec<f64> {
    let mut memory = vec![0.25; LENGTH];
    memory[..numbers.len()].copy_from_slice(numbers);
    memory[COLUMN as usize..][..5].copy_from_slice(&[4.0, -1.0, 0.0, 0.5, 2.0]);
    memory
}

/// A program, ready to be run both ways.
struct Both {
    program: Program,
    orders: usize,
    /// Where records end.
    rest: u32,
    kernels: Kernels,
}

impl Both {
    fn new(program: Program, operands: u32, orders: usize, rest: u32) -> Self {
        let results = vec![(TEMPORARIES..LENGTH as u32).collect()];
        let mut asked = Asked { calls: vec![vec![None]; WIDTH], bounds: vec![Some(operands)], results };
        asked.calls[orders - 1][0] = Some(operands);
        // SAFETY: `run` brings operands that lie inside of memory, as what the programs of this file address does, and
        // records are only read.
        let kernels = unsafe { compile(std::slice::from_ref(&program), rest, &asked) }.unwrap();
        Both { program, orders, rest, kernels }
    }

    /// The bits of memory, interpreted and native: numbers, and then balls.
    fn run(&self, operands: &[u32], numbers: &[f64]) -> [Vec<u64>; 2] {
        let (mut interpreted, mut native) = (memory(numbers), memory(numbers));
        // As those of some copy.
        let copy = 5;
        let stride = |k: usize| 3 * k as u32 + 1;
        let operands: Vec<Affine> = (0..)
            .zip(operands)
            .map(|(k, &at)| Affine { first: at.wrapping_sub(copy * stride(k)), stride: stride(k) })
            .collect();
        run(&self.program, &operands, copy, &mut interpreted, self.orders);
        // SAFETY: as in `new`.
        unsafe { self.kernels.get(0, self.orders).unwrap()(operands.as_ptr(), copy, native.as_mut_ptr()) };
        let (numbers, rest) = (memory(numbers), self.rest);
        let radius = |k: usize| 0.1 * numbers[(7 * k + 3) % LENGTH].abs();
        let balls: Vec<Ball> = (rest as usize..LENGTH).map(|k| [numbers[k], radius(k)]).collect();
        let (mut bounded, mut natively) = (balls.clone(), balls);
        let now = [numbers[0], 0.125];
        let mut enclosing = Enclosing { numbers: &numbers, enclosed: &mut bounded, rest, now };
        bound(&self.program, &operands, copy, &mut enclosing);
        let kernel = self.kernels.bound(0).unwrap();
        // SAFETY: as in `new`.
        unsafe { kernel(operands.as_ptr(), copy, numbers.as_ptr(), natively.as_mut_ptr(), &raw const now) };
        // Which of two NaN comes out of their sum is not promised.
        let bits = |x: f64| if x.is_nan() { f64::NAN.to_bits() } else { x.to_bits() };
        [(interpreted, bounded), (native, natively)].map(|(numbers, balls)| {
            numbers.into_iter().chain(balls.into_iter().flatten()).map(bits).collect()
        })
    }
}

fn number() -> impl Strategy<Value = f64> {
    prop_oneof![
        6 => -3.0..3.0f64,
        1 => prop::sample::select(vec![0.0, -0.0, 1.0, -1.0, 2.0, f64::INFINITY, f64::NAN, 1e-310, 1e300]),
    ]
}

/// An instruction whose operands are what was read or computed before.
fn instruction(code: Code, position: u32, a: u32, b: u32) -> Instruction {
    let place = |k: u32| {
        let at = k % (10 + position);
        if at < 10 { at * WIDTH as u32 } else { TEMPORARIES + (at - 10) * WIDTH as u32 }
    };
    let b = match code {
        Code::IntegerPower => (b % 11) as i32 as u32,
        Code::Locate | Code::Lookup => COLUMN,
        _ => place(b),
    };
    Instruction { code, to: TEMPORARIES + position * WIDTH as u32, a: place(a), b }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    /// Straight-line programs of all codes.
    #[test]
    fn native_code_has_the_bits_of_the_interpreter(
        codes in prop::collection::vec((0..ARITHMETIC.len() + OTHERS.len(), 0..99u32, 0..99u32), 1..20),
        numbers in prop::collection::vec(number(), READ as usize),
        orders in 1..=WIDTH,
    ) {
        let all: Vec<Code> = ARITHMETIC.into_iter().chain(OTHERS).collect();
        let instructions = (0..).zip(codes)
            .map(|(position, (code, a, b))| instruction(all[code], position, a, b))
            .collect();
        let program = Program { instructions, gather: TEMPORARIES, stride: WIDTH as u32 };
        let [interpreted, native] = Both::new(program, 0, orders, 0).run(&[], &numbers);
        prop_assert_eq!(interpreted, native);
    }
}

/// Each code alone, on all pairs of numbers that are special somewhere.
#[test]
fn each_code_agrees_on_special_numbers() {
    let special = [0.0, -0.0, 1.0, -1.0, 0.5, 2.0, f64::INFINITY, f64::NEG_INFINITY, f64::NAN];
    for code in ARITHMETIC.into_iter().chain(OTHERS) {
        for exponent in if code == Code::IntegerPower { -3..4 } else { 0..1 } {
            let mut alone = instruction(code, 0, 0, 1);
            if code == Code::IntegerPower {
                alone.b = exponent as u32;
            }
            for orders in 1..=WIDTH {
                let program =
                    Program { instructions: vec![alone], gather: TEMPORARIES, stride: WIDTH as u32 };
                let both = Both::new(program, 0, orders, 0);
                for (x, y) in special.into_iter().flat_map(|x| special.map(|y| (x, y))) {
                    let [interpreted, native] = both.run(&[], &[x, y, 0.7, y, x, -0.3].repeat(5));
                    assert_eq!(interpreted, native, "{code:?} of {x} and {y}, {orders} orders");
                }
            }
        }
    }
}

/// `if a < b then c else d`, then a use of what came out, on operands that each call brings.
#[test]
fn branches_and_operands() {
    let at = |k: u32| TEMPORARIES + k * WIDTH as u32;
    let (less, chosen, sum) = (at(4), at(5), at(6));
    let step = |code, to, a, b| Instruction { code, to, a, b };
    let program = Program {
        instructions: vec![
            step(Code::Less, less, at(0), at(1)),
            step(Code::JumpIfZero, 0, less, 5),
            step(Code::Square, at(7), at(2), 0),
            step(Code::CopyJ, chosen, at(7), 0),
            step(Code::Jump, 0, 0, 6),
            step(Code::CopyJ, chosen, at(3), 0),
            step(Code::AddJJ, sum, chosen, at(0)),
            step(Code::Store, 1, sum, 0),
        ],
        gather: TEMPORARIES,
        stride: WIDTH as u32,
    };
    let numbers: Vec<f64> = (0..READ).map(|k| f64::from(k * 7 % 5) + 0.5).collect();
    for orders in 1..=WIDTH {
        let both = Both::new(program.clone(), 4, orders, 0);
        for operands in [[0, 3, 6, 9], [3, 0, 6, 9], [12, 15, 0, 0], [9, 9, 9, 9]] {
            let [interpreted, native] = both.run(&operands, &numbers);
            let written = operands[1] as usize;
            assert_eq!(interpreted[..READ as usize], native[..READ as usize], "{operands:?}");
            assert_ne!(interpreted[written], numbers[written].to_bits());
            assert_eq!(interpreted[sum as usize], native[sum as usize]);
        }
    }
}

/// Trajectories of two to four coefficients, addressed and brought by a call, at several times.
#[test]
fn trajectories_are_followed() {
    let at = |k: u32| TEMPORARIES + k * WIDTH as u32;
    for (count, orders) in (2..=4).flat_map(|count| (1..=WIDTH).map(move |orders| (count, orders))) {
        let follow = |code, to, a| Instruction { code, to, a, b: count };
        let product = Instruction { code: Code::MulJJ, to: at(2), a: at(0), b: at(1) };
        let instructions =
            vec![follow(Code::FollowOperand, at(0), 0), follow(Code::Follow, at(1), 8), product];
        let program = Program { instructions, gather: TEMPORARIES, stride: WIDTH as u32 };
        let both = Both::new(program, 1, orders, READ);
        for now in [-1.0, 0.25, 3.0] {
            let mut numbers: Vec<f64> = (0..READ).map(|k| f64::from(k * 7 % 5) - 1.5).collect();
            numbers[0] = now;
            let [interpreted, native] = both.run(&[16], &numbers);
            assert_eq!(interpreted, native, "{count} coefficients, {orders} orders, at {now}");
            let value = |first: usize| {
                let s = now - numbers[first + count as usize];
                (0..count as usize).rev().fold(0.0, |sum, k| sum * s + numbers[first + k])
            };
            let expected = value(16) * value(8);
            let found = f64::from_bits(native[at(2) as usize]);
            assert!((found - expected).abs() < 1e-12 * (1.0 + expected.abs()), "{found} {expected}");
        }
    }
}
