use crate::ast::Expression;
use crate::error::SyntaxError;
use crate::grammar;
use crate::kinds::SyntaxNode;
use crate::parser::Parser;
use rowan::GreenNode;

/// A tree that keeps every byte of the text, and the mistakes found on the way.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Parse {
    green: GreenNode,
    errors: Vec<SyntaxError>,
}

impl Parse {
    pub(crate) fn new(green: GreenNode, errors: Vec<SyntaxError>) -> Self {
        Parse { green, errors }
    }

    /// The expression, as far as it could be read.
    pub fn expression(&self) -> Option<Expression> {
        self.syntax().children().find_map(Expression::cast)
    }

    /// The mistakes, in the order of their places; empty if the text is well formed.
    pub fn errors(&self) -> &[SyntaxError] {
        &self.errors
    }

    /// The root of the tree.
    pub fn syntax(&self) -> SyntaxNode {
        SyntaxNode::new_root(self.green.clone())
    }
}

/// Reads one expression. Never fails: whatever the text, there is a tree whose text it is.
pub fn parse_expression(text: &str) -> Parse {
    let mut parser = Parser::new(text);
    grammar::expressions::root(&mut parser);
    parser.finish()
}
