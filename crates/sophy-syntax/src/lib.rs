//! Text → lossless tree, with every mistake of grammar; parsing never fails and knows no meaning.
//!
//! [`parse_file`] reads a file of HSML: components, functions, constants and imports. [`parse_expression`] reads
//! one expression, as SOPHY XML has them. Both return a [`Parse`]: a `rowan` tree that keeps every byte, and
//! [`SyntaxError`]s whose ranges are bytes of the text. [`ast`] is the typed view of the tree; it tolerates
//! whatever is missing. [`format()`] lays out a file.
//!
//! A file has one message for each mistake: what follows from it in the same statement is not reported, and what
//! comes after is read as it was meant. A section that lacks its `end` ends where another one starts.
//!
//! The one expression language, from loose to tight:
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
//! `%` starts a comment; `%%` one that documents the declaration after it; `'Ground Impact'` quotes a name that is
//! not an identifier or is a reserved word.

pub mod ast;
mod brackets;
mod error;
mod format;
mod grammar;
mod kinds;
mod lexer;
mod parse;
mod parser;

pub use error::{CODES, SyntaxError};
pub use format::format;
pub use kinds::{Sophy, SyntaxElement, SyntaxKind, SyntaxNode, SyntaxToken};
pub use parse::{Parse, parse_expression, parse_file};
