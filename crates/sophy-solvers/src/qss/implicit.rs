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
//! On the average q is x, so that errors cancel; the literature lets q touch x from one side, and takes twice as many
//! steps for the same bound of |x − q|. For the first order q is ΔQ ahead and left ΔQ behind.

use super::engine::Qss;
use sophy_field::Equations;
use sophy_segment::rising_root;

/// The rate of a state along its quantised trajectory: a·q + u.
#[derive(Clone, Copy, Debug)]
struct Linear {
    /// ∂f/∂q of the state itself, 1/s; not positive.
    a: f64,
    /// u, u̇, ½ü.
    u: [f64; 3],
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
}

impl<const ORDER: usize> Qss<ORDER> {
    /// Value and slope of the next quantised trajectory of a state whose own rate pulls it back; `None` if it does not.
    pub(super) fn quantise_ahead(
        &mut self,
        e: &Equations,
        i: usize,
        t: f64,
        quantum: f64,
    ) -> Option<[f64; 3]> {
        let a = self.own_slope(e, i, t);
        let record = self.record(i);
        let (x, q) = (record.x_from(t), record.q_from(t));
        let mut u = [0.0; 3];
        for k in 0..ORDER {
            u[k] = (k + 1) as f64 * x[k + 1] - a * q[k];
        }
        let q = Linear { a, u }.quantise::<ORDER>(x[0], quantum);
        (a <= 0.0 && q.iter().all(|q| q.is_finite())).then_some(q)
    }

    /// ∂f/∂q of a state by its own quantised trajectory: the coefficient of a motion of this state alone.
    fn own_slope(&mut self, e: &Equations, i: usize, t: f64) -> f64 {
        let mut slope = 0.0;
        for &entry in e.entries(&e.own[i]) {
            let block = e.block(entry, &self.locations);
            // The others stand still.
            for &source in e.sources(&block.sources) {
                let record = self.record(source.position());
                let (q, value) = ((record.q(), record.tq()), record.q_at(t));
                self.kept.push(q);
                let slope = if source.position() == i { 1.0 } else { 0.0 };
                self.record_mut(source.position()).set_q([value, slope, 0.0], t);
            }
            // As many coefficients as its rates have anyway, so that one native function serves both.
            self.run_block(e, block, t, if ORDER == 2 && block.bends { 3 } else { 2 });
            let mut kept = std::mem::take(&mut self.kept);
            for (&source, (q, start)) in e.sources(&block.sources).iter().zip(kept.drain(..)) {
                self.record_mut(source.position()).set_q(q, start);
            }
            self.kept = kept;
            for row in &e.rows[block.rows.start as usize..block.rows.end as usize] {
                if row.state.position() == i {
                    slope = e.result(row.result, &self.memory, 2)[1];
                }
            }
        }
        slope
    }
}
