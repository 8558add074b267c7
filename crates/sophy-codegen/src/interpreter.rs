//! The interpreter: one function that runs any program, for every number of coefficients and for numbers and
//! enclosures alike.

use crate::jet;
use crate::scalar::Scalar;
use sophy_field::{Code, Program};
use sophy_segment::Interval;

/// Runs `program` on numbers; see [`sophy_field::Run`].
pub fn run(program: &Program, operands: &[u32], memory: &mut [f64], orders: usize) {
    dispatch(program, operands, memory, orders);
}

/// Runs `program` on enclosures; see [`sophy_field::Enclose`].
pub fn enclose(program: &Program, operands: &[u32], memory: &mut [Interval], orders: usize) {
    dispatch(program, operands, memory, orders);
}

#[inline]
fn dispatch<T: Scalar>(program: &Program, operands: &[u32], memory: &mut [T], orders: usize) {
    match orders {
        1 => execute::<T, 1>(program, operands, memory),
        2 => execute::<T, 2>(program, operands, memory),
        3 => execute::<T, 3>(program, operands, memory),
        _ => execute::<T, 4>(program, operands, memory),
    }
}

#[inline]
fn load<T: Copy, const N: usize>(memory: &[T], at: u32) -> [T; N] {
    let at = at as usize;
    let slice = &memory[at..at + N];
    std::array::from_fn(|k| slice[k])
}

#[inline]
fn store<T: Copy, const N: usize>(memory: &mut [T], at: u32, value: [T; N]) {
    let at = at as usize;
    memory[at..at + N].copy_from_slice(&value);
}

pub(crate) fn execute<T: Scalar, const N: usize>(program: &Program, operands: &[u32], memory: &mut [T]) {
    // Behind a scalar stands something too: what is copied with it is never read.
    let mut to = program.gather;
    for &operand in operands {
        let value = load::<T, N>(memory, operand);
        store(memory, to, value);
        to += program.stride;
    }
    let mut next = 0;
    while let Some(instruction) = program.instructions.get(next) {
        next += 1;
        let (to, a, b) = (instruction.to, instruction.a, instruction.b);
        macro_rules! jet {
            ($at:expr) => {
                load::<T, N>(memory, $at)
            };
        }
        macro_rules! scalar {
            ($at:expr) => {
                memory[$at as usize]
            };
        }
        let value: [T; N] = match instruction.code {
            Code::AddJJ => zip(jet!(a), jet!(b), |x, y| x + y),
            Code::AddJS => with_first(jet!(a), |x| x + scalar!(b)),
            Code::SubJJ => zip(jet!(a), jet!(b), |x, y| x - y),
            Code::SubJS => with_first(jet!(a), |x| x - scalar!(b)),
            Code::SubSJ => {
                let right = jet!(b);
                let mut c = right.map(|x| -x);
                c[0] = scalar!(a) - right[0];
                c
            }
            Code::MulJJ => jet::multiply(jet!(a), jet!(b)),
            Code::MulJS => {
                let factor = scalar!(b);
                jet!(a).map(|x| x * factor)
            }
            Code::DivJJ => jet::divide(jet!(a), jet!(b)),
            Code::DivJS => {
                let below = scalar!(b);
                jet!(a).map(|x| x / below)
            }
            Code::DivSJ => {
                let mut above = [T::of(0.0); N];
                above[0] = scalar!(a);
                jet::divide(above, jet!(b))
            }
            Code::Negate => jet!(a).map(|x| -x),
            Code::Square => jet::square(jet!(a)),
            Code::IntegerPower => jet::integer_power(jet!(a), b as i32),
            Code::PowJS => jet::power_constant(jet!(a), scalar!(b)),
            Code::PowSJ => {
                let mut base = [T::of(0.0); N];
                base[0] = scalar!(a);
                jet::power(base, jet!(b))
            }
            Code::PowJJ => jet::power(jet!(a), jet!(b)),
            Code::Min | Code::Max => {
                let (x, y) = (jet!(a), jet!(b));
                let (low, high) = if instruction.code == Code::Min { (x, y) } else { (y, x) };
                T::choose(x[0].less(y[0]), || low, || high)
            }
            Code::Atan2 => jet::atan2(jet!(a), jet!(b)),
            Code::Sin => jet::sine_cosine(jet!(a), false).0,
            Code::Cos => jet::sine_cosine(jet!(a), false).1,
            Code::Tan => jet::tangent(jet!(a), false),
            Code::Asin => jet::asin(jet!(a)),
            Code::Acos => jet::acos(jet!(a)),
            Code::Atan => jet::atan(jet!(a)),
            Code::Sinh => jet::sine_cosine(jet!(a), true).0,
            Code::Cosh => jet::sine_cosine(jet!(a), true).1,
            Code::Tanh => jet::tangent(jet!(a), true),
            Code::Asinh => jet::asinh(jet!(a)),
            Code::Acosh => jet::acosh(jet!(a)),
            Code::Atanh => jet::atanh(jet!(a)),
            Code::Exp => jet::exp(jet!(a)),
            Code::Ln => jet::ln(jet!(a)),
            Code::Log10 => jet::log10(jet!(a)),
            Code::Sqrt => jet::sqrt(jet!(a)),
            Code::Abs => {
                let x = jet!(a);
                T::choose(x[0].less(T::of(0.0)), || x.map(|c| -c), || x)
            }
            Code::Sign => constant(jet!(a)[0].sign()),
            Code::Floor => constant(jet!(a)[0].floor()),
            Code::CopyJ => jet!(a),
            Code::Spread => constant(scalar!(a)),
            Code::Less => {
                memory[to as usize] = truth(scalar!(a).less(scalar!(b)));
                continue;
            }
            Code::LessEqual => {
                let (x, y) = (scalar!(a), scalar!(b));
                memory[to as usize] = T::choose(x.less(y), || [T::of(1.0)], || [truth(x.equal(y))])[0];
                continue;
            }
            Code::Equal => {
                memory[to as usize] = truth(scalar!(a).equal(scalar!(b)));
                continue;
            }
            Code::Locate => {
                memory[to as usize] = scalar!(a).locate(column(memory, b));
                continue;
            }
            Code::Lookup => {
                memory[to as usize] = scalar!(a).lookup(column(memory, b));
                continue;
            }
            Code::Not => {
                memory[to as usize] = T::choose(is_zero(scalar!(a)), || [T::of(1.0)], || [T::of(0.0)])[0];
                continue;
            }
            Code::And => {
                memory[to as usize] =
                    T::choose(is_zero(scalar!(a)), || [T::of(0.0)], || [as_truth(scalar!(b))])[0];
                continue;
            }
            Code::Or => {
                memory[to as usize] =
                    T::choose(is_zero(scalar!(a)), || [as_truth(scalar!(b))], || [T::of(1.0)])[0];
                continue;
            }
            Code::JumpIfZero => {
                if T::decided(is_zero(scalar!(a))) {
                    next = b as usize;
                }
                continue;
            }
            Code::Jump => {
                next = b as usize;
                continue;
            }
            Code::Store => {
                let value = jet!(a);
                store(memory, operands[to as usize], value);
                continue;
            }
        };
        store(memory, to, value);
    }
}

/// The numbers of a column: they stand behind their count.
#[inline]
fn column<T: Scalar>(memory: &[T], at: u32) -> &[T] {
    let first = at as usize + 1;
    &memory[first..first + memory[at as usize].count()]
}

#[inline]
fn zip<T: Copy, const N: usize>(a: [T; N], b: [T; N], f: impl Fn(T, T) -> T) -> [T; N] {
    std::array::from_fn(|k| f(a[k], b[k]))
}

#[inline]
fn with_first<T: Copy, const N: usize>(mut a: [T; N], f: impl Fn(T) -> T) -> [T; N] {
    a[0] = f(a[0]);
    a
}

#[inline]
fn constant<T: Scalar, const N: usize>(value: T) -> [T; N] {
    let mut c = [T::of(0.0); N];
    c[0] = value;
    c
}

#[inline]
fn truth<T: Scalar>(value: T::Truth) -> T {
    T::choose(value, || [T::of(1.0)], || [T::of(0.0)])[0]
}

#[inline]
fn is_zero<T: Scalar>(value: T) -> T::Truth {
    value.equal(T::of(0.0))
}

/// 0 for 0, else 1.
#[inline]
fn as_truth<T: Scalar>(value: T) -> T {
    T::choose(is_zero(value), || [T::of(0.0)], || [T::of(1.0)])[0]
}
