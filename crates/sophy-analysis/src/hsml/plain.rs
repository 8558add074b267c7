//! Declarations without places, to compare them in tests, here and of SOPHY XML.

use super::*;
use sophy_diagnostics::Span;
use sophy_syntax::ast::Expression;
use sophy_syntax::{SyntaxElement, SyntaxKind};

/// What it is, without where it stands.
pub(crate) trait Plain {
    fn plain(&self) -> String;
}

macro_rules! plain_fields {
    ($($name:ident: $($field:ident)*;)*) => {
        $(impl Plain for $name {
            fn plain(&self) -> String {
                let mut text = concat!(stringify!($name), " {").to_owned();
                $(text += concat!("\n", stringify!($field), ": "); text += &self.$field.plain();)*
                text.replace('\n', "\n  ") + "\n}"
            }
        })*
    };
}

plain_fields! {
    Declarations: imports constants functions components;
    ComponentDeclaration: kind name documentation ports knobs views parameters variables clock delay priority initial
        update equations initial_location locations events rules members connections units hints;
    TypeText: name shape;
    PortDeclaration: name documentation direction kind range unit;
    KnobDeclaration: name documentation range unit;
    ParameterDeclaration: name documentation kind value unit;
    FunctionDeclaration: name documentation parameters result body;
    VariableDeclaration: role name documentation kind range initial unit;
    Equations: dynamics constraints output;
    Target: name indices;
    EquationDeclaration: derivative target right;
    ConstraintDeclaration: left right;
    LocationDeclaration: name documentation variables equations invariant transitions;
    TransitionDeclaration: name documentation trigger priority destination actions;
    EventDeclaration: flag indices documentation priority rising falling;
    RuleDeclaration: documentation condition delay latched cancellable initially priority actions;
    MemberDeclaration: name indices documentation component parameters extents;
    PortText: parts;
}

macro_rules! plain_debug {
    ($($name:ident)*) => {
        $(impl Plain for $name {
            fn plain(&self) -> String {
                format!("{self:?}")
            }
        })*
    };
}

plain_debug!(String bool ComponentKind Direction VariableRole);

macro_rules! plain_variants {
    ($($name:ident: $($variant:ident($($part:ident),*))*;)*) => {
        $(impl Plain for $name {
            fn plain(&self) -> String {
                match self {
                    $($name::$variant($($part),*) => {
                        [stringify!($variant).to_owned(), $($part.plain()),*].join(" ")
                    })*
                }
            }
        })*
    };
}

plain_variants! {
    RangeText: Bounds(low, high) Set(values);
    TriggerDeclaration: When(guard) On(labels, guard) WhenOrOn(guard, labels) Rate(rate, guard)
        Invariant(span, guard) Synchronised(label, guard);
    MemberItem: Member(member) For(repeated);
}

impl Plain for Span {
    fn plain(&self) -> String {
        String::new()
    }
}

impl<T: Plain> Plain for Vec<T> {
    fn plain(&self) -> String {
        format!("[{}]", self.iter().map(Plain::plain).collect::<Vec<_>>().join(", "))
    }
}

impl<T: Plain> Plain for Option<T> {
    fn plain(&self) -> String {
        self.as_ref().map_or_else(|| "-".to_owned(), Plain::plain)
    }
}

impl<A: Plain, B: Plain> Plain for (A, B) {
    fn plain(&self) -> String {
        format!("({}, {})", self.0.plain(), self.1.plain())
    }
}

impl<T: Plain> Plain for Spanned<T> {
    fn plain(&self) -> String {
        self.value.plain()
    }
}

impl<T: Plain> Plain for Loop<T> {
    fn plain(&self) -> String {
        let head = [self.variable.plain(), self.from.plain(), self.to.plain()].join(" ");
        format!("for {head} {}", self.items.plain())
    }
}

/// The words, whatever is between them, names without quotes; parentheses around the whole do not count.
impl Plain for ExpressionText {
    fn plain(&self) -> String {
        let inner = self.expression.clone().and_then(Expression::unparenthesised);
        let Some(inner) = inner.filter(|_| self.well_formed) else { return self.written().to_owned() };
        let tokens = inner.syntax().descendants_with_tokens().filter_map(SyntaxElement::into_token);
        let words = tokens.filter(|token| !token.kind().is_trivia()).map(|token| match token.kind() {
            SyntaxKind::QuotedName => token.text().trim_matches('\'').to_owned(),
            _ => token.text().to_owned(),
        });
        format!("«{}»", words.collect::<Vec<_>>().join(" "))
    }
}

impl Plain for ClockDeclaration {
    fn plain(&self) -> String {
        match self {
            ClockDeclaration::Announced { name, initial } => {
                format!("announced {} {}", name.plain(), initial.plain())
            }
            ClockDeclaration::Every { period, offset, .. } => {
                format!("every {} {}", period.plain(), offset.plain())
            }
        }
    }
}

impl Plain for EquationItem {
    fn plain(&self) -> String {
        match self {
            EquationItem::Equation(equation) => equation.plain(),
            EquationItem::If { branches, otherwise, .. } => {
                format!("if {} {}", branches.plain(), otherwise.plain())
            }
            EquationItem::For(repeated) => repeated.plain(),
        }
    }
}

impl Plain for Statement {
    fn plain(&self) -> String {
        match self {
            Statement::Assign { target, right } => format!("{} := {}", target.plain(), right.plain()),
            Statement::Emit(label) => format!("emit {}", label.plain()),
            Statement::Hold(flag) => format!("hold {}", flag.plain()),
            Statement::If { branches, otherwise } => format!("if {} {}", branches.plain(), otherwise.plain()),
            Statement::For(repeated) => repeated.plain(),
        }
    }
}

impl Plain for ConnectionItem {
    fn plain(&self) -> String {
        match self {
            ConnectionItem::Connect { from, to } => format!("{} -> {}", from.plain(), to.plain()),
            ConnectionItem::Compose { members, matrix, .. } => {
                format!("{} with {}", members.plain(), matrix.plain())
            }
            ConnectionItem::For(repeated) => repeated.plain(),
        }
    }
}
