use std::time::Instant;

/// One row of the table.
#[derive(Clone, Debug)]
pub struct Measured {
    /// Which problem.
    pub bench: &'static str,
    /// Who solved it.
    pub by: &'static str,
    /// Median of wall times, ms.
    pub wall_ms: f64,
    /// Simulated time, s.
    pub simulated: f64,
    /// Changes of quantised states.
    pub steps: u64,
    /// Transitions taken.
    pub transitions: Option<usize>,
    /// What the error is of.
    pub error_of: &'static str,
    /// Its absolute value.
    pub error: f64,
    /// Median of the ratios to the floor run just before, 1 for the floor.
    pub ratio: f64,
}

/// Wall times of two rivals that ran in turn.
pub struct Times {
    /// Median of the first, ms.
    pub first: f64,
    /// Median of the second, ms.
    pub second: f64,
    /// Median of second / first, pair by pair.
    pub ratio: f64,
}

/// Runs two rivals in turn, `repetitions` times each after one that does not count, and gives their times with
/// their last results.
pub fn alternate<A, B>(
    repetitions: usize,
    mut first: impl FnMut() -> A,
    mut second: impl FnMut() -> B,
) -> (Times, A, B) {
    let (mut a, mut b) = (first(), second());
    let mut pairs = Vec::with_capacity(repetitions);
    for _ in 0..repetitions {
        let begin = Instant::now();
        a = first();
        let between = Instant::now();
        b = second();
        pairs.push(((between - begin).as_secs_f64(), between.elapsed().as_secs_f64()));
    }
    let times = Times {
        first: 1e3 * median(pairs.iter().map(|p| p.0)),
        second: 1e3 * median(pairs.iter().map(|p| p.1)),
        ratio: median(pairs.iter().map(|p| p.1 / p.0)),
    };
    (times, a, b)
}

fn median(values: impl Iterator<Item = f64>) -> f64 {
    let mut values: Vec<f64> = values.collect();
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}
