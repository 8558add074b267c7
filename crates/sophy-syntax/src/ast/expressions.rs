use super::{elements, name_of, range_of, range_of_token, tokens};
use crate::kinds::{SyntaxElement, SyntaxKind, SyntaxNode};
use std::ops::Range;

/// Any expression.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub enum Expression {
    /// `1.5`, `true`.
    Literal(Literal),
    /// `x`, `'Ground Impact'`.
    Reference(Reference),
    /// `f(a, b)`.
    Call(Call),
    /// `(a)`.
    Parentheses(Parentheses),
    /// `-a`, `not a`.
    Prefix(Prefix),
    /// `a^b`.
    Power(Power),
    /// `a + b - c`, `a*b/c`, `a and b`, `a or b`.
    Chain(Chain),
    /// `a < b`.
    Comparison(Comparison),
    /// `if c then a else b`.
    Conditional(Conditional),
    /// `"idle"`.
    StringLiteral(StringLiteral),
    /// `[1, 2, 3]`.
    Vector(Vector),
    /// `x[i, j]`.
    Index(Index),
    /// `auv.drag.x[3]`, `cell[2].out`.
    Path(Path),
    /// `sum(i in 1..n where c : e)`.
    Reduction(Reduction),
}

macro_rules! views {
    ($($name:ident),*) => {
        $(
            #[doc = concat!("See [`Expression::", stringify!($name), "`].")]
            #[derive(Clone, Debug, PartialEq, Eq, Hash)]
            pub struct $name(pub(super) SyntaxNode);

            impl $name {
                /// Bytes of the text, white space around it left out.
                pub fn range(&self) -> Range<usize> {
                    range_of(&self.0)
                }
            }
        )*

        impl Expression {
            /// The view of a node, if it is an expression.
            pub fn cast(node: SyntaxNode) -> Option<Self> {
                match node.kind() {
                    $(SyntaxKind::$name => Some(Expression::$name($name(node))),)*
                    _ => None,
                }
            }

            /// The node.
            pub fn syntax(&self) -> &SyntaxNode {
                match self {
                    $(Expression::$name(view) => &view.0,)*
                }
            }
        }
    };
}

views!(
    Literal,
    Reference,
    Call,
    Parentheses,
    Prefix,
    Power,
    Chain,
    Comparison,
    Conditional,
    StringLiteral,
    Vector,
    Index,
    Path,
    Reduction
);

impl Expression {
    /// Bytes of the text, white space around it left out.
    pub fn range(&self) -> Range<usize> {
        range_of(self.syntax())
    }

    /// The expression without parentheses around it.
    #[must_use]
    pub fn unparenthesised(self) -> Option<Expression> {
        let mut expression = self;
        while let Expression::Parentheses(parentheses) = expression {
            expression = parentheses.inner()?;
        }
        Some(expression)
    }
}

/// What a literal says.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LiteralValue {
    /// A number; as near as can be said where it is malformed.
    Number(f64),
    /// `true` or `false`.
    Boolean(bool),
}

impl Literal {
    /// Its value.
    pub fn value(&self) -> Option<LiteralValue> {
        let token = tokens(&self.0).next()?;
        match token.kind() {
            SyntaxKind::True => Some(LiteralValue::Boolean(true)),
            SyntaxKind::False => Some(LiteralValue::Boolean(false)),
            _ => token.text().parse().ok().map(LiteralValue::Number),
        }
    }
}

impl Reference {
    /// The name, without quotes.
    pub fn name(&self) -> Option<String> {
        tokens(&self.0).next().map(|token| name_of(&token))
    }
}

impl Call {
    /// The name of the function, without quotes.
    pub fn name(&self) -> Option<String> {
        tokens(&self.0).next().map(|token| name_of(&token))
    }

    /// Where the name stands.
    pub fn name_range(&self) -> Option<Range<usize>> {
        tokens(&self.0).next().map(|token| range_of_token(&token))
    }

    /// The arguments, in order.
    pub fn arguments(&self) -> Vec<Expression> {
        self.0
            .children()
            .filter(|node| node.kind() == SyntaxKind::Arguments)
            .flat_map(|node| node.children().filter_map(Expression::cast))
            .collect()
    }
}

impl Parentheses {
    /// What stands between them.
    pub fn inner(&self) -> Option<Expression> {
        operands(&self.0).next()
    }
}

/// A sign or a negation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs)] // the names say it
pub enum PrefixOperator {
    Plus,
    Minus,
    Not,
}

impl Prefix {
    /// The operator.
    pub fn operator(&self) -> Option<PrefixOperator> {
        tokens(&self.0).find_map(|token| match token.kind() {
            SyntaxKind::Plus => Some(PrefixOperator::Plus),
            SyntaxKind::Minus => Some(PrefixOperator::Minus),
            SyntaxKind::Not => Some(PrefixOperator::Not),
            _ => None,
        })
    }

    /// What it applies to.
    pub fn operand(&self) -> Option<Expression> {
        operands(&self.0).next()
    }
}

impl Power {
    /// `a` of `a^b`.
    pub fn base(&self) -> Option<Expression> {
        self.sides().0
    }

    /// `b` of `a^b`.
    pub fn exponent(&self) -> Option<Expression> {
        self.sides().1
    }

    fn sides(&self) -> (Option<Expression>, Option<Expression>) {
        split(&self.0, |kind| kind == SyntaxKind::Caret)
    }
}

/// An operator between operands of a [`Chain`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[allow(missing_docs)] // the names say it
pub enum ChainOperator {
    Add,
    Subtract,
    Multiply,
    Divide,
    And,
    Or,
}

impl ChainOperator {
    fn of(kind: SyntaxKind) -> Option<Self> {
        match kind {
            SyntaxKind::Plus => Some(ChainOperator::Add),
            SyntaxKind::Minus => Some(ChainOperator::Subtract),
            SyntaxKind::Star => Some(ChainOperator::Multiply),
            SyntaxKind::Slash => Some(ChainOperator::Divide),
            SyntaxKind::And => Some(ChainOperator::And),
            SyntaxKind::Or => Some(ChainOperator::Or),
            _ => None,
        }
    }
}

/// An operator of a [`Chain`] and the operand on its right.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Step {
    /// `None` where it is missing.
    pub operator: Option<ChainOperator>,
    /// `None` where it is missing.
    pub operand: Option<Expression>,
}

impl Chain {
    /// The leftmost operand.
    pub fn first(&self) -> Option<Expression> {
        let mut before_operator = elements(&self.0).take_while(|e| ChainOperator::of(e.kind()).is_none());
        before_operator.find_map(expression_of)
    }

    /// Operators and further operands, to be applied from left to right.
    pub fn steps(&self) -> Vec<Step> {
        let mut steps: Vec<Step> = Vec::new();
        let mut seen_first = false;
        for element in elements(&self.0) {
            if let Some(operator) = ChainOperator::of(element.kind()) {
                seen_first = true;
                steps.push(Step { operator: Some(operator), operand: None });
            } else if let Some(operand) = expression_of(element) {
                match steps.last_mut() {
                    Some(last) if last.operand.is_none() => last.operand = Some(operand),
                    None if !seen_first => seen_first = true,
                    _ => steps.push(Step { operator: None, operand: Some(operand) }),
                }
            }
        }
        steps
    }
}

/// How a [`Comparison`] compares.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[allow(missing_docs)] // the names say it
pub enum ComparisonOperator {
    Less,
    LessEqual,
    Greater,
    GreaterEqual,
    Equal,
    NotEqual,
}

impl ComparisonOperator {
    fn of(kind: SyntaxKind) -> Option<Self> {
        match kind {
            SyntaxKind::Less => Some(ComparisonOperator::Less),
            SyntaxKind::LessEqual => Some(ComparisonOperator::LessEqual),
            SyntaxKind::Greater => Some(ComparisonOperator::Greater),
            SyntaxKind::GreaterEqual => Some(ComparisonOperator::GreaterEqual),
            SyntaxKind::Equal => Some(ComparisonOperator::Equal),
            SyntaxKind::NotEqual => Some(ComparisonOperator::NotEqual),
            _ => None,
        }
    }
}

impl Comparison {
    /// The operator; the first, should there be more.
    pub fn operator(&self) -> Option<ComparisonOperator> {
        tokens(&self.0).find_map(|token| ComparisonOperator::of(token.kind()))
    }

    /// Where the operator stands.
    pub fn operator_range(&self) -> Option<Range<usize>> {
        tokens(&self.0)
            .find(|token| ComparisonOperator::of(token.kind()).is_some())
            .map(|token| range_of_token(&token))
    }

    /// Left of the operator.
    pub fn left(&self) -> Option<Expression> {
        self.sides().0
    }

    /// Right of the operator.
    pub fn right(&self) -> Option<Expression> {
        self.sides().1
    }

    fn sides(&self) -> (Option<Expression>, Option<Expression>) {
        split(&self.0, |kind| ComparisonOperator::of(kind).is_some())
    }
}

impl Conditional {
    /// After `if`.
    pub fn condition(&self) -> Option<Expression> {
        self.after(SyntaxKind::If)
    }

    /// After `then`.
    pub fn then_value(&self) -> Option<Expression> {
        self.after(SyntaxKind::Then)
    }

    /// After `else`.
    pub fn else_value(&self) -> Option<Expression> {
        self.after(SyntaxKind::Else)
    }

    fn after(&self, keyword: SyntaxKind) -> Option<Expression> {
        let is_keyword = |kind| matches!(kind, SyntaxKind::If | SyntaxKind::Then | SyntaxKind::Else);
        elements(&self.0)
            .skip_while(|e| e.kind() != keyword)
            .skip(1)
            .take_while(|e| !is_keyword(e.kind()))
            .find_map(expression_of)
    }
}

impl StringLiteral {
    /// What stands between the quotes.
    pub fn value(&self) -> Option<String> {
        let token = tokens(&self.0).next()?;
        Some(token.text().trim_matches(['"', '“', '”', '„']).to_owned())
    }
}

impl Vector {
    /// The elements, in order; rows of a matrix are vectors.
    pub fn elements(&self) -> Vec<Expression> {
        operands(&self.0).collect()
    }
}

/// A part of an [`Index`] or [`Path`] after its base.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Part {
    /// `.name`, and where the name stands.
    Member(String, Range<usize>),
    /// `[i, j]`, and where it stands.
    Indices(Vec<Expression>, Range<usize>),
}

impl Index {
    /// What elements are taken of.
    pub fn base(&self) -> Option<Expression> {
        operands(&self.0).next()
    }

    /// The indices; those of `x[i][j]` one after the other.
    pub fn parts(&self) -> Vec<Part> {
        parts(&self.0)
    }
}

impl Path {
    /// What stands before the first point or bracket.
    pub fn base(&self) -> Option<Expression> {
        operands(&self.0).next()
    }

    /// Members and indices, in order.
    pub fn parts(&self) -> Vec<Part> {
        parts(&self.0)
    }
}

fn parts(node: &SyntaxNode) -> Vec<Part> {
    let part = |element: SyntaxElement| match element {
        SyntaxElement::Node(node) if node.kind() == SyntaxKind::Indices => {
            Some(Part::Indices(operands(&node).collect(), range_of(&node)))
        }
        SyntaxElement::Token(token) if !token.kind().is_trivia() && token.kind() != SyntaxKind::Dot => {
            Some(Part::Member(name_of(&token), range_of_token(&token)))
        }
        _ => None,
    };
    elements(node).filter_map(part).collect()
}

/// A loop variable of a [`Reduction`] and its values.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Binder {
    /// The variable.
    pub name: String,
    /// Where its name stands.
    pub name_range: Range<usize>,
    /// First value.
    pub from: Option<Expression>,
    /// Last value.
    pub to: Option<Expression>,
    /// Where `from..to` stands.
    pub range: Range<usize>,
}

impl Reduction {
    /// `sum`, `min`, `max`, `all`, `any`, or whatever else stands there.
    pub fn name(&self) -> Option<String> {
        tokens(&self.0).next().map(|token| name_of(&token))
    }

    /// Where the name stands.
    pub fn name_range(&self) -> Option<Range<usize>> {
        tokens(&self.0).next().map(|token| range_of_token(&token))
    }

    /// Loop variables, the outermost first.
    pub fn binders(&self) -> Vec<Binder> {
        let nodes = self.0.children().filter(|node| node.kind() == SyntaxKind::Binder);
        nodes.filter_map(|node| binder(&node)).collect()
    }

    /// After `where`.
    pub fn condition(&self) -> Option<Expression> {
        let is_where = |e: &SyntaxElement| e.as_token().is_some_and(|token| token.text() == "where");
        let mut after = elements(&self.0).skip(1).skip_while(|e| !is_where(e));
        after.next()?;
        after.take_while(|e| e.kind() != SyntaxKind::Colon).find_map(expression_of)
    }

    /// After the colon.
    pub fn body(&self) -> Option<Expression> {
        elements(&self.0).skip_while(|e| e.kind() != SyntaxKind::Colon).find_map(expression_of)
    }
}

fn binder(node: &SyntaxNode) -> Option<Binder> {
    let name = tokens(node).next()?;
    let range = node.children().find(|child| child.kind() == SyntaxKind::Range)?;
    let (from, to) = split(&range, |kind| kind == SyntaxKind::DotDot);
    Some(Binder {
        name: name_of(&name),
        name_range: range_of_token(&name),
        from,
        to,
        range: range_of(&range),
    })
}

fn operands(node: &SyntaxNode) -> impl Iterator<Item = Expression> + use<> {
    node.children().filter_map(Expression::cast)
}

fn expression_of(element: SyntaxElement) -> Option<Expression> {
    element.into_node().and_then(Expression::cast)
}

/// The operands before and after the first operator.
fn split(
    node: &SyntaxNode,
    is_operator: impl Fn(SyntaxKind) -> bool,
) -> (Option<Expression>, Option<Expression>) {
    let before = elements(node).take_while(|e| !is_operator(e.kind())).find_map(expression_of);
    let mut after_operator = elements(node).skip_while(|e| !is_operator(e.kind())).skip(1);
    let after = after_operator.find_map(expression_of);
    (before, after)
}
