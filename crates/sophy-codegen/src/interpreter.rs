//! The interpreter: one function that runs any program, for every number of coefficients and for numbers, balls and
//! enclosures alike.

use crate::ball::BallOf;
use crate::jet;
use crate::scalar::Scalar;
use sophy_field::{Affine, Ball, Code, Enclosing, NOW, Program};
use sophy_segment::Interval;

/// Runs `program` on numbers; see [`sophy_field::Run`].
pub fn run(program: &Program, operands: &[Affine], copy: u32, memory: &mut [f64], orders: usize) {
    dispatch(program, (operands, copy), &mut Numbers(memory), orders);
}

/// Runs `program` on enclosures; see [`sophy_field::Enclose`].
pub fn enclose(program: &Program, operands: &[Affine], copy: u32, memory: &mut Enclosing<'_>, orders: usize) {
    dispatch(program, (operands, copy), memory, orders);
}

/// Bounds `program`; see [`sophy_field::Bound`].
pub fn bound(program: &Program, operands: &[Affine], copy: u32, memory: &mut Enclosing<'_, Ball>) {
    execute::<BallOf<f64>, _, 1>(program, (operands, copy), memory);
}

#[inline]
fn dispatch<T: Scalar>(
    program: &Program,
    operands: (&[Affine], u32),
    memory: &mut impl Bank<T>,
    orders: usize,
) {
    match orders {
        1 => execute::<T, _, 1>(program, operands, memory),
        2 => execute::<T, _, 2>(program, operands, memory),
        3 => execute::<T, _, 3>(program, operands, memory),
        _ => execute::<T, _, 4>(program, operands, memory),
    }
}

/// Memory of some kind of numbers.
pub(crate) trait Bank<T: Scalar> {
    /// The present time, s.
    fn now(&self) -> T;
    fn get(&self, at: u32) -> T;
    fn set(&mut self, at: u32, value: T);
    /// The position of `x` among the knots of a column.
    fn locate(&self, x: T, column: u32) -> T;
    /// The number at position `x` of a column.
    fn lookup(&self, x: T, column: u32) -> T;

    #[inline]
    fn load<const N: usize>(&self, at: u32) -> [T; N] {
        std::array::from_fn(|k| self.get(at + k as u32))
    }
    #[inline]
    fn store<const N: usize>(&mut self, at: u32, value: [T; N]) {
        for (at, value) in (at..).zip(value) {
            self.set(at, value);
        }
    }
}

/// All of memory as numbers.
pub(crate) struct Numbers<'a, T>(pub(crate) &'a mut [T]);

impl<T: Scalar> Bank<T> for Numbers<'_, T> {
    #[inline]
    fn now(&self) -> T {
        self.0[NOW]
    }
    #[inline]
    fn get(&self, at: u32) -> T {
        self.0[at as usize]
    }
    #[inline]
    fn set(&mut self, at: u32, value: T) {
        self.0[at as usize] = value;
    }
    #[inline]
    fn locate(&self, x: T, column: u32) -> T {
        x.locate(numbers_of(&self.0[column as usize..]))
    }
    #[inline]
    fn lookup(&self, x: T, column: u32) -> T {
        x.lookup(numbers_of(&self.0[column as usize..]))
    }
    #[inline]
    fn load<const N: usize>(&self, at: u32) -> [T; N] {
        let slice = &self.0[at as usize..][..N];
        std::array::from_fn(|k| slice[k])
    }
    #[inline]
    fn store<const N: usize>(&mut self, at: u32, value: [T; N]) {
        self.0[at as usize..][..N].copy_from_slice(&value);
    }
}

impl Bank<Interval> for Enclosing<'_> {
    fn now(&self) -> Interval {
        self.now
    }
    #[inline]
    fn get(&self, at: u32) -> Interval {
        match at.checked_sub(self.rest) {
            Some(at) => self.enclosed[at as usize],
            None => Interval::point(self.numbers[at as usize]),
        }
    }
    #[inline]
    fn set(&mut self, at: u32, value: Interval) {
        // What programs write stands behind the records.
        self.enclosed[(at - self.rest) as usize] = value;
    }
    fn locate(&self, x: Interval, column: u32) -> Interval {
        x.locate(numbers_of(&self.enclosed[(column - self.rest) as usize..]))
    }
    fn lookup(&self, x: Interval, column: u32) -> Interval {
        x.lookup(numbers_of(&self.enclosed[(column - self.rest) as usize..]))
    }
}

impl Bank<BallOf<f64>> for Enclosing<'_, Ball> {
    fn now(&self) -> BallOf<f64> {
        let [middle, radius] = self.now;
        BallOf { middle, radius }
    }
    #[inline]
    fn get(&self, at: u32) -> BallOf<f64> {
        let [middle, radius] = match at.checked_sub(self.rest) {
            Some(at) => self.enclosed[at as usize],
            None => [self.numbers[at as usize], 0.0],
        };
        BallOf { middle, radius }
    }
    #[inline]
    fn set(&mut self, at: u32, BallOf { middle, radius }: BallOf<f64>) {
        self.enclosed[(at - self.rest) as usize] = [middle, radius];
    }
    fn locate(&self, x: BallOf<f64>, _: u32) -> BallOf<f64> {
        x.locate(&[])
    }
    fn lookup(&self, x: BallOf<f64>, column: u32) -> BallOf<f64> {
        let middle = x.middle.lookup(numbers_of(&self.numbers[column as usize..]));
        BallOf { middle, radius: x.radius_of_lookup() }
    }
}

fn numbers_of<T: Scalar>(column: &[T]) -> &[T] {
    &column[1..=column[0].count()]
}

pub(crate) fn execute<T: Scalar, B: Bank<T>, const N: usize>(
    program: &Program,
    (operands, copy): (&[Affine], u32),
    memory: &mut B,
) {
    // Behind a scalar stands something too: what is copied with it is never read, nor is a trajectory, which its
    // instruction follows.
    let mut to = program.gather;
    for operand in operands {
        let value = memory.load::<N>(operand.of(copy));
        memory.store(to, value);
        to += program.stride;
    }
    let mut next = 0;
    while let Some(instruction) = program.instructions.get(next) {
        next += 1;
        let (to, a, b) = (instruction.to, instruction.a, instruction.b);
        macro_rules! jet {
            ($at:expr) => {
                memory.load::<N>($at)
            };
        }
        macro_rules! scalar {
            ($at:expr) => {
                memory.get($at)
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
                memory.set(to, truth(scalar!(a).less(scalar!(b))));
                continue;
            }
            Code::LessEqual => {
                let (x, y) = (scalar!(a), scalar!(b));
                memory.set(to, T::choose(x.less(y), || [T::of(1.0)], || [truth(x.equal(y))])[0]);
                continue;
            }
            Code::Equal => {
                memory.set(to, truth(scalar!(a).equal(scalar!(b))));
                continue;
            }
            Code::Locate => {
                memory.set(to, memory.locate(scalar!(a), b));
                continue;
            }
            Code::Lookup => {
                memory.set(to, memory.lookup(scalar!(a), b));
                continue;
            }
            Code::Not => {
                memory.set(to, T::choose(is_zero(scalar!(a)), || [T::of(1.0)], || [T::of(0.0)])[0]);
                continue;
            }
            Code::And => {
                let both = T::choose(is_zero(scalar!(a)), || [T::of(0.0)], || [as_truth(scalar!(b))])[0];
                memory.set(to, both);
                continue;
            }
            Code::Or => {
                let either = T::choose(is_zero(scalar!(a)), || [as_truth(scalar!(b))], || [T::of(1.0)])[0];
                memory.set(to, either);
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
                memory.store(operands[to as usize].of(copy), value);
                continue;
            }
            Code::Follow => follow(memory, a, b),
            Code::FollowOperand => follow(memory, operands[a as usize].of(copy), b),
        };
        memory.store(to, value);
    }
}

/// The jet of a trajectory at the present time.
#[inline]
fn follow<T: Scalar, B: Bank<T>, const N: usize>(memory: &B, at: u32, coefficients: u32) -> [T; N] {
    match coefficients {
        2 => {
            let [c0, c1, start] = memory.load(at);
            T::follow(&[c0, c1], memory.now() - start)
        }
        3 => {
            let [c0, c1, c2, start] = memory.load(at);
            T::follow(&[c0, c1, c2], memory.now() - start)
        }
        _ => {
            let [c0, c1, c2, c3, start] = memory.load(at);
            T::follow(&[c0, c1, c2, c3], memory.now() - start)
        }
    }
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
