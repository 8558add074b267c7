//! One file per check: what is wrong, why it matters to a modeller, and the way out.
//!
//! `HS01…` is about names and what is declared, `HS02…` about single expressions, `HS03…` about definitions that
//! go round in a circle, `HS04…` about transitions that hardly mean what they say.
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
pub(crate) mod hs0201_unknown_function;
pub(crate) mod hs0202_wrong_number_of_arguments;
pub(crate) mod hs0203_number_as_condition;
pub(crate) mod hs0204_equality;
pub(crate) mod hs0205_division_by_zero;
pub(crate) mod hs0206_natural_logarithm;
pub(crate) mod hs0207_not_available;
pub(crate) mod hs0208_function_without_arguments;
pub(crate) mod hs0301_circular_constants;
pub(crate) mod hs0302_recursive_function;
pub(crate) mod hs0303_algebraic_loop;
pub(crate) mod hs0304_too_large;
pub(crate) mod hs0401_constant_guard;
pub(crate) mod hs0402_taken_on_entry;
mod places;
mod suggestion;

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
    (hs0117_hidden_name::CODE, "a declared name hides a predefined one"),
    (hs0118_unused::CODE, "a constant or input is not used"),
    (hs0119_no_location::CODE, "a system has no location"),
    (hs0201_unknown_function::CODE, "something is called that is not a function"),
    (hs0202_wrong_number_of_arguments::CODE, "a function is called with the wrong number of arguments"),
    (hs0203_number_as_condition::CODE, "a number stands where a condition is needed"),
    (hs0204_equality::CODE, "quantities that vary continuously are compared for equality"),
    (hs0205_division_by_zero::CODE, "a division by zero"),
    (hs0206_natural_logarithm::CODE, "`log` is the natural logarithm"),
    (hs0207_not_available::CODE, "a quantity is used where it has no value"),
    (hs0208_function_without_arguments::CODE, "a function is used without arguments"),
    (hs0301_circular_constants::CODE, "constants define one another"),
    (hs0302_recursive_function::CODE, "a function calls itself"),
    (hs0303_algebraic_loop::CODE, "outputs define one another"),
    (hs0304_too_large::CODE, "functions multiply the model beyond bounds"),
    (hs0401_constant_guard::CODE, "a guard is always true or always false"),
    (hs0402_taken_on_entry::CODE, "a transition is taken the instant its location is entered"),
];

#[cfg(test)]
mod tests {
    use super::CODES;

    #[test]
    fn codes_are_in_order_and_stand_once() {
        assert!(CODES.windows(2).all(|pair| pair[0].0 < pair[1].0));
    }
}
