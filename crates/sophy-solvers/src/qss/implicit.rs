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
//! On the average q is x, so that errors cancel; the literature lets the line touch x from one side, and takes twice as
//! many steps for the same bound of |x − q|. For the first order q is ΔQ ahead and left ΔQ behind.

use super::engine::Qss;
use sophy_field::Equations;

/// The rate of a state along its quantised trajectory.
#[derive(Clone, Copy, Debug)]
struct Linear {
    /// ∂f/∂q of the state itself, 1/s; negative.
    a: f64,
    /// f and ḟ along the present q, which is q and q̇.
    rate: [f64; 2],
    q: [f64; 2],
}

impl Linear {
    /// Value and slope of the next quantised trajectory at x; the slope is 0 for order 1.
    fn quantise<const ORDER: usize>(&self, x: f64, quantum: f64) -> [f64; 2] {
        let Linear { a, rate, q } = *self;
        let u = rate[0] - a * q[0];
        if ORDER == 1 {
            return [first(a, u, x, quantum), 0.0];
        }
        let u1 = rate[1] - a * q[1];
        let drift = a * u + u1;
        // Where ẍ = 0.
        let rest = -drift / (a * a);
        if (rest - x).abs() <= quantum {
            return [rest, a * rest + u];
        }
        // The chord of a convex parabola lies above it on both sides.
        let offset = if a * a * x + drift > 0.0 { -quantum } else { quantum };
        let start = x + offset;
        let curvature = (a * a * start + drift).abs();
        let pull = a * quantum;
        let h = 1.5 * ((pull * pull + 4.0 / 3.0 * curvature * quantum).sqrt() - pull) / curvature;
        [start, (a * start + u + h * u1) / (1.0 - h * a)]
    }
}

/// A quantum beside x on the side to which x goes, or where x rests.
fn first(a: f64, u: f64, x: f64, quantum: f64) -> f64 {
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

impl<const ORDER: usize> Qss<ORDER> {
    /// Value and slope of the next quantised trajectory of a state whose own rate pulls it back; `None` if it does not.
    pub(super) fn quantise_ahead(
        &mut self,
        e: &Equations,
        i: usize,
        t: f64,
        quantum: f64,
    ) -> Option<[f64; 2]> {
        let a = self.own_slope(e, i, t);
        let record = &self.records[i];
        let linear =
            Linear { a, rate: [record.slope_at(t), 2.0 * record.x[2]], q: [record.q_at(t), record.q[1]] };
        let q = linear.quantise::<ORDER>(record.x_at(t), quantum);
        (a <= 0.0 && q[0].is_finite() && q[1].is_finite()).then_some(q)
    }

    /// ∂f/∂q of a state by its own quantised trajectory: the coefficient of a motion of this state alone.
    fn own_slope(&mut self, e: &Equations, i: usize, t: f64) -> f64 {
        let mut slope = 0.0;
        for &entry in e.entries(&e.own[i]) {
            let block = e.block(entry, &self.locations);
            for &source in e.sources(&block.sources) {
                let at = e.layout.quantised_of(source);
                self.memory[at] = self.records[source.position()].q_at(t);
                self.memory[at + 1] = if source.position() == i { 1.0 } else { 0.0 };
            }
            e.execute(&block.call, &mut self.memory, 2);
            for row in &e.rows[block.rows.start as usize..block.rows.end as usize] {
                if row.state.position() == i {
                    slope = e.result(row.result, &self.memory, 2)[1];
                }
            }
        }
        slope
    }
}
