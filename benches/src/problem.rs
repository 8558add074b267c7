//! Problems with known solutions that Sophy and its peers solve side by side.

use sophy_ir::Model;
use sophy_testkit::Reference;
use sophy_testkit::problems::{Hopper, circle};
use sophy_testkit::stiff::{AdvectionReaction, Smooth, stiff_pair, stiff_pair_at};

/// Which problem.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Problem {
    /// x′ = v, v′ = −x from (1, 0): nothing damps an error away.
    Oscillator,
    /// x₁′ = x₂/100, x₂′ = −100 x₁ − 100 x₂ + 2020 from (0, 20).
    StiffPair,
    /// Raibert's hopper: four locations, 3460 transitions in 1000 s.
    Hopper,
    /// u′ᵢ = 1000(uᵢ₋₁ − uᵢ) − 1000 uᵢ(uᵢ − ½)(uᵢ − 1) in 1000 cells.
    Front,
}

/// What is right: states at some times, or times of transitions.
#[derive(Clone, Debug, Default)]
pub struct Truth {
    /// The states at each of [`Problem::instants`].
    pub states: Vec<Vec<f64>>,
    /// Times of the first transitions, s.
    pub transitions: Vec<f64>,
}

/// Cells of the front.
pub const FRONT: AdvectionReaction = AdvectionReaction(1000);

impl Problem {
    pub const ALL: [Problem; 4] = [Problem::Oscillator, Problem::StiffPair, Problem::Hopper, Problem::Front];

    pub fn name(self) -> &'static str {
        match self {
            Problem::Oscillator => "oscillator",
            Problem::StiffPair => "stiff pair",
            Problem::Hopper => "hopper",
            Problem::Front => "front",
        }
    }

    pub fn model(self) -> Model {
        match self {
            Problem::Oscillator => circle(),
            Problem::StiffPair => stiff_pair(),
            Problem::Hopper => Hopper::TAU40.model(),
            Problem::Front => FRONT.model(),
        }
    }

    /// Simulated time, s.
    pub fn stop(self) -> f64 {
        match self {
            Problem::Oscillator => 200.0,
            Problem::StiffPair => 500.0,
            Problem::Hopper => 1000.0,
            Problem::Front => 1.0,
        }
    }

    /// The simulated time that is enough to know the error, s: references of the hopper reach to 20 s.
    pub fn judged(self) -> f64 {
        if self == Problem::Hopper { 20.0 } else { self.stop() }
    }

    /// When the states are asked for; a hopper is judged by its transitions.
    pub fn instants(self) -> Vec<f64> {
        let count: u32 = match self {
            Problem::Oscillator | Problem::StiffPair => 20,
            Problem::Hopper => 0,
            Problem::Front => 5,
        };
        (1..=count).map(|i| self.stop() * f64::from(i) / f64::from(count)).collect()
    }

    /// Transitions there are until the stop.
    pub fn transitions(self) -> Option<usize> {
        (self == Problem::Hopper).then_some(3460)
    }

    pub fn error_of(self) -> &'static str {
        match self {
            Problem::Hopper => "any of the first 68 transitions, s",
            _ => "any state at any instant asked for",
        }
    }

    pub fn truth(self) -> Truth {
        let states = |at: &dyn Fn(f64) -> Vec<f64>| Truth {
            states: self.instants().into_iter().map(at).collect(),
            transitions: Vec::new(),
        };
        match self {
            Problem::Oscillator => states(&|t| vec![libm::cos(t), -libm::sin(t)]),
            Problem::StiffPair => states(&|t| stiff_pair_at(t).to_vec()),
            Problem::Hopper => {
                let transitions = Reference::read("hopper/tau40_events.csv").numbers("t");
                Truth { states: Vec::new(), transitions }
            }
            // Halving the step changes nothing above 1e-8.
            Problem::Front => states(&|t| FRONT.runge_kutta(t, 2e-5)),
        }
    }

    /// States at 0 s.
    pub fn start(self) -> Vec<f64> {
        match self {
            Problem::Oscillator => vec![1.0, 0.0],
            Problem::StiffPair => vec![0.0, 20.0],
            Problem::Hopper => vec![1.9, 0.1, 0.0, 0.0],
            Problem::Front => FRONT.start(),
        }
    }

    /// The rates of a problem without locations.
    pub fn rates(self, x: &[f64], rates: &mut [f64]) {
        match self {
            Problem::Oscillator => (rates[0], rates[1]) = (x[1], -x[0]),
            Problem::StiffPair => {
                (rates[0], rates[1]) = (0.01 * x[1], 2020.0 - 100.0 * (x[0] + x[1]));
            }
            Problem::Hopper => unreachable!("its rates depend on the location"),
            Problem::Front => FRONT.rates(x, rates),
        }
    }

    /// Their derivative along `v`.
    pub fn rates_along(self, x: &[f64], v: &[f64], along: &mut [f64]) {
        match self {
            Problem::Oscillator => (along[0], along[1]) = (v[1], -v[0]),
            Problem::StiffPair => (along[0], along[1]) = (0.01 * v[1], -100.0 * (v[0] + v[1])),
            Problem::Hopper => unreachable!("its rates depend on the location"),
            Problem::Front => {
                let mut before = 0.0;
                for ((along, &u), &v) in along.iter_mut().zip(x).zip(v) {
                    *along = 1000.0 * (before - v) - 1000.0 * (3.0 * u * (u - 1.0) + 0.5) * v;
                    before = v;
                }
            }
        }
    }
}

impl Truth {
    /// The largest error; infinite where something is missing or no number.
    pub fn error(&self, states: &[Vec<f64>], transitions: &[f64]) -> f64 {
        if states.len() < self.states.len() || transitions.len() < self.transitions.len() {
            return f64::INFINITY;
        }
        let expected = self.states.iter().flatten().chain(&self.transitions);
        let found = states[..self.states.len()].iter().flatten().chain(transitions);
        let errors = expected.zip(found).map(|(expected, found)| (expected - found).abs());
        errors.fold(0.0, |most, error| {
            if error <= most {
                most
            } else if error.is_nan() {
                f64::INFINITY
            } else {
                error
            }
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_missing_or_no_number_is_no_small_error() {
        let truth = Truth { states: vec![vec![1.0, 2.0]], transitions: vec![0.5] };
        assert_eq!(truth.error(&[vec![1.0, 2.25]], &[0.5, 0.75]), 0.25);
        for (states, transitions) in
            [(vec![], vec![0.5]), (vec![vec![1.0, 2.0]], vec![]), (vec![vec![f64::NAN, 2.0]], vec![0.5])]
        {
            assert_eq!(truth.error(&states, &transitions), f64::INFINITY);
        }
    }

    #[test]
    fn rates_along_a_direction_are_their_derivative() {
        for problem in [Problem::Oscillator, Problem::StiffPair, Problem::Front] {
            let x: Vec<f64> = problem.start().iter().map(|x| x + 0.25).collect();
            let v: Vec<f64> = (0..x.len()).map(|i| 0.5 - (i % 3) as f64).collect();
            let rates_at = |h: f64| {
                let at: Vec<f64> = x.iter().zip(&v).map(|(x, v)| x + h * v).collect();
                let mut rates = vec![0.0; x.len()];
                problem.rates(&at, &mut rates);
                rates
            };
            let mut along = vec![0.0; x.len()];
            problem.rates_along(&x, &v, &mut along);
            for ((after, before), along) in rates_at(1e-5).iter().zip(rates_at(-1e-5)).zip(along) {
                assert!(((after - before) / 2e-5 - along).abs() < 1e-4, "{}", problem.name());
            }
        }
    }
}
