//! Input signals as lines between breakpoints, and events from outside.

use crate::experiment::{AtEnd, ExperimentError, Interpolation, Signal};
use sophy_field::{Changes, EventIndex, InputIndex};

/// The inputs of a run as time goes on.
#[derive(Clone, Debug)]
pub(crate) struct Inputs {
    signals: Vec<Driver>,
    /// Time and receivers, in the order of time.
    events: Vec<(f64, EventIndex)>,
    next_event: usize,
    /// When a signal changes next, s.
    next_signal: f64,
}

#[derive(Clone, Debug)]
struct Driver {
    input: InputIndex,
    signal: Signal,
    /// First sample after the present line's start.
    next: usize,
}

impl Inputs {
    pub(crate) fn new(signals: Vec<(InputIndex, Signal)>, events: Vec<(f64, EventIndex)>) -> Self {
        let mut events = events;
        events.sort_by(|a, b| a.0.total_cmp(&b.0));
        let signals = signals.into_iter().map(|(input, signal)| Driver { input, signal, next: 0 }).collect();
        Inputs { signals, events, next_event: 0, next_signal: f64::INFINITY }
    }

    /// Value and slope of every input at `start`, in the order given; everything before is past.
    pub(crate) fn begin(&mut self, start: f64) -> Vec<[f64; 2]> {
        self.next_event = self.events.partition_point(|event| event.0 < start);
        let begin = |driver: &mut Driver| {
            driver.next = driver.signal.times.partition_point(|&time| time <= start);
            driver.line(start)
        };
        let lines = self.signals.iter_mut().map(begin).collect();
        self.look_ahead();
        lines
    }

    fn look_ahead(&mut self) {
        self.next_signal = self.signals.iter().map(Driver::next_time).fold(f64::INFINITY, f64::min);
    }

    /// The next time at which something changes or arrives; infinite if nothing does.
    pub(crate) fn next_time(&self) -> f64 {
        let event = self.events.get(self.next_event).map_or(f64::INFINITY, |event| event.0);
        event.min(self.next_signal)
    }

    /// Everything due at `time`: the changes of inputs, and the events, in order.
    pub(crate) fn due(&mut self, time: f64, changes: &mut Changes) -> Vec<EventIndex> {
        if self.next_signal <= time {
            for driver in &mut self.signals {
                if driver.next_time() <= time {
                    while driver.next_time() <= time {
                        driver.next += 1;
                    }
                    changes.inputs.push((driver.input, driver.line(time)));
                }
            }
            self.look_ahead();
        }
        let mut events = Vec::new();
        while let Some(&(at, event)) = self.events.get(self.next_event) {
            if at > time {
                break;
            }
            events.push(event);
            self.next_event += 1;
        }
        events
    }
}

impl Driver {
    fn next_time(&self) -> f64 {
        self.signal.times.get(self.next).copied().unwrap_or(f64::INFINITY)
    }

    /// Value and slope at `time`, which lies between samples `next - 1` and `next`.
    fn line(&self, time: f64) -> [f64; 2] {
        let (times, values) = (&self.signal.times, &self.signal.values);
        let Some(last) = self.next.checked_sub(1) else {
            return [values.first().copied().unwrap_or(0.0), 0.0];
        };
        match self.signal.interpolation {
            Interpolation::Linear if self.next < times.len() => {
                let slope = (values[self.next] - values[last]) / (times[self.next] - times[last]);
                [values[last] + slope * (time - times[last]), slope]
            }
            _ => [values[last], 0.0],
        }
    }
}

/// Whether a signal covers a run.
pub(crate) fn check(name: &str, signal: &Signal, start: f64, stop: f64) -> Result<(), ExperimentError> {
    let item = format!("inputs.{name}");
    let (Some(&first), Some(&last)) = (signal.times.first(), signal.times.last()) else {
        return Err(ExperimentError::new(item, format!("input `{name}` has no samples ({})", signal.origin)));
    };
    if let Some(bad) = signal.values.iter().chain(&signal.times[1..]).find(|value| !value.is_finite()) {
        return Err(ExperimentError::new(
            item,
            format!("input `{name}` has a sample {bad} ({})", signal.origin),
        ));
    }
    if first > start {
        return Err(ExperimentError::new(
            item,
            format!(
                "input `{name}` begins at {first} s, after the run's start at {start} s ({})",
                signal.origin
            ),
        )
        .help(format!("start the run at {first} s (`start = {first}`), or add an earlier sample")));
    }
    if last < stop && signal.at_end == AtEnd::Error {
        return Err(ExperimentError::new(
            item,
            format!("input `{name}` ends at {last} s, before the run's stop at {stop} s ({})", signal.origin),
        )
        .help(format!("stop the run at {last} s (`--stop {last}`), or hold the last value (`after = \"hold\"`, `--after hold`)")));
    }
    Ok(())
}
