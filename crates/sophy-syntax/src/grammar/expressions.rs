use crate::error::{SyntaxError, codes};
use crate::kinds::SyntaxKind;
use crate::parser::Parser;
use rowan::Checkpoint;

/// A text that is one expression.
pub(crate) fn root(p: &mut Parser<'_>) {
    p.start(SyntaxKind::Root);
    expression(p);
    if p.current() != SyntaxKind::End {
        unexpected(p);
        p.start(SyntaxKind::Error);
        p.take_rest();
        p.finish_node();
    }
    p.take_rest();
    p.finish_node();
}

/// How tightly operators bind, from loose to tight.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Level {
    Conditional,
    Or,
    And,
    Not,
    Comparison,
    Sum,
    Product,
    Sign,
    Power,
}

pub(crate) fn expression(p: &mut Parser<'_>) {
    operation(p, Level::Conditional);
}

/// An operand and the operators after it that bind at least as tightly as `least`.
fn operation(p: &mut Parser<'_>, least: Level) {
    p.nested(|p| {
        let start = p.checkpoint();
        let left = p.range().start;
        operand(p, least);
        while let Some(level) = infix(p.current()).filter(|&level| level >= least) {
            match level {
                Level::Power => power(p, start),
                Level::Comparison => comparison(p, start, left),
                _ => chain(p, start, level),
            }
        }
    });
}

/// The level of the operator at `kind`. Where an operand starts, its operator was forgotten; most likely `*`.
fn infix(kind: SyntaxKind) -> Option<Level> {
    use SyntaxKind as K;
    match kind {
        K::Or => Some(Level::Or),
        K::And => Some(Level::And),
        K::Less | K::LessEqual | K::Greater | K::GreaterEqual | K::Equal | K::NotEqual => {
            Some(Level::Comparison)
        }
        K::Plus | K::Minus => Some(Level::Sum),
        K::Star | K::Slash => Some(Level::Product),
        K::Caret => Some(Level::Power),
        _ if starts_operand(kind) => Some(Level::Product),
        _ => None,
    }
}

fn starts_operand(kind: SyntaxKind) -> bool {
    use SyntaxKind as K;
    matches!(
        kind,
        K::Number
            | K::Name
            | K::QuotedName
            | K::String
            | K::True
            | K::False
            | K::Not
            | K::If
            | K::LeftParenthesis
    )
}

/// `a + b - c`: operands of one level, left to right.
fn chain(p: &mut Parser<'_>, start: Checkpoint, level: Level) {
    let operands = match level {
        Level::Or => Level::And,
        Level::And => Level::Not,
        Level::Sum => Level::Product,
        _ => Level::Sign,
    };
    p.start_at(start, SyntaxKind::Chain);
    let mut forgotten = false;
    while infix(p.current()) == Some(level) {
        if starts_operand(p.current()) {
            if !forgotten {
                missing_operator(p);
            }
            forgotten = true;
            p.quietly(|p| operation(p, operands));
        } else {
            forgotten = false;
            p.bump();
            operation(p, operands);
        }
    }
    p.finish_node();
}

/// `a^b`; `a^b^c` is `a^(b^c)`.
fn power(p: &mut Parser<'_>, start: Checkpoint) {
    p.start_at(start, SyntaxKind::Power);
    p.bump();
    operation(p, Level::Sign);
    p.finish_node();
}

/// `a < b`; `a < b < c` is refused, but read to its end. The first operand starts at byte `left`.
fn comparison(p: &mut Parser<'_>, start: Checkpoint, left: usize) {
    p.start_at(start, SyntaxKind::Comparison);
    let mut operand = left;
    let mut parts = Vec::new();
    let mut operators = Vec::new();
    while infix(p.current()) == Some(Level::Comparison) {
        operators.push(p.range());
        p.bump();
        let next = p.range().start;
        if operators.len() == 1 {
            operation(p, Level::Sum);
        } else {
            p.quietly(|p| operation(p, Level::Sum));
        }
        let end = p.previous().map_or(next, |token| token.range.end);
        parts.push(p.text_of(operand..end.max(operand)));
        operand = next;
    }
    if let [first, second, ..] = operators.as_slice() {
        p.error(
            SyntaxError::new(codes::CHAINED_COMPARISON, second.clone(), "comparisons cannot be chained")
                .related(first.clone(), "the first comparison")
                .help(format!("write `{}`", parts.join(" and "))),
        );
    }
    p.finish_node();
}

fn operand(p: &mut Parser<'_>, least: Level) {
    use SyntaxKind as K;
    match p.current() {
        K::Number | K::True | K::False => leaf(p, K::Literal),
        K::String => leaf(p, K::Error), // reported by the lexer
        K::Name | K::QuotedName if p.next() == K::LeftParenthesis => call(p),
        K::Name | K::QuotedName => leaf(p, K::Reference),
        K::LeftParenthesis => parentheses(p),
        K::Minus | K::Plus => prefix(p, Level::Sign),
        K::Not => {
            if least > Level::Not {
                parentheses_needed(p, "not");
            }
            prefix(p, Level::Not);
        }
        K::If => {
            if least > Level::Conditional {
                parentheses_needed(p, "if");
            }
            conditional(p);
        }
        _ => missing_operand(p),
    }
}

fn leaf(p: &mut Parser<'_>, kind: SyntaxKind) {
    p.start(kind);
    p.bump();
    p.finish_node();
}

fn prefix(p: &mut Parser<'_>, operand: Level) {
    p.start(SyntaxKind::Prefix);
    p.bump();
    operation(p, operand);
    p.finish_node();
}

fn parentheses(p: &mut Parser<'_>) {
    p.start(SyntaxKind::Parentheses);
    p.bump();
    expression(p);
    close(p);
    p.finish_node();
}

/// `name(a, b)`.
fn call(p: &mut Parser<'_>) {
    p.start(SyntaxKind::Call);
    p.bump();
    p.start(SyntaxKind::Arguments);
    p.bump();
    if p.current() != SyntaxKind::RightParenthesis {
        expression(p);
        while p.current() == SyntaxKind::Comma {
            p.bump();
            expression(p);
        }
    }
    close(p);
    p.finish_node();
    p.finish_node();
}

/// The `)` of a `(`, after whatever does not fit before it. That there is none is already reported.
fn close(p: &mut Parser<'_>) {
    if !matches!(p.current(), SyntaxKind::RightParenthesis | SyntaxKind::End) {
        unexpected(p);
        p.start(SyntaxKind::Error);
        let mut open = 0;
        loop {
            match p.current() {
                SyntaxKind::End => break,
                SyntaxKind::RightParenthesis if open == 0 => break,
                SyntaxKind::LeftParenthesis => open += 1,
                SyntaxKind::RightParenthesis => open -= 1,
                _ => {}
            }
            p.bump();
        }
        p.finish_node();
    }
    if p.current() == SyntaxKind::RightParenthesis {
        p.bump();
    }
}

/// `if c then a else b`.
fn conditional(p: &mut Parser<'_>) {
    let keyword = p.range();
    let errors_before = p.error_count();
    p.start(SyntaxKind::Conditional);
    p.bump();
    expression(p);
    for part in [SyntaxKind::Then, SyntaxKind::Else] {
        if p.current() == part {
            p.bump();
            expression(p);
            continue;
        }
        if p.error_count() == errors_before {
            let name = if part == SyntaxKind::Then { "then" } else { "else" };
            p.error(
                SyntaxError::new(codes::INCOMPLETE_IF, keyword.clone(), format!("this `if` has no `{name}`"))
                    .help("write `if condition then value else other`"),
            );
        }
    }
    p.finish_node();
}

fn parentheses_needed(p: &mut Parser<'_>, word: &str) {
    let range = p.range();
    p.error(
        SyntaxError::new(codes::PARENTHESES_NEEDED, range, format!("`{word}` needs parentheses here"))
            .help(format!("put it in parentheses: `({word} …)`")),
    );
}

fn missing_operator(p: &mut Parser<'_>) {
    if p.after_reported() {
        return;
    }
    let (right, left) = (p.range(), p.previous().map(|token| token.range));
    let right_text = p.text_of(right.clone());
    let mut error = SyntaxError::new(
        codes::MISSING_OPERATOR,
        right,
        match &left {
            Some(left) => {
                format!("an operator is missing between `{}` and `{right_text}`", p.text_of(left.clone()))
            }
            None => format!("an operator is missing before `{right_text}`"),
        },
    );
    if let Some(left) = left {
        error = error
            .help(format!("for a product write `{} * {right_text}`", p.text_of(left.clone())))
            .related(left, "");
    }
    p.error(error);
}

fn missing_operand(p: &mut Parser<'_>) {
    use SyntaxKind as K;
    if p.after_reported() {
        return;
    }
    let here = p.range();
    let (range, message) = match p.previous() {
        Some(before) if matches!(before.kind, K::LeftParenthesis | K::Comma) => match p.current() {
            K::RightParenthesis | K::Comma | K::End => {
                (before.range.start..here.end, "an expression is missing here".to_owned())
            }
            _ => (here.clone(), format!("`{}` has nothing on its left", p.text_of(here))),
        },
        Some(before) => {
            (before.range.clone(), format!("`{}` has nothing on its right", p.text_of(before.range)))
        }
        None if p.current() == K::End => (here, "an expression is missing".to_owned()),
        None => (here.clone(), format!("`{}` has nothing on its left", p.text_of(here))),
    };
    p.error(
        SyntaxError::new(codes::MISSING_EXPRESSION, range, message)
            .help("write a number, a name or an expression there"),
    );
}

fn unexpected(p: &mut Parser<'_>) {
    if p.after_reported() {
        return;
    }
    let range = p.range();
    let text = p.text_of(range.clone());
    let mut error = SyntaxError::new(codes::UNEXPECTED, range, format!("`{text}` is not expected here"));
    if p.current() == SyntaxKind::Comma {
        let number_before = p.previous().filter(|token| token.kind == SyntaxKind::Number);
        error = match number_before {
            Some(number) if p.next() == SyntaxKind::Number => {
                error.help(format!("a decimal number has a point: `{}.…`", p.text_of(number.range)))
            }
            _ => error.help("a comma stands only between the arguments of a function"),
        };
    }
    p.error(error);
}
