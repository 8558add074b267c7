//! Superdense time.

use std::cmp::Ordering;

/// A superdense instant: a time and the number of the micro-step taken at that time.
///
/// Discrete changes take no time, yet one may cause the next, so a quantity can have several values at
/// one time: `(t, 0)` is the value with which the continuous motion arrives at `t`, `(t, n)` the one after
/// n micro-steps, and the motion continues from the last of them. Instants are ordered by time first, by
/// step second; nothing lies between `(t, n)` and `(t, n + 1)`.
///
/// The order is total ([`f64::total_cmp`]), so instants can be keys. [`Instant::new`] turns −0 into 0,
/// which keeps the two zeros one time; NaN sorts after every time and never denotes one.
#[derive(Clone, Copy, Debug)]
pub struct Instant {
    /// Time in s.
    pub time: f64,
    /// Number of micro-steps taken at `time` before this instant.
    pub step: u32,
}

impl Instant {
    /// The instant after `step` micro-steps at `time` (s).
    #[must_use]
    pub fn new(time: f64, step: u32) -> Self {
        Self { time: time + 0.0, step }
    }

    /// The instant at which the motion arrives at `time` (s), before any micro-step.
    #[must_use]
    pub fn at(time: f64) -> Self {
        Self::new(time, 0)
    }

    /// The instant one micro-step later.
    #[must_use]
    pub fn next_step(self) -> Self {
        Self { step: self.step + 1, ..self }
    }
}

impl Ord for Instant {
    fn cmp(&self, other: &Self) -> Ordering {
        self.time.total_cmp(&other.time).then(self.step.cmp(&other.step))
    }
}

impl PartialOrd for Instant {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Instant {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}

impl Eq for Instant {}

#[cfg(test)]
mod tests {
    use super::Instant;

    #[test]
    fn time_comes_first_then_the_step() {
        let ordered = [
            Instant::new(f64::NEG_INFINITY, 9),
            Instant::new(-1.0, 7),
            Instant::at(0.0),
            Instant::new(0.0, 1),
            Instant::new(0.0, 2),
            Instant::at(0.0_f64.next_up()),
            Instant::at(f64::INFINITY),
            Instant::at(f64::NAN),
        ];
        for (i, a) in ordered.iter().enumerate() {
            for (j, b) in ordered.iter().enumerate() {
                assert_eq!(a.cmp(b), i.cmp(&j), "{a:?} {b:?}");
            }
        }
    }

    #[test]
    fn the_two_zeros_are_one_time() {
        assert_eq!(Instant::at(-0.0), Instant::at(0.0));
        assert_eq!(Instant::at(-0.0).next_step(), Instant::new(0.0, 1));
    }
}
