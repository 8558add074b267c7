use crate::error::{SyntaxError, codes};
use crate::grammar::items::eat_misspelt;
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

/// An expression without a comparison at its outside: the left side of an equation or an assignment.
pub(crate) fn side(p: &mut Parser<'_>) {
    operation(p, Level::Sum);
}

/// An operand and the operators after it that bind at least as tightly as `least`.
fn operation(p: &mut Parser<'_>, least: Level) {
    p.nested(|p| {
        let start = p.checkpoint();
        let left = p.range().start;
        operand(p, least);
        while let Some(level) = infix(p.current()).filter(|&level| level >= least) {
            if starts_operand(p.current()) && ends_before(p) {
                break;
            }
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
            | K::LeftBracket
    )
}

/// Whether an operand that stands here after another one belongs to something else, rather than lacks an operator.
fn ends_before(p: &Parser<'_>) -> bool {
    p.begins_anew() || p.at_word("where")
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
            if ends_before(p) {
                break;
            }
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

/// So many comparisons in a row are written out in a message.
const MOST_COMPARISONS: usize = 8;

/// `a < b`; `a < b < c` is refused, but read to its end. The first operand starts at byte `left`.
fn comparison(p: &mut Parser<'_>, start: Checkpoint, left: usize) {
    p.start_at(start, SyntaxKind::Comparison);
    let mut operand = left;
    let mut parts = Vec::new();
    let mut operators = Vec::new();
    while infix(p.current()) == Some(Level::Comparison) {
        if operators.len() < MOST_COMPARISONS {
            operators.push(p.range());
        }
        p.bump();
        let next = p.range().start;
        if operators.len() == 1 {
            operation(p, Level::Sum);
        } else {
            p.quietly(|p| operation(p, Level::Sum));
        }
        if parts.len() < MOST_COMPARISONS {
            let end = p.previous().map_or(next, |token| token.range().end);
            parts.push(p.text_of(operand..end.max(operand)));
        }
        operand = next;
    }
    if let [first, second, ..] = operators.as_slice() {
        if parts.len() == MOST_COMPARISONS {
            parts.push("…");
        }
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
        K::String => leaf(p, K::StringLiteral), // where there are none, the lexer has reported it
        K::Name | K::QuotedName | K::LeftParenthesis | K::LeftBracket => selection(p),
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

/// An operand and what is selected of it: `x[2]`, `auv.drag.x[i]`, `(A*B)[1, 2]`.
fn selection(p: &mut Parser<'_>) {
    use SyntaxKind as K;
    let start = p.checkpoint();
    match p.current() {
        K::LeftParenthesis => parentheses(p),
        K::LeftBracket => vector(p),
        _ if p.next() == K::LeftParenthesis => call(p),
        _ => leaf(p, K::Reference),
    }
    let mut kind = None;
    loop {
        match p.current() {
            K::LeftBracket if !p.begins_anew() => {
                indices(p);
                kind = kind.or(Some(K::Index));
            }
            K::Dot => {
                p.bump();
                kind = Some(K::Path);
                if matches!(p.current(), K::Name | K::QuotedName) || p.current().word().is_some() {
                    p.bump();
                } else {
                    missing_operand(p);
                }
            }
            _ => break,
        }
    }
    if let Some(kind) = kind {
        p.start_at(start, kind);
        p.finish_node();
    }
}

/// `[i, j]` after what it selects from.
fn indices(p: &mut Parser<'_>) {
    p.start(SyntaxKind::Indices);
    p.bump();
    list(p, SyntaxKind::RightBracket);
    p.finish_node();
}

/// `[1, 2]`, `[[1, 2], [3, 4]]`.
fn vector(p: &mut Parser<'_>) {
    p.start(SyntaxKind::Vector);
    p.bump();
    list(p, SyntaxKind::RightBracket);
    p.finish_node();
}

fn parentheses(p: &mut Parser<'_>) {
    p.start(SyntaxKind::Parentheses);
    p.bump();
    expression(p);
    close(p, SyntaxKind::RightParenthesis);
    p.finish_node();
}

/// `name(a, b)`, `sum(i in 1..n : x[i])`.
fn call(p: &mut Parser<'_>) {
    let start = p.checkpoint();
    p.bump();
    let parenthesis = p.checkpoint();
    p.bump();
    if at_binder(p) {
        p.start_at(start, SyntaxKind::Reduction);
        reduction(p);
    } else {
        p.start_at(start, SyntaxKind::Call);
        p.start_at(parenthesis, SyntaxKind::Arguments);
        if p.current() == SyntaxKind::RightParenthesis {
            p.bump();
        } else {
            list(p, SyntaxKind::RightParenthesis);
        }
        p.finish_node();
    }
    p.finish_node();
}

/// Expressions with commas between them, up to `closing`.
fn list(p: &mut Parser<'_>, closing: SyntaxKind) {
    expression(p);
    while p.current() == SyntaxKind::Comma {
        p.bump();
        expression(p);
    }
    close(p, closing);
}

/// Whether `i in` stands here.
fn at_binder(p: &Parser<'_>) -> bool {
    matches!(p.current(), SyntaxKind::Name | SyntaxKind::QuotedName) && is_in(p.next(), p.ahead(1).1)
}

/// Where it is not reserved, `in` is a name.
fn is_in(kind: SyntaxKind, text: &str) -> bool {
    kind == SyntaxKind::InKeyword || (kind == SyntaxKind::Name && text == "in")
}

/// `i in 1..n, j in 1..m where c : e)`.
fn reduction(p: &mut Parser<'_>) {
    let errors_before = p.error_count();
    binder(p);
    while p.current() == SyntaxKind::Comma {
        p.bump();
        if at_binder(p) {
            binder(p);
        } else {
            missing(p, "a loop variable", "write for example `j in 1..3` after the comma");
            skip(p, SyntaxKind::RightParenthesis);
        }
    }
    if p.at_word("where") {
        p.bump();
        expression(p);
    }
    if p.current() == SyntaxKind::Colon {
        p.bump();
        expression(p);
    } else {
        if p.error_count() == errors_before {
            missing(p, "`:`", "write the range, a colon and what is to be combined: `sum(i in 1..3 : x[i])`");
        }
        skip(p, SyntaxKind::RightParenthesis);
    }
    close(p, SyntaxKind::RightParenthesis);
}

/// `i in 1..n`.
fn binder(p: &mut Parser<'_>) {
    p.start(SyntaxKind::Binder);
    p.bump();
    p.bump();
    p.start(SyntaxKind::Range);
    operation(p, Level::Sum);
    if p.current() == SyntaxKind::DotDot {
        p.bump();
        operation(p, Level::Sum);
    } else {
        missing(p, "`..`", "a range has a first and a last value: `1..3`");
    }
    p.finish_node();
    p.finish_node();
}

/// Something a reduction needs does not stand here.
fn missing(p: &mut Parser<'_>, what: &str, help: &str) {
    if p.after_reported() {
        return;
    }
    let range = p.range();
    let before = match p.text_of(range.clone()) {
        "" => "at the end".to_owned(),
        text => format!("before `{text}`"),
    };
    p.error(
        SyntaxError::new(codes::MISSING_EXPRESSION, range, format!("{what} is missing {before}")).help(help),
    );
}

/// The closing bracket, after whatever does not fit before it. That there is none is already reported.
fn close(p: &mut Parser<'_>, closing: SyntaxKind) {
    if p.current() != closing && p.current() != SyntaxKind::End {
        unexpected(p);
        skip(p, closing);
    }
    if p.current() == closing {
        p.bump();
    }
}

/// Takes what stands before `closing`.
fn skip(p: &mut Parser<'_>, closing: SyntaxKind) {
    use SyntaxKind as K;
    p.start(K::Error);
    let mut open = 0;
    loop {
        match p.current() {
            K::End => break,
            kind if kind == closing && open == 0 => break,
            K::LeftParenthesis | K::LeftBracket | K::LeftBrace => open += 1,
            K::RightParenthesis | K::RightBracket | K::RightBrace => open -= 1,
            _ => {}
        }
        p.bump();
    }
    p.finish_node();
}

/// `if c then a else b`.
fn conditional(p: &mut Parser<'_>) {
    let keyword = p.range();
    let errors_before = p.error_count();
    p.start(SyntaxKind::Conditional);
    p.bump();
    p.stopped_by(&["then"], expression);
    for part in [SyntaxKind::Then, SyntaxKind::Else] {
        let word = if part == SyntaxKind::Then { "then" } else { "else" };
        let is_misspelt = p.current() != part && !p.is_expression_alone() && eat_misspelt(p, word);
        if is_misspelt || p.current() == part {
            if !is_misspelt {
                p.bump();
            }
            match part {
                SyntaxKind::Then => p.stopped_by(&["else"], expression),
                _ => expression(p),
            }
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
    let (right, left) = (p.range(), p.previous().map(|token| token.range()));
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
        Some(before) if matches!(before.kind, K::LeftParenthesis | K::LeftBracket | K::Comma) => {
            match p.current() {
                K::RightParenthesis | K::RightBracket | K::Comma | K::End => {
                    (before.range().start..here.end, "an expression is missing here".to_owned())
                }
                _ => (here.clone(), format!("`{}` has nothing on its left", p.text_of(here))),
            }
        }
        Some(before) => (before.range(), format!("`{}` has nothing on its right", p.text_of(before.range()))),
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
    let number = p.previous().filter(|token| token.kind == SyntaxKind::Number);
    let number = number.map(|token| p.text_of(token.range()));
    error = match (p.current(), number) {
        (SyntaxKind::Comma, Some(number)) if p.next() == SyntaxKind::Number => {
            error.help(format!("a decimal number has a point: `{number}.…`"))
        }
        (SyntaxKind::Comma, _) => error.help("a comma stands only between the arguments of a function"),
        (SyntaxKind::String, Some(number)) => error.help(format!(
            "a number in an expression has no unit: write `{number}`, or before the component `constant NAME = {number} {text};`"
        )),
        _ => error,
    };
    p.error(error);
}
