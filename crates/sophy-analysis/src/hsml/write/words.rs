use super::Writer;
use crate::declarations::{ExpressionText, RangeText, Spanned, Target, TypeText};
use sophy_syntax::ast::{ComparisonOperator, Expression, FileItem};
use sophy_syntax::{SyntaxElement, SyntaxKind, SyntaxToken, parse_file};

/// Words that end a condition or rate where they stand alone.
const CLAUSES: &[&str] = &["initially", "delay", "latched", "cancellable", "priority"];

impl Writer {
    /// A name, in quotes if it is no identifier.
    pub(super) fn name(&mut self, name: &Spanned<String>) -> String {
        self.name_text(&name.value)
    }

    pub(super) fn names(&mut self, names: &[Spanned<String>]) -> String {
        names.iter().map(|name| self.name(name)).collect::<Vec<_>>().join(", ")
    }

    fn name_text(&mut self, name: &str) -> String {
        if !self.needs_quotes(name) {
            return name.to_owned();
        }
        let shown = name.chars().map(|c| match c {
            '\'' | '‘' | '’' => '′',
            c if c.is_control() => ' ',
            c => c,
        });
        format!("'{}'", shown.collect::<String>())
    }

    /// Whether the grammar does not take a word for a name.
    fn needs_quotes(&mut self, name: &str) -> bool {
        // Names in some places only.
        if matches!(name, "event" | "events" | "location") {
            return true;
        }
        if let Some(&known) = self.quoted.get(name) {
            return known;
        }
        let parse = parse_file(&format!("constant {name} = 0;"));
        let is_name = parse.errors().is_empty()
            && parse.file().and_then(|file| file.items().next()).is_some_and(|item| match item {
                FileItem::Constant(constant) => constant.name().is_some_and(|found| found.text == name),
                _ => false,
            });
        self.quoted.insert(name.to_owned(), !is_name);
        !is_name
    }

    /// A text in double quotes.
    pub(super) fn string(text: &str) -> String {
        let shown = text.chars().map(|c| match c {
            '"' | '“' | '”' | '„' => '″',
            c if c.is_control() => ' ',
            c => c,
        });
        format!("\"{}\"", shown.collect::<String>())
    }

    /// `%%` before each line.
    pub(super) fn documentation(&mut self, documentation: &str) {
        if documentation.is_empty() {
            return;
        }
        for line in documentation.split('\n') {
            let line = line.trim_end();
            self.line(&if line.is_empty() {
                "%%".to_owned()
            } else {
                format!("%% {}", line.replace('\r', " "))
            });
        }
    }

    /// An expression that something else follows, or another expression.
    pub(super) fn operand(&mut self, expression: &ExpressionText) -> String {
        let text = self.expression(expression);
        match &expression.expression {
            Some(Expression::Conditional(_)) => format!("({text})"),
            _ => text,
        }
    }

    /// A condition or rate that clauses may follow.
    pub(super) fn condition(&mut self, expression: &ExpressionText) -> String {
        let text = self.words(expression, CLAUSES);
        match &expression.expression {
            Some(Expression::Conditional(_)) => format!("({text})"),
            _ => text,
        }
    }

    /// The right side of an equation, in which a comparison with `=` needs parentheses.
    pub(super) fn right_side(&mut self, expression: &ExpressionText) -> String {
        let text = self.expression(expression);
        let open = expression.expression.as_ref().is_some_and(has_open_equality);
        if open { format!("({text})") } else { text }
    }

    /// An expression as it is written, what HSML reserves in quotes.
    pub(super) fn expression(&mut self, expression: &ExpressionText) -> String {
        self.words(expression, &[])
    }

    fn words(&mut self, expression: &ExpressionText, quoted: &[&str]) -> String {
        let Some(tree) = &expression.expression else { return expression.written().trim().to_owned() };
        let range = tree.range();
        let mut text = String::new();
        let tokens = tree.syntax().descendants_with_tokens().filter_map(SyntaxElement::into_token);
        for token in tokens.filter(|token| {
            usize::from(token.text_range().start()) >= range.start
                && usize::from(token.text_range().end()) <= range.end
        }) {
            match token.kind() {
                SyntaxKind::Name if self.is_quoted_here(&token, quoted) => {
                    text.push_str(&format!("'{}'", token.text()));
                }
                // A `%%` would document something.
                SyntaxKind::Comment | SyntaxKind::DocComment => {
                    text.push_str(&format!("% {}", token.text().trim_start_matches('%').trim()));
                }
                _ => text.push_str(token.text()),
            }
        }
        text
    }

    /// Whether a name in an expression needs quotes; `words` do in this place.
    fn is_quoted_here(&mut self, token: &SyntaxToken, words: &[&str]) -> bool {
        let text = token.text();
        // `location` is predefined, and a name within expressions.
        let free = text == "location" || is_in(token);
        !free && (words.contains(&text) || self.needs_quotes(text))
    }

    pub(super) fn list(&mut self, expressions: &[ExpressionText]) -> String {
        expressions.iter().map(|expression| self.expression(expression)).collect::<Vec<_>>().join(", ")
    }

    /// `[a, b]`, or nothing.
    pub(super) fn brackets(&mut self, expressions: &[ExpressionText]) -> String {
        if expressions.is_empty() { String::new() } else { format!("[{}]", self.list(expressions)) }
    }

    pub(super) fn kind(&mut self, kind: &TypeText) -> String {
        let name = match kind.name.value.as_str() {
            "event" => "event".to_owned(),
            _ => self.name(&kind.name),
        };
        name + &self.brackets(&kind.shape)
    }

    pub(super) fn range(&mut self, range: &RangeText) -> String {
        match range {
            RangeText::Bounds(low, high) => format!("({}, {})", self.expression(low), self.expression(high)),
            RangeText::Set(values) => format!("{{{}}}", self.list(values)),
        }
    }

    pub(super) fn target(&mut self, target: &Target) -> String {
        self.name(&target.name) + &self.brackets(&target.indices)
    }
}

/// The `in` of `sum(i in 1..n : …)`, which is a plain word where nothing is reserved.
fn is_in(token: &SyntaxToken) -> bool {
    token.text() == "in"
        && token.parent().is_some_and(|parent| parent.kind() == SyntaxKind::Binder)
        && token.prev_sibling_or_token().is_some()
}

/// Whether a comparison with `=` stands outside of all parentheses.
fn has_open_equality(expression: &Expression) -> bool {
    let mut open: Vec<Expression> = vec![expression.clone()];
    while let Some(next) = open.pop() {
        match next {
            Expression::Comparison(comparison)
                if comparison.operator() == Some(ComparisonOperator::Equal) =>
            {
                return true;
            }
            Expression::Prefix(prefix) => open.extend(prefix.operand()),
            Expression::Chain(chain) => {
                open.extend(chain.first());
                open.extend(chain.steps().into_iter().filter_map(|step| step.operand));
            }
            Expression::Conditional(c) => {
                open.extend([c.condition(), c.then_value(), c.else_value()].into_iter().flatten());
            }
            _ => {}
        }
    }
    false
}
