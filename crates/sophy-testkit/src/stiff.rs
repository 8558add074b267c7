//! Stiff and large systems whose rates are plain functions, too, for references by Runge–Kutta.

use crate::Build;
use sophy_ir::Model;

/// A system without events.
pub trait Smooth {
    /// Its model; states are named `x1`, `x2`, ….
    fn model(&self) -> Model;

    /// Its states at 0 s.
    fn start(&self) -> Vec<f64>;

    /// The rates of all states.
    fn rates(&self, x: &[f64], rates: &mut [f64]);

    /// The states at `stop` (s) by the classical Runge–Kutta method with steps of `h` (s).
    fn runge_kutta(&self, stop: f64, h: f64) -> Vec<f64> {
        let mut x = self.start();
        let count = x.len();
        let mut k = vec![vec![0.0; count]; 4];
        let mut at = x.clone();
        for _ in 0..(stop / h).round() as usize {
            for (stage, part) in [0.0, 0.5, 0.5, 1.0].into_iter().enumerate() {
                for i in 0..count {
                    let before = if stage == 0 { 0.0 } else { k[stage - 1][i] };
                    at[i] = x[i] + part * h * before;
                }
                self.rates(&at, &mut k[stage]);
            }
            for i in 0..count {
                x[i] += h / 6.0 * (k[0][i] + 2.0 * k[1][i] + 2.0 * k[2][i] + k[3][i]);
            }
        }
        x
    }
}

/// x₁′ = x₂/100, x₂′ = −100 x₁ − 100 x₂ + 2020 from (0, 20): eigenvalues −0.01 and −99.99.
pub fn stiff_pair() -> Model {
    let mut b = Build::default();
    b.component("");
    let (x1, x2) = (b.state("x1", 0.0), b.state("x2", 20.0));
    let here = b.location("all");
    let [hundredth, hundred, rest] = [0.01, 100.0, 2020.0].map(|n| b.number(n));
    let (first, second) = (b.read(x1), b.read(x2));
    let slow = b.mul(hundredth, second);
    let sum = b.add(first, second);
    let pulled = b.mul(hundred, sum);
    let fast = b.sub(rest, pulled);
    b.rate(here, x1, slow);
    b.rate(here, x2, fast);
    b.model()
}

/// x₁ and x₂ of [`stiff_pair`] at `t` (s).
pub fn stiff_pair_at(t: f64) -> [f64; 2] {
    // λ² + 100 λ + 1 = 0
    let root = f64::sqrt(9996.0);
    let (slow, fast) = (-2.0 / (100.0 + root), -(100.0 + root) / 2.0);
    let b = (0.2 + 20.2 * slow) / (fast - slow);
    let a = -20.2 - b;
    let (ea, eb) = (a * libm::exp(slow * t), b * libm::exp(fast * t));
    [20.2 + ea + eb, 100.0 * (slow * ea + fast * eb)]
}

/// u′ᵢ = N(uᵢ₋₁ − uᵢ) − 1000 uᵢ(uᵢ − ½)(uᵢ − 1), u₀ = 1: a front that travels through N cells at rest, of which the
/// first 0.3 N are 1 at the start.
#[derive(Clone, Copy, Debug)]
pub struct AdvectionReaction(
    /// N.
    pub usize,
);

impl Smooth for AdvectionReaction {
    fn model(&self) -> Model {
        let mut b = Build::default();
        b.component("");
        let cells: Vec<_> =
            (1..).zip(self.start()).map(|(i, start)| b.state(&format!("x{i}"), start)).collect();
        let here = b.location("all");
        let [one, half, speed, reaction] = [1.0, 0.5, self.0 as f64, 1000.0].map(|n| b.number(n));
        let mut before = one;
        for cell in cells {
            let u = b.read(cell);
            let step = b.sub(before, u);
            let (flow, middle, end) = (b.mul(step, speed), b.sub(u, half), b.sub(u, one));
            let product = b.mul(u, middle);
            let product = b.mul(product, end);
            let source = b.mul(product, reaction);
            let rate = b.sub(flow, source);
            b.rate(here, cell, rate);
            before = u;
        }
        b.model()
    }

    fn start(&self) -> Vec<f64> {
        (0..self.0).map(|i| if 10 * i < 3 * self.0 { 1.0 } else { 0.0 }).collect()
    }

    fn rates(&self, u: &[f64], rates: &mut [f64]) {
        let mut before = 1.0;
        for (rate, &u) in rates.iter_mut().zip(u) {
            *rate = self.0 as f64 * (before - u) - 1000.0 * u * (u - 0.5) * (u - 1.0);
            before = u;
        }
    }
}

/// A line of coils and capacitors, i′ₖ = uₖ₋₁ − uₖ, u′ₖ = iₖ − iₖ₊₁, at rest, to which a source of u₀ = 1 is switched;
/// a matched resistance at its end. Its states are the currents, then the voltages.
#[derive(Clone, Copy, Debug)]
pub struct LcLine(
    /// Sections, of two states each.
    pub usize,
);

impl Smooth for LcLine {
    fn model(&self) -> Model {
        let mut b = Build::default();
        b.component("");
        let states: Vec<_> = (1..=2 * self.0).map(|i| b.state(&format!("x{i}"), 0.0)).collect();
        let here = b.location("all");
        let values: Vec<_> = states.iter().map(|&state| b.read(state)).collect();
        let (currents, voltages) = values.split_at(self.0);
        let mut before = b.number(1.0);
        for k in 0..self.0 {
            let across = b.sub(before, voltages[k]);
            b.rate(here, states[k], across);
            let out = currents.get(k + 1).copied().unwrap_or(voltages[k]);
            let into = b.sub(currents[k], out);
            b.rate(here, states[self.0 + k], into);
            before = voltages[k];
        }
        b.model()
    }

    fn start(&self) -> Vec<f64> {
        vec![0.0; 2 * self.0]
    }

    fn rates(&self, x: &[f64], rates: &mut [f64]) {
        let (currents, voltages) = x.split_at(self.0);
        let (coils, capacitors) = rates.split_at_mut(self.0);
        let mut before = 1.0;
        for k in 0..self.0 {
            coils[k] = before - voltages[k];
            capacitors[k] = currents[k] - currents.get(k + 1).copied().unwrap_or(voltages[k]);
            before = voltages[k];
        }
    }
}
