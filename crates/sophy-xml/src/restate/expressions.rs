use super::complaints::Complaints;
use sophy_analysis::{Dialect, ExpressionText};
use sophy_diagnostics::Span;
use sophy_syntax::ast::Expression;
use sophy_syntax::{SyntaxKind, parse_expression};
use std::borrow::Cow;
use std::collections::HashMap;
use std::rc::Rc;

/// Most locals that may stand in one another's equations.
const MAX_DEPTH: usize = 60;

/// Longest text that replaces a local, in bytes.
const MAX_LENGTH: usize = 1 << 16;

/// Writes expressions; of HSML, those that SOPHY XML can say.
#[derive(Debug)]
pub(super) struct Expressions {
    dialect: Dialect,
}

/// The locals that a location knows, with what they stand for.
#[derive(Debug, Default)]
pub(super) struct Locals<'c> {
    /// `None`: no equation defines it here.
    pub(super) definitions: HashMap<&'c str, Option<&'c ExpressionText>>,
    replacements: HashMap<&'c str, Rc<str>>,
}

impl Expressions {
    pub(super) fn new(dialect: Dialect) -> Self {
        Expressions { dialect }
    }

    /// An expression outside locations.
    pub(super) fn constant<'c>(
        &mut self,
        expression: &'c ExpressionText,
        complaints: &mut Complaints,
    ) -> Cow<'c, str> {
        self.located(expression, &mut Locals::default(), complaints)
    }

    /// An expression of a location.
    pub(super) fn located<'c>(
        &mut self,
        expression: &'c ExpressionText,
        locals: &mut Locals<'c>,
        complaints: &mut Complaints,
    ) -> Cow<'c, str> {
        let text = match locals.replaced(expression, 0) {
            Ok(text) => text,
            Err(Obstacle { span, what, way_out }) => {
                complaints.cannot(span, what, way_out);
                return Cow::Borrowed(expression.written());
            }
        };
        // What was SOPHY XML can be said, and what is malformed has been complained about.
        if self.dialect == Dialect::Hsml
            && expression.well_formed
            && let Some(error) = parse_expression(&text).errors().first()
        {
            complaints.cannot(
                expression.span,
                format!("SOPHY XML cannot say this expression: {}", error.message),
                "only numbers, conditions and functions of them can stand in SOPHY XML",
            );
        }
        text
    }
}

/// Why a local cannot be replaced by its equation.
struct Obstacle {
    span: Span,
    what: String,
    way_out: &'static str,
}

impl<'c> Locals<'c> {
    /// The text of an expression with every local replaced; `depth` counts the locals around it.
    fn replaced(&mut self, expression: &'c ExpressionText, depth: usize) -> Result<Cow<'c, str>, Obstacle> {
        let written = expression.written();
        let Some(tree) = expression.expression.as_ref().filter(|_| !self.definitions.is_empty()) else {
            return Ok(Cow::Borrowed(written));
        };
        let obstacle = |what, way_out| Obstacle { span: expression.span, what, way_out };
        let mut text = String::new();
        let mut rest = tree.range().start;
        let end = tree.range().end;
        let mut reduction = None;
        for node in tree.syntax().descendants() {
            if node.kind() == SyntaxKind::Reduction {
                reduction = Some(());
            }
            let Some(Expression::Reference(reference)) = Expression::cast(node) else { continue };
            let Some(name) = reference.name() else { continue };
            let Some((&name, &definition)) = self.definitions.get_key_value(name.as_str()) else { continue };
            if reduction.is_some() {
                let what = format!("local `{name}` cannot be replaced by its equation inside `sum`, `min` …");
                return Err(obstacle(what, "write its equation there"));
            }
            let Some(definition) = definition else {
                let what = format!("local `{name}` has no equation here that could stand in its place");
                return Err(obstacle(what, "define it by one equation `… = …`"));
            };
            let replacement = self.replacement(name, definition, depth)?;
            let range = reference.range();
            text.push_str(expression.text.get(rest..range.start).unwrap_or(""));
            text.push_str(&replacement);
            rest = range.end;
            if text.len() > MAX_LENGTH {
                let what = format!("this becomes too long with `{name}` replaced by its equation");
                return Err(obstacle(what, "make the local a state or an output"));
            }
        }
        if text.is_empty() {
            return Ok(Cow::Borrowed(written));
        }
        text.push_str(expression.text.get(rest..end).unwrap_or(""));
        Ok(Cow::Owned(text))
    }

    fn replacement(
        &mut self,
        name: &'c str,
        definition: &'c ExpressionText,
        depth: usize,
    ) -> Result<Rc<str>, Obstacle> {
        if let Some(known) = self.replacements.get(name) {
            return Ok(known.clone());
        }
        if depth >= MAX_DEPTH {
            return Err(Obstacle {
                span: definition.span,
                what: format!(
                    "local `{name}` depends on too many others, or on itself, to be replaced by its equation"
                ),
                way_out: "make it a state or an output",
            });
        }
        let text = self.replaced(definition, depth + 1)?;
        let alone = matches!(
            definition.expression,
            Some(
                Expression::Literal(_)
                    | Expression::Reference(_)
                    | Expression::Call(_)
                    | Expression::Parentheses(_)
            )
        );
        // A local that stands for another one may stand for a sum by now.
        let text: Rc<str> = match text {
            Cow::Borrowed(text) if alone => Rc::from(text),
            text => Rc::from(format!("({text})")),
        };
        self.replacements.insert(name, text.clone());
        Ok(text)
    }
}
