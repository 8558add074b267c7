//! Linearly implicit quantisation (LIQSS): q is not where x is but where x is going.
//!
//! The rate of a state is taken as f = a·q + u + u̇·τ, with a = ∂f/∂q of the state itself, exact from its equation. q
//! is chosen a quantum beside x such that x meets it (Migoni, Bortolotto, Kofman, Cellier, *Linearly implicit
//! quantization-based integration methods for stiff ordinary differential equations*, Simulation Modelling Practice
//! and Theory 35, 2013). If x would come to rest before that, q is the place of rest, and no further step is needed:
//! a stiff state does not hop to and fro about its equilibrium. States with a ≥ 0 gain nothing and are quantised as by
//! QSS.
//!
//! For the second order q is a line about which x swings once: x − q is −δ now, δ/2 at τ = h, where both have the same
//! slope, and −δ again at 2h, |δ| = ΔQ. With g = a²·q(0) + a·u + u̇ this gives ẍ = g/(1 − ha) and ⅓g·h² − aδ·h + δ = 0.
//! For the third, q is a parabola about which x swings twice: x − q = δ(αz³ + (1 − α)z), z = 2τ/h − 1, from −δ to δ; the
//! two swings in between stay below half of it (α = 5/2). With g = ½a²(a·q(0) + u) + ½a·u̇ + ½ü and y = 1/h this gives
//! 24α·y³ − 12αa·y² + (2α + 1)a²·y = g/δ.
//!
//! What a neighbour does may turn x back at once, where it is next to the edge of the band: then two states would chase
//! each other, quanta apart, in steps of rounding. A state that has hardly moved since its last step therefore begins
//! anew with q = x, as by QSS, and comes to rest smoothly if its place of rest is near: with e = x − rest,
//! e = e₀(1 − t/T)ⁿ for T = n/|a| and order n.
//!
//! On the average q is x, so that errors cancel; the literature lets q touch x from one side, and takes twice as many
//! steps for the same bound of |x − q|. For the first order q is ΔQ ahead and left ΔQ behind.

use super::engine::Qss;
use super::group::Whereabouts;
use sophy_field::{Equations, sources_of};
use sophy_segment::rising_root;

/// The rate of a state along its quantised trajectory: a·q + u.
#[derive(Clone, Copy, Debug)]
pub(super) struct Linear {
    /// ∂f/∂q of the state itself, 1/s.
    pub(super) a: f64,
    /// u, u̇, ½ü.
    pub(super) u: [f64; 3],
}

/// α: how far x swings out between the ends of a quantised parabola.
const SWING: f64 = 2.5;

impl Linear {
    /// The next quantised trajectory at x; not finite where nothing is gained.
    fn quantise<const ORDER: usize>(self, x: f64, quantum: f64) -> [f64; 3] {
        match ORDER {
            1 => [self.value(x, quantum), 0.0, 0.0],
            2 => self.line(x, quantum),
            _ => self.parabola(x, quantum),
        }
    }

    /// A quantum beside x on the side to which x goes, or where x rests.
    fn value(self, x: f64, quantum: f64) -> f64 {
        let Linear { a, u: [u, ..] } = self;
        let rest = -u / a;
        let rate = a * x + u;
        if (rest - x).abs() <= quantum {
            rest
        } else if rate == 0.0 {
            x
        } else {
            x + quantum.copysign(rate)
        }
    }

    fn line(self, x: f64, quantum: f64) -> [f64; 3] {
        let Linear { a, u: [u, u1, _] } = self;
        let drift = a * u + u1;
        // Where ẍ = 0.
        let rest = -drift / (a * a);
        if (rest - x).abs() <= quantum {
            return [rest, a * rest + u, 0.0];
        }
        // The chord of a convex parabola lies above it on both sides.
        let offset = if a * a * x + drift > 0.0 { -quantum } else { quantum };
        let start = x + offset;
        let curvature = (a * a * start + drift).abs();
        let pull = a * quantum;
        let h = 1.5 * ((pull * pull + 4.0 / 3.0 * curvature * quantum).sqrt() - pull) / curvature;
        [start, (a * start + u + h * u1) / (1.0 - h * a), 0.0]
    }

    fn parabola(self, x: f64, quantum: f64) -> [f64; 3] {
        let Linear { a, u: [u, u1, u2] } = self;
        let drift = a * (a * u + u1) + 2.0 * u2;
        // Where the third derivative of x is 0.
        let rest = -drift / (a * a * a);
        if (rest - x).abs() <= quantum {
            let slope = a * rest + u;
            return [rest, slope, 0.5 * (a * slope + u1)];
        }
        let delta = quantum.copysign(a * a * a * x + drift);
        let start = x + delta;
        let g = 0.5 * (a * a * a * start + drift) / delta;
        let y = rising_root([(2.0 * SWING + 1.0) * a * a, -12.0 * SWING * a, 24.0 * SWING], g);
        let slope = a * start + u - (4.0 * SWING + 2.0) * delta * y;
        [start, slope, 0.5 * (a * slope + u1) + 12.0 * SWING * delta * y * y]
    }

    /// A trajectory that begins at x, so that the rate is that of x itself. If x would come to rest within a quantum, it
    /// leads there, after the delay; else it goes the way of x.
    fn settle<const ORDER: usize>(self, x: f64, quantum: f64) -> ([f64; 3], f64) {
        let rest = self.rest::<ORDER>();
        let apart = x - rest[0];
        if self.a < 0.0 && apart.abs() <= quantum {
            let delay = ORDER as f64 / -self.a;
            let way = match ORDER {
                1 => [apart, 0.0, 0.0],
                2 => [apart, -apart / delay, 0.0],
                _ => [apart, -2.0 * apart / delay, apart / (delay * delay)],
            };
            return ([x, rest[1] + way[1], rest[2] + way[2]], delay);
        }
        let Linear { a, u: [u, u1, _] } = self;
        let slope = a * x + u;
        let curve = 0.5 * (a * slope + u1);
        ([x, if ORDER > 1 { slope } else { 0.0 }, if ORDER > 2 { curve } else { 0.0 }], f64::INFINITY)
    }

    /// The polynomial motion ṙ = a·r + u on which x rests beside its moving neighbours.
    fn rest<const ORDER: usize>(self) -> [f64; 3] {
        let Linear { a, u } = self;
        let mut rest = [0.0; 3];
        let mut next = 0.0;
        for k in (0..ORDER).rev() {
            rest[k] = (next - u[k]) / a;
            next = k as f64 * rest[k];
        }
        rest
    }
}

/// What belongs to a state that is quantised ahead.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ahead {
    /// x at its last step.
    last: f64,
    /// How many steps in a row it has hardly moved.
    idle: u32,
    /// When x comes to rest on the way it is, s; infinite if it is on another way.
    pub(super) settles: f64,
    /// ∂f/∂q of the state itself where that is a constant, and the count of switchings for which it is one.
    slope: (f64, u64),
    pub(super) whereabouts: Whereabouts,
}

impl Ahead {
    pub(super) const NEW: Ahead = Ahead {
        last: f64::NAN,
        idle: 0,
        settles: f64::INFINITY,
        slope: (f64::NAN, u64::MAX),
        whereabouts: Whereabouts::NEW,
    };

    /// A step at x.
    pub(super) fn arrive(&mut self, x: f64) {
        self.last = x;
        self.settles = f64::INFINITY;
    }
}

/// q takes value and slope of x, eq. (3.7).
pub(super) fn explicit<const ORDER: usize>([x, slope, bend, _]: [f64; 4]) -> [f64; 3] {
    [x, if ORDER > 1 { slope } else { 0.0 }, if ORDER > 2 { bend } else { 0.0 }]
}

/// A state that has moved by less than this part of its quantum since its last step has hardly moved.
const HARDLY: f64 = 0.001;
/// So many steps in a row in which it has hardly moved are enough.
const MOST_IDLE: u32 = 3;

impl<const ORDER: usize, const IMPLICIT: bool> Qss<ORDER, IMPLICIT> {
    /// The next quantised trajectory of a state at its step.
    pub(super) fn quantise_ahead(&mut self, e: &Equations, i: usize, t: f64, quantum: f64) -> [f64; 3] {
        let linear = self.linear(e, i, t);
        let x = self.record(i).x_from(t);
        let ahead = &mut self.ahead[i];
        let hardly_moved = t < ahead.settles && (x[0] - ahead.last).abs() < HARDLY * quantum;
        ahead.idle = if hardly_moved { ahead.idle + 1 } else { 0 };
        let turned_back = linear.a < 0.0 && ahead.idle >= MOST_IDLE;
        ahead.arrive(x[0]);
        ahead.whereabouts.note(x[0], quantum);
        if linear.a < 0.0
            && ahead.whereabouts.is_restless()
            && let Some(q) = self.rest_together(e, i, t)
        {
            return q;
        }
        let q = linear.quantise::<ORDER>(x[0], quantum);
        if turned_back {
            self.go_to_rest(i, t, linear, quantum)
        } else if linear.a <= 0.0 && q.iter().all(|q| q.is_finite()) {
            q
        } else {
            explicit::<ORDER>(x)
        }
    }

    /// The quantised trajectory that begins at x, and how long x follows it to its rest.
    pub(super) fn go_to_rest(&mut self, i: usize, t: f64, linear: Linear, quantum: f64) -> [f64; 3] {
        let (q, delay) = linear.settle::<ORDER>(self.record(i).x_at(t), quantum);
        self.ahead[i].settles = t + delay;
        q
    }

    /// The rate of a state as a function of its own quantised trajectory.
    pub(super) fn linear(&mut self, e: &Equations, i: usize, t: f64) -> Linear {
        let (known, switchings) = self.ahead[i].slope;
        let a = if switchings == self.switchings {
            known
        } else {
            let a = self.slope(e, i, i, t);
            if ORDER > 1 && e.own_blocks(i, &self.locations).all(|(block, _)| !block.bends) {
                self.ahead[i].slope = (a, self.switchings);
            }
            a
        };
        let record = self.record(i);
        let (x, q) = (record.x_from(t), record.q_from(t));
        let mut u = [0.0; 3];
        for k in 0..ORDER {
            u[k] = (k + 1) as f64 * x[k + 1] - a * q[k];
        }
        Linear { a, u }
    }

    /// ∂f/∂q of a state by the quantised trajectory of a source: the coefficient of a motion of this one alone.
    pub(super) fn slope(&mut self, e: &Equations, state: usize, of: usize, t: f64) -> f64 {
        let mut slope = 0.0;
        let (own, copy) = e.own(state);
        for evaluation in own {
            let turn = evaluation.of(copy);
            let (block, copy) = (e.block(turn, &self.locations), turn.copy);
            // The others stand still.
            for source in sources_of(&block.reads, copy) {
                let source = source.position();
                let record = self.record(source);
                let (q, value) = ((record.q(), record.tq()), record.q_at(t));
                self.kept.push(q);
                let slope = if source == of { 1.0 } else { 0.0 };
                self.record_mut(source).set_q([value, slope, 0.0], t);
            }
            // As many coefficients as its rates have anyway, so that one native function serves both.
            self.run_block(e, (block, copy), t, if ORDER == 2 && block.bends { 3 } else { 2 });
            let mut kept = std::mem::take(&mut self.kept);
            for (source, (q, start)) in sources_of(&block.reads, copy).zip(kept.drain(..)) {
                self.record_mut(source.position()).set_q(q, start);
            }
            self.kept = kept;
            for row in &block.rows {
                if row.state.of(copy) as usize == state {
                    slope = e.rate(row, copy, &self.memory)[1];
                }
            }
        }
        slope
    }
}
