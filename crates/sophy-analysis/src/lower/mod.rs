//! Syntax → graph: names resolved, types checked, functions and outputs inlined.

mod call;
mod definitions;
mod expression;
mod functions;
mod initial;
mod locations;

pub(crate) use definitions::{Definition, lower_definitions};
pub(crate) use expression::{Context, Scope};

pub(crate) use initial::lower_initial_values;
pub(crate) use locations::{LoweredEquation, LoweredLocation, LoweredTransition, Strays, lower_location};

use crate::declarations::ExpressionText;
use sophy_syntax::{SyntaxElement, SyntaxKind};

/// The names that stand in an expression, as they are spelt.
pub(crate) fn names_in(text: &ExpressionText) -> Vec<String> {
    let tokens = text.parse.syntax().descendants_with_tokens().filter_map(SyntaxElement::into_token);
    tokens
        .filter_map(|token| match token.kind() {
            SyntaxKind::Name => Some(token.text().to_owned()),
            SyntaxKind::QuotedName => Some(token.text().trim_matches('\'').to_owned()),
            _ => None,
        })
        .collect()
}
