//! Typed view of the tree.
//!
//! Every type wraps one node of the tree and finds its parts when asked. Nothing is copied, and nothing is
//! promised: a part may be missing, because the text may be wrong. So accessors return `Option` or lists, and
//! this file must not panic, whatever the tree.
//!
//! To visit an expression, match on [`Expression`]; a file starts with [`File`]. Ranges are bytes of the parsed
//! text.

#![deny(clippy::unwrap_used, clippy::expect_used, clippy::panic, clippy::indexing_slicing)]

/// Defines views of nodes of one kind each.
macro_rules! view {
    ($($(#[$doc:meta])* $name:ident = $kind:ident;)*) => {
        $(
            $(#[$doc])*
            #[derive(Clone, Debug, PartialEq, Eq, Hash)]
            pub struct $name(SyntaxNode);

            impl $crate::ast::View for $name {
                fn cast(node: SyntaxNode) -> Option<Self> {
                    (node.kind() == $crate::kinds::SyntaxKind::$kind).then_some($name(node))
                }

                fn syntax(&self) -> &SyntaxNode {
                    &self.0
                }
            }
        )*
    };
}

/// Defines views of nodes of several kinds, of which each has its view.
macro_rules! views_of {
    ($($(#[$doc:meta])* $name:ident: $($variant:ident),+;)*) => {
        $(
            $(#[$doc])*
            #[derive(Clone, Debug, PartialEq, Eq, Hash)]
            #[allow(missing_docs)] // the types of the variants say it
            pub enum $name {
                $($variant($variant),)+
            }

            impl $crate::ast::View for $name {
                fn cast(node: SyntaxNode) -> Option<Self> {
                    $(
                        if let Some(view) = $variant::cast(node.clone()) {
                            return Some($name::$variant(view));
                        }
                    )+
                    None
                }

                fn syntax(&self) -> &SyntaxNode {
                    match self {
                        $($name::$variant(view) => view.syntax(),)+
                    }
                }
            }
        )*
    };
}

mod body;
mod composition;
mod expressions;
mod file;
mod statements;

pub use body::*;
pub use composition::*;
pub use expressions::*;
pub use file::*;
pub use statements::*;

use crate::kinds::{Sophy, SyntaxElement, SyntaxKind, SyntaxNode, SyntaxToken};
use rowan::{Children, GreenNodeData, GreenTokenData, Language, NodeOrToken};
use std::ops::Range;

/// A typed view of a node.
pub trait View: Sized {
    /// The view of `node`, if it is of this kind.
    fn cast(node: SyntaxNode) -> Option<Self>;

    /// The node.
    fn syntax(&self) -> &SyntaxNode;

    /// Bytes of the text, white space around it left out.
    fn range(&self) -> Range<usize> {
        range_of(self.syntax())
    }

    /// Where its first token stands; for most nodes the keyword that says what they are.
    fn keyword_range(&self) -> Range<usize> {
        keyword(self.syntax()).map_or_else(|| self.range(), |token| range_of_token(&token))
    }

    /// The `%%` comments on lines of their own before it, line by line, without the signs.
    fn documentation(&self) -> String {
        documentation(self.syntax())
    }
}

/// A name and where it stands.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Name {
    /// Without quotes.
    pub text: String,
    /// With quotes.
    pub range: Range<usize>,
}

fn name_of_token(token: &SyntaxToken) -> Option<Name> {
    matches!(token.kind(), SyntaxKind::Name | SyntaxKind::QuotedName)
        .then(|| Name { text: name_of(token), range: range_of_token(token) })
}

/// The names among the tokens of `node`.
fn names(node: &SyntaxNode) -> impl Iterator<Item = Name> + use<> {
    tokens(node).filter_map(|token| name_of_token(&token))
}

/// The token `position` of `node`, if it is a name.
fn name_at(node: &SyntaxNode, position: usize) -> Option<Name> {
    tokens(node).nth(position).and_then(|token| name_of_token(&token))
}

/// The first token of `node` that is no trivia.
fn keyword(node: &SyntaxNode) -> Option<SyntaxToken> {
    tokens(node).next()
}

fn child<T: View>(node: &SyntaxNode) -> Option<T> {
    node.children().find_map(T::cast)
}

fn children<T: View>(node: &SyntaxNode) -> impl Iterator<Item = T> + use<T> {
    node.children().filter_map(T::cast)
}

/// The expressions among the children of `node`.
fn expressions(node: &SyntaxNode) -> impl Iterator<Item = Expression> + use<> {
    node.children().filter_map(Expression::cast)
}

/// The expression after the first token of `kind`.
fn expression_after(node: &SyntaxNode, kind: SyntaxKind) -> Option<Expression> {
    elements(node)
        .skip_while(|e| e.kind() != kind)
        .filter_map(SyntaxElement::into_node)
        .find_map(Expression::cast)
}

/// The expression before the first token that is one of `kinds`.
fn expression_before(node: &SyntaxNode, kinds: &[SyntaxKind]) -> Option<Expression> {
    elements(node)
        .take_while(|e| !kinds.contains(&e.kind()))
        .filter_map(SyntaxElement::into_node)
        .find_map(Expression::cast)
}

/// The expressions in the brackets that are the first child of `kind`.
fn bracketed(node: &SyntaxNode, kind: SyntaxKind) -> Vec<Expression> {
    node.children()
        .find(|child| child.kind() == kind)
        .map(|child| expressions(&child).collect())
        .unwrap_or_default()
}

fn documentation(node: &SyntaxNode) -> String {
    let first = std::iter::successors(node.first_token(), SyntaxToken::next_token)
        .find(|token| !token.kind().is_trivia());
    let before = std::iter::successors(first.and_then(|token| token.prev_token()), SyntaxToken::prev_token)
        .take_while(|token| token.kind().is_trivia());
    let mut lines: Vec<String> = before
        .filter(|token| token.kind() == SyntaxKind::DocComment && starts_line(token))
        .map(|token| token.text().trim_start_matches('%').trim().to_owned())
        .collect();
    lines.reverse();
    lines.join("\n")
}

/// Whether nothing but space stands before `token` on its line.
fn starts_line(token: &SyntaxToken) -> bool {
    token
        .prev_token()
        .is_none_or(|before| before.kind() == SyntaxKind::Whitespace && before.text().contains('\n'))
}

fn elements(node: &SyntaxNode) -> impl Iterator<Item = SyntaxElement> + use<> {
    node.children_with_tokens()
}

fn tokens(node: &SyntaxNode) -> impl Iterator<Item = SyntaxToken> + use<> {
    elements(node).filter_map(SyntaxElement::into_token).filter(|token| !token.kind().is_trivia())
}

fn name_of(token: &SyntaxToken) -> String {
    match token.kind() {
        SyntaxKind::QuotedName => token.text().trim_matches(['\'', '‘', '’']).to_owned(),
        _ => token.text().to_owned(),
    }
}

fn range_of_token(token: &SyntaxToken) -> Range<usize> {
    token.text_range().into()
}

/// From the first to the last token that means something.
fn range_of(node: &SyntaxNode) -> Range<usize> {
    let whole: Range<usize> = node.text_range().into();
    let (mut start, mut end) = (whole.start, whole.end);
    let meaningful = |token: &SyntaxToken| !token.kind().is_trivia();
    let green = node.green();
    // Nearly always both are at the edges, and below a cursor the tree is cheaper to walk than with cursors.
    if !edge_has_meaning(&green, |mut parts| parts.next()) {
        let first = std::iter::successors(node.first_token(), SyntaxToken::next_token).find(meaningful);
        start = first.map_or(start, |token| range_of_token(&token).start).max(start);
    }
    if !edge_has_meaning(&green, |mut parts| parts.next_back()) {
        let last = std::iter::successors(node.last_token(), SyntaxToken::prev_token).find(meaningful);
        end = last.map_or(end, |token| range_of_token(&token).end).min(end);
    }
    start..end.max(start)
}

/// Whether the first or last token, by the part that is taken of each node, means something.
fn edge_has_meaning(
    node: &GreenNodeData,
    part: impl Fn(Children<'_>) -> Option<NodeOrToken<&GreenNodeData, &GreenTokenData>>,
) -> bool {
    let mut at = part(node.children());
    loop {
        match at {
            Some(NodeOrToken::Node(node)) => at = part(node.children()),
            Some(NodeOrToken::Token(token)) => return !Sophy::kind_from_raw(token.kind()).is_trivia(),
            None => return false,
        }
    }
}
