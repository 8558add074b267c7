//! Statements (`:=`, at an instant) and equations (`=`, always), with `if` and `for`.

use crate::error::{SyntaxError, codes};
use crate::grammar::blocks::{self, Holds};
use crate::grammar::expressions::{expression, side};
use crate::grammar::items::{
    at_name, eat, eat_misspelt, expect, expect_before, missing, misspelt, name, semicolon, unknown_word,
};
use crate::kinds::SyntaxKind;
use crate::parser::Parser;
use sophy_diagnostics::closest;

/// A statement.
pub(crate) fn statement(p: &mut Parser<'_>) {
    use SyntaxKind as K;
    match p.current() {
        K::If => conditional(p, statement),
        K::ForKeyword => for_loop(p, statement),
        K::Name
            if matches!(p.next(), K::Name | K::QuotedName)
                && (p.ahead(2).0 == K::Semicolon || !p.breaks_line_after()) =>
        {
            let words = ["emit", "hold"];
            let meant = if words.contains(&p.word()) { p.word() } else { unknown_statement(p) };
            p.start(if meant == "hold" { K::Hold } else { K::Emit });
            p.bump();
            name(p, "a name");
            semicolon(p);
            p.finish_node();
        }
        K::Name | K::QuotedName => assignment(p),
        _ => {}
    }
}

fn unknown_statement(p: &mut Parser<'_>) -> &'static str {
    unknown_word(p, "a statement", &["emit", "hold", "if", "for"]);
    closest(p.word(), ["emit", "hold"]).unwrap_or("emit")
}

/// `x[i] := e;`.
fn assignment(p: &mut Parser<'_>) {
    p.start(SyntaxKind::AssignmentStatement);
    p.fenced(side);
    let range = p.range();
    let wrong = match p.current() {
        SyntaxKind::Assign => None,
        SyntaxKind::Equal => Some("`=` states an equation; a statement assigns with `:=`"),
        SyntaxKind::Colon => Some("`:` gives a parameter its value; a statement assigns with `:=`"),
        _ => {
            missing(p, "`:=`", "write `name := value;`");
            semicolon(p);
            p.finish_node();
            return;
        }
    };
    if let Some(message) = wrong {
        p.error(SyntaxError::new(codes::EQUALITY, range, message).help("write `:=`"));
    }
    p.bump();
    p.fenced(expression);
    semicolon(p);
    p.finish_node();
}

/// An equation whose left side is a variable or a derivative.
pub(crate) fn explicit_equation(p: &mut Parser<'_>) {
    match p.current() {
        SyntaxKind::If => conditional(p, explicit_equation),
        SyntaxKind::ForKeyword => for_loop(p, explicit_equation),
        kind if starts_side(kind) => equality(p, true),
        _ => {}
    }
}

/// An equation between any two expressions.
pub(crate) fn equation(p: &mut Parser<'_>) {
    match p.current() {
        SyntaxKind::If => conditional(p, equation),
        SyntaxKind::ForKeyword => for_loop(p, equation),
        kind if starts_side(kind) => equality(p, false),
        _ => {}
    }
}

fn starts_side(kind: SyntaxKind) -> bool {
    use SyntaxKind as K;
    matches!(
        kind,
        K::Name
            | K::QuotedName
            | K::Number
            | K::LeftParenthesis
            | K::LeftBracket
            | K::Minus
            | K::Plus
            | K::String
    )
}

/// `x` of `dx/dt`.
fn derivative(left: &str) -> Option<&str> {
    let (above, below) = left.split_once('/')?;
    let name = above.trim().strip_prefix('d')?;
    (below.trim() == "dt" && !name.is_empty()).then_some(name)
}

/// `l = r;`.
fn equality(p: &mut Parser<'_>, explicit: bool) {
    p.start(SyntaxKind::Equation);
    let left = p.range().start;
    let is_misspelt = explicit && at_misspelt_derivative(p);
    if is_misspelt {
        misspelt(p, "der");
    }
    let left_is_target = !explicit || is_misspelt || at_target(p);
    p.fenced(side);
    let range = p.range();
    match p.current() {
        SyntaxKind::Equal if !left_is_target => {
            let left = left..p.end_of_previous();
            let help = match derivative(p.text_of(left.clone())) {
                Some(name) => format!("write `der({name}) = …`"),
                None => "solve it for one variable, or put it in `constraints`".to_owned(),
            };
            p.error(
                SyntaxError::new(
                    codes::LEFT_SIDE,
                    left,
                    "the left side of this equation is not `x`, `x[i]` or `der(x)`",
                )
                .help(help),
            );
        }
        SyntaxKind::Equal => {}
        SyntaxKind::Assign => p.error(
            SyntaxError::new(
                codes::EQUALITY,
                range.clone(),
                "`:=` assigns at an instant; an equation is written with `=`",
            )
            .help("write `=`"),
        ),
        SyntaxKind::Colon => p.error(
            SyntaxError::new(
                codes::EQUALITY,
                range.clone(),
                "`:` gives a parameter its value; an equation is written with `=`",
            )
            .help("write `=`"),
        ),
        _ => {
            missing(p, "`=`", "write `name = expression;`");
            semicolon(p);
            p.finish_node();
            return;
        }
    }
    p.bump();
    let right = p.position();
    p.fenced(expression);
    if let Some(second) = p.open_equality(right) {
        p.error(
            SyntaxError::new(
                codes::COMPARISON_IN_EQUATION,
                second,
                "a comparison with `=` in an equation needs parentheses",
            )
            .related(range, "the equation")
            .help("write `name = (a = b);`, or end the first equation with `;`"),
        );
    }
    semicolon(p);
    p.finish_node();
}

/// Whether `x`, `x[…]` or `der(…)` stands here, and then `=`.
fn at_target(p: &Parser<'_>) -> bool {
    use SyntaxKind as K;
    at_name(p)
        && match p.next() {
            K::LeftBracket => p.after_brackets() == K::Equal,
            K::LeftParenthesis => p.word() == "der" && p.after_brackets() == K::Equal,
            next => next == K::Equal,
        }
}

/// `dr(x) = …`: what is called on the left can only be `der`.
fn at_misspelt_derivative(p: &Parser<'_>) -> bool {
    p.current() == SyntaxKind::Name
        && p.next() == SyntaxKind::LeftParenthesis
        && p.word() != "der"
        && closest(p.word(), ["der"]).is_some()
        && p.after_brackets() == SyntaxKind::Equal
}

/// `if c then … elsif c then … else … end if;` around `item`s.
fn conditional(p: &mut Parser<'_>, item: fn(&mut Parser<'_>)) {
    use SyntaxKind as K;
    p.nested_statement(|p| {
        p.start(K::IfStatement);
        blocks::open(p, "if", Holds::Items, p.range());
        loop {
            branch(p, item);
            if p.unwinding.is_some() || !matches!(p.current(), K::Else | K::ElsifKeyword) {
                break;
            }
        }
        blocks::close(p);
        p.finish_node();
    });
}

/// `if c then [do] …`, `elsif c then [do] …` or `else [do] …`.
fn branch(p: &mut Parser<'_>, item: fn(&mut Parser<'_>)) {
    use SyntaxKind as K;
    p.begin_item();
    p.start(K::Branch);
    let has_condition = p.current() != K::Else;
    p.bump();
    if has_condition {
        p.fenced_before(&["then"], expression);
        if !eat_misspelt(p, "then") {
            expect_before(p, K::Then, "`then`", "write `if condition then`");
        }
    }
    eat(p, K::DoKeyword);
    blocks::content(p, &[K::Else, K::ElsifKeyword], item);
    p.finish_node();
}

/// Whether a loop starts here; a misspelt `for` is reported.
pub(crate) fn at_for(p: &mut Parser<'_>) -> bool {
    use SyntaxKind as K;
    let is_misspelt = p.current() == K::Name
        && matches!(p.next(), K::Name | K::QuotedName)
        && p.ahead(2).0 == K::InKeyword
        && closest(p.word(), ["for"]).is_some();
    if is_misspelt {
        misspelt(p, "for");
    }
    is_misspelt || p.current() == K::ForKeyword
}

/// `for i in 1..n loop … end loop;` around `item`s.
pub(crate) fn for_loop(p: &mut Parser<'_>, item: fn(&mut Parser<'_>)) {
    use SyntaxKind as K;
    p.nested_statement(|p| {
        p.start(K::ForLoop);
        let opening = p.range();
        p.bump();
        let help = "write `for i in 1..n loop`";
        name(p, "the name of an index");
        if expect(p, K::InKeyword, "`in`", help) {
            range(p);
        }
        if !eat_misspelt(p, "loop") {
            expect_before(p, K::LoopKeyword, "`loop`", help);
        }
        blocks::open(p, "loop", Holds::Items, opening);
        blocks::content(p, &[], item);
        blocks::close(p);
        p.finish_node();
    });
}

/// `1..n`.
fn range(p: &mut Parser<'_>) {
    p.start(SyntaxKind::Range);
    p.fenced(side);
    if expect(p, SyntaxKind::DotDot, "`..`", "write `for i in 1..n loop`") {
        p.fenced_before(&["loop"], side);
    }
    p.finish_node();
}
