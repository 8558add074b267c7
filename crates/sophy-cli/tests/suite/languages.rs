//! Models in HSML, and from one language to the other.

use crate::support::{Folder, OSCILLATOR};

const TANK: &str = "\
CTC Tank is
interface
  output(level, signal, \"m\");
end interface;
body
  declarations
    state level := 1 \"m\";
  end declarations;
  dynamics
    der(level) = -level/T;
  end dynamics;

  assignments
    T : 2 \"s\";
  end assignments;
end body;
";

#[test]
fn hsml_is_checked_run_shown_and_emitted() {
    let folder = Folder::new("hsml");
    folder.write("tank.hsml", TANK);
    folder.sophy(&["check", "tank.hsml"]).ends(0, &["tank.hsml: no mistakes found"]);
    folder.sophy(&["run", "tank.hsml", "--stop", "2", "--output", "tank.csv"]).ends(0, &["wrote tank.csv"]);
    assert!(folder.read("tank.csv").lines().next().is_some_and(|head| head.contains("level")));
    folder.sophy(&["plot", "tank.csv", "-o", "tank.svg"]).ends(0, &["tank.svg"]);
    assert!(folder.sophy(&["info", "tank.hsml"]).ends(0, &[]).out.contains("Tank"));
    assert_eq!(folder.sophy(&["run", "tank.hsml", "--emit", "tree"]).out.trim(), TANK.trim());
    for stage in ["model", "system"] {
        assert!(folder.sophy(&["run", "tank.hsml", "--emit", stage]).ends(0, &[]).out.contains("level"));
    }
    folder.write("wrong.hsml", &TANK.replace("-level/T", "-levl/T"));
    folder.sophy(&["run", "wrong.hsml"]).ends(1, &["HS0101", "wrong.hsml:10:", "did you mean `level`?"]);
}

#[test]
fn the_component_to_run_is_said_where_it_is_not_clear() {
    let folder = Folder::new("hsml_system");
    folder.write("two.hsml", &format!("{TANK}{}", TANK.replace("Tank", "Basin")));
    folder.sophy(&["check", "two.hsml"]).ends(0, &["no mistakes found"]);
    folder.sophy(&["run", "two.hsml"]).ends(1, &["HS0142", "--system NAME"]);
    folder.sophy(&["run", "two.hsml", "--system", "Basin", "--stop", "1"]).ends(0, &["Basin: reached"]);
    folder.sophy(&["run", "two.hsml", "--system", "Basn"]).ends(1, &["HS0142", "did you mean `Basin`?"]);
    folder.write("two.toml", "model = \"two.hsml\"\nsystem = \"Basin\"\n[run]\nstop = 1.0\n");
    folder.sophy(&["run", "two.toml"]).ends(0, &["Basin: reached"]);
    folder.sophy(&["run", "two.toml", "--system", "Tank"]).ends(0, &["Tank: reached"]);
}

#[test]
fn several_files_are_all_checked_and_imports_are_followed() {
    let folder = Folder::new("hsml_imports");
    folder.write("tank.hsml", TANK);
    folder.write(
        "plant.hsml",
        "import \"tank.hsml\";\nSYSTEM Plant is\nbody\n  components\n    a : Tank;\n    b : Tank(T : 3);\n  end components;\nend body;\n",
    );
    folder.write("lost.hsml", "import \"nowhere.hsml\";\n");
    folder.sophy(&["check", "plant.hsml", "lost.hsml", "tank.hsml"]).ends(
        1,
        &["plant.hsml: no mistakes found", "HS0141", "lost.hsml: 1 error", "tank.hsml: no mistakes found"],
    );
    folder.sophy(&["run", "plant.hsml", "--stop", "1", "--output", "plant.csv"]).ends(0, &[]);
    let head = folder.read("plant.csv").lines().next().unwrap_or_default().to_owned();
    assert!(head.contains("a.level") && head.contains("b.level"), "{head}");
}

#[test]
fn check_finds_loops_across_components() {
    let folder = Folder::new("hsml_loop");
    let gain = "CTC Gain is\ninterface\n  input(u, signal);\n  output(y, signal);\nend interface;\nbody\n  output\n    y = 2*u;\n  end output;\nend body;\n";
    folder.write(
        "loop.hsml",
        &format!("{gain}SYSTEM Loop is\nbody\n  components\n    a : Gain;\n    b : Gain;\n  end components;\n  connections\n    a.y -> b.u;\n    b.y -> a.u;\n  end connections;\nend body;\n"),
    );
    folder
        .sophy(&["check", "loop.hsml"])
        .ends(1, &["HS0303", "a.y = 2.0 * u", "b.y = 2.0 * u", "loop.hsml: 1 error"]);
    folder.sophy(&["run", "loop.hsml"]).ends(1, &["HS0303"]);
}

#[test]
fn models_go_from_one_language_to_the_other_and_run_alike() {
    let folder = Folder::with_oscillator("convert_languages");
    folder.sophy(&["convert", "oscillator.xml", "oscillator.hsml"]).ends(0, &["wrote oscillator.hsml"]);
    folder.sophy(&["fmt", "--check", "oscillator.hsml"]).ends(0, &[]);
    folder.sophy(&["convert", "oscillator.hsml", "again.xml"]).ends(0, &["wrote again.xml"]);
    let run =
        |file: &str| folder.sophy(&["run", file, "--stop", "10", "--output", "-"]).ends(0, &[]).out.clone();
    let expected = run("oscillator.xml");
    assert_eq!(run("oscillator.hsml"), expected);
    assert_eq!(run("again.xml"), expected);
    folder.sophy(&["convert", "oscillator.hsml", "b.hsml"]).ends(2, &["sophy fmt"]);
    folder.sophy(&["convert", "oscillator.hsml", "b.csv"]).ends(2, &["cannot convert"]);
}

#[test]
fn what_the_other_language_cannot_say_is_named_and_nothing_written() {
    let folder = Folder::new("convert_unsayable");
    folder.sophy(&["new", "lbc", "Manager", "-o", "manager.hsml"]).ends(0, &[]);
    folder.sophy(&["convert", "manager.hsml", "manager.xml"]).ends(1, &["SX0401", "manager.hsml:"]);
    folder.write("two.hsml", &format!("{TANK}{}", TANK.replace("Tank", "Basin")));
    folder.sophy(&["convert", "two.hsml", "two.xml"]).ends(1, &["SX0401", "--system NAME"]);
    folder.write("wrong.hsml", &TANK.replace("-level/T", "-levl/T"));
    folder.sophy(&["convert", "wrong.hsml", "wrong.xml"]).ends(1, &["HS0101"]);
    assert!(!folder.has("manager.xml") && !folder.has("two.xml") && !folder.has("wrong.xml"));
    folder.sophy(&["convert", "two.hsml", "two.xml", "--system", "Basin"]).ends(0, &["SX0402"]);
    assert!(folder.read("two.xml").contains("<name>Basin</name>"));
}

#[test]
fn convert_says_what_is_said_otherwise_and_what_is_left_behind() {
    let folder = Folder::with_oscillator("convert_says");
    let two = OSCILLATOR
        .replace("<states>", "<!-- of the mass --><states>")
        .replace("Left</destination></reset>", "Left</destination></reset><inputevent>push</inputevent>");
    folder.write("two.xml", &two);
    folder
        .sophy(&["convert", "two.xml", "two.hsml"])
        .ends(0, &["HSML has two transitions", "1 comment (`<!-- -->`) is left behind", "wrote two.hsml"]);
    assert_eq!(folder.read("two.hsml").matches("transition 'to the left'").count(), 2);

    folder.write(
        "tank.hsml",
        "%% A tank.\n% Mine.\nCTC Tank is body declarations state x := 1; % full\nend declarations; location A \
         dynamics der(x) = -1; end dynamics; end location; end body;",
    );
    folder
        .sophy(&["convert", "tank.hsml", "tank.xml"])
        .ends(0, &["2 comments (`%`) are left behind: only documentation (`%%`) is kept", "wrote tank.xml"]);
    assert!(folder.read("tank.xml").contains("<documentation>A tank.</documentation>"));
}
