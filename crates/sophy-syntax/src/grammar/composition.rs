//! Composites: components, connections and composition matrices.

use crate::error::{SyntaxError, codes};
use crate::grammar::expressions::expression;
use crate::grammar::items::{
    at_name, close, eat, expect, missing, misspelt, name, once, semicolon, shape, unit,
};
use crate::grammar::statements::{at_for, for_loop};
use crate::kinds::SyntaxKind;
use crate::parser::Parser;
use sophy_diagnostics::closest;

/// `name : Type(p : 1)[3];`.
pub(crate) fn instance(p: &mut Parser<'_>) {
    use SyntaxKind as K;
    if at_for(p) {
        return for_loop(p, instance);
    }
    match p.current() {
        K::Name | K::QuotedName => {}
        _ => return,
    }
    p.start(K::Instance);
    p.bump();
    if p.current() == K::LeftBracket {
        shape(p, K::Indices);
    }
    if sign(p, K::Colon, "a component of a composite is given with `:`", "write `name : Component;`")
        && name(p, "the name of a component")
    {
        let mut seen = Vec::new();
        loop {
            match p.current() {
                K::LeftParenthesis => {
                    once(p, &mut seen, K::InstanceArguments, "list of values");
                    arguments(p);
                }
                K::LeftBracket => {
                    once(p, &mut seen, K::Shape, "number of copies");
                    shape(p, K::Shape);
                }
                _ => break,
            }
        }
    }
    semicolon(p);
    p.finish_node();
}

/// The sign of a declaration or connection; another one is reported and taken for it.
fn sign(p: &mut Parser<'_>, kind: SyntaxKind, message: &str, help: &str) -> bool {
    use SyntaxKind as K;
    let range = p.range();
    let other =
        matches!(p.current(), K::Colon | K::Equal | K::Assign | K::Arrow | K::GreaterEqual | K::Minus);
    if p.current() != kind && other {
        p.error(SyntaxError::new(codes::EQUALITY, range, message).help(help));
        p.bump();
        return true;
    }
    expect(p, kind, if kind == K::Arrow { "`->`" } else { "`:`" }, help)
}

/// `(p : 1, q : 2)`.
fn arguments(p: &mut Parser<'_>) {
    p.start(SyntaxKind::InstanceArguments);
    p.bump();
    while at_name(p) {
        p.start(SyntaxKind::InstanceArgument);
        p.bump();
        if expect(p, SyntaxKind::Colon, "`:`", "write `(parameter : value)`") {
            p.fenced(expression);
            unit(p);
        }
        p.finish_node();
        if !eat(p, SyntaxKind::Comma) {
            break;
        }
        if !at_name(p) {
            missing(p, "a parameter", "write `parameter : value` there, or delete the `,`");
        }
    }
    close(p, SyntaxKind::RightParenthesis);
    p.finish_node();
}

/// `a.b[i] -> c.d;` or `compose a, b with [[…]];`.
pub(crate) fn connection(p: &mut Parser<'_>) {
    use SyntaxKind as K;
    if at_for(p) {
        return for_loop(p, connection);
    }
    match p.current() {
        K::Name | K::QuotedName => {}
        _ => return,
    }
    if matches!(p.next(), K::Name | K::QuotedName) {
        if !p.at_word("compose") && closest(p.word(), ["compose"]).is_some() {
            misspelt(p, "compose");
            return compose(p);
        }
        if p.at_word("compose") {
            return compose(p);
        }
    }
    p.start(K::Connection);
    port(p);
    if sign(p, K::Arrow, "a connection is written with `->`", "write `a.output -> b.input;`") {
        if at_name(p) {
            port(p);
        } else {
            missing(p, "the input that is connected", "write `a.output -> b.input;`");
        }
    }
    semicolon(p);
    p.finish_node();
}

/// `a.b[i]`.
fn port(p: &mut Parser<'_>) {
    use SyntaxKind as K;
    p.start(K::Port);
    p.bump();
    loop {
        match p.current() {
            K::LeftBracket => shape(p, K::Indices),
            K::Dot => {
                p.bump();
                name(p, "the name of a port");
            }
            _ => break,
        }
    }
    p.finish_node();
}

/// `compose a, b with [[1, 0], [0, 1]];`.
fn compose(p: &mut Parser<'_>) {
    p.start(SyntaxKind::Compose);
    p.bump();
    port(p);
    while eat(p, SyntaxKind::Comma) {
        if at_name(p) {
            port(p);
        } else {
            missing(p, "the name of a component", "write it there, or delete the `,`");
        }
    }
    if p.at_word("with") {
        p.bump();
        p.fenced(expression);
    } else {
        missing(p, "`with`", "write `compose a, b with [[1, 0], [0, 1]];`");
    }
    semicolon(p);
    p.finish_node();
}
