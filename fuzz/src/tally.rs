//! What a campaign came to.

use crate::target::Cost;
use std::fmt;
use std::str::FromStr;
use std::time::Duration;

/// Ratios are taken of inputs from this length on: below, constants count.
const LONG: usize = 1000;

/// Sums and extremes over inputs.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Tally {
    pub(crate) inputs: u64,
    pub(crate) bytes: u64,
    /// Inputs without a mistake.
    pub(crate) sound: u64,
    /// Wall clock, mutations included.
    pub(crate) elapsed: Duration,
    /// CPU time of what is measured.
    pub(crate) busy: Duration,
    pub(crate) slowest: Extreme,
    pub(crate) slowest_per_byte: Extreme,
    pub(crate) largest_per_byte: Extreme,
}

/// An input that took most of something.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Extreme {
    pub(crate) index: u64,
    pub(crate) length: usize,
    /// ms, ns per byte or bytes per byte.
    pub(crate) value: f64,
}

impl Extreme {
    fn consider(&mut self, other: Extreme) {
        if other.value > self.value {
            *self = other;
        }
    }
}

impl Tally {
    pub(crate) fn add(&mut self, index: u64, length: usize, cost: Cost) {
        self.inputs += 1;
        self.bytes += length as u64;
        self.sound += u64::from(cost.sound);
        self.busy += cost.time;
        let of = |value| Extreme { index, length, value };
        let seconds = cost.time.as_secs_f64();
        self.slowest.consider(of(1e3 * seconds));
        if length >= LONG {
            self.slowest_per_byte.consider(of(1e9 * seconds / length as f64));
            self.largest_per_byte.consider(of(cost.peak as f64 / length as f64));
        }
    }

    pub(crate) fn join(&mut self, other: &Tally) {
        self.inputs += other.inputs;
        self.bytes += other.bytes;
        self.sound += other.sound;
        self.elapsed += other.elapsed;
        self.busy += other.busy;
        self.slowest.consider(other.slowest);
        self.slowest_per_byte.consider(other.slowest_per_byte);
        self.largest_per_byte.consider(other.largest_per_byte);
    }

    /// For people.
    pub(crate) fn summary(&self) -> String {
        let of = |extreme: &Extreme, unit: &str| {
            format!("{:.1} {unit} (input {}, {} bytes)", extreme.value, extreme.index, extreme.length)
        };
        format!(
            "{} inputs ({} without a mistake), {:.1} MB in {:.0} s ({:.0} inputs/s; parsing {:.1} MB/s)\n  \
             slowest {}\n  slowest per byte {}\n  most memory per byte {}",
            self.inputs,
            self.sound,
            self.bytes as f64 / 1e6,
            self.elapsed.as_secs_f64(),
            self.inputs as f64 / self.elapsed.as_secs_f64().max(1e-9),
            self.bytes as f64 / 1e6 / self.busy.as_secs_f64().max(1e-9),
            of(&self.slowest, "ms"),
            of(&self.slowest_per_byte, "ns/byte"),
            of(&self.largest_per_byte, "bytes/byte"),
        )
    }
}

/// For another process.
impl fmt::Display for Tally {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} {} {}", self.inputs, self.bytes, self.sound)?;
        write!(f, " {} {}", self.elapsed.as_secs_f64(), self.busy.as_secs_f64())?;
        for extreme in [&self.slowest, &self.slowest_per_byte, &self.largest_per_byte] {
            write!(f, " {} {} {}", extreme.index, extreme.length, extreme.value)?;
        }
        Ok(())
    }
}

/// From another process.
impl FromStr for Tally {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let mut words = text.split(' ');
        fn next<T: FromStr>(words: &mut std::str::Split<'_, char>) -> Result<T, String> {
            words.next().and_then(|word| word.parse().ok()).ok_or_else(|| "not a tally".to_owned())
        }
        let seconds = |words: &mut _| next(words).map(|s: f64| Duration::from_secs_f64(s.max(0.0)));
        let extreme = |words: &mut _| -> Result<Extreme, String> {
            Ok(Extreme { index: next(words)?, length: next(words)?, value: next(words)? })
        };
        let words = &mut words;
        Ok(Tally {
            inputs: next(words)?,
            bytes: next(words)?,
            sound: next(words)?,
            elapsed: seconds(words)?,
            busy: seconds(words)?,
            slowest: extreme(words)?,
            slowest_per_byte: extreme(words)?,
            largest_per_byte: extreme(words)?,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_tally_survives_the_way_to_another_process() {
        let mut tally = Tally { elapsed: Duration::from_millis(2500), ..Tally::default() };
        tally.add(3, 5000, Cost { time: Duration::from_micros(125), peak: 4000, sound: true });
        tally.add(9, 12, Cost { time: Duration::from_micros(250), peak: 9000, sound: false });
        assert_eq!(tally.to_string().parse(), Ok(tally));
        assert_eq!((tally.slowest.index, tally.largest_per_byte.index, tally.sound), (9, 3, 1));
    }
}
