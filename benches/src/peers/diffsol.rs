//! The crate `diffsol`: Tsitouras' explicit method, an implicit Runge–Kutta method and BDF, with roots and resets.

use super::{Outcome, Solver, clocked};
use crate::problem::Problem;
use ::diffsol::error::DiffsolError;
use ::diffsol::{
    NalgebraContext, NalgebraLU, NalgebraMat, NalgebraVec, OdeBuilder, OdeEquations, OdeEquationsImplicit,
    OdeSolverMethod, OdeSolverProblem, OdeSolverStopReason, Vector,
};
use std::cell::Cell;

struct Peer {
    method: &'static str,
}

pub fn all() -> Vec<Box<dyn Solver>> {
    let methods = ["tsit45", "esdirk34", "bdf"];
    methods.into_iter().map(|method| Box::new(Peer { method }) as Box<dyn Solver>).collect()
}

impl Solver for Peer {
    fn by(&self) -> String {
        "diffsol".to_owned()
    }

    fn method(&self) -> &str {
        self.method
    }

    fn can(&self, problem: Problem) -> bool {
        // Dense matrices of a thousand rows would be no fair use of the implicit methods.
        problem != Problem::Front || self.method == "tsit45"
    }

    fn solve(&mut self, problem: Problem, stop: f64, setting: f64) -> Result<Outcome, String> {
        match problem {
            Problem::Hopper => hopper(self.method, stop, setting),
            _ => smooth(problem, self.method, stop, setting),
        }
        .map_err(|error| error.to_string())
    }
}

fn smooth(problem: Problem, method: &str, stop: f64, tolerance: f64) -> Result<Outcome, DiffsolError> {
    let start = problem.start();
    let states = start.len();
    let built = OdeBuilder::<NalgebraMat<f64>>::new()
        .rtol(tolerance)
        .atol([tolerance])
        .rhs_implicit(
            |x: &[f64], _: &[f64], _: f64, rates: &mut [f64]| problem.rates(x, rates),
            |x: &[f64], _: &[f64], _: f64, v: &[f64], along: &mut [f64]| problem.rates_along(x, v, along),
        )
        .init(|_: &[f64], _: f64, x: &mut [f64]| x.copy_from_slice(&start), states)
        .build()?;
    driven(&built, method, &problem.instants(), stop)
}

/// The hopper by one root that depends on the location.
fn hopper(method: &str, stop: f64, tolerance: f64) -> Result<Outcome, DiffsolError> {
    let location = Cell::new(0);
    let start = Problem::Hopper.start();
    let built = OdeBuilder::<NalgebraMat<f64>>::new()
        .rtol(tolerance)
        .atol([tolerance])
        .rhs_implicit(
            |x: &[f64], _: &[f64], _: f64, rates: &mut [f64]| hopper_rates(location.get(), x, rates),
            |x: &[f64], _: &[f64], _: f64, v: &[f64], along: &mut [f64]| {
                hopper_along(location.get(), x, v, along);
            },
        )
        .init(|_: &[f64], _: f64, x: &mut [f64]| x.copy_from_slice(&start), start.len())
        .root(|x: &[f64], _: &[f64], _: f64, root: &mut [f64]| root[0] = hopper_root(location.get(), x), 1)
        .reset(|x: &[f64], _: &[f64], _: f64, after: &mut [f64]| {
            after.copy_from_slice(x);
            match location.get() {
                1 => after[2] = 0.0,
                2 => after[3] = 40.0 * x[0],
                _ => {}
            }
            location.set((location.get() + 1) % 4);
        })
        .build()?;
    driven(&built, method, &[], stop)
}

fn hopper_rates(location: usize, x: &[f64], rates: &mut [f64]) {
    let (y, v) = (x[0], x[1]);
    rates[0] = v;
    rates[1] = match location {
        0 => 0.0,
        1 => 8.0 / y - 0.2 * v,
        2 => 40.0 - 0.2 * v,
        _ => x[3] / y - 0.2 * v,
    } - 9.82;
    rates[2] = if location == 2 { 1.0 } else { 0.0 };
    rates[3] = 0.0;
}

fn hopper_along(location: usize, x: &[f64], v: &[f64], along: &mut [f64]) {
    let spring = if location == 1 { 8.0 } else { x[3] };
    let bend = -spring / (x[0] * x[0]) * v[0];
    along[0] = v[1];
    along[1] = match location {
        0 => 0.0,
        1 => bend - 0.2 * v[1],
        2 => -0.2 * v[1],
        _ => v[3] / x[0] + bend - 0.2 * v[1],
    };
    along[2] = 0.0;
    along[3] = 0.0;
}

/// Changes its sign where the location is left.
fn hopper_root(location: usize, x: &[f64]) -> f64 {
    match location {
        // While it rises the foot has just left the ground, and y − l may be a rounding below 0.
        0 => f64::max(x[1], x[0] - 0.5),
        1 => x[1],
        2 => f64::max(x[2] - 0.1, x[0] - 0.5),
        _ => x[0] - 0.5,
    }
}

/// Makes the solver of a method and drives it.
fn driven<E>(
    built: &OdeSolverProblem<E>,
    method: &str,
    instants: &[f64],
    stop: f64,
) -> Result<Outcome, DiffsolError>
where
    E: OdeEquationsImplicit<T = f64, M = NalgebraMat<f64>, V = NalgebraVec<f64>, C = NalgebraContext>,
{
    match method {
        "tsit45" => drive(built.tsit45()?, instants, stop),
        "esdirk34" => drive(built.esdirk34::<NalgebraLU<f64>>()?, instants, stop),
        _ => drive(built.bdf::<NalgebraLU<f64>>()?, instants, stop),
    }
}

fn drive<'a, E, S>(mut solver: S, instants: &[f64], stop: f64) -> Result<Outcome, DiffsolError>
where
    E: OdeEquations<T = f64> + 'a,
    S: OdeSolverMethod<'a, E>,
{
    let mut found = Outcome::default();
    let (done, time) = clocked(|| -> Result<(), DiffsolError> {
        solver.set_stop_time(stop)?;
        loop {
            let reason = solver.step()?;
            let reached = match reason {
                OdeSolverStopReason::RootFound(time, _) => time,
                _ => solver.state().t,
            };
            while let Some(&instant) = instants.get(found.states.len()).filter(|&&instant| instant <= reached)
            {
                found.states.push(solver.interpolate(instant)?.clone_as_vec());
            }
            match reason {
                OdeSolverStopReason::InternalTimestep => {}
                OdeSolverStopReason::TstopReached => return Ok(()),
                OdeSolverStopReason::RootFound(time, _) => {
                    found.transitions.push(time);
                    solver.state_mut_back(time)?;
                    solver.apply_reset()?;
                    if time >= stop {
                        return Ok(());
                    }
                    solver.set_stop_time(stop)?;
                }
            }
        }
    });
    done?;
    let steps = solver.get_statistics().number_of_steps as u64;
    Ok(Outcome { steps, time, ..found })
}
