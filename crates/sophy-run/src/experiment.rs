use crate::backend::Backend;
use sophy_solvers::Quantum;

/// Everything a run needs besides the model. Names are those of the model; `component.name` in a composition.
#[derive(Clone, Debug, PartialEq)]
pub struct Experiment {
    /// Simulated time at which the run starts, s.
    pub start: f64,
    /// Simulated time at which it ends, s.
    pub stop: f64,
    /// Seed of everything random; recorded even where nothing is.
    pub seed: u64,
    /// The engine.
    pub method: Method,
    /// How equations are evaluated.
    pub backend: Backend,
    /// Error accepted in states without a quantum, as a fraction of their largest |x|; see [`Quantum::from_tolerance`].
    pub tolerance: f64,
    /// Quanta by name pattern; the last rule that matches a state counts.
    pub quanta: Vec<QuantumRule>,
    /// Values of knobs (parameters).
    pub knobs: Vec<(String, f64)>,
    /// Initial values of states; they win over those of the model.
    pub initial: Vec<(String, f64)>,
    /// Initial locations, by component (empty for a model of one nameless component).
    pub initial_locations: Vec<(String, String)>,
    /// Signals of the inputs.
    pub inputs: Vec<(String, Signal)>,
    /// Events from outside: time (s) and label, in the order of time.
    pub events: Vec<(f64, String)>,
    /// What to record, by name pattern; `None` is outputs and locations.
    pub record: Option<Vec<String>>,
    /// Record on a grid of this step (s) instead of at every event.
    pub every: Option<f64>,
    /// Record every micro-step.
    pub microsteps: bool,
    /// Log the kinks crossed (`abs`, `min`, `if`, … in rates) along with transitions.
    pub all_events: bool,
}

impl Default for Experiment {
    fn default() -> Self {
        Experiment {
            start: 0.0,
            stop: 10.0,
            seed: 0,
            method: Method::Auto,
            backend: Backend::Auto,
            tolerance: 1e-4,
            quanta: Vec::new(),
            knobs: Vec::new(),
            initial: Vec::new(),
            initial_locations: Vec::new(),
            inputs: Vec::new(),
            events: Vec::new(),
            record: None,
            every: None,
            microsteps: false,
            all_events: false,
        }
    }
}

/// Engines by name.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Method {
    /// The best for the model; at present QSS2.
    #[default]
    Auto,
    /// First-order quantised states.
    Qss1,
    /// Second-order quantised states.
    Qss2,
    /// Third-order quantised states.
    Qss3,
    /// First-order quantised states, linearly implicit: for stiff models.
    Liqss1,
    /// Second-order quantised states, linearly implicit: for stiff models.
    Liqss2,
    /// Third-order quantised states, linearly implicit: for stiff models.
    Liqss3,
}

impl Method {
    /// All names that [`Method::named`] knows.
    pub const NAMES: &'static [&'static str] =
        &["auto", "qss1", "qss2", "qss3", "liqss1", "liqss2", "liqss3"];

    /// The method of a name.
    pub fn named(name: &str) -> Option<Method> {
        match name {
            "auto" => Some(Method::Auto),
            "qss1" => Some(Method::Qss1),
            "qss2" => Some(Method::Qss2),
            "qss3" => Some(Method::Qss3),
            "liqss1" => Some(Method::Liqss1),
            "liqss2" => Some(Method::Liqss2),
            "liqss3" => Some(Method::Liqss3),
            _ => None,
        }
    }

    /// The order of its segments.
    pub(crate) fn order(self) -> u32 {
        match self {
            Method::Qss1 | Method::Liqss1 => 1,
            Method::Auto | Method::Qss2 | Method::Liqss2 => 2,
            Method::Qss3 | Method::Liqss3 => 3,
        }
    }

    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Method::Auto => "auto",
            Method::Qss1 => "qss1",
            Method::Qss2 => "qss2",
            Method::Qss3 => "qss3",
            Method::Liqss1 => "liqss1",
            Method::Liqss2 => "liqss2",
            Method::Liqss3 => "liqss3",
        }
    }
}

/// A quantum for the states whose name matches.
#[derive(Clone, Debug, PartialEq)]
pub struct QuantumRule {
    /// A name; `*` stands for any characters.
    pub pattern: String,
    /// The quantum.
    pub quantum: Quantum,
}

/// Samples of an input.
#[derive(Clone, Debug, PartialEq)]
pub struct Signal {
    /// Times, s, never decreasing; an equal pair is a jump.
    pub times: Vec<f64>,
    /// Values, in the input's unit.
    pub values: Vec<f64>,
    /// Between samples.
    pub interpolation: Interpolation,
    /// After the last sample.
    pub at_end: AtEnd,
    /// Where it comes from, for messages.
    pub origin: String,
}

/// What a signal is between two samples.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Interpolation {
    /// The value of a row holds until the next row.
    #[default]
    Hold,
    /// A straight line.
    Linear,
}

/// What a signal is after its last sample.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum AtEnd {
    /// Nothing: a run that goes on is an error, reported before it starts.
    #[default]
    Error,
    /// The last value holds.
    Hold,
}

impl Signal {
    /// A value that never changes.
    pub fn constant(value: f64) -> Self {
        Signal {
            times: vec![f64::NEG_INFINITY],
            values: vec![value],
            interpolation: Interpolation::Hold,
            at_end: AtEnd::Hold,
            origin: "a constant".to_owned(),
        }
    }
}

/// An experiment does not fit its model.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{message}")]
pub struct ExperimentError {
    /// The item, as a path of keys such as `knobs.TAU` or `inputs.Pin`.
    pub item: String,
    /// What is wrong.
    pub message: String,
    /// The way out.
    pub help: Option<String>,
}

impl ExperimentError {
    pub(crate) fn new(item: impl Into<String>, message: impl Into<String>) -> Self {
        ExperimentError { item: item.into(), message: message.into(), help: None }
    }

    pub(crate) fn help(mut self, help: impl Into<String>) -> Self {
        self.help = Some(help.into());
        self
    }
}

/// Whether `name` matches `pattern`, in which `*` stands for any characters.
pub(crate) fn matches(pattern: &str, name: &str) -> bool {
    let Some((first, rest)) = pattern.split_once('*') else { return pattern == name };
    let Some(mut name) = name.strip_prefix(first) else { return false };
    let mut parts: Vec<&str> = rest.split('*').collect();
    let Some(last) = parts.pop() else { return true };
    for part in parts {
        let Some(at) = name.find(part) else { return false };
        name = &name[at + part.len()..];
    }
    name.ends_with(last)
}

#[cfg(test)]
mod tests {
    use super::matches;

    #[test]
    fn stars_stand_for_any_characters() {
        for (pattern, name, expected) in [
            ("Speed", "Speed", true),
            ("Speed", "Speed2", false),
            ("*", "anything", true),
            ("a.*", "a.x", true),
            ("a.*", "b.x", false),
            ("*.x", "a.x", true),
            ("a*b*c", "a--b--c", true),
            ("a*b*c", "a--c", false),
            ("ab*ba", "aba", false),
        ] {
            assert_eq!(matches(pattern, name), expected, "{pattern} {name}");
        }
    }
}
