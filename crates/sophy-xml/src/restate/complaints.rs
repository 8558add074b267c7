use super::{Location, Names, is_event};
use crate::codes::{RESTATED, UNSAYABLE};
use sophy_analysis::{ComponentDeclaration, ComponentKind, Direction, VariableDeclaration, VariableRole};
use sophy_diagnostics::{Diagnostic, Diagnostics, Span};
use std::collections::HashSet;

/// What SOPHY XML cannot say, or says otherwise.
#[derive(Debug, Default)]
pub(super) struct Complaints {
    pub(super) diagnostics: Diagnostics,
}

impl Complaints {
    /// SOPHY XML cannot say what stands at `span`.
    pub(super) fn cannot(&mut self, span: Span, what: impl Into<String>, way_out: impl Into<String>) {
        self.diagnostics.push(Diagnostic::error(UNSAYABLE, span, what).help(way_out));
    }

    /// SOPHY XML says it in other words.
    pub(super) fn restated(&mut self, span: Span, what: impl Into<String>) {
        self.diagnostics.push(Diagnostic::note_at(RESTATED, span, what));
    }

    pub(super) fn other_kind(&mut self, component: &ComponentDeclaration) {
        let kind = match component.kind {
            ComponentKind::Ctc => "a CTC",
            ComponentKind::Dtc => "a DTC",
            ComponentKind::Lbc => "an LBC",
            ComponentKind::Cc => "a CC",
            ComponentKind::System => "a SYSTEM",
        };
        let name = &component.name;
        self.cannot(
            name.span,
            format!("`{}` is {kind}; SOPHY XML has continuous-time components only", name.value),
            "keep it in HSML; each CTC in it can be written on its own",
        );
    }

    /// Notes on a mode or local.
    pub(super) fn remark_on(&mut self, variable: &VariableDeclaration, names: &Names<'_>) {
        let name = &variable.name.value;
        match variable.role {
            VariableRole::Mode => self
                .restated(variable.name.span, format!("mode `{name}` becomes a state with the derivative 0")),
            VariableRole::Local if names.locals.contains(name.as_str()) => self.restated(
                variable.name.span,
                format!("local `{name}` is replaced by its equation where it is used"),
            ),
            _ => {}
        }
    }

    /// Notes on event labels, which SOPHY XML does not declare.
    pub(super) fn remark_on_events(&mut self, component: &ComponentDeclaration, locations: &[Location<'_>]) {
        let transitions = || locations.iter().flat_map(|location| &location.transitions);
        let triggering: HashSet<&str> = transitions().flat_map(|t| t.input_events.iter().copied()).collect();
        let emitted: HashSet<&str> = transitions().flat_map(|t| t.output_events.iter().copied()).collect();
        for port in component.ports.iter().filter(|port| is_event(port)) {
            let name = port.name.value.as_str();
            let used = match port.direction {
                Direction::Input => triggering.contains(name),
                _ => emitted.contains(name),
            };
            if !used {
                let message = format!(
                    "event `{name}` is left out: no transition has it, and SOPHY XML has no declaration of events"
                );
                self.restated(port.name.span, message);
            } else if !port.documentation.is_empty() {
                let message = format!(
                    "the documentation of event `{name}` is left out: SOPHY XML has no declaration of events"
                );
                self.restated(port.name.span, message);
            }
        }
    }
}
