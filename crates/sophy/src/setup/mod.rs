//! What is asked for beside the model: the experiment, the files to write, and where each wish was said.
//!
//! An experiment file is read key by key (`keys`), so that all of its mistakes are found at once; `values`
//! knows the types of TOML, `signal` the input files.

mod keys;
mod signal;
mod values;

use crate::load::nowhere;
use sophy_diagnostics::{Code, Diagnostic, Span};
use sophy_run::{AtEnd, Experiment, ExperimentError, Interpolation, Signal};
use std::collections::BTreeMap;
use std::path::PathBuf;

pub(crate) use keys::read_setup;
pub use signal::{SignalError, read_signal};

/// An experiment, what it writes, and where each of its items was said.
///
/// A command line changes a loaded setup item by item, then [`Setup::said_at`] tells where the new value
/// stands, so that a message points at the flag instead of the file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Setup {
    /// Everything a run needs besides the model.
    pub experiment: Experiment,
    /// The files it writes.
    pub outputs: Outputs,
    /// Places of items, by key path such as `knobs.TAU`.
    places: BTreeMap<String, Span>,
}

/// The files a run writes.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Outputs {
    /// Results: `.csv`, `.arrow`, `.parquet`; `-` is CSV on stdout.
    pub results: Vec<PathBuf>,
    /// The log of transitions, a CSV.
    pub events: Option<PathBuf>,
    /// Pictures of the result: `.png`, `.svg`, `.html`.
    pub plots: Vec<PathBuf>,
    /// Two variables whose phase portrait the pictures show.
    pub phase: Option<(String, String)>,
}

impl Setup {
    /// Remembers where `item` (a key path such as `knobs.TAU`) was said; the last place counts.
    pub fn said_at(&mut self, item: impl Into<String>, span: Span) {
        self.places.insert(item.into(), span);
    }

    /// Sets how all inputs from files go between their samples.
    pub fn interpolate(&mut self, interpolation: Interpolation) {
        self.sampled().for_each(|signal| signal.interpolation = interpolation);
    }

    /// Sets what all inputs from files do after their last sample.
    pub fn after_the_end(&mut self, at_end: AtEnd) {
        self.sampled().for_each(|signal| signal.at_end = at_end);
    }

    /// Signals that are not constants.
    fn sampled(&mut self) -> impl Iterator<Item = &mut Signal> {
        let signals = self.experiment.inputs.iter_mut().map(|(_, signal)| signal);
        signals.filter(|signal| signal.times.first().is_some_and(|first| first.is_finite()))
    }

    /// An error of the experiment as a message at the key or flag it is about.
    pub fn explain(&self, error: &ExperimentError) -> Diagnostic {
        let mut diagnostic = match self.place(&error.item) {
            Some(span) => Diagnostic::error(FITS, span, &error.message),
            None => nowhere(FITS.0, error.message.clone()),
        };
        diagnostic.helps.extend(error.help.clone());
        diagnostic
    }

    /// The place of an item, or of the nearest section it belongs to.
    fn place(&self, item: &str) -> Option<Span> {
        let exact = self.places.get(item);
        let sections = || self.places.iter().rev().find(|(place, _)| is_section(place, item));
        exact.or_else(|| sections().map(|(_, span)| span)).copied()
    }
}

/// The experiment does not fit the model.
const FITS: Code = Code("EX0201");

fn is_section(place: &str, item: &str) -> bool {
    item.strip_prefix(place).is_some_and(|rest| rest.starts_with('.'))
}

impl Outputs {
    /// All files, in the order results, events, pictures; stdout is none.
    pub fn paths(&self) -> Vec<PathBuf> {
        let all = self.results.iter().chain(&self.events).chain(&self.plots);
        all.filter(|path| path.as_os_str() != "-").cloned().collect()
    }
}
