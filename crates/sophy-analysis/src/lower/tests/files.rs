use super::*;

fn world() -> MemoryWorld {
    MemoryWorld::default()
        .with("models/aero.csv", "alpha,Cl,Cd\n# a comment\n-10, -1, 0.1\n0, 0, 0.02\n10, 1, 0.1\n")
        .with("models/pin.csv", "Pin,Time\n5,0\n7,10\n")
        .with("models/twice.csv", "t,x\n0,1\n1,2\n1,3\n")
        .with("models/word.csv", "t,x\n0,1\n1,two\n")
        .with("models/short.csv", "t,x\n0,1\n")
        .with("models/ragged.csv", "t,x\n0,1\n1\n")
        .with("models/auv.toml", "mass = 5\nname = 'idle'\n[drag]\nx = [1.5, 2, 3]\n[[fin]]\nspan = 4\n")
        .with("models/bad.toml", "mass = 5\nmass = ")
}

fn check_files(table: &[(&str, &str)]) {
    let declarations = "constant auv = data(\"auv.toml\");";
    for (expression, expected) in table {
        let lowered = lower_at(Place::INSTANT, declarations, expression, &world());
        assert_eq!(lowered.text(), *expected, "{expression}");
    }
}

#[test]
fn tables() {
    check_files(&[
        ("table(\"aero.csv\", \"Cl\", z)", "table0(z)"),
        ("table(\"aero.csv\", \"Cl\", z) + table(\"aero.csv\", \"Cl\", w, linear)", "table0(z) + table0(w)"),
        ("table(\"aero.csv\", \"Cl\", z) + table(\"aero.csv\", \"Cd\", z, cubic)", "table0(z) + table1(z)"),
        ("table(\"aero.csv\", \"Cl\", 5)", "0.5"),
        ("table(\"aero.csv\", \"Cl\", 10, hold)", "1"),
        ("table(\"aero.csv\", \"Cl\", 9.5, hold)", "0"),
        ("signal_file(\"pin.csv\", \"Pin\")", "table0(time)"),
        (
            "table(\"aero.csv\", \"Cl\", 11)",
            "HS0220 11: `aero.csv` has no value at 11 | help: its range is -10 to 10",
        ),
        (
            "table(\"aero.csv\", \"CL\", z)",
            "HS0215 \"CL\": `aero.csv` cannot be used: it has no column `CL` | help: did you mean `Cl`?",
        ),
        (
            "table(\"nose.csv\", \"Cl\", z)",
            "HS0215 \"nose.csv\": `nose.csv` cannot be used: it cannot be read: no such file | help: paths start \
             from the folder of the file they are written in",
        ),
        (
            "table(\"twice.csv\", \"x\", z)",
            "HS0215 \"twice.csv\": `twice.csv` cannot be used: line 4: column `t` must increase, but 1 follows 1 | \
             help: sort the lines, and keep one of those that are equal",
        ),
        (
            "table(\"word.csv\", \"x\", z)",
            "HS0215 \"word.csv\": `word.csv` cannot be used: line 3: `two` in column `x` is not a finite number | \
             help: correct the file",
        ),
        (
            "table(\"short.csv\", \"x\", z)",
            "HS0215 \"short.csv\": `short.csv` cannot be used: it needs at least 2 lines of numbers | help: correct \
             the file",
        ),
        (
            "table(\"ragged.csv\", \"x\", z)",
            "HS0215 \"ragged.csv\": `ragged.csv` cannot be used: line 3: it has 1 fields, the line before it 2 | \
             help: correct the file",
        ),
        (
            "table(\"aero.csv\", \"Cl\", z, spline)",
            "HS0220 spline: `spline` is not a way to read a file | help: declare it, or use one of the words that \
             may stand here: `linear`, `hold`, `cubic`",
        ),
    ]);
}

#[test]
fn a_signal_file_may_hold_its_last_value() {
    let mut files_of = Vec::new();
    for option in ["", ", linear", ", hold, last", ", last"] {
        let expression = format!("signal_file(\"pin.csv\", \"Pin\"{option})");
        files_of.push(lower_at(Place::EQUATION, "", &expression, &world()).text());
    }
    assert_eq!(files_of, vec!["table0(time)"; 4]);
    let folded = "constant it = table(\"pin.csv\", \"Time\", 6);";
    assert_eq!(
        lower_at(Place::EQUATION, folded, "it", &world()).text(),
        "5",
        "the first column has the knots"
    );
}

#[test]
fn records() {
    check_files(&[
        ("auv.mass*auv.drag.x[2]", "10"),
        ("dot(auv.drag.x, [1, 0, 0])", "1.5"),
        ("auv.fin[1].span", "4"),
        ("phase = auv.name", "phase = 0"),
        (
            "auv.drag.x[4]",
            "HS0212 4: index 4 is out of bounds: `auv` is a vector of 3 | help: its indices go from 1 to 3",
        ),
        ("auv.mas", "HS0217 mas: `auv` has no `mas` | help: did you mean `mass`?"),
        (
            "auv.drag",
            "HS0217 drag: `auv.drag` is a record of constants, and has no value itself | help: use one of its \
             constants: `auv.drag.x`",
        ),
        (
            "auv.fin",
            "HS0217 fin: `auv.fin` is a list of records | help: choose one by its index: `auv.fin[1]`",
        ),
        (
            "auv",
            "HS0217 auv: `auv` is a record of constants, and has no value itself | help: use one of its constants: \
             `auv.drag`",
        ),
        (
            "data(\"auv.toml\")",
            "HS0220 data: `data` gives a record, which cannot be part of an expression | help: name it, `constant \
             vehicle = data(\"vehicle.toml\");`, and use `vehicle.mass`",
        ),
    ]);
    let bad = lower_at(Place::EQUATION, "constant r = data(\"bad.toml\");", "r.mass", &world());
    assert!(bad.messages().starts_with("HS0215 \"bad.toml\": `bad.toml` cannot be used: line 2:"));
}
