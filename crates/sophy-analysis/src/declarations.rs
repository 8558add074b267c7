use sophy_diagnostics::{Span, TextMap};
use sophy_syntax::ast::Expression;
use sophy_syntax::{Parse, parse_expression};
use std::rc::Rc;

/// What a front end found in a file: plain, spanned, nothing resolved yet.
///
/// The readers of HSML ([`crate::read_hsml`]) and SOPHY XML both produce this, writers of both print it, and
/// [`crate::analyse`] makes a [`sophy_ir::Model`] of it. Every part may be missing or wrong: the checks say so.
#[derive(Clone, Debug, Default)]
pub struct Declarations {
    /// Other files whose declarations are visible here.
    pub imports: Vec<Spanned<String>>,
    /// `constant` declarations.
    pub constants: Vec<ParameterDeclaration>,
    /// User functions, in written order.
    pub functions: Vec<FunctionDeclaration>,
    /// Components, in written order.
    pub components: Vec<ComponentDeclaration>,
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

/// An expression as written: its tree, and where each byte of the text it stands in is in the source.
#[derive(Clone, Debug)]
pub struct ExpressionText {
    /// The text that ranges of the tree count in: of the expression alone (decoded: `&gt;` is `>`), or of the
    /// whole file.
    pub text: Rc<str>,
    /// The tree, if there is anything.
    pub expression: Option<Expression>,
    /// Whether it has no mistakes of grammar; else its structure is a guess.
    pub well_formed: bool,
    /// Offsets of `text` in the source.
    pub map: TextMap,
    /// Where it stands as a whole.
    pub span: Span,
}

impl ExpressionText {
    /// An expression that is a text of its own, with the tree and the mistakes of grammar in it.
    pub fn parse(text: &str, map: TextMap) -> (Self, Parse) {
        let parse = parse_expression(text);
        let expression = ExpressionText {
            text: Rc::from(text),
            expression: parse.expression(),
            well_formed: parse.errors().is_empty(),
            span: map.whole(),
            map,
        };
        (expression, parse)
    }

    /// Its text: all of it if it is a text of its own, else the part of the file.
    pub fn written(&self) -> &str {
        if self.map.whole() == self.span {
            return &self.text;
        }
        let range = self.expression.as_ref().map_or(self.span.range(), Expression::range);
        self.text.get(range).unwrap_or("")
    }
}

/// The kinds of components.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ComponentKind {
    /// Continuous time.
    Ctc,
    /// Discrete time.
    Dtc,
    /// Logic.
    Lbc,
    /// Composite.
    Cc,
    /// A composite without inputs.
    System,
}

/// A component.
#[derive(Clone, Debug)]
pub struct ComponentDeclaration {
    /// What it is.
    pub kind: ComponentKind,
    /// Its name.
    pub name: Spanned<String>,
    /// Text describing it; empty if there is none.
    pub documentation: String,
    /// Inputs, outputs and event labels, in written order.
    pub ports: Vec<PortDeclaration>,
    /// Parameters an experiment may set.
    pub knobs: Vec<KnobDeclaration>,
    /// Variables to be recorded and displayed.
    pub views: Vec<Spanned<String>>,
    /// Values of parameters.
    pub parameters: Vec<ParameterDeclaration>,
    /// States, locals, modes and flags of the body.
    pub variables: Vec<VariableDeclaration>,
    /// When a DTC executes.
    pub clock: Option<ClockDeclaration>,
    /// Seconds between execution and effect.
    pub delay: Option<ExpressionText>,
    /// Smaller executes first.
    pub priority: Option<ExpressionText>,
    /// The `initial` section.
    pub initial: Vec<Statement>,
    /// The `update` section.
    pub update: Vec<Statement>,
    /// Equations that hold in all locations.
    pub equations: Equations,
    /// The first location, where it is named.
    pub initial_location: Option<Spanned<String>>,
    /// Locations.
    pub locations: Vec<LocationDeclaration>,
    /// Event sections.
    pub events: Vec<EventDeclaration>,
    /// Rules.
    pub rules: Vec<RuleDeclaration>,
    /// Members of a composite.
    pub members: Vec<MemberItem>,
    /// Connections of a composite.
    pub connections: Vec<ConnectionItem>,
    /// Units said apart from the declaration, by name (hints of SOPHY XML).
    pub units: Vec<(Spanned<String>, Spanned<String>)>,
    /// Names and values of what a file says to other tools; nothing here depends on it.
    pub hints: Vec<(Spanned<String>, Spanned<String>)>,
    /// Which rules of the two languages apply.
    pub dialect: Dialect,
}

/// Where the two languages differ in what a declaration means.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Dialect {
    /// HSML.
    Hsml,
    /// SOPHY XML: an output has a map in every location; all parameters can be set.
    Xml,
}

impl ComponentDeclaration {
    /// A component of which nothing but kind and name is known.
    pub fn new(kind: ComponentKind, name: Spanned<String>, dialect: Dialect) -> Self {
        ComponentDeclaration {
            kind,
            name,
            documentation: String::new(),
            ports: Vec::new(),
            knobs: Vec::new(),
            views: Vec::new(),
            parameters: Vec::new(),
            variables: Vec::new(),
            clock: None,
            delay: None,
            priority: None,
            initial: Vec::new(),
            update: Vec::new(),
            equations: Equations::default(),
            initial_location: None,
            locations: Vec::new(),
            events: Vec::new(),
            rules: Vec::new(),
            members: Vec::new(),
            connections: Vec::new(),
            units: Vec::new(),
            hints: Vec::new(),
            dialect,
        }
    }
}

/// Directions of a port.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Direction {
    /// Given from outside.
    Input,
    /// Given to the outside.
    Output,
    /// The label of transitions taken together with others.
    Synchronised,
}

/// Types as written, `signal[3]` included.
#[derive(Clone, Debug)]
pub struct TypeText {
    /// `signal`, `real`, `integer`, `boolean`, `string`, `event`, or whatever else stands there.
    pub name: Spanned<String>,
    /// Extents of a vector or matrix.
    pub shape: Vec<ExpressionText>,
}

/// A range as written.
#[derive(Clone, Debug)]
pub enum RangeText {
    /// `(low, high)`.
    Bounds(ExpressionText, ExpressionText),
    /// `{a, b, c}`.
    Set(Vec<ExpressionText>),
}

/// `input(name, type, range, "unit");`
#[derive(Clone, Debug)]
pub struct PortDeclaration {
    /// Its name.
    pub name: Spanned<String>,
    /// What it means; empty if nothing was said.
    pub documentation: String,
    /// Where it leads.
    pub direction: Direction,
    /// Its type; `None` if none was given (SOPHY XML: a signal).
    pub kind: Option<TypeText>,
    /// Values it can have.
    pub range: Option<RangeText>,
    /// Its unit.
    pub unit: Option<Spanned<String>>,
}

/// `knob(name, range, "unit");`
#[derive(Clone, Debug)]
pub struct KnobDeclaration {
    /// Its name.
    pub name: Spanned<String>,
    /// What it means; empty if nothing was said.
    pub documentation: String,
    /// Values it can have.
    pub range: Option<RangeText>,
    /// Its unit.
    pub unit: Option<Spanned<String>>,
}

/// `name : value "unit";` of an `assignments` section, `constant name = value "unit";` of a file, or a constant of
/// SOPHY XML.
#[derive(Clone, Debug)]
pub struct ParameterDeclaration {
    /// Its name.
    pub name: Spanned<String>,
    /// What it means; empty if nothing was said.
    pub documentation: String,
    /// Its type, if it is a constant of a file that says so.
    pub kind: Option<TypeText>,
    /// Its value.
    pub value: ExpressionText,
    /// Its unit.
    pub unit: Option<Spanned<String>>,
}

/// `function name(a, b : real[3]) : real[3] = body;`
#[derive(Clone, Debug)]
pub struct FunctionDeclaration {
    /// Its name.
    pub name: Spanned<String>,
    /// What it does; empty if nothing was said.
    pub documentation: String,
    /// Its parameters with their types, where they are given.
    pub parameters: Vec<(Spanned<String>, Option<TypeText>)>,
    /// The type of its value, where it is given.
    pub result: Option<TypeText>,
    /// Its value.
    pub body: ExpressionText,
}

/// What a variable of a body is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum VariableRole {
    /// A state.
    State,
    /// Defined by an equation, or within a `:=` section by an assignment.
    Local,
    /// Changes at instants only.
    Mode,
    /// Its sign changes are events.
    Flag,
}

/// `state x : real[3] in (0, 1) := 0 "m";`
#[derive(Clone, Debug)]
pub struct VariableDeclaration {
    /// What it is.
    pub role: VariableRole,
    /// Its name.
    pub name: Spanned<String>,
    /// What it means; empty if nothing was said.
    pub documentation: String,
    /// Its type.
    pub kind: Option<TypeText>,
    /// Values it can have.
    pub range: Option<RangeText>,
    /// Its value at the start.
    pub initial: Option<ExpressionText>,
    /// Its unit.
    pub unit: Option<Spanned<String>>,
}

/// When a DTC executes.
#[derive(Clone, Debug)]
pub enum ClockDeclaration {
    /// `tsample t_next := 0;`
    Announced {
        /// The variable.
        name: Spanned<String>,
        /// Its first value.
        initial: Option<ExpressionText>,
    },
    /// `tsample every Ts from t0;`
    Every {
        /// Where `tsample` stands.
        span: Span,
        /// Seconds between executions.
        period: ExpressionText,
        /// The first execution.
        offset: Option<ExpressionText>,
    },
}

/// Sections of equations, of a body or a location.
#[derive(Clone, Debug, Default)]
pub struct Equations {
    /// `der(x) = …`, and locals and flags.
    pub dynamics: Vec<EquationItem>,
    /// Equations between expressions.
    pub constraints: Vec<ConstraintDeclaration>,
    /// `y = …`.
    pub output: Vec<EquationItem>,
}

/// An equation, or equations under conditions.
#[derive(Clone, Debug)]
pub enum EquationItem {
    /// One equation.
    Equation(EquationDeclaration),
    /// `if … then … elsif … else … end if;`
    If {
        /// Conditions and what holds under them.
        branches: Vec<(ExpressionText, Vec<EquationItem>)>,
        /// What holds otherwise, if it is written.
        otherwise: Option<Vec<EquationItem>>,
        /// Where `if` stands.
        span: Span,
    },
    /// `for i in a..b loop … end loop;`
    For(Loop<EquationItem>),
}

/// `for i in a..b loop … end loop;`
#[derive(Clone, Debug)]
pub struct Loop<T> {
    /// The loop variable.
    pub variable: Spanned<String>,
    /// First value.
    pub from: ExpressionText,
    /// Last value.
    pub to: ExpressionText,
    /// What is repeated.
    pub items: Vec<T>,
}

/// The left-hand side of an equation or assignment: `x`, `x[i, j]`.
#[derive(Clone, Debug)]
pub struct Target {
    /// The name.
    pub name: Spanned<String>,
    /// Indices, if only an element is meant.
    pub indices: Vec<ExpressionText>,
}

/// `der(x) = right`, `y[2] = right`.
#[derive(Clone, Debug)]
pub struct EquationDeclaration {
    /// Whether the left-hand side is the derivative of the target.
    pub derivative: bool,
    /// What is defined.
    pub target: Target,
    /// The right-hand side.
    pub right: ExpressionText,
}

/// `left = right`.
#[derive(Clone, Debug)]
pub struct ConstraintDeclaration {
    /// Left-hand side.
    pub left: ExpressionText,
    /// Right-hand side.
    pub right: ExpressionText,
}

/// What is done at an instant.
#[derive(Clone, Debug)]
pub enum Statement {
    /// `x[i] := right;`
    Assign {
        /// What gets a value.
        target: Target,
        /// The right-hand side.
        right: ExpressionText,
    },
    /// `emit label;`
    Emit(Spanned<String>),
    /// `hold S;`
    Hold(Spanned<String>),
    /// `if … then … elsif … else … end if;`
    If {
        /// Conditions and what is done under them.
        branches: Vec<(ExpressionText, Vec<Statement>)>,
        /// What is done otherwise.
        otherwise: Vec<Statement>,
    },
    /// `for i in a..b loop … end loop;`
    For(Loop<Statement>),
}

/// A location.
#[derive(Clone, Debug)]
pub struct LocationDeclaration {
    /// Its name.
    pub name: Spanned<String>,
    /// What it is; empty if nothing was said.
    pub documentation: String,
    /// Variables that exist only here.
    pub variables: Vec<VariableDeclaration>,
    /// What holds here.
    pub equations: Equations,
    /// What holds as long as the location may be kept.
    pub invariant: Option<ExpressionText>,
    /// Outgoing transitions.
    pub transitions: Vec<TransitionDeclaration>,
}

/// What triggers a transition.
#[derive(Clone, Debug)]
pub enum TriggerDeclaration {
    /// `when guard`; no guard if the file has none (the reader has said so).
    When(Option<ExpressionText>),
    /// `on a, b when guard`.
    On(Vec<Spanned<String>>, Option<ExpressionText>),
    /// SOPHY XML: while the guard holds, or on an event.
    WhenOrOn(Option<ExpressionText>, Vec<Spanned<String>>),
    /// `rate λ when guard`.
    Rate(ExpressionText, Option<ExpressionText>),
    /// `on invariant when guard`.
    Invariant(Span, Option<ExpressionText>),
    /// `sync label when guard`.
    Synchronised(Spanned<String>, Option<ExpressionText>),
}

/// A transition.
#[derive(Clone, Debug)]
pub struct TransitionDeclaration {
    /// Its name.
    pub name: Spanned<String>,
    /// What it is; empty if nothing was said.
    pub documentation: String,
    /// When it is taken.
    pub trigger: TriggerDeclaration,
    /// Smaller goes first.
    pub priority: Option<ExpressionText>,
    /// Where it leads.
    pub destination: Spanned<String>,
    /// What is done.
    pub actions: Vec<Statement>,
}

/// `event(S) priority 2 … end event;`
#[derive(Clone, Debug)]
pub struct EventDeclaration {
    /// The flag.
    pub flag: Spanned<String>,
    /// Its element, if the flag is a vector.
    pub indices: Vec<ExpressionText>,
    /// What it is; empty if nothing was said.
    pub documentation: String,
    /// Smaller goes first.
    pub priority: Option<ExpressionText>,
    /// `negative-to-positive`.
    pub rising: Option<Vec<Statement>>,
    /// `positive-to-negative`.
    pub falling: Option<Vec<Statement>>,
}

/// `when condition … do … end when;`
#[derive(Clone, Debug)]
pub struct RuleDeclaration {
    /// Where `when` stands.
    pub span: Span,
    /// What it is; empty if nothing was said.
    pub documentation: String,
    /// The condition.
    pub condition: ExpressionText,
    /// Seconds from the trigger to the execution.
    pub delay: Option<ExpressionText>,
    /// Whether right-hand sides are read at the trigger.
    pub latched: bool,
    /// Whether what is pending is dropped when the condition becomes false.
    pub cancellable: bool,
    /// Whether truth at the start counts.
    pub initially: bool,
    /// Smaller goes first.
    pub priority: Option<ExpressionText>,
    /// What is done.
    pub actions: Vec<Statement>,
}

/// A member of a composite, or members in a loop.
#[derive(Clone, Debug)]
pub enum MemberItem {
    /// `name[i] : Component(p : value)[n];`
    Member(MemberDeclaration),
    /// `for i in a..b loop … end loop;`
    For(Loop<MemberItem>),
}

/// `name[i] : Component(p : value)[n];`
#[derive(Clone, Debug)]
pub struct MemberDeclaration {
    /// Its name.
    pub name: Spanned<String>,
    /// Which element of an array, inside a loop.
    pub indices: Vec<ExpressionText>,
    /// What it is; empty if nothing was said.
    pub documentation: String,
    /// What it is a copy of.
    pub component: Spanned<String>,
    /// Values of its parameters.
    pub parameters: Vec<ParameterDeclaration>,
    /// Extents of an array.
    pub extents: Vec<ExpressionText>,
}

/// A connection, or connections in a loop.
#[derive(Clone, Debug)]
pub enum ConnectionItem {
    /// `from -> to;`
    Connect {
        /// What feeds.
        from: PortText,
        /// What is fed.
        to: PortText,
    },
    /// `compose a, b with matrix;`
    Compose {
        /// Where `compose` stands.
        span: Span,
        /// Members.
        members: Vec<PortText>,
        /// The matrix.
        matrix: ExpressionText,
    },
    /// `for i in a..b loop … end loop;`
    For(Loop<ConnectionItem>),
}

/// `cell[i].out[2]`, or `out` of the composite itself.
#[derive(Clone, Debug)]
pub struct PortText {
    /// Names with their indices, separated by points; none if it is not written.
    pub parts: Vec<(Spanned<String>, Vec<ExpressionText>)>,
    /// Where it stands as a whole.
    pub span: Span,
}
