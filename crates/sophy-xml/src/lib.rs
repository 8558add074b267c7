//! SOPHY XML (thesis, appendix A.4 and A.5) to and from [`Declarations`](sophy_analysis::Declarations).
//!
//! [`read`] walks from bytes to declarations and reports every mistake of a file in one pass:
//!
//! 1. `encoding`: bytes to text;
//! 2. `parser`: text to a tree of elements that survives unbalanced tags, a bare `<` or an unknown entity,
//!    and knows the place of every byte (`markup`, `tag`, `nesting`, `reference` and
//!    `doctype` are its parts);
//! 3. `content`: the tree against the `schema`, the definition [`DTD`] as a table;
//! 4. `declarations`: the tree to declarations; expressions are parsed here, and [`syntax_errors`] says what
//!    is wrong with them; `hints` finds what the definition lacks (initial state, units, functions);
//! 5. `judge`: a file without a mistake so far must also satisfy a strict parser.
//!
//! [`write()`] is the way back: `restate` puts a component into the words of SOPHY XML, or says why it cannot, and
//! what it made is written down. Nothing is fetched: no external entity, no external definition. Size, depth,
//! number of nodes and the expansion of entities are bounded (`limits`). Every message has a code of
//! [`CODES`].

mod codes;
mod content;
mod declarations;
mod doctype;
mod document;
mod encoding;
mod hints;
mod judge;
mod limits;
mod markup;
mod nesting;
mod parser;
mod read;
mod reference;
mod restate;
mod schema;
mod syntax_errors;
mod tag;
mod write;

pub use codes::CODES;
pub use read::{DTD, Reading, read};
pub use syntax_errors::syntax_errors;
pub use write::{Writing, write};
