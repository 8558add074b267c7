use sophy_diagnostics::{Diagnostic, Diagnostics, Span};

/// An expression uses a name that nothing declares.
pub(crate) struct UnknownName {
    pub(crate) name: String,
    pub(crate) span: Span,
    /// Whether it is called.
    pub(crate) called: bool,
    /// Parameters of the function whose body it stands in.
    pub(crate) parameters: Vec<String>,
}

/// What the lowering meets. Facts that are reported together, however often they occur, are gathered.
#[derive(Default)]
pub(crate) struct Findings {
    pub(crate) diagnostics: Diagnostics,
    pub(crate) unknown_names: Vec<UnknownName>,
    /// Uses of `log`.
    pub(crate) logarithms: Vec<Span>,
    /// Whether it was said that the model grows beyond bounds.
    pub(crate) too_large: bool,
}

impl Findings {
    pub(crate) fn report(&mut self, diagnostic: Diagnostic) {
        self.diagnostics.push(diagnostic);
    }
}
