//! The first instant at which a function leaves the sign decided for it.
//!
//! Both searches share their conventions: the decided sign is the one just right of the start (limit from
//! the right), touching without crossing does not count, and a function that begins with the other sign
//! crosses at the start, the joint of two segments.

mod bracket;
mod cubic;
mod enclosed;
mod parabola;
mod reach;

pub use cubic::{cubic_crossing, cubic_leaves};
pub use enclosed::{Search, Start, first_crossing};
pub use parabola::parabola_crossing;
pub use reach::{cube_reach, cube_root, rising_root};
