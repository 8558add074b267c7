//! One file per check: what is wrong, why it matters to a modeller, and the way out.
//!
//! `HS01…` is about names and what is declared, `HS02…` about single expressions, `HS03…` about definitions that
//! go round in a circle, `HS040…` about transitions that hardly mean what they say, `HS041…` about connections.
//!
//! A check is a function `diagnostic` from a fact to the message. Where the fact is not met on the way but has
//! to be looked for, `find` does that.

pub(crate) mod hs0101_unknown_name;
pub(crate) mod hs0102_equation_for_undeclared_state;
pub(crate) mod hs0103_reset_of_undeclared_state;
pub(crate) mod hs0104_map_for_undeclared_output;
pub(crate) mod hs0105_unknown_initial_value;
pub(crate) mod hs0106_unit_for_unknown_name;
pub(crate) mod hs0107_declared_twice;
pub(crate) mod hs0108_defined_twice;
pub(crate) mod hs0109_output_without_map;
pub(crate) mod hs0110_state_without_equation;
pub(crate) mod hs0111_output_differs_from_state;
pub(crate) mod hs0112_location_declared_twice;
pub(crate) mod hs0113_transition_declared_twice;
pub(crate) mod hs0114_unknown_destination;
pub(crate) mod hs0115_unknown_initial_location;
pub(crate) mod hs0116_unreachable_location;
pub(crate) mod hs0117_hidden_name;
pub(crate) mod hs0118_unused;
pub(crate) mod hs0119_no_location;
pub(crate) mod hs0120_unknown_type;
pub(crate) mod hs0121_extent;
pub(crate) mod hs0122_unit;
pub(crate) mod hs0123_knob_without_value;
pub(crate) mod hs0124_unknown_view;
pub(crate) mod hs0125_type_does_not_suit;
pub(crate) mod hs0126_out_of_range;
pub(crate) mod hs0127_declaration_for_another_kind;
pub(crate) mod hs0128_port_differs;
pub(crate) mod hs0129_not_defined_by_equations;
pub(crate) mod hs0130_branches_differ;
pub(crate) mod hs0131_loop_bounds;
pub(crate) mod hs0132_unknown_event;
pub(crate) mod hs0133_not_assignable;
pub(crate) mod hs0134_hold_without_flag;
pub(crate) mod hs0135_index;
pub(crate) mod hs0136_event_section;
pub(crate) mod hs0137_no_clock;
pub(crate) mod hs0138_unknown_component;
pub(crate) mod hs0139_unknown_parameter;
pub(crate) mod hs0140_array_of_components;
pub(crate) mod hs0141_import;
pub(crate) mod hs0142_no_component;
pub(crate) mod hs0143_local_without_equation;
pub(crate) mod hs0144_flag_without_event;
pub(crate) mod hs0145_constrained;
pub(crate) mod hs0146_assigned_by_two;
pub(crate) mod hs0147_read_before_assigned;
pub(crate) mod hs0148_of_another_location;
pub(crate) mod hs0149_name_with_a_bracket;
pub(crate) mod hs0201_unknown_function;
pub(crate) mod hs0202_wrong_number_of_arguments;
pub(crate) mod hs0203_number_as_condition;
pub(crate) mod hs0204_equality;
pub(crate) mod hs0205_division_by_zero;
pub(crate) mod hs0206_natural_logarithm;
pub(crate) mod hs0207_not_available;
pub(crate) mod hs0208_function_without_arguments;
pub(crate) mod hs0209_units;
pub(crate) mod hs0210_wrong_kind;
pub(crate) mod hs0211_shape;
pub(crate) mod hs0212_index;
pub(crate) mod hs0213_not_known;
pub(crate) mod hs0214_choices;
pub(crate) mod hs0215_file;
pub(crate) mod hs0216_reduction_of_nothing;
pub(crate) mod hs0217_no_such_part;
pub(crate) mod hs0218_derivative;
pub(crate) mod hs0219_two_events;
pub(crate) mod hs0220_wrong_argument;
pub(crate) mod hs0301_circular_constants;
pub(crate) mod hs0302_recursive_function;
pub(crate) mod hs0303_algebraic_loop;
pub(crate) mod hs0304_too_large;
pub(crate) mod hs0401_constant_guard;
pub(crate) mod hs0402_taken_on_entry;
pub(crate) mod hs0403_round_without_time;
pub(crate) mod hs0410_unknown_port;
pub(crate) mod hs0411_connection_direction;
pub(crate) mod hs0412_connected_units;
pub(crate) mod hs0413_driven_twice;
pub(crate) mod hs0414_not_connected;
pub(crate) mod hs0415_connected_types;
pub(crate) mod hs0416_connected_shapes;
pub(crate) mod hs0417_composition_matrix;
pub(crate) mod hs0418_connected_ranges;
pub(crate) mod places;
pub(crate) mod suggestion;
mod words;

use sophy_diagnostics::Code;

/// Every code of this crate with the kind of mistake it names.
pub const CODES: &[(Code, &str)] = &[
    (hs0101_unknown_name::CODE, "an expression uses a name that is not declared"),
    (hs0102_equation_for_undeclared_state::CODE, "an equation for something that is not a state"),
    (hs0103_reset_of_undeclared_state::CODE, "a reset of something that is not a state"),
    (hs0104_map_for_undeclared_output::CODE, "a map for something that is not an output"),
    (hs0105_unknown_initial_value::CODE, "an initial value of something that is not a state"),
    (hs0106_unit_for_unknown_name::CODE, "a unit for a name that is not declared"),
    (hs0107_declared_twice::CODE, "a name is declared twice"),
    (hs0108_defined_twice::CODE, "a quantity is defined twice"),
    (hs0109_output_without_map::CODE, "an output is not defined in a location"),
    (hs0110_state_without_equation::CODE, "a state has no equation"),
    (hs0111_output_differs_from_state::CODE, "an output with the name of a state is something else"),
    (hs0112_location_declared_twice::CODE, "two locations have one name"),
    (hs0113_transition_declared_twice::CODE, "two transitions of a location have one name"),
    (hs0114_unknown_destination::CODE, "a transition leads to a location that does not exist"),
    (hs0115_unknown_initial_location::CODE, "the first location does not exist"),
    (hs0116_unreachable_location::CODE, "no transition leads to a location"),
    (hs0117_hidden_name::CODE, "a declared name hides another one"),
    (hs0118_unused::CODE, "a constant or input is not used"),
    (hs0119_no_location::CODE, "a system has no location"),
    (hs0120_unknown_type::CODE, "a type that does not exist"),
    (hs0121_extent::CODE, "an extent that is no number of elements"),
    (hs0122_unit::CODE, "a unit that cannot be read or converted"),
    (hs0123_knob_without_value::CODE, "a knob has no value"),
    (hs0124_unknown_view::CODE, "a view of something that is not a variable"),
    (hs0125_type_does_not_suit::CODE, "a type does not suit what has it"),
    (hs0126_out_of_range::CODE, "a value outside its range"),
    (hs0127_declaration_for_another_kind::CODE, "a section or declaration of another kind of component"),
    (hs0128_port_differs::CODE, "an output differs from the variable of its name"),
    (hs0129_not_defined_by_equations::CODE, "an equation for something that equations do not define"),
    (hs0130_branches_differ::CODE, "branches of an equation define different variables"),
    (hs0131_loop_bounds::CODE, "a loop that does not run, or too often"),
    (hs0132_unknown_event::CODE, "an event label that the interface does not have"),
    (hs0133_not_assignable::CODE, "an assignment to something that cannot be assigned"),
    (hs0134_hold_without_flag::CODE, "`hold` without a flag"),
    (hs0135_index::CODE, "an index outside a vector or matrix"),
    (hs0136_event_section::CODE, "an event section without a flag or without a direction"),
    (hs0137_no_clock::CODE, "a discrete-time component does not say when it executes"),
    (hs0138_unknown_component::CODE, "a component that does not exist or contains itself"),
    (hs0139_unknown_parameter::CODE, "a parameter that the component does not have"),
    (hs0140_array_of_components::CODE, "an array of components that is none"),
    (hs0141_import::CODE, "a file cannot be imported"),
    (hs0142_no_component::CODE, "it is not clear what a run is started on"),
    (hs0143_local_without_equation::CODE, "a local, flag or output has no equation"),
    (hs0144_flag_without_event::CODE, "nothing listens to a flag"),
    (hs0145_constrained::CODE, "more constraints than unknowns"),
    (hs0146_assigned_by_two::CODE, "a variable may be assigned twice at one instant"),
    (hs0147_read_before_assigned::CODE, "a local is read before it is assigned"),
    (hs0148_of_another_location::CODE, "a name that another location declares for itself"),
    (hs0149_name_with_a_bracket::CODE, "a name contains a bracket or a point"),
    (hs0201_unknown_function::CODE, "something is called that is not a function"),
    (hs0202_wrong_number_of_arguments::CODE, "a function is called with the wrong number of arguments"),
    (hs0203_number_as_condition::CODE, "a number stands where a condition is needed"),
    (hs0204_equality::CODE, "quantities that vary continuously are compared for equality"),
    (hs0205_division_by_zero::CODE, "a division by zero"),
    (hs0206_natural_logarithm::CODE, "`log` is the natural logarithm"),
    (hs0207_not_available::CODE, "a quantity is used where it has no value"),
    (hs0208_function_without_arguments::CODE, "a function is used without arguments"),
    (hs0209_units::CODE, "quantities in different units are combined"),
    (hs0210_wrong_kind::CODE, "a value of the wrong kind: number, truth value or text"),
    (hs0211_shape::CODE, "vectors and matrices that do not fit"),
    (hs0212_index::CODE, "an index that does not exist"),
    (hs0213_not_known::CODE, "a value that must be known before a run"),
    (hs0214_choices::CODE, "a text that a variable cannot be"),
    (hs0215_file::CODE, "a table or data file that cannot be used"),
    (hs0216_reduction_of_nothing::CODE, "the smallest or largest of nothing"),
    (hs0217_no_such_part::CODE, "a part that something does not have"),
    (hs0218_derivative::CODE, "`der` on a right-hand side"),
    (hs0219_two_events::CODE, "two events at once"),
    (hs0220_wrong_argument::CODE, "an argument that a predefined function cannot use"),
    (hs0301_circular_constants::CODE, "constants define one another"),
    (hs0302_recursive_function::CODE, "a function calls itself"),
    (hs0303_algebraic_loop::CODE, "outputs define one another"),
    (hs0304_too_large::CODE, "functions multiply the model beyond bounds"),
    (hs0401_constant_guard::CODE, "a guard is always true or always false"),
    (hs0402_taken_on_entry::CODE, "a transition is taken the instant its location is entered"),
    (hs0403_round_without_time::CODE, "transitions lead round in a circle without time passing"),
    (hs0410_unknown_port::CODE, "a connection to a port or component that does not exist"),
    (hs0411_connection_direction::CODE, "a connection against the direction of its ports"),
    (hs0412_connected_units::CODE, "connected quantities have different units"),
    (hs0413_driven_twice::CODE, "a port is fed twice"),
    (hs0414_not_connected::CODE, "a port is not connected"),
    (hs0415_connected_types::CODE, "connected ports have different types"),
    (hs0416_connected_shapes::CODE, "connected ports have different shapes"),
    (hs0417_composition_matrix::CODE, "a composition matrix does not fit"),
    (hs0418_connected_ranges::CODE, "a connection can leave the range of its target"),
];

#[cfg(test)]
mod tests {
    use super::CODES;

    #[test]
    fn codes_are_in_order_and_stand_once() {
        assert!(CODES.windows(2).all(|pair| pair[0].0 < pair[1].0));
    }
}
