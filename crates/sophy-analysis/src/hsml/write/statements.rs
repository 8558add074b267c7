use super::Writer;
use crate::declarations::{EquationItem, ExpressionText, Loop, Statement};
use sophy_syntax::ast::{ChainOperator, Expression, LiteralValue, PrefixOperator};

impl Writer {
    pub(super) fn statement(&mut self, statement: &Statement) {
        match statement {
            Statement::Assign { target, right } => {
                let (target, right) = (self.target(target), self.expression(right));
                self.line(&format!("{target} := {right};"));
            }
            Statement::Emit(label) => {
                let label = self.name(label);
                self.line(&format!("emit {label};"));
            }
            Statement::Hold(flag) => {
                let flag = self.name(flag);
                self.line(&format!("hold {flag};"));
            }
            Statement::If { branches, otherwise } => {
                let otherwise = Some(otherwise).filter(|statements| !statements.is_empty());
                self.conditional(branches, otherwise, Self::statement);
            }
            Statement::For(repeated) => self.repeated(repeated, Self::statement),
        }
    }

    pub(super) fn equation(&mut self, equation: &EquationItem) {
        match equation {
            EquationItem::Equation(equation) => {
                let (target, right) = (self.target(&equation.target), self.right_side(&equation.right));
                let left = if equation.derivative { format!("der({target})") } else { target };
                self.line(&format!("{left} = {right};"));
            }
            EquationItem::If { branches, otherwise, .. } => {
                self.conditional(branches, otherwise.as_ref(), Self::equation);
            }
            EquationItem::For(repeated) => self.repeated(repeated, Self::equation),
        }
    }

    /// The left side of a constraint, which ends at the first `=`.
    pub(super) fn left_side(&mut self, expression: &ExpressionText) -> String {
        let text = self.expression(expression);
        let needs_parentheses = match &expression.expression {
            Some(Expression::Comparison(_) | Expression::Conditional(_)) => true,
            Some(Expression::Literal(literal)) => matches!(literal.value(), Some(LiteralValue::Boolean(_))),
            Some(Expression::Prefix(prefix)) => prefix.operator() == Some(PrefixOperator::Not),
            Some(Expression::Chain(chain)) => chain
                .steps()
                .iter()
                .any(|step| matches!(step.operator, Some(ChainOperator::And | ChainOperator::Or))),
            _ => false,
        };
        if needs_parentheses { format!("({text})") } else { text }
    }

    fn conditional<T>(
        &mut self,
        branches: &[(ExpressionText, Vec<T>)],
        otherwise: Option<&Vec<T>>,
        item: fn(&mut Self, &T),
    ) {
        for (position, (condition, items)) in branches.iter().enumerate() {
            let condition = self.operand(condition);
            self.line(&format!("{} {condition} then", if position == 0 { "if" } else { "elsif" }));
            self.items(items, item);
        }
        if let Some(items) = otherwise {
            self.line("else");
            self.items(items, item);
        }
        self.line("end if;");
    }

    pub(super) fn repeated<T>(&mut self, repeated: &Loop<T>, item: fn(&mut Self, &T)) {
        let (variable, from) = (self.name(&repeated.variable), self.expression(&repeated.from));
        let to = self.expression(&repeated.to);
        self.line(&format!("for {variable} in {from}..{to} loop"));
        self.items(&repeated.items, item);
        self.line("end loop;");
    }

    fn items<T>(&mut self, items: &[T], item: fn(&mut Self, &T)) {
        self.depth += 1;
        items.iter().for_each(|each| item(self, each));
        self.depth -= 1;
    }
}
