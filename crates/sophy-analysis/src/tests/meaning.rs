//! What expressions are worth, compared with plain Rust.

use crate::testing::{check_model, model_of};
use proptest::prelude::*;
use sophy_ir::{Leaf, Model, Value, VariableId, VariableKind, evaluate};

/// The value of `expression` as the equation of a state, given states `x` and `y` and a boolean-valued output.
fn value(expression: &str, x: f64, y: f64) -> f64 {
    let text = format!(
        "constant two = 2
         constant four = two*two
         function square(a) = a*a
         function distance(a, b) = sqrt(square(a) + square(b))
         function inside(a) = a > 0 and a < four
         state x
         state y
         state z
         output positive
         output twice
         location A
           der x = 0
           der y = 0
           out twice = 2*positive
           out positive = x > 0
           der z = {expression}"
    );
    let (sources, declarations) = crate::testing::read(&text);
    let (model, diagnostics) = crate::testing::analysed(&sources, &declarations);
    let model = model.unwrap_or_else(|| panic!("{expression}: {diagnostics:?}"));
    evaluate_equation(&model, 2, x, y)
}

fn evaluate_equation(model: &Model, position: usize, x: f64, y: f64) -> f64 {
    let equation = &crate::testing::automaton(model).locations[0].dynamics[position];
    evaluate(&model.root().graph, equation.right, &mut |leaf| Value::Real(leaf_value(model, leaf, x, y)))
        .real()
}

fn leaf_value(model: &Model, leaf: Leaf, x: f64, y: f64) -> f64 {
    match leaf {
        Leaf::Time => 7.0,
        Leaf::Variable(id) => match (model.root().variable(id).name.as_str(), model.root().variable(id).kind)
        {
            ("x", _) => x,
            ("y", _) => y,
            (_, VariableKind::Parameter { value, .. }) => {
                evaluate(&model.root().graph, value, &mut |leaf| Value::Real(leaf_value(model, leaf, x, y)))
                    .real()
            }
            (_, VariableKind::Output) => {
                let location = &crate::testing::automaton(model).locations[0];
                let map = location.values.iter().find(|equation| equation.variable == id).expect("a map");
                evaluate(&model.root().graph, map.right, &mut |leaf| {
                    Value::Real(leaf_value(model, leaf, x, y))
                })
                .real()
            }
            (name, kind) => panic!("{name} {kind:?} has no value"),
        },
        other => panic!("{other:?} in a model"),
    }
}

#[test]
fn predefined_functions() {
    for (expression, expected) in [
        ("ceil(x)", 3.0),
        ("ceil(-x)", -2.0),
        ("floor(-x)", -3.0),
        ("min(x, y, 1)", -3.0),
        ("max(1, y, x, 2)", 2.5),
        ("sat(x)", 1.0),
        ("sat(y)", -1.0),
        ("sat(0.25)", 0.25),
        ("sat(x, -2, 2)", 2.0),
        ("sat(y, -2, 2)", -2.0),
        ("mod(x, y)", -0.5),
        ("mod(y, x)", 2.0),
        ("mod(-7, 3)", 2.0),
        ("rem(x, y)", 2.5),
        ("rem(y, x)", -0.5),
        ("rem(-7, 3)", -1.0),
        ("hypot(3, 4)", 5.0),
        ("pow(x, 2)", 6.25),
        ("x^2^0.5*0 + -y^2", -9.0),
        ("2^-1", 0.5),
        ("sign(y) + abs(y)", 2.0),
        ("ln(exp(2))", 2.0),
        ("log10(1000)", 3.0),
        ("atan2(0, -1) - pi", 0.0),
        ("time", 7.0),
        ("two + four", 6.0),
        ("distance(3, 4)", 5.0),
        ("square(square(two))", 16.0),
        ("if inside(x) then 10 else 20", 10.0),
        ("if inside(y) then 10 else 20", 20.0),
    ] {
        let found = value(expression, 2.5, -3.0);
        assert!((found - expected).abs() < 1e-14, "{expression}: {found} instead of {expected}");
    }
}

#[test]
fn a_condition_counts_as_one_or_zero() {
    assert_eq!(value("(x > 0) + (y > 0)*10", 1.0, 1.0), 11.0);
    assert_eq!(value("(x > 0) + (y > 0)*10", 1.0, -1.0), 1.0);
    assert_eq!(value("-inside(x)", 1.0, 0.0), -1.0);
    assert_eq!(value("square(x > 0)", 1.0, 0.0), 1.0);
    assert_eq!(value("x > 0", 1.0, 0.0), 1.0);
}

#[test]
fn equality_of_conditions() {
    for (x, y) in [(1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)] {
        let same = f64::from(u8::from((x > 0.0) == (y > 0.0)));
        assert_eq!(value("(x > 0) = (y > 0)", x, y), same);
        assert_eq!(value("(x > 0) <> (y > 0)", x, y), 1.0 - same);
    }
}

#[test]
fn outputs_are_read_through_their_maps_in_any_order() {
    assert_eq!(value("twice + positive", 3.0, 0.0), 3.0);
    assert_eq!(value("twice + positive", -3.0, 0.0), 0.0);
}

#[test]
fn a_declared_name_is_meant_before_a_predefined_one() {
    let model = check_model(
        "constant pi = 3
         function sin(a) = 10*a
         state x
         location A
           der x = sin(pi)",
        "warning[HS0117] line 1 `pi`: `pi` hides the predefined `pi` (declared as a constant)
           help: rename it, if only for the reader's sake
         warning[HS0117] line 2 `sin`: `sin` hides the predefined `sin` (declared as a function)
           help: rename it, if only for the reader's sake",
    );
    assert_eq!(evaluate_equation(&model, 0, 0.0, 0.0), 30.0);
}

#[test]
fn constants_are_parameters_over_parameters() {
    let model = model_of(
        "constant c = 2*b
         constant b = a + 1
         constant a = 4
         unit a = kg
         initial x = c
         state x
         location A
           der x = c",
    );
    let VariableKind::State(Some(initial)) = model.root().variables[3].kind else {
        panic!("x starts somewhere")
    };
    let start =
        evaluate(&model.root().graph, initial, &mut |leaf| Value::Real(leaf_value(&model, leaf, 0.0, 0.0)));
    assert_eq!(start, Value::Real(10.0));
    let right = crate::testing::automaton(&model).locations[0].dynamics[0].right;
    let leaves: Vec<Leaf> = model.root().graph.dependencies([right]).into_iter().collect();
    assert_eq!(
        leaves,
        [Leaf::Variable(VariableId(2))],
        "a constant is not inlined: an experiment may set it"
    );
    assert_eq!(model.root().variables[0].unit.as_deref(), Some("kg"));
}

/// An arithmetic expression, with its value in plain Rust.
fn arithmetic() -> impl Strategy<Value = (String, fn(f64, f64) -> f64)> {
    prop::sample::select(vec![
        ("x + y*2 - x/4".to_owned(), (|x, y| x + y * 2.0 - x / 4.0) as fn(f64, f64) -> f64),
        ("x - y - 3".to_owned(), |x, y| x - y - 3.0),
        ("x/y/2".to_owned(), |x, y| x / y / 2.0),
        ("-x^2 + (-x)^2".to_owned(), |x, _| -(x * x) + (-x) * (-x)),
        ("2*-x".to_owned(), |x, _| 2.0 * -x),
        ("if x < y then x else y".to_owned(), |x, y| if x < y { x } else { y }),
        ("if not x < y or y > 1 and x > 1 then 1 else 2".to_owned(), |x, y| {
            if x >= y || (y > 1.0 && x > 1.0) { 1.0 } else { 2.0 }
        }),
        ("abs(x) + sqrt(y*y)".to_owned(), |x, y| x.abs() + (y * y).sqrt()),
        ("max(x, y) - min(x, y)".to_owned(), |x, y| if x < y { y - x } else { x - y }),
        ("mod(x, 3)".to_owned(), |x, _| x - 3.0 * (x / 3.0).floor()),
        ("rem(x, 3)".to_owned(), |x, _| x - 3.0 * (x / 3.0).trunc()),
        ("ceil(x)".to_owned(), |x, _| x.ceil()),
    ])
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]
    #[test]
    fn expressions_are_worth_what_rust_says(
        (text, meaning) in arithmetic(), x in -10.0..10.0f64, y in 0.5..10.0f64,
    ) {
        prop_assert_eq!(value(&text, x, y), meaning(x, y), "{}", text);
    }
}
