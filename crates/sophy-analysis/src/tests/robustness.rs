//! Whatever is declared, the analysis ends, and a model exists only without errors.

use crate::testing::{diagnostics_of, read};
use proptest::prelude::*;

#[test]
fn the_deepest_expression_fits_on_a_small_stack() {
    let deep = format!("{}x{}", "(1 < 1 or not 1 + 1*-".repeat(40), ")".repeat(40));
    let text = format!("state x\nlocation A\n der x = {deep}");
    let small = std::thread::Builder::new().stack_size(1 << 20);
    let thread = small.spawn(move || diagnostics_of(&text).len()).expect("a thread");
    assert!(thread.join().is_ok());
}

#[test]
fn a_long_sum_costs_no_stack() {
    let text = format!("state x\nlocation A\n der x = x{}", " + 2*x".repeat(20_000));
    assert!(diagnostics_of(&text).is_empty());
}

fn line() -> impl Strategy<Value = String> {
    let name = || prop::sample::select(vec!["a", "b", "f", "x", "time", "sin", ""]);
    let expression = || {
        prop::sample::select(vec![
            "",
            "0",
            "a",
            "b + x",
            "f(a)",
            "f(b, x)",
            "1/0",
            "x = 1",
            "x < 1",
            "a <",
            "(x",
            "if x then a else b",
            "sin",
            "f",
            "x(1)",
            "time",
            "false",
            "b and x",
            "log(x)",
        ])
    };
    prop_oneof![
        (name(), expression()).prop_map(|(n, e)| format!("constant {n} = {e}")),
        (name(), name(), expression()).prop_map(|(n, p, e)| format!("function {n}({p}) = {e}")),
        name().prop_map(|n| format!("state {n}")),
        name().prop_map(|n| format!("input {n}")),
        name().prop_map(|n| format!("output {n}")),
        (name(), expression()).prop_map(|(n, e)| format!("initial {n} = {e}")),
        name().prop_map(|n| format!("start {n}")),
        name().prop_map(|n| format!("unit {n} = m")),
        (name(), name(), expression(), expression(), name()).prop_map(|(l, n, e, g, d)| {
            format!("location {l}\nder {n} = {e}\nout {n} = {e}\ntransition {n} when {g} goto {d}\nreset {n} = {e}")
        }),
    ]
}

proptest! {
    #[test]
    fn any_declarations_are_analysed(lines in prop::collection::vec(line(), 0..12)) {
        let (sources, declarations) = read(&lines.join("\n"));
        let (model, diagnostics) = crate::testing::analysed(&sources, &declarations);
        prop_assert!(model.is_none() || !diagnostics.has_errors());
        if let Some(model) = model {
            let component = crate::testing::automaton(&model);
            prop_assert!(component.initial_location < component.locations.len());
            for transition in component.locations.iter().flat_map(|location| &location.transitions) {
                prop_assert!(transition.destination < component.locations.len());
            }
        }
    }
}
