//! `precision`: what an error costs, engine by engine.

use crate::measure::medians;
use crate::peers::{Ours, Work};
use crate::problem::Problem;
use sophy_run::Method;

/// One run.
#[derive(Clone, Debug)]
pub struct Point {
    pub problem: Problem,
    pub method: Method,
    pub quantum: f64,
    /// As [`Problem::error_of`] says.
    pub error: f64,
    pub steps: u64,
    /// CPU time, ms.
    pub cpu_ms: f64,
}

pub const PROBLEMS: [Problem; 3] = [Problem::Oscillator, Problem::StiffPair, Problem::Hopper];
pub const METHODS: [Method; 6] =
    [Method::Qss1, Method::Qss2, Method::Qss3, Method::Liqss1, Method::Liqss2, Method::Liqss3];

/// First-order engines need ten times the steps for a tenth of the error; who needs more than so many is told to stop.
const MOST: Work = Work { steps: 3_000_000 };

/// Quanta from 1e-1 to 1e-7, but for those that take too long or are too coarse for the model.
pub fn bench() -> Vec<Point> {
    let mut points = Vec::new();
    for problem in PROBLEMS {
        let truth = problem.truth();
        for method in METHODS {
            let mut ours = Ours::new(method);
            for decade in 1..=7 {
                let quantum = libm::pow(10.0, -f64::from(decade));
                let mut solve = || ours.solve_within(problem, problem.judged(), quantum, MOST);
                let found = match solve() {
                    Ok(found) => found,
                    Err(why) => {
                        eprintln!(
                            "left out: {}, {} with {quantum:.0e} ({why})",
                            method.name(),
                            problem.name()
                        );
                        continue;
                    }
                };
                let repetitions = if found.time.wall_ms < 50.0 { 5 } else { 1 };
                let times: Vec<_> =
                    (0..repetitions).filter_map(|_| solve().ok()).map(|found| found.time).collect();
                points.push(Point {
                    problem,
                    method,
                    quantum,
                    error: truth.error(&found.states, &found.transitions),
                    steps: found.steps,
                    cpu_ms: medians(&times).cpu_ms,
                });
            }
        }
    }
    points
}
