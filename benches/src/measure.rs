use cpu_time::ThreadTime;
use std::time::Instant;

/// One row of the table.
#[derive(Clone, Debug)]
pub struct Measured {
    /// Which problem.
    pub bench: &'static str,
    /// By which engine.
    pub method: String,
    /// Who solved it.
    pub by: String,
    /// Quantum or tolerance.
    pub setting: f64,
    /// What it took.
    pub time: Time,
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
    /// The largest error that was allowed, where `setting` was chosen by it.
    pub wanted: Option<f64>,
    /// Median of the ratios of its CPU time to that of the floor run just before; 1 for the floor, none without one.
    pub to_floor: Option<f64>,
    /// CPU time over that of our quickest engine that is as exact.
    pub to_ours: Option<f64>,
}

/// Medians.
#[derive(Clone, Copy, Debug, Default)]
pub struct Time {
    /// By the clock on the wall, ms.
    pub wall_ms: f64,
    /// Of the processor, ms: what others do at the same time disturbs it less.
    pub cpu_ms: f64,
}

/// Times of two rivals that ran in turn.
pub struct Times {
    /// Of the first.
    pub first: Time,
    /// Of the second.
    pub second: Time,
    /// Median of second / first in CPU time, pair by pair.
    pub ratio: f64,
}

/// Runs two rivals in turn, the second on what `begin` makes, `repetitions` times each, and gives their times with
/// their last results. The first pair does not count.
pub fn alternate<A, S>(
    repetitions: usize,
    mut first: impl FnMut() -> A,
    begin: impl Fn() -> S,
    second: impl Fn(&mut S),
) -> (Times, A, S) {
    let (mut a, mut b) = (first(), begin());
    second(&mut b);
    let (mut first_times, mut second_times) = (Vec::new(), Vec::new());
    for _ in 0..repetitions {
        b = begin();
        let (result, time) = timed(&mut first);
        a = result;
        first_times.push(time);
        second_times.push(timed(&mut || second(&mut b)).1);
    }
    let ratios = first_times.iter().zip(&second_times).map(|(first, second)| second.cpu_ms / first.cpu_ms);
    let times = Times { ratio: median(ratios), first: medians(&first_times), second: medians(&second_times) };
    (times, a, b)
}

/// Times `work` on what `begin` makes, and gives the median with the last result.
pub fn repeat<S>(repetitions: usize, begin: impl Fn() -> S, work: impl Fn(&mut S)) -> (Time, S) {
    let mut state = begin();
    let mut times = Vec::new();
    for _ in 0..repetitions {
        state = begin();
        times.push(timed(&mut || work(&mut state)).1);
    }
    (medians(&times), state)
}

/// The result of `run`, and what it took.
pub fn timed<R>(run: &mut impl FnMut() -> R) -> (R, Time) {
    let (wall, cpu) = (Instant::now(), ThreadTime::now());
    let result = run();
    let (wall, cpu) = (wall.elapsed(), cpu.elapsed());
    (result, Time { wall_ms: 1e3 * wall.as_secs_f64(), cpu_ms: 1e3 * cpu.as_secs_f64() })
}

/// Of the wall and of CPU times, each by itself.
pub fn medians(times: &[Time]) -> Time {
    Time {
        wall_ms: median(times.iter().map(|time| time.wall_ms)),
        cpu_ms: median(times.iter().map(|time| time.cpu_ms)),
    }
}

/// The one in the middle.
pub fn median(values: impl Iterator<Item = f64>) -> f64 {
    let mut values: Vec<f64> = values.collect();
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}
