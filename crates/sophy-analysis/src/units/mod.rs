//! Physical units: strings as engineers write them, their algebra, and what is known of an expression's unit.
//!
//! A [`Unit`] is a [`Dimension`] (exponents of the seven SI base units) with a factor: how many SI units it is.
//! Where a literal took part, which may have been a conversion, the factor is unknown and only the dimension
//! counts. Angles are dimensionless: the radian is 1, the degree π/180.
//!
//! [`parse`] reads a unit, [`Measured`] follows units through expressions; what does not fit is a [`Mismatch`]
//! whose text says what to convert.

mod dimension;
mod display;
mod measured;
mod parse;
mod table;
mod unit;
mod wording;

pub(crate) use dimension::Dimension;
pub(crate) use display::conversion;
pub(crate) use measured::{Measured, Mismatch};
pub(crate) use parse::{NoteKind, UnitError, parse};
pub(crate) use unit::Unit;
