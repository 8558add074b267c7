use crate::units::NoteKind;
use sophy_diagnostics::{Diagnostic, Diagnostics, Severity, SourceId, Span};
use std::collections::HashSet;

/// An expression uses a name that nothing declares.
pub(crate) struct UnknownName {
    pub(crate) name: String,
    pub(crate) span: Span,
    /// Whether it is called.
    pub(crate) called: bool,
    /// What can be named where it stands, likelier ones first.
    pub(crate) candidates: Vec<String>,
}

/// What the lowering meets. Facts that are reported together, however often they occur, are gathered.
#[derive(Default)]
pub(crate) struct Findings {
    pub(crate) diagnostics: Diagnostics,
    pub(crate) unknown_names: Vec<UnknownName>,
    /// Uses of `log`.
    pub(crate) logarithms: Vec<Span>,
    /// What was said of units of a file; once is enough.
    pub(crate) unit_notes: Vec<(SourceId, NoteKind)>,
    /// Whether it was said that the model grows beyond bounds.
    pub(crate) too_large: bool,
    /// Binders that were said to hide something: the body of a function is lowered with every call.
    pub(crate) binders: HashSet<Span>,
    errors: usize,
}

impl Findings {
    pub(crate) fn report(&mut self, diagnostic: Diagnostic) {
        self.errors += usize::from(diagnostic.severity == Severity::Error);
        self.diagnostics.push(diagnostic);
    }

    pub(crate) fn report_all(&mut self, diagnostics: Diagnostics) {
        self.errors += diagnostics.count(Severity::Error);
        self.diagnostics.extend(diagnostics);
    }

    /// Errors so far, unknown names included.
    pub(crate) fn error_count(&self) -> usize {
        self.errors + self.unknown_names.len()
    }
}
