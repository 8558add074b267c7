//! Syntax → graph: names resolved; types, shapes and units checked; functions, loops and arrays written out.
//!
//! [`Lowering`] makes a [`Typed`] of an expression. What names mean is in [`Symbols`], what the place of the
//! expression allows in [`Place`], tables and data files in [`Files`].

mod call;
mod comparison;
mod definitions;
mod expression;
mod files;
mod fit;
mod functions;
mod lowering;
mod matrices;
mod operators;
mod record;
mod reduction;
mod scope;
mod selection;
mod special;
#[cfg(test)]
mod tests;
mod typed;

pub(crate) use definitions::{Definition, lower_globals};
pub(crate) use files::{FileMistake, Files};
pub(crate) use lowering::{Expected, Lowering};
pub(crate) use scope::{Globals, Place, Symbol, SymbolKind, SymbolValue, Symbols, VariableSymbol};
pub(crate) use typed::{Elements, Shape, Typed, Varies};

use crate::declarations::ExpressionText;
use sophy_syntax::{SyntaxElement, SyntaxKind};

/// The names that stand in an expression, as they are spelt.
pub(crate) fn names_in(text: &ExpressionText) -> Vec<String> {
    let Some(expression) = &text.expression else { return Vec::new() };
    let tokens = expression.syntax().descendants_with_tokens().filter_map(SyntaxElement::into_token);
    let mut names = Vec::new();
    let mut is_part = false;
    for token in tokens.filter(|token| !token.kind().is_trivia()) {
        match token.kind() {
            _ if is_part => {} // `record.part`
            SyntaxKind::Name => names.push(token.text().to_owned()),
            SyntaxKind::QuotedName => names.push(token.text().trim_matches(['\'', '‘', '’']).to_owned()),
            _ => {}
        }
        is_part = token.kind() == SyntaxKind::Dot;
    }
    names
}
