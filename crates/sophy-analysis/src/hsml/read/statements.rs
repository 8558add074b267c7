use super::reader::Reader;
use crate::declarations::{
    ConstraintDeclaration, EquationDeclaration, EquationItem, ExpressionText, Loop, Statement, Target,
};
use crate::hsml::codes::{ASSIGNED, CONDITIONAL_CONSTRAINT, ELSE};
use sophy_syntax::ast::{self, AssignmentStatement, Branch, ForLoop, IfStatement};

/// The parts of an `if` with conditions, and the one without.
type Parts<T> = (Vec<(ExpressionText, Vec<T>)>, Option<Vec<T>>);

impl Reader<'_> {
    pub(super) fn statements(&mut self, statements: ast::Statements) -> Vec<Statement> {
        let mut read = Vec::new();
        for statement in statements {
            match statement {
                ast::Statement::AssignmentStatement(view) => read.extend(self.assignment(&view)),
                ast::Statement::Emit(view) => read.push(Statement::Emit(self.name(view.name(), &view))),
                ast::Statement::Hold(view) => read.push(Statement::Hold(self.name(view.name(), &view))),
                ast::Statement::IfStatement(view) => {
                    let content = |reader: &mut Self, branch: &Branch| reader.statements(branch.statements());
                    let (branches, otherwise) = self.branches(&view, content);
                    read.push(Statement::If { branches, otherwise: otherwise.unwrap_or_default() });
                }
                ast::Statement::ForLoop(view) => {
                    let items = self.statements(view.statements());
                    read.push(Statement::For(self.repeated(&view, items)));
                }
            }
        }
        read
    }

    fn assignment(&mut self, view: &AssignmentStatement) -> Option<Statement> {
        let left = view.left()?;
        let Some(target) = view.target().filter(|target| !target.derivative) else {
            if !self.is_damaged(&left.range()) {
                let span = self.span(left.range());
                self.complain(
                    ASSIGNED,
                    span,
                    "the left side of this assignment is not `x` or `x[i]`",
                    "assign to a variable; derivatives are given by equations in `dynamics`",
                );
            }
            return None;
        };
        let target = self.target(target);
        Some(Statement::Assign { target, right: self.required(view.value(), view) })
    }

    fn target(&mut self, target: ast::Target) -> Target {
        Target { name: self.spanned(target.name), indices: self.expressions(target.indices) }
    }

    pub(super) fn equations(&mut self, equations: ast::Equations) -> Vec<EquationItem> {
        let mut read = Vec::new();
        for equation in equations {
            match equation {
                ast::EquationItem::Equation(view) => read.extend(self.equation(&view)),
                ast::EquationItem::IfStatement(view) => {
                    let content = |reader: &mut Self, branch: &Branch| reader.equations(branch.equations());
                    let (branches, otherwise) = self.branches(&view, content);
                    read.push(EquationItem::If { branches, otherwise, span: self.keyword(&view) });
                }
                ast::EquationItem::ForLoop(view) => {
                    let items = self.equations(view.equations());
                    read.push(EquationItem::For(self.repeated(&view, items)));
                }
            }
        }
        read
    }

    /// `None` if the left side is not what it should be, which the parser has said.
    fn equation(&mut self, view: &ast::Equation) -> Option<EquationItem> {
        let target = view.target()?;
        Some(EquationItem::Equation(EquationDeclaration {
            derivative: target.derivative,
            target: self.target(target),
            right: self.required(view.right(), view),
        }))
    }

    pub(super) fn constraints(&mut self, equations: ast::Equations) -> Vec<ConstraintDeclaration> {
        let mut constraints = Vec::new();
        for equation in equations {
            let span = match equation {
                ast::EquationItem::Equation(view) => {
                    constraints.push(ConstraintDeclaration {
                        left: self.required(view.left(), &view),
                        right: self.required(view.right(), &view),
                    });
                    continue;
                }
                ast::EquationItem::IfStatement(view) => self.keyword(&view),
                ast::EquationItem::ForLoop(view) => self.keyword(&view),
            };
            self.complain(
                CONDITIONAL_CONSTRAINT,
                span,
                "constraints stand neither under conditions nor in loops",
                "write conditions into the equation: `(if c then a else b) = 0`; equate vectors as a whole",
            );
        }
        constraints
    }

    /// The parts of an `if`, each read by `content`.
    fn branches<T>(&mut self, view: &IfStatement, content: fn(&mut Self, &Branch) -> Vec<T>) -> Parts<T> {
        let mut branches = Vec::new();
        let mut otherwise = None;
        for branch in view.branches() {
            if otherwise.is_some() {
                let span = self.keyword(&branch);
                self.complain(
                    ELSE,
                    span,
                    "this stands after the `else`, which is the last part of an `if`",
                    "put it before the `else`, or start another `if`",
                );
            }
            let items = content(self, &branch);
            if branch.is_else() {
                otherwise.get_or_insert(items);
            } else {
                branches.push((self.required(branch.condition(), &branch), items));
            }
        }
        (branches, otherwise)
    }

    pub(super) fn repeated<T>(&mut self, view: &ForLoop, items: Vec<T>) -> Loop<T> {
        let range = view.index_range();
        let (from, to) = range.map_or((None, None), |range| (range.first(), range.last()));
        Loop {
            variable: self.name(view.variable(), view),
            from: self.required(from, view),
            to: self.required(to, view),
            items,
        }
    }
}
