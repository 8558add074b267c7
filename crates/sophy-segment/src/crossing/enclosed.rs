//! First sign change of a smooth function, by enclosures of it and its first two derivatives.
//!
//! The window is swept from left to right in boxes as large as possible. A box is decided if
//! - the enclosure of the function excludes 0 (no crossing),
//! - that of the first derivative does (monotone: the signs at the ends decide), or
//! - that of the second does (convex or concave: the signs at the ends and at the extremum decide),
//!
//! and is bisected otherwise, left half first. Near a multiple root nothing is decided before the function
//! is zero to rounding: such a box is passed over, and the certain signs before and after it tell whether the
//! function crossed or touched there.

use super::bracket::turn;
use crate::{Interval, Sign};

/// What is known where the search begins.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Start {
    /// The sign decided just right of the start; see [`Sign::after`].
    pub sign: Sign,
    /// Whether the value at the start counts as exactly zero: a surface just located. What rounding left
    /// there is neither found again nor taken for a sign.
    pub on_surface: bool,
}

/// What a search found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Search {
    /// The function keeps its decided sign on the whole window; touching included, within rounding.
    ///
    /// A zero that, to rounding, falls on the end of the window is left to the window that begins there: the
    /// limit from the right decides, and the sign is remembered.
    None,
    /// The sign changes at this time (s); before it, down to a few ulp, the function has its decided sign
    /// or touches zero within rounding.
    Crossing(f64),
    /// The function is zero to rounding between these times (s), the second of which is the end of the window
    /// if that took few boxes. Before it is as with `None`.
    Blurred(f64, f64),
    /// From this time (s) on it cannot be told: the budget ran out, or there is no finite enclosure.
    Undecided(f64),
}

/// First time in (from, to] at which g changes from its decided sign to the opposite one.
///
/// If g begins with the opposite sign (provably; on the surface, by the first derivative that is not zero),
/// the crossing is at `from`. With the sign 0, the crossing is where g is provably no longer zero.
/// Touching is not crossing. If g is exactly zero throughout, the answers are those of
/// [`parabola_crossing`](crate::parabola_crossing): a crossing at `from`, or none if the sign is 0.
///
/// - `enclose`: enclosures of the Taylor coefficients g, g′, g″/2 over any part of the window; the narrower
///   the interval, the closer they must be, and on a point they should differ from the values by rounding only
/// - `from`, `to`: the window in s, finite, `from <= to`
/// - `budget`: number of boxes after which the search gives up. A window takes one box to a few for each
///   turn of g, up to a hundred more for a triple root and, if rounding blurs them, some thousands for
///   roots of higher multiplicity; 10 000 decides all that is not hopeless
///
/// The time returned is the first double at or after the sign change of the midpoints of the enclosures on
/// points, so its error is that of evaluating g: a few ulp of g divided by g′.
pub fn first_crossing(
    enclose: &mut impl FnMut(Interval) -> [Interval; 3],
    from: f64,
    to: f64,
    start: Start,
    budget: u32,
) -> Search {
    if !(from.is_finite() && to.is_finite()) {
        return Search::Undecided(from);
    }
    let grain = (to - from) * GRAIN;
    let sweep = Sweep { enclose, sign: start.sign, residue: Interval::ZERO, from, grain };
    match start.sign {
        Sign::Zero => sweep.departure(to, budget),
        _ => sweep.crossing(to, start.on_surface, budget),
    }
}

/// Boxes narrower than this part of the window are not divided (times near 0 have tiny ulps).
const GRAIN: f64 = 1.0 / (1_u128 << 64) as f64;
/// Crossings are refined further, to this part of the grain.
const REFINEMENT: f64 = 1.0 / (1_u128 << 40) as f64;
/// A box is zero to rounding if no value in it exceeds this many widths of the enclosure on a point.
const NOISE: f64 = 4.0;
/// An interval up to the end of the window is wide if it is longer than this many ulp of time.
const WIDE: f64 = 64.0;
/// Boxes after which a search stops that finds nothing but rounding.
const BLURRED_BOXES: u32 = 1000;

/// f = ±g, oriented to be positive until the crossing.
struct Sweep<'a, F> {
    enclose: &'a mut F,
    sign: Sign,
    /// f(from) where that counts as zero, until f has left zero; f is known up to it.
    residue: Interval,
    from: f64,
    grain: f64,
}

/// A time and enclosures of f, f′, f″/2 there.
#[derive(Clone, Copy)]
struct Point {
    t: f64,
    f: [Interval; 3],
}

impl Point {
    fn is_positive(&self) -> bool {
        self.f[0].lo > 0.0
    }

    fn is_negative(&self) -> bool {
        self.f[0].hi < 0.0
    }
}

/// What one box says about f, which is positive or zero to rounding at its left end.
enum Verdict {
    /// f does not turn negative up to this point, the right end.
    Holds(Point),
    /// The same, since it is zero to rounding on the whole box.
    Blurred(Point),
    /// f turns negative once after the first time, not later than at the second.
    Turns(f64, f64),
    /// Undecided: look at the part up to this time first.
    Divide(f64),
    /// There is no finite enclosure.
    Lost,
}

impl<F: FnMut(Interval) -> [Interval; 3]> Sweep<'_, F> {
    /// Sweeps the window for the first turn of f from positive to negative.
    fn crossing(mut self, to: f64, on_surface: bool, budget: u32) -> Search {
        let mut left = self.at(self.from);
        let on_surface = on_surface || left.f[0] == Interval::ZERO;
        let begins = if on_surface { &left.f[1..] } else { &left.f[..1] };
        if begins.iter().find(|f| **f != Interval::ZERO).is_some_and(|f| f.hi < 0.0) {
            return Search::Crossing(self.from);
        }
        if on_surface {
            self.residue = left.f[0];
        }
        // The last time at which f is certainly positive, and since when it is zero to rounding.
        let (mut certain, mut blurred) = (self.from, None);
        let mut ends = vec![to];
        let mut boxes = 0;
        while let Some(&end) = ends.last() {
            if left.t >= end {
                ends.pop();
                continue;
            }
            boxes += 1;
            if boxes > budget {
                return Search::Undecided(left.t);
            }
            let leaving = on_surface && left.t == self.from;
            let right = match self.judge(left, end, certain, leaving) {
                Verdict::Divide(middle) => {
                    ends.push(middle);
                    continue;
                }
                Verdict::Turns(after, before) => {
                    return Search::Crossing(self.refine(after, before, on_surface));
                }
                Verdict::Lost => return Search::Undecided(left.t),
                Verdict::Blurred(right) => {
                    let (since, first) = *blurred.get_or_insert((left.t, boxes));
                    if boxes - first > BLURRED_BOXES {
                        return Search::Blurred(since, right.t);
                    }
                    right
                }
                Verdict::Holds(right) => right,
            };
            if right.is_positive() {
                (certain, blurred) = (right.t, None);
                self.residue = Interval::ZERO;
            }
            left = right;
        }
        match blurred {
            Some((since, _)) if to - since > WIDE * ulp(to) => Search::Blurred(since, to),
            _ => Search::None,
        }
    }

    /// Decides the box from `left` to `end`. `leaving`: it begins on the surface.
    fn judge(&mut self, left: Point, end: f64, certain: f64, leaving: bool) -> Verdict {
        let x = Interval { lo: left.t, hi: end };
        let f = self.over(x);
        if f[0].lo > 0.0 {
            return Verdict::Holds(Point { t: end, f });
        }
        if leaving && f[0] == Interval::ZERO {
            return Verdict::Turns(left.t, left.t);
        }
        let Some(middle) = self.middle(x) else {
            let right = self.at(end);
            return match (right.is_negative(), f[0].is_finite()) {
                (true, _) => Verdict::Turns(certain, end),
                (false, true) => Verdict::Blurred(right),
                (false, false) => Verdict::Lost,
            };
        };
        let centre = self.at(middle);
        let f = tightened(f, x, centre);
        if f[0].hi < 0.0 {
            return Verdict::Turns(certain, left.t);
        }
        let right = if f[0].lo > 0.0 { Point { t: end, f } } else { self.at(end) };
        let shape = if leaving { self.leave(left, f, right) } else { self.follow(left, f, right, certain) };
        if let Some(verdict) = shape {
            verdict
        } else if is_noise(f[0], centre.f[0]) {
            if right.is_negative() { Verdict::Turns(certain, end) } else { Verdict::Blurred(right) }
        } else {
            Verdict::Divide(middle)
        }
    }

    /// Decides a box by monotonicity or convexity.
    fn follow(&mut self, left: Point, f: [Interval; 3], right: Point, certain: f64) -> Option<Verdict> {
        let [f0, f1, f2] = f;
        let by_right_end =
            if right.is_negative() { Verdict::Turns(certain, right.t) } else { Verdict::Holds(right) };
        let (convex, concave) = (f2.lo >= 0.0, f2.hi <= 0.0);
        let (f1_left, f1_right) = (left.f[1], right.f[1]);
        let rises = f1.lo >= 0.0 || convex && f1_left.lo >= 0.0 || concave && f1_right.lo >= 0.0;
        let falls = f1.hi <= 0.0 || convex && f1_right.hi <= 0.0 || concave && f1_left.hi <= 0.0;
        if f0.lo > 0.0 || rises || falls {
            return Some(by_right_end);
        }
        if concave {
            // not below its chord
            if !right.is_negative() || left.is_positive() {
                return Some(by_right_end);
            }
            let top = self.extremum(left.t, right.t, 1.0);
            let after = if top.is_positive() { top.t } else { certain };
            return Some(Verdict::Turns(after, right.t));
        }
        if convex {
            let bottom = self.extremum(left.t, right.t, -1.0);
            if bottom.is_negative() {
                return Some(Verdict::Turns(certain, bottom.t));
            }
            // not below its tangent
            let depth = bottom.f[1].magnitude() * (right.t - left.t) - bottom.f[0].lo;
            if right.is_negative() || depth <= NOISE * bottom.f[0].width() {
                return Some(by_right_end);
            }
        }
        None
    }

    /// Decides a box that begins on the surface, where f counts as zero and does not begin negative, by the
    /// enclosure of the slope (f(t) − f(from)) / (t − from).
    fn leave(&mut self, left: Point, f: [Interval; 3], right: Point) -> Option<Verdict> {
        let [_, f1, f2] = f;
        let length = Interval { lo: 0.0, hi: (Interval::point(right.t) - Interval::point(left.t)).hi };
        let slope = common(f1, left.f[1] + f2 * length);
        // A slope that begins at zero to rounding is decided by the second derivative.
        if slope.lo > 0.0 || f2.lo >= 0.0 || f2.hi <= 0.0 {
            let turns = right.is_negative();
            return Some(if turns { Verdict::Turns(left.t, right.t) } else { Verdict::Holds(right) });
        }
        None
    }

    /// The highest (`side` 1) point of a concave or the lowest (−1) of a convex f between two times.
    fn extremum(&mut self, after: f64, before: f64, side: f64) -> Point {
        let resolution = self.grain;
        let t = turn(&mut |t| side * self.at(t).f[1].midpoint(), after, before, resolution);
        self.at(t)
    }

    /// The turn of f between two times.
    fn refine(&mut self, after: f64, before: f64, on_surface: bool) -> f64 {
        self.residue = Interval::ZERO;
        let begins_turned = after == self.from && !on_surface && self.at(after).f[0].midpoint() <= 0.0;
        if begins_turned || after >= before {
            return after;
        }
        let resolution = self.grain * REFINEMENT;
        turn(&mut |t| self.at(t).f[0].midpoint(), after, before, resolution)
    }

    /// Sweeps the window for the first time at which f is provably not zero.
    fn departure(mut self, to: f64, budget: u32) -> Search {
        let (mut left, mut blurred) = (self.from, None);
        let mut ends = vec![to];
        let mut boxes = 0;
        while let Some(&end) = ends.last() {
            boxes += 1;
            if boxes > budget {
                return Search::Undecided(left);
            }
            let x = Interval { lo: left, hi: end };
            let mut f = self.over(x);
            if f[0] != Interval::ZERO {
                let middle = self.middle(x);
                let centre = self.at(middle.unwrap_or(left));
                f = tightened(f, x, centre);
                if f.iter().any(|f| !f.contains_zero()) {
                    return Search::Crossing(left);
                }
                if let Some(middle) = middle
                    && !is_noise(f[0], centre.f[0])
                {
                    ends.push(middle);
                    continue;
                }
                if !f[0].is_finite() {
                    return Search::Undecided(left);
                }
                let (since, first) = *blurred.get_or_insert((left, boxes));
                if boxes - first > BLURRED_BOXES {
                    return Search::Blurred(since, end);
                }
            }
            left = end;
            ends.pop();
        }
        blurred.map_or(Search::None, |(since, _)| Search::Blurred(since, to))
    }

    /// Enclosures of f, f′, f″/2 over `x`.
    fn over(&mut self, x: Interval) -> [Interval; 3] {
        let g = (self.enclose)(x);
        let [f0, f1, f2] = if self.sign == Sign::Negative { g.map(|g| -g) } else { g };
        [f0.hull(f0 - self.residue), f1, f2]
    }

    fn at(&mut self, t: f64) -> Point {
        Point { t, f: self.over(Interval { lo: t, hi: t }) }
    }

    /// The middle of a box, unless that is too narrow to be divided.
    fn middle(&self, x: Interval) -> Option<f64> {
        let middle = x.midpoint();
        (x.lo < middle && middle < x.hi && x.width() > self.grain).then_some(middle)
    }
}

/// Enclosures over `x`, intersected with the mean-value and second-order Taylor forms at the centre.
fn tightened([f0, f1, f2]: [Interval; 3], x: Interval, centre: Point) -> [Interval; 3] {
    let d = x - Interval::point(centre.t);
    let [c0, c1, _] = centre.f;
    let f1 = common(f1, c1 + (f2 + f2) * d);
    let f0 = common(f0, c0 + f1 * d);
    let f0 = common(f0, c0 + c1 * d + f2 * d.square());
    [f0, f1, f2]
}

/// What two enclosures of one value have in common.
fn common(a: Interval, b: Interval) -> Interval {
    a.intersection(b).unwrap_or(a)
}

/// Whether values in `f`, of a box, are zero to the rounding that shows at one of its points.
fn is_noise(f: Interval, point: Interval) -> bool {
    point.is_finite() && f.magnitude() <= NOISE * point.width()
}

fn ulp(t: f64) -> f64 {
    t.abs().next_up() - t.abs()
}
