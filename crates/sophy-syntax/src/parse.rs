use crate::ast::{Expression, File, View};
use crate::error::SyntaxError;
use crate::grammar;
use crate::kinds::SyntaxNode;
use crate::lexer::Mode;
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

    /// The file, if one was read.
    pub fn file(&self) -> Option<File> {
        File::cast(self.syntax())
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

/// Reads a file of components, functions and constants. Never fails: whatever the text, there is a tree whose
/// text it is.
pub fn parse_file(text: &str) -> Parse {
    let mut parser = Parser::new(text, Mode::File);
    grammar::file::root(&mut parser);
    parser.finish()
}

/// Reads one expression. Never fails: whatever the text, there is a tree whose text it is.
pub fn parse_expression(text: &str) -> Parse {
    let mut parser = Parser::new(text, Mode::Expression);
    grammar::expressions::root(&mut parser);
    parser.finish()
}
