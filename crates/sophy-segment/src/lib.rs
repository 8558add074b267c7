//! The vocabulary of time: superdense instants, polynomial segments, enclosures, first crossings.
//!
//! Between events every continuous quantity is a *segment*, a polynomial in local time
//! ([`SegmentRef`]). An event is the first *crossing* of a watch: the first instant at which a scalar
//! function of segments leaves the sign that was decided for it ([`Sign`]). Two functions locate it and
//! miss none:
//!
//! - [`parabola_crossing`], in closed form, for watches that are affine on segments of order two;
//! - [`first_crossing`], by enclosures ([`Interval`]), for every other smooth function.
//!
//! Crossings happen at superdense [`Instant`]s: a time and the number of a micro-step at that time.
//!
//! Conventions, each stated on the type that decides it: the sign just right of a joint ([`Sign::after`]),
//! touching is not crossing ([`parabola_crossing`]), a surface just located counts as exactly zero
//! ([`Start`]), what an enclosure contains ([`Interval`]).

mod crossing;
mod exact;
mod instant;
mod interval;
mod segment;
mod sign;

pub use crossing::{
    Search, Start, cube_reach, cube_root, cubic_crossing, cubic_leaves, first_crossing, parabola_crossing,
    rising_root,
};
pub use instant::Instant;
pub use interval::Interval;
pub use segment::SegmentRef;
pub use sign::Sign;
