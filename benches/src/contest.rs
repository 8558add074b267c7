//! `peers`: everybody solves the same problems to the same errors.
//!
//! The settings of different methods cannot be compared, errors can. So everyone takes the largest quantum or tolerance,
//! in half decades, at which no error is larger than wanted, and then all run in turn.

use crate::measure::{Measured, Time, medians};
use crate::peers::{Outcome, Solver, everybody};
use crate::problem::{Problem, Truth};
use std::time::Instant;

/// Errors wanted.
const WANTED: [f64; 2] = [1e-3, 1e-6];
const ROUNDS: usize = 7;
/// Who took as long as this for one problem is not asked again, s.
const ENOUGH: f64 = 3.0;
/// Smaller settings are not tried by who takes as long as this, s.
const TOO_LONG: f64 = 8.0;

/// Somebody with the setting that is exact enough.
struct Entrant<'a> {
    solver: &'a mut Box<dyn Solver>,
    setting: f64,
    error: f64,
    times: Vec<Time>,
    last: Option<Outcome>,
}

/// All problems, or one; the quickest first.
pub fn bench(only: Option<&str>) -> Vec<Measured> {
    let mut everybody = everybody();
    let mut rows = Vec::new();
    for problem in Problem::ALL.into_iter().filter(|problem| only.is_none_or(|only| problem.name() == only)) {
        let truth = problem.truth();
        let ladders: Vec<_> =
            everybody.iter_mut().map(|solver| ladder(solver.as_mut(), problem, &truth)).collect();
        for wanted in WANTED {
            let mut entrants = Vec::new();
            for (solver, ladder) in everybody.iter_mut().zip(&ladders) {
                match ladder.iter().find(|(_, error)| *error <= wanted) {
                    Some(&(setting, error)) => {
                        entrants.push(Entrant { solver, setting, error, times: Vec::new(), last: None });
                    }
                    None if solver.can(problem) => {
                        let (by, method) = (solver.by(), solver.method());
                        eprintln!(
                            "left out: {by} {method}, {} to {wanted:.0e} (not reached)",
                            problem.name()
                        );
                    }
                    None => {}
                }
            }
            rows.extend(race(problem, wanted, entrants));
        }
    }
    rows
}

/// Settings with their errors, from the coarsest to one that is exact enough for all.
fn ladder(solver: &mut dyn Solver, problem: Problem, truth: &Truth) -> Vec<(f64, f64)> {
    let mut errors = Vec::new();
    if !solver.can(problem) {
        return errors;
    }
    for half_decades in 2..=26 {
        let setting = libm::pow(10.0, -0.5 * f64::from(half_decades));
        let begin = Instant::now();
        let spent = match solver.solve(problem, problem.judged(), setting) {
            Ok(found) => {
                errors.push((setting, truth.error(&found.states, &found.transitions)));
                1e-3 * found.time.cpu_ms
            }
            Err(_) => begin.elapsed().as_secs_f64(),
        };
        let exact = errors.last().is_some_and(|(_, error)| *error <= WANTED[1]);
        if exact || spent > TOO_LONG {
            break;
        }
    }
    errors
}

/// All in turn, round by round, so that what disturbs the machine disturbs everybody.
fn race(problem: Problem, wanted: f64, mut entrants: Vec<Entrant<'_>>) -> Vec<Measured> {
    for _ in 0..ROUNDS {
        for entrant in &mut entrants {
            let spent: f64 = entrant.times.iter().map(|time| 1e-3 * time.wall_ms).sum();
            if spent > ENOUGH {
                continue;
            }
            if let Ok(found) = entrant.solver.solve(problem, problem.stop(), entrant.setting) {
                entrant.times.push(found.time);
                entrant.last = Some(found);
            }
        }
    }
    let mut rows: Vec<Measured> =
        entrants.iter().filter_map(|entrant| row(problem, wanted, entrant)).collect();
    let ours =
        rows.iter().filter(|row| row.by == "Sophy").map(|row| row.time.cpu_ms).fold(f64::INFINITY, f64::min);
    for row in &mut rows {
        row.to_ours = Some(row.time.cpu_ms / ours).filter(|ratio| ratio.is_finite() && *ratio > 0.0);
    }
    rows.sort_by(|a, b| a.time.cpu_ms.total_cmp(&b.time.cpu_ms));
    rows
}

fn row(problem: Problem, wanted: f64, entrant: &Entrant<'_>) -> Option<Measured> {
    let found = entrant.last.as_ref()?;
    Some(Measured {
        bench: problem.name(),
        method: entrant.solver.method().to_owned(),
        by: entrant.solver.by(),
        setting: entrant.setting,
        time: medians(&entrant.times),
        simulated: problem.stop(),
        steps: found.steps,
        transitions: problem.transitions().map(|_| found.transitions.len()),
        error_of: problem.error_of(),
        error: entrant.error,
        wanted: Some(wanted),
        to_floor: None,
        to_ours: None,
    })
}
