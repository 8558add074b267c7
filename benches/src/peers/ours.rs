use super::{Outcome, PATIENCE, Solver, clocked};
use crate::case::Case;
use crate::problem::Problem;
use sophy_field::StateIndex;
use sophy_run::{Backend, Method, Pause, Run};

/// Our engines, native.
pub struct Ours {
    method: Method,
    /// The problem solved last: it is lowered once.
    case: Option<(Problem, Case)>,
}

/// How much may be done at most.
#[derive(Clone, Copy, Debug)]
pub struct Work {
    /// Steps.
    pub steps: u64,
}

impl Ours {
    pub fn new(method: Method) -> Self {
        Ours { method, case: None }
    }

    /// The engines that may reach small errors.
    pub fn engines() -> Vec<Box<dyn Solver>> {
        let methods = [Method::Qss2, Method::Qss3, Method::Liqss2, Method::Liqss3];
        methods.into_iter().map(|method| Box::new(Ours::new(method)) as Box<dyn Solver>).collect()
    }

    /// As [`Solver::solve`], with at most so much work.
    pub fn solve_within(
        &mut self,
        problem: Problem,
        stop: f64,
        quantum: f64,
        work: Work,
    ) -> Result<Outcome, String> {
        if self.case.as_ref().is_none_or(|(known, _)| *known != problem) {
            self.case =
                Some((problem, Case::new(problem.name(), &problem.model(), self.method, quantum, stop)));
        }
        let Some((_, case)) = &self.case else { return Err("no case".to_owned()) };
        let mut run = case.with(quantum, stop).begin(Backend::Native);
        let instants = problem.instants();
        let (states, time) = clocked(|| go(&mut run, &instants, stop, work));
        let transitions = run.taken.iter().map(|taken| taken.time).collect();
        Ok(Outcome { states: states?, transitions, steps: run.statistics().engine.steps, time })
    }
}

fn go(run: &mut Run, instants: &[f64], stop: f64, work: Work) -> Result<Vec<Vec<f64>>, String> {
    let mut states = Vec::with_capacity(instants.len());
    let count = run.system().states.len();
    let last = [stop];
    for &instant in if instants.is_empty() { &last } else { instants } {
        let left = work.steps.saturating_sub(run.statistics().engine.steps);
        match run.advance(instant, left) {
            Ok(Pause::Reached) => {}
            Ok(Pause::Budget) => return Err(format!("more than {} steps", work.steps)),
            Ok(Pause::Zeno(_)) => return Err("transitions accumulate".to_owned()),
            Err(failure) => return Err(failure.to_string()),
        }
        states.push((0..count).map(|i| run.state(StateIndex::new(i))).collect());
    }
    Ok(states)
}

impl Solver for Ours {
    fn by(&self) -> String {
        "Sophy".to_owned()
    }

    fn method(&self) -> &str {
        self.method.name()
    }

    fn can(&self, _: Problem) -> bool {
        true
    }

    fn solve(&mut self, problem: Problem, stop: f64, setting: f64) -> Result<Outcome, String> {
        // A step takes at least 50 ns.
        let work = Work { steps: (PATIENCE / 50e-9) as u64 };
        self.solve_within(problem, stop, setting, work)
    }
}
