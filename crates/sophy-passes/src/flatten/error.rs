use sophy_diagnostics::Span;
use std::fmt;

/// Why components cannot be put together.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum FlattenError {
    /// Quantities depend on one another in a circle: each reads the next, the last the first.
    AlgebraicLoop(Vec<LoopEquation>),
    /// Parameters depend on one another in a circle; the names, first again at the end.
    ParameterLoop(Vec<String>),
    /// Assignments of `initial` sections depend on one another in a circle; the states, first again at the end.
    InitialLoop(Vec<String>),
}

/// An equation of an algebraic loop.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LoopEquation {
    /// Full name of what it defines.
    pub name: String,
    /// The equation, `y = …` in the names of its component; for a connection `inner.u = outer.y`.
    pub text: String,
    /// Where it stands.
    pub span: Option<Span>,
}

impl FlattenError {
    /// What goes in a circle, first again at the end.
    pub fn names(&self) -> Vec<&str> {
        match self {
            FlattenError::AlgebraicLoop(equations) => {
                let names = equations.iter().chain(equations.first());
                names.map(|equation| equation.name.as_str()).collect()
            }
            FlattenError::ParameterLoop(names) | FlattenError::InitialLoop(names) => {
                names.iter().map(String::as_str).collect()
            }
        }
    }
}

impl fmt::Display for FlattenError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let what = match self {
            FlattenError::AlgebraicLoop(_) => "an algebraic loop",
            FlattenError::ParameterLoop(_) => "parameters that define one another",
            FlattenError::InitialLoop(_) => "initial values that define one another",
        };
        write!(f, "the composition has {what}: {}", self.names().join(" -> "))
    }
}

impl std::error::Error for FlattenError {}
