use crate::measure::{Measured, Time, alternate, repeat};
use sophy_field::StateIndex;
use sophy_ir::{Model, System};
use sophy_passes::lower;
use sophy_run::{Backend, Experiment, Method, Pause, Quantum, QuantumRule, Run};
use std::sync::Arc;

/// A system to be run by several rivals. What is measured is the run alone: it is started, native code included, before,
/// and records nothing.
pub struct Case {
    pub bench: &'static str,
    system: Arc<System>,
    method: Method,
    quantum: Quantum,
    /// Simulated time, s.
    pub stop: f64,
}

impl Case {
    pub fn new(bench: &'static str, model: &Model, method: Method, quantum: f64, stop: f64) -> Self {
        let quantum = Quantum::absolute(quantum);
        Case { bench, system: Arc::new(lower(model).expect("it is sound")), method, quantum, stop }
    }

    /// The same by another engine.
    pub fn by(&self, method: Method) -> Self {
        Case { system: Arc::clone(&self.system), method, ..*self }
    }

    /// The same with another quantum, to another time.
    pub fn with(&self, quantum: f64, stop: f64) -> Self {
        Case { system: Arc::clone(&self.system), quantum: Quantum::absolute(quantum), stop, ..*self }
    }

    /// The same with quanta that are this part of |x|, too.
    pub fn relative(self, relative: f64) -> Self {
        Case { quantum: Quantum { relative, ..self.quantum }, ..self }
    }

    /// A run that is started.
    pub fn begin(&self, backend: Backend) -> Run {
        let experiment = Experiment {
            stop: self.stop,
            method: self.method,
            backend,
            quanta: vec![QuantumRule { pattern: "*".to_owned(), quantum: self.quantum }],
            ..Experiment::default()
        };
        let mut run = Run::new(Arc::clone(&self.system), &experiment).expect("it starts");
        run.journal.stop();
        assert_eq!(run.is_native(), backend == Backend::Native);
        run
    }

    fn go(&self, run: &mut Run) {
        assert_eq!(run.advance(self.stop, u64::MAX).expect("it goes on"), Pause::Reached);
    }

    /// The rows of a hand-written loop, interpreted and native; what the loop gave, and the native run. `error` says what
    /// the loop's error is of and how large it is.
    pub fn against<F>(
        &self,
        repetitions: usize,
        mut floor: impl FnMut() -> F,
        error: impl Fn(&F) -> (&'static str, f64),
    ) -> (Vec<Measured>, F, Run) {
        let mut rival =
            |backend| alternate(repetitions, &mut floor, || self.begin(backend), |run| self.go(run));
        let (interpreted, _, _) = rival(Backend::Interpreter);
        let (native, given, run) = rival(Backend::Native);
        let error = error(&given);
        let row = |by, time, ratio| self.row(by, time, &run, error, Some(ratio));
        let rows = vec![
            row("floor", native.first, 1.0),
            row("interpreter", interpreted.second, interpreted.ratio),
            row("native", native.second, native.ratio),
        ];
        (rows, given, run)
    }

    /// Native, alone.
    pub fn alone(&self, repetitions: usize, error: impl Fn(&Run) -> (&'static str, f64)) -> Measured {
        let (time, run) = repeat(repetitions, || self.begin(Backend::Native), |run| self.go(run));
        self.row("native", time, &run, error(&run), None)
    }

    fn row(
        &self,
        by: &'static str,
        time: Time,
        run: &Run,
        (error_of, error): (&'static str, f64),
        ratio: Option<f64>,
    ) -> Measured {
        Measured {
            bench: self.bench,
            method: self.method.name().to_owned(),
            by: by.to_owned(),
            setting: self.quantum.absolute,
            time,
            simulated: self.stop,
            steps: run.statistics().engine.steps,
            transitions: (!run.taken.is_empty()).then_some(run.taken.len()),
            error_of,
            error,
            wanted: None,
            to_floor: ratio,
            to_ours: None,
        }
    }
}

/// Of any state at the end.
pub fn largest_error(run: &Run, expected: &[f64]) -> f64 {
    let error = |(i, x): (usize, &f64)| (run.state(StateIndex::new(i)) - x).abs();
    expected.iter().enumerate().map(error).fold(0.0, f64::max)
}

/// Bits of the first states at the end.
pub fn bits(run: &Run, states: usize) -> Vec<u64> {
    (0..states).map(|i| run.state(StateIndex::new(i)).to_bits()).collect()
}

/// Bits of numbers.
pub fn bits_of(numbers: &[f64]) -> Vec<u64> {
    numbers.iter().map(|x| x.to_bits()).collect()
}
