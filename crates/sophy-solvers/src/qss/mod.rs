//! Quantised-state methods.
//!
//! A state has two trajectories: x(t), a parabola (QSS1: a line, QSS3: a cubic) that integrates its rate, and q(t), a line
//! (QSS1: a constant, QSS3: a parabola) that the rates of others read. When they differ by the quantum ΔQ, q is set to x:
//!
//! | thesis | here |
//! | --- | --- |
//! | δ_int of algorithm 3.1, eq. (3.7) | [`Qss::step`](steps): q ← x, q̇ ← ẋ |
//! | λ of algorithm 3.1, D of §3.2.2 | [`Qss::step`](steps): evaluate what q influences |
//! | δ_ext of algorithm 3.1, eq. (3.5) | [`Qss::set_rate`](steps): x ← x(t); ẋ, ẍ ← new |
//! | ta of algorithm 3.1, eq. (3.6) | [`Record::band_delay`](record) |
//! | algorithm 3.2 | the blocks of `sophy_field::Equations`; ẍ is the exact directional derivative instead of the difference quotient |
//! | timeToHit, eq. (8.3) | [`watches`] |
//!
//! Three weaknesses of the method as printed are mended. A rate that *bends* (for QSS2: is not affine; for QSS1:
//! reads time or an input) is evaluated again before the bend has moved x by a quantum, also when no quantised
//! variable changes; the thesis would follow x′ = sin t by one parabola for ever. At a start, a reset and a
//! change of location q starts on x *with its slope*, instead of one quantum later. The algorithms of chapter 2
//! print δ_int before λ; the output λ is what was predicted before: x at the edge of the band, which q becomes.

mod bend;
mod change;
mod doubt;
mod engine;
mod group;
mod implicit;
mod own;
mod record;
mod settings;
mod stairs;
mod steps;
mod watches;

pub use engine::{Liqss1, Liqss2, Liqss3, Qss, Qss1, Qss2, Qss3};
pub use settings::{Quantum, Settings};
