use sophy_diagnostics::{Span, TextMap};
use sophy_syntax::Parse;

/// What a front end found in a file: plain, spanned, nothing resolved yet.
///
/// The SOPHY XML reader and (next) the HSML reader both produce this; [`crate::analyse`] makes a
/// [`sophy_ir::Model`] of it. Every part may be missing or wrong: the checks say so.
#[derive(Clone, Debug)]
pub struct Declarations {
    /// Name of the system.
    pub name: Spanned<String>,
    /// Text describing it; empty if there is none.
    pub documentation: String,
    /// Constants, in written order.
    pub constants: Vec<ConstantDeclaration>,
    /// User functions, in written order.
    pub functions: Vec<FunctionDeclaration>,
    /// States.
    pub states: Vec<VariableDeclaration>,
    /// Inputs.
    pub inputs: Vec<VariableDeclaration>,
    /// Outputs.
    pub outputs: Vec<VariableDeclaration>,
    /// Initial values of states.
    pub initial: Vec<EquationDeclaration>,
    /// The first location, where it is named.
    pub initial_location: Option<Spanned<String>>,
    /// Units, by name of the variable or constant.
    pub units: Vec<(Spanned<String>, Spanned<String>)>,
    /// Names and values of what a file says to other tools; nothing here depends on it.
    pub hints: Vec<(Spanned<String>, Spanned<String>)>,
    /// Locations.
    pub locations: Vec<LocationDeclaration>,
}

/// A value and where it stands.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Spanned<T> {
    /// The value.
    pub value: T,
    /// Where it stands.
    pub span: Span,
}

impl<T> Spanned<T> {
    /// Puts a value at a place.
    pub fn new(value: T, span: Span) -> Self {
        Spanned { value, span }
    }
}

/// An expression as written: its decoded text, its tree with the mistakes of grammar, and where each byte
/// of the text stands in the source.
#[derive(Clone, Debug)]
pub struct ExpressionText {
    /// Decoded text (`&gt;` is `>`).
    pub text: String,
    /// Tree and errors.
    pub parse: Parse,
    /// Offsets of `text` in the source.
    pub map: TextMap,
}

/// A named constant.
#[derive(Clone, Debug)]
pub struct ConstantDeclaration {
    /// Its name.
    pub name: Spanned<String>,
    /// Its value: a number or an expression over other constants.
    pub value: ExpressionText,
}

/// `function name(parameters) = body`.
#[derive(Clone, Debug)]
pub struct FunctionDeclaration {
    /// Its name.
    pub name: Spanned<String>,
    /// Names of its parameters.
    pub parameters: Vec<Spanned<String>>,
    /// Its value.
    pub body: ExpressionText,
}

/// A state, input or output.
#[derive(Clone, Debug)]
pub struct VariableDeclaration {
    /// Its name.
    pub name: Spanned<String>,
    /// What it means; empty if nothing was said.
    pub documentation: String,
}

/// A name and an expression: an equation, an output map or a reset.
#[derive(Clone, Debug)]
pub struct EquationDeclaration {
    /// The state or output.
    pub target: Spanned<String>,
    /// The right-hand side.
    pub right: ExpressionText,
}

/// A location.
#[derive(Clone, Debug)]
pub struct LocationDeclaration {
    /// Its name.
    pub name: Spanned<String>,
    /// What it is; empty if nothing was said.
    pub documentation: String,
    /// `der(state) = …`.
    pub dynamics: Vec<EquationDeclaration>,
    /// `output = …`.
    pub outputs: Vec<EquationDeclaration>,
    /// Outgoing transitions.
    pub transitions: Vec<TransitionDeclaration>,
}

/// A transition.
#[derive(Clone, Debug)]
pub struct TransitionDeclaration {
    /// Its name.
    pub name: Spanned<String>,
    /// What it is; empty if nothing was said.
    pub documentation: String,
    /// The condition; `None` if the file has none (the reader has said so).
    pub guard: Option<ExpressionText>,
    /// Where it leads.
    pub destination: Spanned<String>,
    /// `state := …`.
    pub resets: Vec<EquationDeclaration>,
    /// Events that trigger it.
    pub input_events: Vec<Spanned<String>>,
    /// Events it emits.
    pub output_events: Vec<Spanned<String>>,
}
