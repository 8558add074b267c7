/// One transition taken.
#[derive(Clone, Debug, PartialEq)]
pub struct EventRecord {
    /// Simulated time, s.
    pub time: f64,
    /// Micro-step within the instant, from 0.
    pub step: u32,
    /// Component; empty in a model of one nameless component.
    pub component: String,
    /// Name of the transition.
    pub transition: String,
    /// Location left.
    pub from: String,
    /// Location entered.
    pub to: String,
}
