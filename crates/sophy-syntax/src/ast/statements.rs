//! Statements and equations.

use super::{
    Expression, Name, View, bracketed, child, children, expression_after, expression_before, expressions,
    keyword, name_at,
};
use crate::kinds::{SyntaxElement, SyntaxKind, SyntaxNode};
use sophy_diagnostics::closest;
use std::ops::Range;

view! {
    /// `x[i] := e;`.
    AssignmentStatement = AssignmentStatement;
    /// `emit l;`.
    Emit = Emit;
    /// `hold S;`.
    Hold = Hold;
    /// `if c then … elsif c then … else … end if;`, around statements or equations.
    IfStatement = IfStatement;
    /// One part of an [`IfStatement`].
    Branch = Branch;
    /// `for i in 1..n loop … end loop;`, around statements, equations, components or connections.
    ForLoop = ForLoop;
    /// `l = r;`.
    Equation = Equation;
}

views_of! {
    /// What is done at an instant.
    Statement: AssignmentStatement, Emit, Hold, IfStatement, ForLoop;
    /// What holds always.
    EquationItem: Equation, IfStatement, ForLoop;
}

/// Statements, in order.
pub type Statements = Vec<Statement>;
/// Equations, in order.
pub type Equations = Vec<EquationItem>;

pub(super) fn statements_of(node: &SyntaxNode) -> Statements {
    children(node).collect()
}

pub(super) fn equations_of(node: &SyntaxNode) -> Equations {
    children(node).collect()
}

const SIGNS: &[SyntaxKind] = &[SyntaxKind::Assign, SyntaxKind::Equal, SyntaxKind::Colon];

fn right_of_sign(node: &SyntaxNode) -> Option<Expression> {
    node.children_with_tokens()
        .skip_while(|e| !SIGNS.contains(&e.kind()))
        .filter_map(SyntaxElement::into_node)
        .find_map(Expression::cast)
}

impl AssignmentStatement {
    /// What is assigned to, if it is a variable.
    pub fn target(&self) -> Option<Target> {
        self.left().and_then(|left| Target::of(&left))
    }

    /// Left of `:=`.
    pub fn left(&self) -> Option<Expression> {
        expression_before(self.syntax(), SIGNS)
    }

    /// Right of `:=`.
    pub fn value(&self) -> Option<Expression> {
        right_of_sign(self.syntax())
    }
}

impl Emit {
    /// The event.
    pub fn name(&self) -> Option<Name> {
        name_at(self.syntax(), 1)
    }
}

impl Hold {
    /// The flag.
    pub fn name(&self) -> Option<Name> {
        name_at(self.syntax(), 1)
    }
}

impl Equation {
    /// What is defined, if the left side is a variable or a derivative.
    pub fn target(&self) -> Option<Target> {
        self.left().and_then(|left| Target::of(&left))
    }

    /// Left of `=`.
    pub fn left(&self) -> Option<Expression> {
        expression_before(self.syntax(), SIGNS)
    }

    /// Right of `=`.
    pub fn right(&self) -> Option<Expression> {
        right_of_sign(self.syntax())
    }

    /// Where the `=` stands.
    pub fn sign_range(&self) -> Option<Range<usize>> {
        super::tokens(self.syntax())
            .find(|token| SIGNS.contains(&token.kind()))
            .map(|token| token.text_range().into())
    }
}

/// A variable that is defined or assigned: `x`, `x[i]`, `der(x)`, `der(x[i])`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Target {
    /// The name of the variable.
    pub name: Name,
    /// The indices; none for the whole.
    pub indices: Vec<Expression>,
    /// Whether it is the derivative.
    pub derivative: bool,
    /// With `der` and indices.
    pub range: Range<usize>,
}

/// `der`, also misspelt, which has been reported.
fn is_derivative(function: &str) -> bool {
    function == "der" || closest(function, ["der"]).is_some()
}

impl Target {
    /// The target that `left` is.
    pub fn of(left: &Expression) -> Option<Target> {
        let range = left.range();
        let (inner, derivative) = match left {
            Expression::Call(call) if is_derivative(&call.name()?) => match call.arguments().as_slice() {
                [argument] => (argument.clone(), true),
                _ => return None,
            },
            other => (other.clone(), false),
        };
        match &inner {
            Expression::Reference(reference) => {
                let name = Name { text: reference.name()?, range: reference.range() };
                Some(Target { name, indices: Vec::new(), derivative, range })
            }
            Expression::Index(_) => {
                let base = expressions(inner.syntax()).next()?;
                let Expression::Reference(reference) = &base else { return None };
                let name = Name { text: reference.name()?, range: base.range() };
                let indices = bracketed(inner.syntax(), SyntaxKind::Indices);
                Some(Target { name, indices, derivative, range })
            }
            _ => None,
        }
    }
}

impl IfStatement {
    /// Its parts, in order.
    pub fn branches(&self) -> impl Iterator<Item = Branch> + use<> {
        children(self.syntax())
    }
}

impl Branch {
    /// Whether it is the `else`, which has no condition.
    pub fn is_else(&self) -> bool {
        keyword(self.syntax()).is_some_and(|token| token.kind() == SyntaxKind::Else)
    }

    /// After `if` or `elsif`.
    pub fn condition(&self) -> Option<Expression> {
        expressions(self.syntax()).next()
    }

    /// Its statements.
    pub fn statements(&self) -> Statements {
        statements_of(self.syntax())
    }

    /// Its equations.
    pub fn equations(&self) -> Equations {
        equations_of(self.syntax())
    }
}

view! {
    /// `1..n`.
    IndexRange = Range;
}

impl IndexRange {
    /// Left of `..`.
    pub fn first(&self) -> Option<Expression> {
        expression_before(self.syntax(), &[SyntaxKind::DotDot])
    }

    /// Right of `..`.
    pub fn last(&self) -> Option<Expression> {
        expression_after(self.syntax(), SyntaxKind::DotDot)
    }
}

impl ForLoop {
    /// The index.
    pub fn variable(&self) -> Option<Name> {
        name_at(self.syntax(), 1)
    }

    /// What it runs over.
    pub fn index_range(&self) -> Option<IndexRange> {
        child(self.syntax())
    }

    /// Its statements.
    pub fn statements(&self) -> Statements {
        statements_of(self.syntax())
    }

    /// Its equations.
    pub fn equations(&self) -> Equations {
        equations_of(self.syntax())
    }

    /// Its items, of any kind: `items::<ComponentsItem>()`, `items::<ConnectionsItem>()`.
    pub fn items<T: View>(&self) -> impl Iterator<Item = T> + use<T> {
        children(self.syntax())
    }
}
