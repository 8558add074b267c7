//! The crate `ode_solvers`: Dormand and Prince of order 5 and 8, without location of events.

use super::{Outcome, Solver, clocked};
use crate::problem::Problem;
use ode_solvers::{DVector, Dop853, Dopri5, OutputType, System, Vector2};

struct Peer {
    method: &'static str,
}

pub fn all() -> Vec<Box<dyn Solver>> {
    ["Dopri5", "Dop853"].into_iter().map(|method| Box::new(Peer { method }) as Box<dyn Solver>).collect()
}

struct Rates(Problem);

impl System<f64, DVector<f64>> for Rates {
    fn system(&self, _: f64, x: &DVector<f64>, rates: &mut DVector<f64>) {
        self.0.rates(x.as_slice(), rates.as_mut_slice());
    }
}

impl System<f64, Vector2<f64>> for Rates {
    fn system(&self, _: f64, x: &Vector2<f64>, rates: &mut Vector2<f64>) {
        self.0.rates(x.as_slice(), rates.as_mut_slice());
    }
}

/// Steps at most; the default of 100 000 is little for a stiff problem.
const STEPS: u32 = 3_000_000;

impl Solver for Peer {
    fn by(&self) -> String {
        "ode_solvers".to_owned()
    }

    fn method(&self) -> &str {
        self.method
    }

    fn can(&self, problem: Problem) -> bool {
        problem != Problem::Hopper
    }

    fn solve(&mut self, problem: Problem, stop: f64, setting: f64) -> Result<Outcome, String> {
        let start = problem.start();
        let every = problem.instants()[0];
        // Where rows are farther apart than steps, a row at the very end is extrapolated from the step before the last (0.6.2):
        // so the end lies a little beyond it.
        let end = stop * (1.0 + 1e-7);
        // What its `new` chooses, but for the number of steps: the largest step is the whole time, the first its own choice.
        macro_rules! integrate {
            ($solver:ident, $start:expr, $beta:expr, $largest:expr, $smallest:expr) => {{
                let mut solver = $solver::from_param(
                    Rates(problem),
                    0.0,
                    end,
                    every,
                    $start,
                    setting,
                    setting,
                    0.9,
                    $beta,
                    $smallest,
                    $largest,
                    stop,
                    0.0,
                    STEPS,
                    u32::MAX,
                    OutputType::Dense,
                );
                let (done, time) = clocked(|| solver.integrate());
                let stats = done.map_err(|error| error.to_string())?;
                // The first row is the start.
                let states = solver.y_out().iter().skip(1).map(|x| x.as_slice().to_vec()).collect();
                Ok(Outcome { states, transitions: Vec::new(), steps: u64::from(stats.accepted_steps), time })
            }};
        }
        // Short vectors are quicker on the stack.
        match (self.method, start.len()) {
            ("Dopri5", 2) => integrate!(Dopri5, Vector2::from_column_slice(&start), 0.04, 10.0, 0.2),
            ("Dopri5", _) => integrate!(Dopri5, DVector::from_vec(start), 0.04, 10.0, 0.2),
            (_, 2) => integrate!(Dop853, Vector2::from_column_slice(&start), 0.0, 6.0, 0.333),
            _ => integrate!(Dop853, DVector::from_vec(start), 0.0, 6.0, 0.333),
        }
    }
}
