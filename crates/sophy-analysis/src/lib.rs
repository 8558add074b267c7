//! [`Declarations`] (plain, spanned, unresolved) → [`sophy_ir::Model`]: names, types, equations.
//!
//! [`analyse`] finds all mistakes of a system in one pass and makes a model of it if there are none. Every
//! kind of mistake has a file of its own in `checks/`; the lowering of expressions to the graph, which meets
//! most of them, is in `lower/`.

mod analyse;
mod assemble;
mod checks;
mod declarations;
mod dependency_order;
mod findings;
mod lower;
mod names;
mod predefined;
#[cfg(test)]
mod testing;
#[cfg(test)]
mod tests;

pub use analyse::analyse;
pub use checks::CODES;
pub use declarations::*;
