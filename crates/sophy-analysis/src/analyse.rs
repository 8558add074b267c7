use crate::assemble::assemble;
use crate::checks;
use crate::declarations::{Declarations, ExpressionText};
use crate::findings::Findings;
use crate::lower::{
    Context, LoweredLocation, Strays, lower_definitions, lower_initial_values, lower_location,
};
use crate::names::Names;
use sophy_diagnostics::Diagnostics;
use sophy_ir::{Graph, Model};

/// Finds all mistakes of a system, and makes a model of it if there are none.
///
/// Mistakes of grammar, empty names and missing guards are the reader's to report, who knows the file: no
/// model is made from them, but nothing is said of them here.
pub fn analyse(declarations: &Declarations) -> (Option<Model>, Diagnostics) {
    let mut findings = Findings::default();
    let mut graph = Graph::default();

    // Names, then what holds everywhere, then location by location.
    let (names, repeated) = Names::collect(declarations);
    for repeated in &repeated {
        findings.report(checks::hs0107_declared_twice::diagnostic(repeated));
    }
    let definitions = lower_definitions(declarations, &names, &mut graph, &mut findings);
    let mut context = Context {
        names: &names,
        functions: &definitions.functions,
        constants: &definitions.values,
        findings: &mut findings,
    };
    let initial = lower_initial_values(declarations, &mut graph, &mut context);
    let mut strays = Strays::default();
    let locations: Vec<LoweredLocation> = (0..declarations.locations.len())
        .map(|position| lower_location(declarations, position, &mut graph, &mut context, &mut strays))
        .collect();

    // What no single expression shows.
    let Findings { mut diagnostics, unknown_names, logarithms, .. } = findings;
    let mut suggested = checks::hs0101_unknown_name::find(&unknown_names, &names, &mut diagnostics);
    checks::hs0201_unknown_function::find(&unknown_names, &names, &mut diagnostics);
    checks::hs0206_natural_logarithm::find(&logarithms, &mut diagnostics);
    let meant_states =
        checks::hs0102_equation_for_undeclared_state::find(declarations, &strays, &names, &mut diagnostics);
    checks::hs0103_reset_of_undeclared_state::find(declarations, &strays, &names, &mut diagnostics);
    let meant_outputs =
        checks::hs0104_map_for_undeclared_output::find(declarations, &strays, &names, &mut diagnostics);
    checks::hs0106_unit_for_unknown_name::find(declarations, &names, &mut diagnostics);
    checks::hs0109_output_without_map::find(declarations, &names, &meant_outputs, &mut diagnostics);
    checks::hs0110_state_without_equation::find(declarations, &names, &meant_states, &mut diagnostics);
    checks::hs0112_location_declared_twice::find(declarations, &mut diagnostics);
    checks::hs0113_transition_declared_twice::find(declarations, &mut diagnostics);
    checks::hs0114_unknown_destination::find(declarations, &mut diagnostics);
    checks::hs0115_unknown_initial_location::find(declarations, &mut diagnostics);
    checks::hs0116_unreachable_location::find(declarations, &locations, &graph, &mut diagnostics);
    checks::hs0117_hidden_name::find(declarations, &names, &mut diagnostics);
    suggested.extend(meant_states.into_iter().map(|(_, name)| name));
    checks::hs0118_unused::find(declarations, &names, &suggested, &mut diagnostics);
    checks::hs0119_no_location::find(declarations, &mut diagnostics);
    checks::hs0401_constant_guard::find(declarations, &locations, &graph, &mut diagnostics);
    checks::hs0402_taken_on_entry::find(declarations, &locations, &mut graph, &mut diagnostics);

    let well_formed = expressions(declarations).all(|text| text.parse.errors().is_empty());
    let model = if diagnostics.has_errors() || !well_formed {
        None
    } else {
        assemble(declarations, &names, &definitions.constants, &initial, locations, graph)
    };
    (model, diagnostics)
}

/// All expressions of a system.
pub(crate) fn expressions(declarations: &Declarations) -> impl Iterator<Item = &ExpressionText> {
    let d = declarations;
    let everywhere = d.constants.iter().map(|c| &c.value).chain(d.functions.iter().map(|f| &f.body));
    let of_locations = d.locations.iter().flat_map(|location| {
        let equations = location.dynamics.iter().chain(&location.outputs).map(|e| &e.right);
        let of_transitions = location
            .transitions
            .iter()
            .flat_map(|t| t.guard.iter().chain(t.resets.iter().map(|reset| &reset.right)));
        equations.chain(of_transitions)
    });
    everywhere.chain(d.initial.iter().map(|e| &e.right)).chain(of_locations)
}
