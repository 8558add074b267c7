use super::functions::Functions;
use crate::checks::{
    hs0203_number_as_condition, hs0204_equality, hs0205_division_by_zero, hs0207_not_available,
    hs0208_function_without_arguments,
};
use crate::declarations::ExpressionText;
use crate::findings::{Findings, UnknownName};
use crate::names::{Kind, Names};
use crate::predefined::Predefined;
use sophy_diagnostics::{Diagnostic, Span};
use sophy_ir::{Binary, Comparison, Graph, Leaf, Node, NodeId, Unary, VariableId};
use sophy_syntax::ast::{self, ChainOperator, ComparisonOperator, Expression, LiteralValue, PrefixOperator};
use std::collections::HashMap;
use std::ops::Range;

/// A lowered expression.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Typed {
    pub(crate) node: NodeId,
    /// A truth value; otherwise a number.
    pub(crate) boolean: bool,
    /// Whether it can change while time passes: it depends on a state, an input or time.
    pub(crate) varies: bool,
}

/// What names mean at the place of an expression.
#[derive(Clone, Copy)]
pub(crate) enum Scope<'s> {
    /// Constants only; `what` says whose value it is.
    Constants { what: &'static str },
    /// Constants and the parameters of a function.
    Function { parameters: &'s [(String, Typed)] },
    /// Everything; outputs are what the location's maps say, `None` if that is unknown.
    Location { outputs: &'s HashMap<&'s str, Option<Typed>> },
}

/// What all expressions of a system share.
pub(crate) struct Context<'c, 'a> {
    pub(crate) names: &'c Names<'a>,
    pub(crate) functions: &'c Functions<'a>,
    /// Values of constants, where they could be computed.
    pub(crate) constants: &'c HashMap<VariableId, f64>,
    pub(crate) findings: &'c mut Findings,
}

/// Lowers one expression. After a mistake it goes on, to find others, and gives `None`.
pub(crate) struct Lowering<'l, 'c, 'a> {
    pub(crate) context: &'l mut Context<'c, 'a>,
    pub(crate) graph: &'l mut Graph,
    pub(crate) scope: Scope<'l>,
    pub(crate) text: &'l ExpressionText,
    /// In a function: it compares what depends on its parameters with `=` or `<>`.
    pub(crate) compares_equal: bool,
}

impl<'c, 'a> Context<'c, 'a> {
    /// The number that `text` is in `scope`.
    pub(crate) fn number(
        &mut self,
        graph: &mut Graph,
        scope: Scope<'_>,
        text: &ExpressionText,
    ) -> Option<Typed> {
        let mut lowering = Lowering { context: self, graph, scope, text, compares_equal: false };
        let value = lowering.number(text.parse.expression());
        value.filter(|_| text.parse.errors().is_empty())
    }

    /// The truth value that `text` is in `scope`.
    pub(crate) fn condition(
        &mut self,
        graph: &mut Graph,
        scope: Scope<'_>,
        text: &ExpressionText,
    ) -> Option<Typed> {
        let mut lowering = Lowering { context: self, graph, scope, text, compares_equal: false };
        let value = lowering.condition(text.parse.expression());
        value.filter(|_| text.parse.errors().is_empty())
    }
}

impl Lowering<'_, '_, '_> {
    /// A number; a truth value counts as 1 or 0.
    pub(crate) fn number(&mut self, expression: Option<Expression>) -> Option<Typed> {
        let value = self.expression(expression?)?;
        Some(self.as_number(value))
    }

    pub(crate) fn as_number(&mut self, value: Typed) -> Typed {
        if !value.boolean {
            return value;
        }
        let (one, zero) = (self.graph.number(1.0), self.graph.number(0.0));
        Typed { node: self.graph.select(value.node, one, zero), boolean: false, ..value }
    }

    /// A truth value; a number is a mistake.
    pub(crate) fn condition(&mut self, expression: Option<Expression>) -> Option<Typed> {
        let expression = expression?;
        let (range, written) = (expression.range(), self.written(&expression));
        let value = self.expression(expression)?;
        if !value.boolean {
            let number = self.graph.as_number(value.node);
            self.report(hs0203_number_as_condition::diagnostic(self.span(range), &written, number));
            return None;
        }
        Some(value)
    }

    pub(crate) fn expression(&mut self, expression: Expression) -> Option<Typed> {
        match expression {
            Expression::Literal(literal) => self.literal(&literal),
            Expression::Reference(reference) => self.reference(&reference),
            Expression::Call(call) => self.call(&call),
            Expression::Parentheses(parentheses) => self.expression(parentheses.inner()?),
            Expression::Prefix(prefix) => self.prefix(&prefix),
            Expression::Power(power) => {
                let (base, exponent) = (self.number(power.base()), self.number(power.exponent()));
                Some(self.binary(Binary::Power, base?, exponent?))
            }
            Expression::Chain(chain) => self.chain(&chain),
            Expression::Comparison(comparison) => self.comparison(&comparison),
            Expression::Conditional(conditional) => self.conditional(&conditional),
        }
    }

    fn literal(&mut self, literal: &ast::Literal) -> Option<Typed> {
        Some(match literal.value()? {
            LiteralValue::Number(x) => Typed { node: self.graph.number(x), boolean: false, varies: false },
            LiteralValue::Boolean(b) => Typed { node: self.graph.boolean(b), boolean: true, varies: false },
        })
    }

    fn reference(&mut self, reference: &ast::Reference) -> Option<Typed> {
        let name = reference.name()?;
        let span = self.span(reference.range());
        if let Scope::Function { parameters } = self.scope
            && let Some((_, value)) = parameters.iter().find(|(parameter, _)| *parameter == name)
        {
            return Some(*value);
        }
        if let Some(symbol) = self.context.names.symbol(&name) {
            return match symbol.kind {
                Kind::Constant => self.variable(&name, false),
                Kind::Function => {
                    let usage = self.context.functions.usage(&name);
                    self.report(hs0208_function_without_arguments::diagnostic(span, &name, &usage));
                    None
                }
                kind => match self.scope {
                    Scope::Location { outputs } if kind == Kind::Output => {
                        outputs.get(name.as_str()).copied().flatten()
                    }
                    Scope::Location { .. } => self.variable(&name, true),
                    _ => self.not_available(span, &name, kind.with_article()),
                },
            };
        }
        match name.as_str() {
            "pi" => {
                let node = self.graph.number(std::f64::consts::PI);
                Some(Typed { node, boolean: false, varies: false })
            }
            "time" => match self.scope {
                Scope::Location { .. } => {
                    let node = self.graph.leaf(Leaf::Time);
                    Some(Typed { node, boolean: false, varies: true })
                }
                _ => self.not_available(span, "time", "the simulated time"),
            },
            _ => {
                if let Some(function) = Predefined::named(&name) {
                    let usage = function.usage(&name);
                    self.report(hs0208_function_without_arguments::diagnostic(span, &name, &usage));
                } else {
                    self.unknown(name, span, false);
                }
                None
            }
        }
    }

    fn variable(&mut self, name: &str, varies: bool) -> Option<Typed> {
        let id = self.context.names.variable(name)?;
        Some(Typed { node: self.graph.leaf(Leaf::Variable(id)), boolean: false, varies })
    }

    fn not_available(&mut self, span: Span, name: &str, what: &str) -> Option<Typed> {
        let declared = self.context.names.symbol(name).map(|symbol| symbol.span);
        self.report(hs0207_not_available::diagnostic(span, name, what, self.scope, declared));
        None
    }

    pub(crate) fn unknown(&mut self, name: String, span: Span, called: bool) {
        let parameters = match self.scope {
            Scope::Function { parameters } => parameters.iter().map(|(name, _)| name.clone()).collect(),
            _ => Vec::new(),
        };
        self.context.findings.unknown_names.push(UnknownName { name, span, called, parameters });
    }

    fn prefix(&mut self, prefix: &ast::Prefix) -> Option<Typed> {
        match prefix.operator()? {
            PrefixOperator::Not => {
                let value = self.condition(prefix.operand())?;
                Some(Typed { node: self.graph.not(value.node), ..value })
            }
            PrefixOperator::Plus => self.number(prefix.operand()),
            PrefixOperator::Minus => {
                let value = self.number(prefix.operand())?;
                Some(Typed { node: self.graph.unary(Unary::Negate, value.node), ..value })
            }
        }
    }

    pub(crate) fn binary(&mut self, function: Binary, a: Typed, b: Typed) -> Typed {
        let node = self.graph.binary(function, a.node, b.node);
        Typed { node, boolean: false, varies: a.varies || b.varies }
    }

    fn chain(&mut self, chain: &ast::Chain) -> Option<Typed> {
        let steps = chain.steps();
        let logical =
            steps.iter().any(|s| matches!(s.operator, Some(ChainOperator::And | ChainOperator::Or)));
        let mut value = if logical { self.condition(chain.first()) } else { self.number(chain.first()) };
        for step in steps {
            let range = step.operand.as_ref().map(Expression::range);
            let written = step.operand.as_ref().map(|operand| self.written(operand));
            let operand = if logical { self.condition(step.operand) } else { self.number(step.operand) };
            if step.operator == Some(ChainOperator::Divide)
                && let (Some(divisor), Some(range), Some(written)) = (operand, range, written)
            {
                self.check_divisor(divisor, range, &written);
            }
            value = match (value, step.operator, operand) {
                (Some(a), Some(operator), Some(b)) => Some(self.apply(operator, a, b)),
                _ => None,
            };
        }
        value
    }

    fn apply(&mut self, operator: ChainOperator, a: Typed, b: Typed) -> Typed {
        let varies = a.varies || b.varies;
        match operator {
            ChainOperator::Add => self.binary(Binary::Add, a, b),
            ChainOperator::Subtract => self.binary(Binary::Subtract, a, b),
            ChainOperator::Multiply => self.binary(Binary::Multiply, a, b),
            ChainOperator::Divide => self.binary(Binary::Divide, a, b),
            ChainOperator::And => Typed { node: self.graph.and(a.node, b.node), boolean: true, varies },
            ChainOperator::Or => Typed { node: self.graph.or(a.node, b.node), boolean: true, varies },
        }
    }

    /// Complains about a divisor that is the number 0, or a constant with that value.
    pub(crate) fn check_divisor(&mut self, divisor: Typed, range: Range<usize>, written: &str) {
        let span = self.span(range);
        match self.graph.node(divisor.node) {
            Node::Number(bits) if f64::from_bits(bits) == 0.0 => {
                self.report(hs0205_division_by_zero::by_number(span, written));
            }
            Node::Leaf(Leaf::Variable(id)) if self.context.constants.get(&id) == Some(&0.0) => {
                self.report(hs0205_division_by_zero::by_constant(span, written));
            }
            _ => {}
        }
    }

    fn comparison(&mut self, comparison: &ast::Comparison) -> Option<Typed> {
        let (left, right) = (comparison.left(), comparison.right());
        let (left_text, right_text) =
            (left.as_ref().map(|e| self.written(e)), right.as_ref().map(|e| self.written(e)));
        let (a, b) = (left.and_then(|e| self.expression(e)), right.and_then(|e| self.expression(e)));
        let operator = match comparison.operator()? {
            ComparisonOperator::Less => Comparison::Less,
            ComparisonOperator::LessEqual => Comparison::LessEqual,
            ComparisonOperator::Greater => Comparison::Greater,
            ComparisonOperator::GreaterEqual => Comparison::GreaterEqual,
            ComparisonOperator::Equal => Comparison::Equal,
            ComparisonOperator::NotEqual => Comparison::NotEqual,
        };
        let (a, b) = (a?, b?);
        let varies = a.varies || b.varies;
        let equality = matches!(operator, Comparison::Equal | Comparison::NotEqual);
        if equality && a.boolean && b.boolean {
            let same = self.equivalence(a.node, b.node);
            let node = if operator == Comparison::Equal { same } else { self.graph.not(same) };
            return Some(Typed { node, boolean: true, varies });
        }
        let (a, b) = (self.as_number(a), self.as_number(b));
        if equality && varies {
            if matches!(self.scope, Scope::Function { .. }) {
                self.compares_equal = true; // judged where it is called
            } else {
                let span = self.span(comparison.operator_range()?);
                let (left, right) = (left_text.unwrap_or_default(), right_text.unwrap_or_default());
                self.report(hs0204_equality::diagnostic(span, operator, &left, &right));
                return None;
            }
        }
        Some(Typed { node: self.graph.compare(operator, a.node, b.node), boolean: true, varies })
    }

    /// Both true or both false.
    fn equivalence(&mut self, a: NodeId, b: NodeId) -> NodeId {
        let (not_a, not_b) = (self.graph.not(a), self.graph.not(b));
        let (both, neither) = (self.graph.and(a, b), self.graph.and(not_a, not_b));
        self.graph.or(both, neither)
    }

    fn conditional(&mut self, conditional: &ast::Conditional) -> Option<Typed> {
        let condition = self.condition(conditional.condition());
        let a = conditional.then_value().and_then(|e| self.expression(e));
        let b = conditional.else_value().and_then(|e| self.expression(e));
        let (condition, mut a, mut b) = (condition?, a?, b?);
        if a.boolean != b.boolean {
            (a, b) = (self.as_number(a), self.as_number(b));
        }
        let node = self.graph.select(condition.node, a.node, b.node);
        Some(Typed { node, boolean: a.boolean, varies: condition.varies || a.varies || b.varies })
    }

    /// Reports unless the text has mistakes of grammar: its structure is then a guess.
    pub(crate) fn report(&mut self, diagnostic: Diagnostic) {
        if self.text.parse.errors().is_empty() {
            self.context.findings.report(diagnostic);
        }
    }

    pub(crate) fn span(&self, range: Range<usize>) -> Span {
        self.text.map.span(range)
    }

    pub(crate) fn written(&self, expression: &Expression) -> String {
        self.text.text.get(expression.range()).unwrap_or("").to_owned()
    }
}
