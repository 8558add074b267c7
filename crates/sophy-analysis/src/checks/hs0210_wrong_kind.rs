//! A truth value, a text or a fraction stands where a value of another kind is needed.

use sophy_diagnostics::{Code, Diagnostic, Span};
use sophy_ir::Quantity;

pub(crate) const CODE: Code = Code("HS0210");

/// `written` is calculated with.
pub(crate) fn not_a_number(span: Span, written: &str, quantity: Quantity) -> Diagnostic {
    let kind = with_article(quantity);
    let error = Diagnostic::error(CODE, span, format!("`{written}` is {kind}, but a number is needed here"));
    match quantity {
        Quantity::Boolean => error.help(format!("write `(if {written} then 1 else 0)`")),
        _ => error.help("use a number there"),
    }
}

/// `written` is combined by `all` or `any`.
pub(crate) fn not_a_truth(span: Span, written: &str, quantity: Quantity) -> Diagnostic {
    let kind = with_article(quantity);
    Diagnostic::error(CODE, span, format!("`{written}` is {kind}, but a condition is needed here"))
        .help(format!("compare it with something, for example `{written} > 0`"))
}

/// `what`, declared at `declared`, gets a value of another kind.
pub(crate) fn assigned(
    span: Span,
    what: &str,
    declared: Option<Span>,
    expected: Quantity,
    found: Quantity,
) -> Diagnostic {
    let (expected_kind, found_kind) = (with_article(expected), with_article(found));
    let message = format!("{what} is {expected_kind}, but its value is {found_kind}");
    let mut error = Diagnostic::error(CODE, span, message);
    if let Some(declared) = declared {
        error = error.label(declared, expected_kind);
    }
    error.help(match (expected, found) {
        (Quantity::Integer, Quantity::Real) => "round it: `floor(…)`, `floor(… + 0.5)`",
        (Quantity::Real | Quantity::Integer, Quantity::Boolean) => "write `if … then 1 else 0`",
        (Quantity::Boolean, Quantity::Real | Quantity::Integer) => {
            "write `true` or `false`, or compare: `… > 0`"
        }
        (Quantity::Text, _) => "write a text in double quotes",
        _ => "declare it as what it is to be",
    })
}

/// The two branches of `if`.
pub(crate) fn branches(first: Span, second: Span, kinds: (Quantity, Quantity)) -> Diagnostic {
    let (a, b) = (with_article(kinds.0), with_article(kinds.1));
    Diagnostic::error(CODE, second, format!("after `then` there is {a}, but after `else` {b}"))
        .label_main(b)
        .label(first, a)
        .help("both branches need values of one kind")
}

/// Texts are compared with `<` or its like.
pub(crate) fn texts_in_order(span: Span, operator: &str) -> Diagnostic {
    Diagnostic::error(CODE, span, format!("texts cannot be compared with `{operator}`"))
        .help("compare them with `=` or `<>`")
}

/// `what` has to be a whole number.
pub(crate) fn not_whole(span: Span, what: &str, number: f64) -> Diagnostic {
    Diagnostic::error(CODE, span, format!("{what} must be a whole number, but this is {number}"))
        .help("write it without a fraction")
}

/// There is no type of this name, or none that a value can have.
pub(crate) fn no_type(span: Span, name: &str) -> Diagnostic {
    let types = ["real", "integer", "boolean", "string", "signal"];
    let error = Diagnostic::error(CODE, span, format!("`{name}` is not the type of a value"));
    error.help(super::suggestion::suggest(name, &types, "types").help)
}

pub(super) fn with_article(quantity: Quantity) -> &'static str {
    match quantity {
        Quantity::Real => "a real number",
        Quantity::Integer => "a whole number",
        Quantity::Boolean => "a truth value",
        Quantity::Text => "a text",
    }
}
