use super::*;

fn check_with(declarations: &str, table: &[(&str, &str)]) {
    for (expression, expected) in table {
        let lowered = lower_at(Place::INSTANT, declarations, expression, &MemoryWorld::default());
        assert_eq!(lowered.text(), *expected, "{expression}");
    }
}

const EULER: &str = "
    constant g = 9.81;
    constant weights = [1, 2, 3];
    constant name = \"idle\";
    function sat3(x, lo, hi) = min(max(x, lo), hi);
    function twice(x) = sat3(x, 0, g)*2;
    function turn(th : real[2]) : real[2,2] = [[cos(th[1]), 0], [th[2], 1]];
    function pick(v : real[3], j : integer) = v[j];
    function both(a : boolean, b : boolean) : boolean = a and b;
    function ratio(a, b) = a/b;
    function equal(a, b) = if a = b then 1 else 0;
    function add(a, b) = a + b;
";

#[test]
fn calls_are_written_out() {
    check_with(
        EULER,
        &[
            ("g*weights[2]", "19.62"),
            ("phase = name", "phase = 0"),
            ("sat3(z, 0, 1)", "min(max(z, 0), 1)"),
            ("twice(z)", "min(max(z, 0), 9.81) * 2"),
            ("turn([z, w])*[1, x]", "cos(z); w + x"),
            ("pick(q, 2) + pick([1, 2, 3], n)", "q[2] + 3"),
            ("both(on, z > 1)", "on > 0.5 and z > 1"),
            ("equal(i, 2)", "if i = 2 then 1 else 0"),
        ],
    );
}

#[test]
fn arguments_must_fit() {
    check_with(
        EULER,
        &[
            (
                "sat3(z, 0)",
                "HS0202 sat3: `sat3` cannot be called with 2 arguments | sat3: declared here | help: call it as \
             `sat3(x, lo, hi)`",
            ),
            (
                "turn(z)",
                "HS0211 z: parameter `th` of `turn` is a vector of 2, but its value is a single value | th: a vector \
             of 2 | help: for the same number everywhere write `(…)*ones(2)`",
            ),
            (
                "twice(q)",
                "HS0211 q: parameter `x` of `twice` is a single value, but its value is a vector of 3 | x: a single \
             value",
            ),
            (
                "both(on, 1)",
                "HS0210 1: parameter `b` of `both` is a truth value, but its value is a whole number | b: a truth \
             value | help: write `true` or `false`, or compare: `… > 0`",
            ),
            (
                "pick(q, z)",
                "HS0210 z: parameter `j` of `pick` is a whole number, but its value is a real number | j: a whole \
             number | help: round it: `floor(…)`, `floor(… + 0.5)`",
            ),
        ],
    );
}

#[test]
fn mistakes_that_arguments_cause_are_reported_at_the_call() {
    check_with(
        EULER,
        &[
            (
                "ratio(z, 0)",
                "HS0205 ratio: in this call of `ratio`: division by `b`, which is 0 | b: here | help: divide by \
             something that is not 0",
            ),
            (
                "add(x, y)",
                "HS0209 add: in this call of `add`: quantities in `m` and `ft` are added | a: \"m\" | b: \"ft\" | note: \
             1 ft = 0.3048 m | help: convert one of them, or declare both in one unit",
            ),
            (
                "pick(q, 4)",
                "HS0212 pick: in this call of `pick`: index 4 is out of bounds: `v` is a vector of 3 | j: here | help: \
             its indices go from 1 to 3",
            ),
            (
                "equal(z, w)",
                "HS0204 equal: in this call of `equal`: `a = b` asks for equality of what varies continuously | =: \
             here | help: for the instant of a crossing compare with `<` or `>` | help: for values that change \
             only at transitions write `abs(a - b) < 0.5`",
            ),
        ],
    );
}

#[test]
fn bodies_are_checked_once_and_know_nothing_of_the_component() {
    let messages = |declarations: &str, expression: &str| {
        lower_at(Place::INSTANT, declarations, expression, &MemoryWorld::default()).messages()
    };
    assert_eq!(messages("function f(x) = x + zz;", "f(1) + f(2)"), "unknown zz");
    assert_eq!(messages("function f(x) = x*z;", "1"), "unknown z");
    assert_eq!(
        messages("function f(x) = x*time;", "f(z)"),
        "HS0207 time: a function cannot use `time`, which is the simulated time | help: make `time` a parameter, \
         and pass it where it is called"
    );
    assert_eq!(
        messages("function f(x) : real[2] = [x, x, x];", "f(1)"),
        "HS0211 [x, x, x]: the value of `f` is a vector of 2, but its value is a vector of 3 | f: a vector of 2"
    );
    assert_eq!(
        messages("function f(x) = g(x); function g(x) = f(x);", "f(1)"),
        "HS0302 g(x): function `f` calls itself | f(x): the body of `g` | note: each calls the next: `f` → `g` → \
         `f` | help: a repetition is a matter of states and transitions; write the function without it"
    );
    assert!(messages("constant a1 = b1; constant b1 = 2*a1;", "a1").starts_with("HS0301"));
}

#[test]
fn functions_that_double_or_nest_without_end_are_stopped() {
    let mut doubling = "function f0(x) = sin(x) + x;\n".to_owned();
    let mut nesting = doubling.clone();
    for level in 1..40 {
        let below = level - 1;
        doubling += &format!("function f{level}(x) = f{below}(x + 1)*f{below}(x*x);\n");
    }
    for level in 1..2000 {
        nesting += &format!("function f{level}(x) = f{}(x + 1);\n", level - 1);
    }
    for declarations in [doubling, nesting] {
        let call =
            format!("f{}(z) + f{}(w)", declarations.lines().count() - 1, declarations.lines().count() - 1);
        let lowered = lower_at(Place::INSTANT, &declarations, &call, &MemoryWorld::default());
        assert_eq!(lowered.messages().matches("HS0304").count(), 1, "{}", lowered.messages());
    }
}
