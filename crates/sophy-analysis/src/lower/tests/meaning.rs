use super::*;

#[test]
fn names_stand_for_variables() {
    check(&[
        ("x + 2*z", "x + 2 * z"),
        ("time", "time"),
        ("on", "on > 0.5"),
        ("not on and x < 1", "not on > 0.5 and x < 1"),
        ("phase = \"idle\"", "phase = 0"),
        ("\"tracking\" <> phase", "1 <> phase"),
        ("location_index", "location"),
        ("location = \"Ground\"", "location = 2"),
        ("location <> \"Flight\" and on", "location <> 1 and on > 0.5"),
        ("never", "never"),
        ("on = off", "on > 0.5 and off > 0.5 or not on > 0.5 and not off > 0.5"),
        ("if on then x else 2", "if on > 0.5 then x else 2"),
        ("i = 2", "i = 2"),
        ("i + 1 > n", "i + 1 > n"),
        ("hit or x > 1", "event hit or x > 1"),
    ]);
}

#[test]
fn kinds_of_numbers() {
    let quantity = |expression: &str| lower(expression).value.unwrap().quantity;
    for integer in
        ["2", "i*2 - n", "i^2", "floor(x)", "sign(z)", "max(i, 2)", "abs(i)", "mod(i, 2)", "size(p)"]
    {
        assert_eq!(quantity(integer), Quantity::Integer, "{integer}");
    }
    for real in ["2.0", "i/2", "i^(0-1)", "2e3", "max(i, 2.0)", "sqrt(i)", "z", "n*z"] {
        assert_eq!(quantity(real), Quantity::Real, "{real}");
    }
    assert_eq!(quantity("on"), Quantity::Boolean);
    assert_eq!(quantity("phase"), Quantity::Text);
}

#[test]
fn variability() {
    let varies = |expression: &str| lower(expression).value.unwrap().varies;
    assert_eq!(varies("2 + pi"), Varies::Never);
    assert_eq!(varies("2 + a"), Varies::Parameters);
    assert_eq!(varies("if on then a else i"), Varies::Instants);
    assert_eq!(varies("i*time"), Varies::Continuously);
    assert_eq!(varies("hit"), Varies::Instants);
}

#[test]
fn what_is_no_number_or_no_condition() {
    check(&[
        (
            "1 + on",
            "HS0210 on: `on` is a truth value, but a number is needed here | help: write `(if on then 1 else 0)`",
        ),
        (
            "sin(phase)",
            "HS0210 phase: `phase` is a text, but a number is needed here | help: use a number there",
        ),
        (
            "not x",
            "HS0203 x: `x` is a number, but a condition is needed here | help: compare it with something, for \
             example `x > 0`",
        ),
        (
            "if on then on else 1",
            "HS0210 1: after `then` there is a truth value, but after `else` a whole number (a whole number) | \
             on: a truth value | help: both branches need values of one kind",
        ),
        (
            "phase < \"idle\"",
            "HS0210 <: texts cannot be compared with `<` | help: compare them with `=` or `<>`",
        ),
        (
            "x = phase",
            "HS0210 phase: `phase` is a text, but a number is needed here | help: use a number there",
        ),
    ]);
}

#[test]
fn equality() {
    check(&[
        ("n = 3 and i <> 2", "n = 3 and i <> 2"),
        (
            "z = w",
            "HS0204 =: `z = w` asks for equality of what varies continuously | help: for the instant of a \
             crossing compare with `<` or `>` | help: for values that change only at transitions write \
             `abs(z - w) < 0.5`",
        ),
    ]);
}

#[test]
fn texts_a_variable_cannot_be() {
    check(&[
        (
            "phase = \"idel\"",
            "HS0214 \"idel\": `phase` is never \"idel\" | : declared here | help: did you mean `idle`?",
        ),
        (
            "location = \"ground\"",
            "HS0214 \"ground\": there is no location `ground` | help: did you mean `Ground`?",
        ),
    ]);
}

#[test]
fn divisions_by_zero() {
    check_messages(&[
        (
            "x/(2 - 2)",
            "HS0205 (2 - 2): division by `(2 - 2)`, which is 0 | help: divide by something that is not 0",
        ),
        (
            "x/k",
            "HS0205 k: division by `k`, which is 0 unless an experiment sets it | help: give `k` another value",
        ),
        ("if k > 0 then x/k else 0", ""),
        ("if 1 > 0 then 0 else x/0", ""),
        ("mod(x, 0)", "HS0205 0: division by `0`, which is 0 | help: divide by something that is not 0"),
    ]);
}

#[test]
fn what_depends_on_the_course_of_a_run() {
    check(&[
        ("rises(x > 1)", "rises(x > 1)"),
        ("falls(on) or changes(i)", "falls(on > 0.5) or changes(i)"),
        ("chance(0.5)", "chance(0.5)"),
        ("delayed(z, 2)", "delayed(z, 2)"),
        ("delayed(z, a, 0)", "delayed(z, a, 0)"),
        ("delayed(on, 2, true)", "delayed(on, 2, 1) > 0.5"),
        ("smooth(abs(z))", "smooth(abs(z))"),
        ("noise(\"gust\", 2*a, 0.1)", "noise(gust, 2 * a, 0.1)"),
        ("delayed(z, 0)", "HS0220 0: a delay cannot be 0 | help: it must be more than 0 s"),
        ("chance(1.5)", "HS0220 1.5: a probability cannot be 1.5 | help: it must be between 0 and 1"),
        (
            "noise(gust, 1, 0.1)",
            "HS0220 gust: `noise` needs a text in double quotes here | help: write the name of the noise: \
             `\"gust\"`",
        ),
        (
            "noise(\"gust\", x, 0.1)",
            "HS0220 x: a standard deviation cannot change during a run | help: use numbers, constants and \
             parameters only; multiply the noise by what changes",
        ),
        (
            "hit and miss",
            "HS0219 hit: events `hit` and `miss` are never true together | miss: the other event | help: write \
             `or`, or remember the first event in a mode",
        ),
        (
            "der(x) + 1",
            "HS0218 der: `der(x)` can only stand on the left of an equation | help: define a local, `x_dot = …;`, \
             write `der(x) = x_dot;`, and use it here",
        ),
    ]);
    let two = lower("(if chance(0.5) then 1 else 0) + (if chance(0.5) then 1 else 0)");
    assert_eq!(two.specials.len(), 2, "each is a draw of its own");
    assert_eq!(lower("delayed(z, 1) + delayed(z, 1)").specials.len(), 1);
}

#[test]
fn what_a_place_allows() {
    let at = |place, expression: &str| lower_at(place, "", expression, &MemoryWorld::default()).messages();
    assert_eq!(at(Place::PARAMETER, "2*a + n"), "");
    assert_eq!(
        at(Place::PARAMETER, "2*x"),
        "HS0207 x: the value of a parameter cannot use `x`, which is a state | : declared here | help: use \
         numbers, constants and parameters only"
    );
    assert_eq!(
        at(Place::CONSTANT, "a"),
        "HS0207 a: a constant cannot use `a`, which is a parameter | : declared here | help: use numbers and \
         constants only"
    );
    assert_eq!(
        at(Place::INITIAL, "time"),
        "HS0207 time: an initial value cannot use `time`, which is the simulated time | help: use numbers, \
         constants and parameters only"
    );
    let conditions =
        "| help: `rises`, `falls`, `changes`, `chance` and events belong into conditions and actions";
    assert_eq!(
        at(Place::EQUATION, "if hit then 1 else 2"),
        format!("HS0207 hit: an equation cannot use `hit`, which is an event | : declared here {conditions}")
    );
    assert_eq!(
        at(Place::EQUATION, "if rises(on) then 1 else 2"),
        format!("HS0207 rises: an equation cannot use `rises`, which is about instants {conditions}")
    );
    assert_eq!(at(Place::EQUATION, "if on then time else z"), "");
}

#[test]
fn names_and_functions_that_do_not_exist() {
    check(&[
        ("xx + 1", "unknown xx"),
        ("sinus(x) + 1", "unknown sinus"),
        ("sin + 1", "HS0208 sin: `sin` is a function and needs arguments | help: call it as `sin(x)`"),
        (
            "z(1)",
            "HS0201 z: `z` is a state, not a function | : declared here | help: for a product write `z * (…)`",
        ),
        ("min(z)", "HS0202 min: `min` cannot be called with 1 argument | help: call it as `min(a, b, …)`"),
        (
            "cross(p)",
            "HS0202 cross: `cross` cannot be called with 1 argument | help: call it as `cross(a, b)`",
        ),
        (
            "motor",
            "HS0217 motor: `motor` is a component, and has no value | : declared here | help: use one of its \
             variables in a connection",
        ),
        (
            "motor.speed",
            "HS0217 motor.speed: expressions cannot read what belongs to component `motor` | help: connect it: \
             `component.output -> other.input;`",
        ),
        (
            "z.part",
            "HS0217 part: `z` has no part `part`: it is not a record | help: only records of constants, read \
             with `data(\"file.toml\")`, have parts",
        ),
    ]);
}
