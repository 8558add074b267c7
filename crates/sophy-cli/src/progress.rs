use crate::interrupt::Interrupt;
use crate::numbers::{brief, plural};
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use sophy::{EventRecord, Observer, Progress, SinkError};
use std::io::IsTerminal;
use std::ops::ControlFlow;
use std::time::Duration;

/// Looks on while a run goes on: a bar on a terminal after the first second, and an ear for Ctrl-C.
pub(crate) struct Watcher {
    interrupt: Interrupt,
    span: (f64, f64),
    wanted: bool,
    bar: Option<ProgressBar>,
}

const PATIENCE: Duration = Duration::from_secs(1);
const STEPS: u64 = 1000;

impl Watcher {
    /// Watches a run from `start` to `stop`, s.
    pub(crate) fn new(start: f64, stop: f64, json: bool) -> Self {
        let wanted = !json && std::io::stderr().is_terminal();
        Watcher { interrupt: Interrupt::listen(), span: (start, stop), wanted, bar: None }
    }
}

impl Observer for Watcher {
    fn progress(&mut self, progress: &Progress) -> ControlFlow<()> {
        if self.wanted && progress.elapsed > PATIENCE {
            let (start, stop) = self.span;
            let bar = self.bar.get_or_insert_with(bar);
            let share = (progress.time - start) / (stop - start);
            bar.set_position((share * STEPS as f64) as u64);
            let factor = (progress.time - start) / progress.elapsed.as_secs_f64();
            bar.set_message(format!(
                "t = {} of {} s, {} × real time, {}",
                brief(progress.time),
                brief(stop),
                brief(factor),
                plural(progress.statistics.hybrid.transitions, "transition"),
            ));
        }
        if self.interrupt.asked() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }

    fn events(&mut self, _: &[EventRecord]) -> Result<(), SinkError> {
        Ok(())
    }
}

impl Drop for Watcher {
    fn drop(&mut self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }
}

fn bar() -> ProgressBar {
    let style =
        ProgressStyle::with_template("{bar:30} {msg}").unwrap_or_else(|_| ProgressStyle::default_bar());
    ProgressBar::with_draw_target(Some(STEPS), ProgressDrawTarget::stderr_with_hz(8)).with_style(style)
}
