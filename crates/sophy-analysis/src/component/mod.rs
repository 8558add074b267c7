//! One component → its class: names, then parameters, variables and ports, then sections, then what only all
//! sections together show.

mod automaton;
mod builder;
mod checks;
mod discrete;
mod equations;
mod exclusion;
mod held;
mod matching;
mod parameters;
mod statements;
mod types;
mod variables;

pub(crate) use automaton::{BuiltLocation, BuiltTransition};
pub(crate) use builder::{Builder, Given, GivenValue, Shared};
pub(crate) use checks::Stray;
pub(crate) use equations::{Definition, shape_of_part};
pub(crate) use types::{PortType, TYPES};
pub(crate) use variables::{Interface, Port};

use crate::declarations::{ComponentDeclaration, ComponentKind};
use crate::lower::{Expected, Place};
use sophy_ir::{Body, Class, Leaf, VariableKind};
use std::collections::BTreeSet;

/// What became of a component.
pub(crate) struct Built {
    /// `None` if it has mistakes.
    pub(crate) class: Option<Class>,
    pub(crate) interface: Interface,
    /// What members can give, in written order; `None` where that is not known.
    pub(crate) parameters: Vec<(String, Option<Expected>)>,
    /// Parameters whose values decided something of the structure.
    pub(crate) structural: BTreeSet<String>,
}

/// Analyses a component that is no composite.
pub(crate) fn build<'a>(
    declaration: &'a ComponentDeclaration,
    shared: &mut Shared<'a>,
    given: &Given,
) -> Built {
    let errors = shared.findings.error_count();
    let mut builder = Builder::new(declaration, shared, given);
    builder.check_sections();
    builder.foreshadow();
    builder.declare_parameters();
    let interface = builder.declare_variables();
    builder.at(Place::EQUATION).check_functions();
    builder.initial_values();
    let body = match declaration.kind {
        ComponentKind::Dtc => {
            let discrete = builder.discrete(&interface);
            discrete.map(Body::Discrete)
        }
        _ => {
            let initial = builder.initial_section();
            let locations = builder.locations(&interface);
            let events = builder.event_sections();
            let rules = builder.rules();
            builder.check_automaton(&locations, &events);
            builder.check_meetings(&locations, &events, &rules);
            builder.automaton(locations, initial, events, rules).map(Body::Automaton)
        }
    };
    builder.check_uses();
    builder.finish(body, interface, errors)
}

impl Builder<'_, '_> {
    /// The parameters that decide the structure, by way of other parameters too.
    fn structural_closure(&self) -> BTreeSet<String> {
        let base = |id: sophy_ir::VariableId| {
            let name = &self.variables[id.0 as usize].name;
            name.split('[').next().unwrap_or(name).to_owned()
        };
        let mut names = self.structural.clone();
        for (position, variable) in self.variables.iter().enumerate().rev() {
            let VariableKind::Parameter { value, .. } = variable.kind else { continue };
            if names.contains(&base(sophy_ir::VariableId(position as u32))) {
                for leaf in self.graph.dependencies([value]) {
                    if let Leaf::Variable(id) = leaf {
                        names.insert(base(id));
                    }
                }
            }
        }
        names
    }

    /// The class, if nothing was reported since there were `errors` errors.
    pub(crate) fn finish(mut self, body: Option<Body>, interface: Interface, errors: usize) -> Built {
        let declaration = self.declaration;
        let structural = self.structural_closure();
        let parameters = self.parameters_of_members();
        for variable in &mut self.variables {
            let base = variable.name.split('[').next().unwrap_or(&variable.name);
            variable.structural =
                matches!(variable.kind, VariableKind::Parameter { .. }) && structural.contains(base);
        }
        let sound = self.shared.findings.error_count() == errors && !declaration.name.value.is_empty();
        let class = body.filter(|_| sound).map(|body| Class {
            name: declaration.name.value.clone(),
            documentation: declaration.documentation.clone(),
            graph: self.graph,
            variables: self.variables,
            specials: self.specials,
            input_events: interface.input_events.clone(),
            output_events: interface.output_events.clone(),
            synchronised: interface.synchronised.clone(),
            body,
            span: Some(declaration.name.span),
        });
        Built { class, interface, parameters, structural }
    }
}
