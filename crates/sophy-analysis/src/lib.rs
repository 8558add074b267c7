//! [`Declarations`] (plain, spanned, unresolved) → [`sophy_ir::Model`]: names, types, equations.
//!
//! [`analyse`] finds all mistakes of a file in one pass and makes a model of it if there are none. Every kind of
//! mistake has a file of its own in `checks/`. A component becomes a class in `component/`, its expressions are
//! lowered to the graph in `lower/`, composites are put together in `composite/`. `hsml/` reads and writes HSML.

mod analyse;
mod checks;
mod component;
mod composite;
mod declarations;
mod dependency_order;
mod findings;
mod hsml;
mod lower;
mod predefined;
#[cfg(test)]
mod testing;
#[cfg(test)]
mod tests;
mod units;

pub use analyse::{Root, analyse};
pub use checks::CODES;
pub use checks::hs0303_algebraic_loop::across_components as algebraic_loop;
pub use declarations::*;
pub use hsml::{HSML_CODES, HsmlReading, format_hsml, read_hsml, read_with_imports, write_hsml};
