//! What native code calls: elementary functions and tables, each behind one local thunk.

pub(super) use super::trace::{Function, FunctionOfTwo};
use sophy_ir::arithmetic;

/// A name and an address for the linker.
pub(super) type Symbol = (&'static str, *const u8);

macro_rules! thunks {
    ($($name:ident($($argument:ident),+) $body:expr;)*) => {$(
        extern "C" fn $name($($argument: f64),+) -> f64 {
            $body
        }
    )*};
}

// Of `libm`, as everywhere: the same bits on every platform.
thunks! {
    exp(x) libm::exp(x);
    ln(x) libm::log(x);
    log10(x) libm::log10(x);
    sin(x) libm::sin(x);
    cos(x) libm::cos(x);
    tan(x) libm::tan(x);
    asin(x) libm::asin(x);
    acos(x) libm::acos(x);
    atan(x) libm::atan(x);
    sinh(x) libm::sinh(x);
    cosh(x) libm::cosh(x);
    tanh(x) libm::tanh(x);
    asinh(x) libm::asinh(x);
    acosh(x) arithmetic::acosh(x);
    atanh(x) libm::atanh(x);
    atan2(y, x) libm::atan2(y, x);
    pow(x, y) libm::pow(x, y);
}

/// The position of `x` among the knots of a column, which is its length and then its knots.
///
/// # Safety
/// As [`numbers`].
unsafe extern "C" fn locate(column: *const f64, x: f64) -> f64 {
    // SAFETY: as this function's.
    arithmetic::locate(unsafe { numbers(column) }, x)
}

/// The number at position `x` of a column.
///
/// # Safety
/// As [`numbers`].
unsafe extern "C" fn lookup(column: *const f64, x: f64) -> f64 {
    // SAFETY: as this function's.
    arithmetic::lookup(unsafe { numbers(column) }, x)
}

/// The numbers of a column.
///
/// # Safety
/// At `column` stands a length, and so many numbers behind it, which nobody changes meanwhile.
unsafe fn numbers<'a>(column: *const f64) -> &'a [f64] {
    // SAFETY: promised by the caller.
    unsafe { std::slice::from_raw_parts(column.add(1), *column as usize) }
}

/// What reads a column.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) enum OfColumn {
    Locate,
    Lookup,
}

impl OfColumn {
    pub(super) const ALL: [Self; 2] = [Self::Locate, Self::Lookup];

    pub(super) fn symbol(self) -> Symbol {
        // SAFETY: a type; nothing is called here.
        let (name, function): (_, unsafe extern "C" fn(*const f64, f64) -> f64) = match self {
            OfColumn::Locate => ("sophy_locate", locate),
            OfColumn::Lookup => ("sophy_lookup", lookup),
        };
        (name, function as *const u8)
    }
}

impl Function {
    pub(super) const ALL: [Self; 15] = [
        Self::Exp,
        Self::Ln,
        Self::Log10,
        Self::Sin,
        Self::Cos,
        Self::Tan,
        Self::Asin,
        Self::Acos,
        Self::Atan,
        Self::Sinh,
        Self::Cosh,
        Self::Tanh,
        Self::Asinh,
        Self::Acosh,
        Self::Atanh,
    ];

    pub(super) fn symbol(self) -> Symbol {
        let (name, function): (_, extern "C" fn(f64) -> f64) = match self {
            Function::Exp => ("sophy_exp", exp),
            Function::Ln => ("sophy_ln", ln),
            Function::Log10 => ("sophy_log10", log10),
            Function::Sin => ("sophy_sin", sin),
            Function::Cos => ("sophy_cos", cos),
            Function::Tan => ("sophy_tan", tan),
            Function::Asin => ("sophy_asin", asin),
            Function::Acos => ("sophy_acos", acos),
            Function::Atan => ("sophy_atan", atan),
            Function::Sinh => ("sophy_sinh", sinh),
            Function::Cosh => ("sophy_cosh", cosh),
            Function::Tanh => ("sophy_tanh", tanh),
            Function::Asinh => ("sophy_asinh", asinh),
            Function::Acosh => ("sophy_acosh", acosh),
            Function::Atanh => ("sophy_atanh", atanh),
        };
        (name, function as *const u8)
    }
}

impl FunctionOfTwo {
    pub(super) const ALL: [Self; 2] = [Self::Atan2, Self::Pow];

    pub(super) fn symbol(self) -> Symbol {
        let (name, function): (_, extern "C" fn(f64, f64) -> f64) = match self {
            FunctionOfTwo::Atan2 => ("sophy_atan2", atan2),
            FunctionOfTwo::Pow => ("sophy_pow", pow),
        };
        (name, function as *const u8)
    }
}
