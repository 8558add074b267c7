use std::collections::BTreeMap;

/// The columns of a result, without `time`, which always comes first, and `step`, which follows it when
/// every micro-step is recorded.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Schema {
    /// In the order of the file. The n-th real column has the n-th of [`Row::reals`], the n-th label column the n-th
    /// of [`Row::labels`].
    pub columns: Vec<Column>,
    /// Whether rows carry the micro-step number.
    pub with_step: bool,
}

impl Schema {
    /// Number of real columns.
    pub fn reals(&self) -> usize {
        self.columns.iter().filter(|c| c.kind == ColumnKind::Real).count()
    }

    /// Number of label columns.
    pub fn labels(&self) -> usize {
        self.columns.len() - self.reals()
    }
}

/// One recorded variable.
#[derive(Clone, Debug, PartialEq)]
pub struct Column {
    /// `component.variable`, or `variable` alone in a model of one component.
    pub name: String,
    /// Unit as the model states it.
    pub unit: Option<String>,
    /// What its cells are.
    pub kind: ColumnKind,
}

/// What the cells of a column are.
#[derive(Clone, Debug, PartialEq)]
pub enum ColumnKind {
    /// Numbers.
    Real,
    /// A location, a text or a truth value: the cell is a position in these names.
    Label(Vec<String>),
}

impl Column {
    /// Whether it shows the location of a component.
    pub fn is_location(&self) -> bool {
        let last = self.name.rsplit('.').next();
        matches!(self.kind, ColumnKind::Label(_)) && last == Some("location")
    }
}

/// Where a result comes from; written into every result file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Metadata {
    /// Keys and values, such as `model`, `model_hash`, `experiment`, `version`, `seed`, `outcome`.
    pub entries: BTreeMap<String, String>,
}

/// The recorded values at one instant. At a jump there are two rows of one time: before and after.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Row<'a> {
    /// Simulated time, s.
    pub time: f64,
    /// Micro-step; 0 unless every micro-step is recorded.
    pub step: u32,
    /// Values of the real columns, in their units.
    pub reals: &'a [f64],
    /// Positions of the label columns in their names.
    pub labels: &'a [u32],
}

/// A row could not be kept.
#[derive(Debug)]
pub struct SinkError {
    /// Path or name of the sink.
    pub sink: String,
    /// What happened.
    pub source: Box<dyn std::error::Error + Send + Sync>,
}

impl std::fmt::Display for SinkError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "cannot write {}: {}", self.sink, self.source)
    }
}

impl std::error::Error for SinkError {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        Some(self.source.as_ref())
    }
}

/// Takes rows in the order of time, in a run of some length from a thread beside it.
///
/// The schema and the metadata known at the start are given when a sink is made. [`Sink::flush`] is called
/// at least once a second of wall time while a run goes on: what was taken before must then survive the
/// death of the process.
pub trait Sink: Send {
    /// Takes one row.
    ///
    /// # Errors
    /// [`SinkError`] if it cannot be written; the run stops.
    fn row(&mut self, row: Row<'_>) -> Result<(), SinkError>;

    /// Makes what was taken durable.
    ///
    /// # Errors
    /// As [`Sink::row`].
    fn flush(&mut self) -> Result<(), SinkError>;

    /// Completes the result; `metadata` adds what was known only at the end (such as `outcome`).
    ///
    /// # Errors
    /// As [`Sink::row`].
    fn finish(&mut self, metadata: &Metadata) -> Result<(), SinkError>;
}
