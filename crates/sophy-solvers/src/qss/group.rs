//! States that keep one another from resting are put at rest together.
//!
//! LIQSS knows of a state only how it pulls at itself. Where x pulls at y and y at x as strongly, each has a place of
//! rest as long as the other stands, and both hop about the common one for ever, as often as with an explicit method.
//! Modified LIQSS (Di Pietro, Migoni, Kofman, *Improving linearly implicit quantized state system methods*, Simulation
//! 95(2), 2019) changes two such states at once. Here as many as have moved about for some steps without getting anywhere:
//! the linear motion ṙ = A·r + u of the group is solved for that on which all of it rests, and taken if it is stable and
//! nobody is more than a quantum beside it.
//!
//! States that still hop after that take joint steps of length h, as long as quanta allow, at whose end x and q meet with
//! their slopes: (I − hA + ½h²A²)q̇ = Ax + u + hu̇ − ½h²Au̇, q = x − ½h²(Aq̇ + u̇), and (I − hA)q = x + hu for the first order.
//! Both are L-stable, so that they end at rest.

use super::engine::Qss;
use sophy_field::{Equations, StateIndex, sources_of};

/// The most states of a group.
pub(super) const MOST: usize = 12;
/// A state is restless when it has taken so many steps...
const RESTLESS: u32 = 4;
/// ... within so many quanta. Every so many steps its group is tried.
const ABOUT: f64 = 20.0;
/// After so many steps a restless group takes joint steps.
const HOPS: u32 = 40;
/// How often the motion of one step is doubled to see whether it dies out.
const DOUBLINGS: u32 = 16;
/// Joint steps last between 2⁻ˢ and 2ˢ times the time constant of the group.
const SCALES: i32 = 6;

type Vector = [f64; MOST];
type Matrix = [Vector; MOST];

/// Where a state has been of late.
#[derive(Clone, Copy, Debug)]
pub(super) struct Whereabouts {
    /// x when it began to be there.
    anchor: f64,
    /// Steps since.
    steps: u32,
    /// Whether it takes joint steps.
    joint: bool,
}

impl Whereabouts {
    pub(super) const NEW: Whereabouts = Whereabouts { anchor: f64::NAN, steps: 0, joint: false };

    /// A step at x.
    pub(super) fn note(&mut self, x: f64, quantum: f64) {
        if (x - self.anchor).abs() <= ABOUT * quantum {
            self.steps = self.steps.saturating_add(1);
        } else {
            *self = Whereabouts { anchor: x, ..Whereabouts::NEW };
        }
    }

    /// Whether its group is to be tried at this step.
    pub(super) fn is_restless(self) -> bool {
        let often = self.steps > HOPS && self.steps.is_multiple_of(RESTLESS);
        self.joint || self.steps >= RESTLESS && (self.steps.is_power_of_two() || often)
    }

    /// Whether it is on its way to be that: states that hop together do not count alike.
    fn becomes_restless(self) -> bool {
        self.steps >= RESTLESS / 2
    }
}

impl<const ORDER: usize, const IMPLICIT: bool> Qss<ORDER, IMPLICIT> {
    /// Puts a restless state at rest with those about it; its own quantised trajectory is given back, the others follow
    /// theirs and wait in `joined`. `None` if that cannot be.
    pub(super) fn rest_together(&mut self, e: &Equations, i: usize, t: f64) -> Option<[f64; 3]> {
        self.ahead[i].whereabouts.joint = false;
        let (members, count) = self.restless_about(e, i);
        let members = &members[..count];
        if count < 2 {
            return None;
        }
        let mut pulls: Matrix = [[0.0; MOST]; MOST];
        for (row, &m) in members.iter().enumerate() {
            for (column, &n) in members.iter().enumerate() {
                pulls[row][column] = self.slope(e, m, n, t);
            }
        }
        let group = Group {
            count,
            pulls,
            x: members_of(members, |m| self.record(m).x_at(t)),
            drift: self.drift(members, &pulls, t),
        };
        if !group.dies_out() {
            return None;
        }
        let quanta = members_of(members, |m| {
            let x = self.record(m).x_at(t);
            self.next_quantum(m, x)
        });
        let hops = self.ahead[i].whereabouts.steps >= HOPS;
        let (motion, delay) = group
            .rest::<ORDER>(&quanta)
            .map(|rest| (rest, f64::INFINITY))
            .or_else(|| if hops { group.longest_step::<ORDER>(&quanta) } else { None })?;
        for (row, &m) in members.iter().enumerate().rev() {
            let q = motion.map(|coefficients| coefficients[row]);
            self.ahead[m].arrive(group.x[row]);
            self.ahead[m].settles = t + delay;
            self.ahead[m].whereabouts.joint = delay.is_finite();
            if m != i {
                self.take_quantised(m, t, q, quanta[row]);
                self.joined.push(StateIndex::new(m));
            }
        }
        Some(motion.map(|coefficients| coefficients[0]))
    }

    /// The state and the restless ones that depend on it and on which it depends, the nearest ones if they are many.
    fn restless_about(&self, e: &Equations, i: usize) -> ([usize; MOST], usize) {
        let (mut found, mut count) = ([i; MOST], 1);
        // Bit n of `reads[m]`: the rate of the m-th reads the n-th.
        let mut reads = [0_u32; MOST];
        let mut m = 0;
        while m < count {
            for (block, copy) in e.own_blocks(found[m], &self.locations) {
                for source in sources_of(&block.reads, copy) {
                    let source = source.position();
                    let known = found[..count].iter().position(|&f| f == source);
                    let restless = self.ahead.get(source).is_some_and(|s| s.whereabouts.becomes_restless());
                    if let Some(n) = known.or((restless && count < MOST).then_some(count)) {
                        found[n] = source;
                        count = count.max(n + 1);
                        reads[m] |= 1 << n;
                    }
                }
            }
            m += 1;
        }
        let mut depends = 1;
        for _ in 1..count {
            for (m, reads) in reads.iter().enumerate().take(count) {
                if reads & depends != 0 {
                    depends |= 1 << m;
                }
            }
        }
        let (mut members, mut kept) = ([i; MOST], 0);
        for m in (0..count).filter(|m| depends >> m & 1 == 1) {
            members[kept] = found[m];
            kept += 1;
        }
        (members, kept)
    }

    /// u of a group, order by order: what its rates are beside A·q.
    fn drift(&self, members: &[usize], pulls: &Matrix, t: f64) -> [Vector; 3] {
        let mut drift = [[0.0; MOST]; 3];
        for (k, drift) in drift.iter_mut().enumerate().take(ORDER) {
            let rates = members_of(members, |m| (k + 1) as f64 * self.record(m).x_from(t)[k + 1]);
            let quantised = members_of(members, |m| self.record(m).q_from(t)[k]);
            *drift = plus(&rates, -1.0, &times(pulls, &quantised));
        }
        drift
    }
}

/// A group of states about a common rest: ẋ = A·q + u.
#[derive(Clone, Copy, Debug)]
struct Group {
    count: usize,
    /// A, 1/s.
    pulls: Matrix,
    x: Vector,
    /// u, u̇, ½ü.
    drift: [Vector; 3],
}

/// Coefficients of a quantised motion of a group.
type Motion = [Vector; 3];

impl Group {
    /// The motion on which all rest, if none is more than its quantum beside it.
    fn rest<const ORDER: usize>(&self, quanta: &Vector) -> Option<Motion> {
        let mut rest: Motion = [[0.0; MOST]; 3];
        let mut next = [0.0; MOST];
        for k in (0..ORDER).rev() {
            rest[k] = solve(self.pulls, plus(&next, -1.0, &self.drift[k]), self.count)?;
            next = rest[k].map(|r| k as f64 * r);
        }
        self.within(quanta, &rest).then_some(rest)
    }

    /// The longest joint step within the quanta, and its length.
    fn longest_step<const ORDER: usize>(&self, quanta: &Vector) -> Option<(Motion, f64)> {
        let size = self.size();
        let steps = (-SCALES..=SCALES).rev().map(|scale| libm::ldexp(1.0, scale) / size);
        steps
            .filter_map(|h| Some((self.step::<ORDER>(h)?, h)))
            .find(|(motion, _)| self.within(quanta, motion))
    }

    /// A joint step of length h, at whose end x and q meet.
    fn step<const ORDER: usize>(&self, h: f64) -> Option<Motion> {
        let Group { count, pulls, x, drift: [u, u1, _] } = self;
        let mut left = unit_plus(-h, pulls);
        if ORDER > 1 {
            for (row, square) in left.iter_mut().zip(&product(pulls, pulls)) {
                *row = plus(row, 0.5 * h * h, square);
            }
        }
        if ORDER == 1 {
            return Some([solve(left, plus(x, h, u), *count)?, [0.0; MOST], [0.0; MOST]]);
        }
        let ahead = plus(&plus(&times(pulls, x), 1.0, u), h, u1);
        let slope = solve(left, plus(&ahead, -0.5 * h * h, &times(pulls, u1)), *count)?;
        let bend = plus(&times(pulls, &slope), 1.0, u1);
        Some([plus(x, -0.5 * h * h, &bend), slope, [0.0; MOST]])
    }

    /// Whether a motion begins within the quanta beside x.
    fn within(&self, quanta: &Vector, motion: &Motion) -> bool {
        (0..self.count).all(|i| (motion[0][i] - self.x[i]).abs() <= quanta[i] && motion[1][i].is_finite())
    }

    /// Whether ẋ = A·x comes to rest: whether the powers of its Cayley transform (I − hA)⁻¹(I + hA) vanish.
    fn dies_out(&self) -> bool {
        let h = 1.0 / self.size();
        let (behind, ahead) = (unit_plus(-h, &self.pulls), unit_plus(h, &self.pulls));
        // Transposed, which vanishes alike.
        let mut step: Matrix = [[0.0; MOST]; MOST];
        for (column, image) in step.iter_mut().enumerate().take(self.count) {
            let Some(solution) = solve(behind, ahead.map(|row| row[column]), self.count) else {
                return false;
            };
            *image = solution;
        }
        for _ in 0..DOUBLINGS {
            step = product(&step, &step);
        }
        step.iter().flatten().all(|entry| entry.abs() < 0.5)
    }

    /// The largest sum of a row of |A|, 1/s.
    fn size(&self) -> f64 {
        self.pulls.iter().map(|row| row.iter().map(|a| a.abs()).sum()).fold(0.0, f64::max)
    }
}

fn members_of(members: &[usize], mut value: impl FnMut(usize) -> f64) -> Vector {
    let mut vector = [0.0; MOST];
    for (entry, &m) in vector.iter_mut().zip(members) {
        *entry = value(m);
    }
    vector
}

/// a + s·b.
fn plus(a: &Vector, s: f64, b: &Vector) -> Vector {
    std::array::from_fn(|i| a[i] + s * b[i])
}

/// A·x.
fn times(a: &Matrix, x: &Vector) -> Vector {
    a.map(|row| row.iter().zip(x).map(|(a, x)| a * x).sum())
}

/// A·B.
fn product(a: &Matrix, b: &Matrix) -> Matrix {
    a.map(|row| row.iter().zip(b).fold([0.0; MOST], |sum, (&entry, of)| plus(&sum, entry, of)))
}

/// I + s·A.
fn unit_plus(s: f64, a: &Matrix) -> Matrix {
    std::array::from_fn(|i| std::array::from_fn(|j| (if i == j { 1.0 } else { 0.0 }) + s * a[i][j]))
}

/// The solution of A·x = b for the leading `n` rows and columns, by elimination; `None` if A is singular.
fn solve(mut a: Matrix, mut b: Vector, n: usize) -> Option<Vector> {
    for k in 0..n {
        let pivot = (k..n).max_by(|&i, &j| a[i][k].abs().total_cmp(&a[j][k].abs()))?;
        if a[pivot][k] == 0.0 || !a[pivot][k].is_finite() {
            return None;
        }
        a.swap(k, pivot);
        b.swap(k, pivot);
        for i in (0..n).filter(|&i| i != k) {
            let factor = a[i][k] / a[k][k];
            a[i] = plus(&a[i], -factor, &a[k]);
            b[i] -= factor * b[k];
        }
    }
    let mut solution = [0.0; MOST];
    for (k, entry) in solution.iter_mut().enumerate().take(n) {
        *entry = b[k] / a[k][k];
    }
    Some(solution)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const COUNT: usize = 4;

    /// A group of four about some rest; every row of A leaves `margin` of its diagonal, s⁻¹.
    fn group(margin: f64) -> impl Strategy<Value = Group> {
        let entries = prop::array::uniform4(prop::array::uniform4(-1e3..1e3_f64));
        let vectors = prop::array::uniform4(prop::array::uniform4(-1.0..1.0_f64));
        (entries, vectors).prop_map(move |(entries, [x, u, u1, u2])| {
            let mut pulls: Matrix = [[0.0; MOST]; MOST];
            for i in 0..COUNT {
                pulls[i][..COUNT].copy_from_slice(&entries[i]);
                let others: f64 = (0..COUNT).filter(|&j| j != i).map(|j| entries[i][j].abs()).sum();
                pulls[i][i] = -others - margin;
            }
            Group { count: COUNT, pulls, x: long(x), drift: [u, u1, u2].map(long) }
        })
    }

    fn long(short: [f64; COUNT]) -> Vector {
        std::array::from_fn(|i| short.get(i).copied().unwrap_or(0.0))
    }

    fn largest(v: &Vector) -> f64 {
        v.iter().fold(0.0, |largest, x| largest.max(x.abs()))
    }

    proptest! {
        /// Gershgorin's circles are left of zero.
        #[test]
        fn what_is_dominated_by_its_diagonal_dies_out(group in group(1.0)) {
            prop_assert!(group.dies_out());
        }

        /// The sum of the eigenvalues is positive.
        #[test]
        fn what_grows_does_not(mut group in group(1.0)) {
            for i in 0..COUNT {
                group.pulls[i][i] = -group.pulls[i][i];
            }
            prop_assert!(!group.dies_out());
        }

        /// ṙ = A·r + u, coefficient by coefficient.
        #[test]
        fn at_rest_the_motion_moves_as_it_is_pulled(group in group(1.0)) {
            let rest = group.rest::<3>(&[f64::INFINITY; MOST]).expect("a rest");
            for k in 0..3 {
                let pulled = plus(&times(&group.pulls, &rest[k]), 1.0, &group.drift[k]);
                let moves = if k < 2 { rest[k + 1].map(|r| (k + 1) as f64 * r) } else { [0.0; MOST] };
                let scale = 1.0 + largest(&moves) + group.size() * largest(&rest[k]);
                prop_assert!(largest(&plus(&pulled, -1.0, &moves)) < 1e-9 * scale);
            }
        }

        /// After h, x and q meet, of the second order with their slopes.
        #[test]
        fn a_joint_step_ends_where_it_leads(group in group(1.0), scale in -6..=6_i32) {
            let h = libm::ldexp(1.0, scale) / group.size();
            let Group { pulls, x, drift: [u, u1, _], .. } = &group;

            let [q, ..] = group.step::<1>(h).expect("a step");
            let end = plus(x, h, &plus(&times(pulls, &q), 1.0, u));
            prop_assert!(largest(&plus(&end, -1.0, &q)) < 1e-9 * (1.0 + largest(&q)));

            let [q, slope, _] = group.step::<2>(h).expect("a step");
            let (rate, bend) = (plus(&times(pulls, &q), 1.0, u), plus(&times(pulls, &slope), 1.0, u1));
            let end = plus(&plus(x, h, &rate), 0.5 * h * h, &bend);
            prop_assert!(largest(&plus(&end, -1.0, &plus(&q, h, &slope))) < 1e-9 * (1.0 + largest(&q)));
            prop_assert!(largest(&plus(&plus(&rate, h, &bend), -1.0, &slope)) < 1e-9 * (1.0 + h) * group.size());
        }
    }
}
