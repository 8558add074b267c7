use sophy_ir::{Binary, Unary};

/// A function every model knows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Predefined {
    Unary(Unary),
    Binary(Binary),
    /// `min` and `max` of two or more.
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
}

/// Names of quantities every model knows.
pub(crate) const QUANTITIES: [&str; 2] = ["pi", "time"];

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
];

/// What other languages call them, JEP's `angle` among them.
const ELSEWHERE: &[(&str, &str)] = &[
    ("angle", "atan2"),
    ("arccos", "acos"),
    ("arcsin", "asin"),
    ("arctan", "atan"),
    ("ceiling", "ceil"),
    ("clamp", "sat"),
    ("fabs", "abs"),
    ("fmod", "rem"),
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
            Predefined::Fold(_) => arguments >= 2,
            Predefined::Saturate => arguments == 1 || arguments == 3,
        }
    }

    /// How to call it.
    pub(crate) fn usage(self, name: &str) -> String {
        match self {
            Predefined::Unary(_) | Predefined::Ceil | Predefined::Log => format!("{name}(x)"),
            Predefined::Binary(Binary::Atan2) => format!("{name}(y, x)"),
            Predefined::Binary(_) | Predefined::Modulo | Predefined::Remainder | Predefined::Hypotenuse => {
                format!("{name}(a, b)")
            }
            Predefined::Fold(_) => format!("{name}(a, b, …)"),
            Predefined::Saturate => format!("{name}(x) or {name}(x, low, high)"),
        }
    }
}
