use sophy_ir::{Binary, Unary};

/// A function every model knows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Predefined {
    Unary(Unary),
    Binary(Binary),
    /// `min` and `max` of two or more, or of the elements of an array.
    Fold(Binary),
    /// The smallest whole number ≥ x.
    Ceil,
    /// The natural logarithm, with a warning.
    Log,
    /// `sat(x)`: x limited to [−1, 1]; `sat(x, lo, hi)`.
    Saturate,
    /// `a − b·floor(a/b)`: the sign of b.
    Modulo,
    /// The remainder with the sign of a.
    Remainder,
    /// `√(a² + b²)`.
    Hypotenuse,
    /// Of vectors and matrices.
    Array(ArrayFunction),
    /// Of time, instants, chance and files.
    Special(SpecialFunction),
}

/// A function of vectors or matrices.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum ArrayFunction {
    Sum,
    All,
    Any,
    Norm,
    Dot,
    Cross,
    Transpose,
    Inverse,
    Identity,
    Zeros,
    Ones,
    Size,
}

/// A function whose value is not that of its arguments alone.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum SpecialFunction {
    Rises,
    Falls,
    Changes,
    Delayed,
    Noise,
    Chance,
    Smooth,
    Table,
    SignalFile,
    Data,
    Derivative,
}

/// Names of quantities every model knows.
pub(crate) const QUANTITIES: [&str; 5] = ["pi", "time", "location", "location_index", "never"];

use ArrayFunction as A;
use SpecialFunction as S;

const FUNCTIONS: &[(&str, Predefined)] = &[
    ("sin", Predefined::Unary(Unary::Sin)),
    ("cos", Predefined::Unary(Unary::Cos)),
    ("tan", Predefined::Unary(Unary::Tan)),
    ("asin", Predefined::Unary(Unary::Asin)),
    ("acos", Predefined::Unary(Unary::Acos)),
    ("atan", Predefined::Unary(Unary::Atan)),
    ("sinh", Predefined::Unary(Unary::Sinh)),
    ("cosh", Predefined::Unary(Unary::Cosh)),
    ("tanh", Predefined::Unary(Unary::Tanh)),
    ("asinh", Predefined::Unary(Unary::Asinh)),
    ("acosh", Predefined::Unary(Unary::Acosh)),
    ("atanh", Predefined::Unary(Unary::Atanh)),
    ("exp", Predefined::Unary(Unary::Exp)),
    ("ln", Predefined::Unary(Unary::Ln)),
    ("log", Predefined::Log),
    ("log10", Predefined::Unary(Unary::Log10)),
    ("sqrt", Predefined::Unary(Unary::Sqrt)),
    ("abs", Predefined::Unary(Unary::Abs)),
    ("sign", Predefined::Unary(Unary::Sign)),
    ("floor", Predefined::Unary(Unary::Floor)),
    ("ceil", Predefined::Ceil),
    ("min", Predefined::Fold(Binary::Min)),
    ("max", Predefined::Fold(Binary::Max)),
    ("atan2", Predefined::Binary(Binary::Atan2)),
    ("pow", Predefined::Binary(Binary::Power)),
    ("sat", Predefined::Saturate),
    ("mod", Predefined::Modulo),
    ("rem", Predefined::Remainder),
    ("hypot", Predefined::Hypotenuse),
    ("sum", Predefined::Array(A::Sum)),
    ("all", Predefined::Array(A::All)),
    ("any", Predefined::Array(A::Any)),
    ("norm", Predefined::Array(A::Norm)),
    ("dot", Predefined::Array(A::Dot)),
    ("cross", Predefined::Array(A::Cross)),
    ("transpose", Predefined::Array(A::Transpose)),
    ("inv", Predefined::Array(A::Inverse)),
    ("identity", Predefined::Array(A::Identity)),
    ("zeros", Predefined::Array(A::Zeros)),
    ("ones", Predefined::Array(A::Ones)),
    ("size", Predefined::Array(A::Size)),
    ("rises", Predefined::Special(S::Rises)),
    ("falls", Predefined::Special(S::Falls)),
    ("changes", Predefined::Special(S::Changes)),
    ("delayed", Predefined::Special(S::Delayed)),
    ("noise", Predefined::Special(S::Noise)),
    ("chance", Predefined::Special(S::Chance)),
    ("smooth", Predefined::Special(S::Smooth)),
    ("table", Predefined::Special(S::Table)),
    ("signal_file", Predefined::Special(S::SignalFile)),
    ("data", Predefined::Special(S::Data)),
    ("der", Predefined::Special(S::Derivative)),
];

/// What other languages call them, JEP's `angle` among them.
const ELSEWHERE: &[(&str, &str)] = &[
    ("angle", "atan2"),
    ("arccos", "acos"),
    ("arcsin", "asin"),
    ("arctan", "atan"),
    ("ceiling", "ceil"),
    ("clamp", "sat"),
    ("edge", "rises"),
    ("eye", "identity"),
    ("fabs", "abs"),
    ("fmod", "rem"),
    ("inverse", "inv"),
    ("power", "pow"),
    ("sgn", "sign"),
    ("signum", "sign"),
];

impl Predefined {
    /// What a function of another language is called here.
    pub(crate) fn called_elsewhere(name: &str) -> Option<&'static str> {
        ELSEWHERE.iter().find(|(other, _)| *other == name).map(|&(_, here)| here)
    }

    pub(crate) fn named(name: &str) -> Option<Self> {
        FUNCTIONS.iter().find(|(known, _)| *known == name).map(|&(_, function)| function)
    }

    pub(crate) fn names() -> impl Iterator<Item = &'static str> {
        FUNCTIONS.iter().map(|&(name, _)| name)
    }

    pub(crate) fn takes(self, arguments: usize) -> bool {
        match self {
            Predefined::Unary(_) | Predefined::Ceil | Predefined::Log => arguments == 1,
            Predefined::Binary(_) | Predefined::Modulo | Predefined::Remainder | Predefined::Hypotenuse => {
                arguments == 2
            }
            Predefined::Fold(_) => arguments >= 1,
            Predefined::Saturate => arguments == 1 || arguments == 3,
            Predefined::Array(A::Dot | A::Cross) => arguments == 2,
            Predefined::Array(A::Zeros | A::Ones | A::Size) => arguments == 1 || arguments == 2,
            Predefined::Array(_) => arguments == 1,
            Predefined::Special(S::Delayed) => arguments == 2 || arguments == 3,
            Predefined::Special(S::Noise) => arguments == 3,
            Predefined::Special(S::Table) => arguments == 3 || arguments == 4,
            Predefined::Special(S::SignalFile) => (2..=4).contains(&arguments),
            Predefined::Special(_) => arguments == 1,
        }
    }

    /// How to call it.
    pub(crate) fn usage(self, name: &str) -> String {
        let arguments = match self {
            Predefined::Unary(_) | Predefined::Ceil | Predefined::Log => "x",
            Predefined::Binary(Binary::Atan2) => "y, x",
            Predefined::Binary(_) | Predefined::Modulo | Predefined::Remainder | Predefined::Hypotenuse => {
                "a, b"
            }
            Predefined::Fold(_) => "a, b, …",
            Predefined::Saturate => return format!("{name}(x) or {name}(x, low, high)"),
            Predefined::Array(A::Sum | A::All | A::Any) => {
                return format!("{name}(x) or {name}(i in 1..n : x[i])");
            }
            Predefined::Array(A::Norm) => "x",
            Predefined::Array(A::Dot | A::Cross) => "a, b",
            Predefined::Array(A::Transpose | A::Inverse) => "A",
            Predefined::Array(A::Identity) => "n",
            Predefined::Array(A::Zeros | A::Ones) => return format!("{name}(n) or {name}(rows, columns)"),
            Predefined::Array(A::Size) => return format!("{name}(x) or {name}(A, 2)"),
            Predefined::Special(S::Rises | S::Falls) => "condition",
            Predefined::Special(S::Changes | S::Smooth | S::Derivative) => "x",
            Predefined::Special(S::Delayed) => return format!("{name}(x, T) or {name}(x, T, before)"),
            Predefined::Special(S::Noise) => "\"name\", sigma, period",
            Predefined::Special(S::Chance) => "p",
            Predefined::Special(S::Table) => "\"file.csv\", \"column\", x, linear",
            Predefined::Special(S::SignalFile) => "\"file.csv\", \"column\", hold, last",
            Predefined::Special(S::Data) => "\"file.toml\"",
        };
        format!("{name}({arguments})")
    }
}
