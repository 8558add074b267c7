/// The quantum of a state: ΔQ = max(absolute, relative·|x|), taken anew at each change of q.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Quantum {
    /// In the state's unit; positive. Smaller is more accurate; QSS2 needs 1/√ΔQ, QSS1 1/ΔQ steps.
    pub absolute: f64,
    /// Fraction of |x|; 0 for a fixed quantum.
    pub relative: f64,
    /// Whether |x| is the largest one at a change of q so far, instead of the present one.
    pub largest: bool,
}

/// Quanta are so much smaller than a tolerance: what an error is in quanta depends on the model, up to 50
/// in the examples (docs/book/accuracy.md).
const MARGIN: f64 = 0.1;

/// What is no larger than this, in the state's unit, counts as 0: a state that starts at 0 has no size of its own yet.
const SMALLEST: f64 = 1e-9;

impl Quantum {
    /// A fixed quantum.
    pub fn absolute(absolute: f64) -> Self {
        Quantum { absolute, relative: 0.0, largest: false }
    }

    /// For a global error of the size of `tolerance`, as a fraction of the largest |x|: a tenth of it, of the
    /// largest |x| so far. The present |x| would ask an oscillation for an accuracy where it passes 0 that its tops
    /// have spoiled already.
    pub fn from_tolerance(tolerance: f64) -> Self {
        let relative = MARGIN * tolerance;
        Quantum { absolute: SMALLEST * relative, relative, largest: true }
    }

    /// ΔQ at x.
    #[inline]
    pub fn at(self, x: f64) -> f64 {
        let relative = self.relative * x.abs();
        if relative > self.absolute { relative } else { self.absolute }
    }
}

/// How a quantised engine works.
#[derive(Clone, Debug, PartialEq)]
pub struct Settings {
    /// One quantum per state.
    pub quanta: Vec<Quantum>,
    /// The longest time, s, for which a rate that bends is trusted without being evaluated again; a guard
    /// against a bend that vanishes at one instant. A hundredth of the run is usual. It does not hold while nothing
    /// that the rate reads moves by a quantum.
    pub trust: f64,
    /// The longest time, s, over which a non-linear guard is searched ahead at once. Any value finds the same
    /// crossings; a sixteenth of the run is usual.
    pub window: f64,
    /// The most boxes that one search may bisect before it says that it cannot decide.
    pub search_budget: u32,
}

impl Settings {
    /// Usual settings for a run of `span` s; a run of no length counts as one of 1 s.
    pub fn for_span(quanta: Vec<Quantum>, span: f64) -> Self {
        let span = if span > 0.0 { span } else { 1.0 };
        Settings { quanta, trust: span / 100.0, window: span / 16.0, search_budget: 20_000 }
    }
}
