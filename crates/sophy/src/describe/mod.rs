//! What there is to know of a model without running it.

mod automata;
mod clocks;
mod components;
mod coupling;
mod index;
mod quantities;
#[cfg(test)]
mod tests;

pub use automata::{AutomatonDescription, LocationDescription, Reaction, TransitionDescription};
pub use clocks::ClockDescription;
pub use components::ComponentDescription;
pub use coupling::{Dependency, Knot, Sparsity};
pub use quantities::Quantity;

use crate::error::Error;
use automata::automata;
use clocks::clocks;
use components::Census;
use coupling::Coupling;
use quantities::Values;
use serde::Serialize;
use sophy_ir::{Model, System};

/// What there is to know of a model without running it.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Description {
    /// Name of the model.
    pub name: String,
    /// What it is, in the author's words.
    pub documentation: String,
    /// The components as a tree, in written order, each before its members; copies and elements of an array are one.
    pub components: Vec<ComponentDescription>,
    /// Continuous states with their initial values.
    pub states: Vec<Quantity>,
    /// What changes at instants only, with the initial values.
    pub modes: Vec<Quantity>,
    /// Inputs.
    pub inputs: Vec<Quantity>,
    /// Outputs.
    pub outputs: Vec<Quantity>,
    /// Variables that are shown though they are no outputs.
    pub views: Vec<Quantity>,
    /// Parameters, knobs among them, with their values.
    pub constants: Vec<Quantity>,
    /// What has locations, event sections or rules, once for all copies.
    pub automata: Vec<AutomatonDescription>,
    /// What executes at instants it announces, once for all copies.
    pub clocks: Vec<ClockDescription>,
    /// The coupling matrix D (thesis §3.2.2), row by row; empty if it is too dense to be written out.
    pub dependencies: Vec<Dependency>,
    /// How full D is; `None` if it is too dense to be counted.
    pub sparsity: Option<Sparsity>,
    /// Continuous quantities each of which depends on all others of its knot, the largest knot first.
    pub knots: Vec<Knot>,
    /// Index of the differential-algebraic equations: 0 without constraints, 1, or 2 for "2 or more", by structure.
    pub index: u8,
    /// Quantities whose sign changes are located.
    pub watches: Vec<WatchDescription>,
    /// How large the model is.
    pub sizes: Sizes,
    /// What this version checks but cannot run, a sentence each.
    pub awaits: Vec<String>,
}

/// A quantity whose sign changes are located.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct WatchDescription {
    /// The quantity, as text.
    pub quantity: String,
    /// Whether it is affine in states, inputs and time.
    pub affine: bool,
}

/// How large a model is, all copies counted.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Sizes {
    /// Components of which the whole consists, composites included.
    pub components: u64,
    /// Locations that were written.
    pub locations: u64,
    /// Transitions of components, event sections not counted.
    pub transitions: u64,
    /// Quantities that are not states and that equations read.
    pub algebraics: u64,
    /// Distinct expressions, all parts counted.
    pub expressions: u64,
}

/// Describes a model.
///
/// # Errors
/// [`Error::Composition`] if the model is no system.
pub fn describe(model: &Model) -> Result<Description, Error> {
    let system = sophy_passes::lower(model)?;
    let census = Census::new(model);
    let values = Values::new(model, &system);
    let coupling = Coupling::new(&system);
    let states = |discrete: bool| system.states.iter().filter(move |state| state.discrete == discrete);
    let outputs = |view: bool| system.outputs.iter().filter(move |output| output.view == view);
    let rows = coupling.rows();
    Ok(Description {
        name: model.name().to_owned(),
        documentation: model.classes.get(model.root.0 as usize).map_or("", |c| &c.documentation).to_owned(),
        states: states(false).map(|state| values.state(&state)).collect(),
        modes: states(true).map(|state| values.state(&state)).collect(),
        inputs: system.inputs.iter().map(|input| values.input(input)).collect(),
        outputs: outputs(false).map(|output| values.output(&output)).collect(),
        views: outputs(true).map(|output| values.output(&output)).collect(),
        constants: values.constants(),
        automata: automata(model, &census, &system),
        clocks: clocks(model, &census, &values),
        sparsity: rows.as_ref().map(|rows| coupling.sparsity(rows)),
        dependencies: rows.map(|rows| coupling.dependencies(&rows)).unwrap_or_default(),
        knots: coupling.knots(),
        index: model.classes.iter().map(index::index).max().unwrap_or(0),
        watches: watches(&system),
        sizes: sizes(model, &census, &system),
        awaits: system.awaits.iter().map(ToString::to_string).collect(),
        components: census.components,
    })
}

fn watches(system: &System) -> Vec<WatchDescription> {
    let described =
        |w: sophy_ir::Watch| WatchDescription { quantity: system.text(w.difference), affine: w.affine };
    system.watches.iter().map(described).collect()
}

fn sizes(model: &Model, census: &Census, system: &System) -> Sizes {
    let mut sizes = Sizes {
        algebraics: system.algebraics.len() as u64,
        expressions: system.graph.len() as u64,
        ..Sizes::default()
    };
    for (class, of_class) in model.classes.iter().zip(&census.of_class) {
        sizes.components += of_class.copies;
        if let sophy_ir::Body::Automaton(automaton) = &class.body {
            let transitions: usize =
                automaton.locations.iter().map(|location| location.transitions.len()).sum();
            let written = automaton.locations.iter().filter(|location| !location.name.is_empty()).count();
            sizes.locations += of_class.copies * written as u64;
            sizes.transitions += of_class.copies * transitions as u64;
        }
    }
    // The whole is none of its parts.
    sizes.components = sizes.components.saturating_sub(1);
    sizes
}
