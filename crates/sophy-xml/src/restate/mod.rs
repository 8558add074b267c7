//! A component in the words of SOPHY XML: what a file of it consists of, or why there is none.
//!
//! - [`restate`]: the whole, section by section;
//! - `unsayable`: parts that SOPHY XML has no words for;
//! - `expressions`: texts of expressions, with locals replaced by what they stand for;
//! - `locations`: equations of the body and of locations, transitions;
//! - `hints`: what stands in hints.
//!
//! A message says what cannot be said, where it stands, and the way out.

mod complaints;
mod expressions;
mod hints;
mod locations;
mod unsayable;

use complaints::Complaints;
use expressions::Expressions;
use sophy_analysis::{
    ComponentDeclaration, ComponentKind, Dialect, Direction, FunctionDeclaration, ParameterDeclaration,
    VariableRole,
};
use sophy_diagnostics::Diagnostics;
use std::borrow::Cow;
use std::collections::HashSet;

/// What a SOPHY XML file says, element by element.
#[derive(Debug, Default)]
pub(crate) struct System<'c> {
    pub(crate) name: &'c str,
    pub(crate) documentation: &'c str,
    /// Name and text.
    pub(crate) hints: Vec<(String, Cow<'c, str>)>,
    /// Symbol and value.
    pub(crate) constants: Vec<(&'c str, Cow<'c, str>)>,
    /// Name and documentation.
    pub(crate) states: Vec<(&'c str, &'c str)>,
    pub(crate) inputs: Vec<(&'c str, &'c str)>,
    pub(crate) outputs: Vec<(&'c str, &'c str)>,
    pub(crate) locations: Vec<Location<'c>>,
}

#[derive(Debug)]
pub(crate) struct Location<'c> {
    pub(crate) name: Cow<'c, str>,
    pub(crate) documentation: &'c str,
    /// State and derivative.
    pub(crate) dynamics: Vec<(&'c str, Cow<'c, str>)>,
    /// Output and value.
    pub(crate) output: Vec<(&'c str, Cow<'c, str>)>,
    pub(crate) transitions: Vec<Transition<'c>>,
}

#[derive(Debug)]
pub(crate) struct Transition<'c> {
    pub(crate) name: &'c str,
    pub(crate) documentation: Cow<'c, str>,
    pub(crate) domain: Cow<'c, str>,
    pub(crate) destination: &'c str,
    /// State and value.
    pub(crate) resets: Vec<(&'c str, Cow<'c, str>)>,
    pub(crate) input_events: Vec<&'c str>,
    pub(crate) output_events: Vec<&'c str>,
}

/// What the names of a component are in SOPHY XML.
#[derive(Debug, Default)]
pub(crate) struct Names<'c> {
    /// States, and modes, which become states.
    states: HashSet<&'c str>,
    modes: Vec<&'c str>,
    /// Outputs that carry a value.
    outputs: Vec<&'c str>,
    output_set: HashSet<&'c str>,
    /// Locals of the body that are no outputs: they get replaced.
    locals: HashSet<&'c str>,
}

impl<'c> Names<'c> {
    fn of(component: &'c ComponentDeclaration) -> Self {
        let mut names = Names::default();
        for port in &component.ports {
            if port.direction == Direction::Output && !is_event(port) {
                names.outputs.push(&port.name.value);
                names.output_set.insert(&port.name.value);
            }
        }
        for variable in &component.variables {
            let name = variable.name.value.as_str();
            match variable.role {
                VariableRole::State => {
                    names.states.insert(name);
                }
                VariableRole::Mode => {
                    names.states.insert(name);
                    names.modes.push(name);
                }
                VariableRole::Local if !names.output_set.contains(name) => {
                    names.locals.insert(name);
                }
                VariableRole::Local | VariableRole::Flag => {}
            }
        }
        names
    }
}

fn is_event(port: &sophy_analysis::PortDeclaration) -> bool {
    port.kind.as_ref().is_some_and(|kind| kind.name.value == "event")
}

/// The SOPHY XML of a component with the functions and constants of its file. With errors among the messages it
/// is incomplete.
pub(crate) fn restate<'c>(
    component: &'c ComponentDeclaration,
    functions: &'c [FunctionDeclaration],
    constants: &'c [ParameterDeclaration],
) -> (System<'c>, Diagnostics) {
    let mut complaints = Complaints::default();
    if component.kind != ComponentKind::Ctc {
        complaints.other_kind(component);
        return (System::default(), complaints.diagnostics);
    }
    unsayable::refuse(component, functions, constants, &mut complaints);
    let names = Names::of(component);
    let mut expressions = Expressions::new(component.dialect);
    // In the order of the definition.
    let mut system = System {
        name: &component.name.value,
        documentation: &component.documentation,
        hints: hints::hints(component, functions, constants, &mut expressions, &mut complaints),
        ..System::default()
    };
    for constant in constants.iter().chain(&component.parameters) {
        system
            .constants
            .push((constant.name.value.as_str(), expressions.constant(&constant.value, &mut complaints)));
    }
    for variable in &component.variables {
        if names.states.contains(variable.name.value.as_str()) {
            system.states.push((&variable.name.value, &variable.documentation));
        }
        complaints.remark_on(variable, &names);
    }
    for port in component.ports.iter().filter(|port| !is_event(port)) {
        match port.direction {
            Direction::Input => system.inputs.push((&port.name.value, &port.documentation)),
            _ => system.outputs.push((&port.name.value, &port.documentation)),
        }
    }
    system.locations = locations::locations(component, &names, &mut expressions, &mut complaints);
    if component.dialect == Dialect::Hsml {
        complaints.remark_on_events(component, &system.locations);
    }
    (system, complaints.diagnostics)
}
