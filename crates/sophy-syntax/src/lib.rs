//! Text → lossless tree, with every mistake of grammar; parsing never fails and knows no meaning.
//!
//! [`parse_expression`] reads the one expression language of Sophy and returns a [`Parse`]: a `rowan` tree
//! that keeps every byte, and [`SyntaxError`]s whose ranges are bytes of the text. [`ast`] is the typed view of
//! the tree; it tolerates whatever is missing. Precedence, from loose to tight:
//!
//! | | |
//! | --- | --- |
//! | `if c then a else b` | in parentheses inside anything else |
//! | `or` `\|\|` | left to right |
//! | `and` `&&` | left to right |
//! | `not` `!` | `not a < b` is `not (a < b)` |
//! | `<` `<=` `>` `>=` `=` `<>` | do not associate; `==` and `!=` are accepted |
//! | `+` `-` | left to right |
//! | `*` `/` | left to right |
//! | `-` `+` as a sign | `-x^2` is `-(x^2)` |
//! | `^` | right to left; `2^-x` is `2^(-x)` |
//!
//! `%` starts a comment; `'Ground Impact'` quotes a name that is not an identifier.

pub mod ast;
mod error;
mod grammar;
mod kinds;
mod lexer;
mod parse;
mod parser;

pub use error::{CODES, SyntaxError};
pub use kinds::{Sophy, SyntaxElement, SyntaxKind, SyntaxNode, SyntaxToken};
pub use parse::{Parse, parse_expression};
