use crate::support::Folder;

#[test]
fn info_draws_the_automaton() {
    let folder = Folder::with_oscillator("info-draw");
    let answer =
        folder.sophy(&["info", "oscillator.xml", "--draw", "a.svg", "--draw", "a.dot", "--draw", "a.png"]);
    answer.ends(0, &["wrote a.svg", "wrote a.dot", "wrote a.png"]);
    let svg = folder.read("a.svg");
    for text in ["Right", "Left", "x &lt; 0", "−stiffness·x"] {
        assert!(svg.contains(text), "{text}\n{svg}");
    }
    let dot = folder.read("a.dot");
    assert!(dot.contains("b0 -> b1 [label=\"x < 0\"") && dot.contains("start0 -> b0;"), "{dot}");
    folder.sophy(&["info", "oscillator.xml", "--draw", "a.pdf"]).ends(2, &["a.pdf", ".svg"]);
    folder
        .sophy(&["info", "oscillator.xml", "--draw", "b.svg", "--component", "wheel"])
        .ends(2, &["`wheel`"]);
}

#[test]
fn info_cuts_long_lists() {
    let folder = Folder::new("info-long");
    folder.write(
        "chain.hsml",
        "
CTC Cell is
interface
  input(inp, signal); output(out, signal);
end interface;
body
  declarations state x := 0; end declarations;
  dynamics der(x) = inp - x; end dynamics;
  output out = x; end output;
end body;

SYSTEM Chain is
body
  components cell : Cell[2000]; end components;
  connections
    cell[2000].out -> cell[1].inp;
    for i in 1..1999 loop cell[i].out -> cell[i+1].inp; end loop;
  end connections;
end body;
",
    );
    let info = folder.sophy(&["info", "chain.hsml"]);
    info.ends(0, &[]);
    for text in
        ["cell : Cell[2000]", "2 000 in all", "more states (--all shows them)", "bandwidth 1 999", "Index 0"]
    {
        assert!(info.out.contains(text), "{text}\n{}", info.out);
    }
    assert!(info.out.lines().count() < 200, "{}", info.out);
    assert!(folder.sophy(&["info", "chain.hsml", "--all"]).out.lines().count() > 2000);
}

const HOUSE: &str = r#"
CTC Heater is
interface
  output(heat, signal, "W");
  output(on, boolean);
  output(stage, string, {"idle", "busy"});
end interface;
body
  declarations
    mode on : boolean := true;
    mode stage in {"idle", "busy"} := "idle";
    state clock := 0;
  end declarations;
  dynamics
    der(clock) = if location = "Resting" then 0 else 1;
  end dynamics;
  output
    heat = if on and stage <> "busy" then power else 0;
  end output;
  location Working
    transition pause when on and clock > 3 or stage = "busy" goto Resting do
      on := false;
      stage := if clock > 2 then "busy" else "idle";
    end transition;
  end location;
  location Resting
  end location;
  assignments
    power : 3000;
  end assignments;
end body;

CTC Tank is
interface
  input(heat, signal, "W");
end interface;
body
  declarations state x : real[n] := 0; end declarations;
  dynamics der(x) = heat*ones; end dynamics;
  assignments n : 2; ones : [1, 1]; end assignments;
end body;

SYSTEM House is
body
  components
    heater : Heater[2];
    tank : Tank;
  end components;
  connections heater[1].heat -> tank.heat; end connections;
end body;
"#;

#[test]
fn info_and_drawings_show_what_was_written() {
    let folder = Folder::new("info-written");
    folder.write("house.hsml", HOUSE);
    let info = folder.sophy(&["info", "house.hsml"]);
    info.ends(0, &[]);
    for text in [
        "SYSTEM",
        "3 components",
        "4 locations",
        "4 parameters",
        "when on and clock > 3 or stage = \"busy\"",
        "stage := if clock > 2 then \"busy\" else \"idle\"",
        "on := false",
        "fixed: it decides the structure",
        "have their parameters in common",
        "no rate reads a state",
    ] {
        assert!(info.out.contains(text), "{text}\n{}", info.out);
    }
    folder
        .sophy(&["info", "house.hsml", "--draw", "a.svg", "--component", "heater"])
        .ends(0, &["wrote a.svg"]);
    let svg = folder.read("a.svg").replace("&quot;", "\"").replace("&gt;", ">");
    for text in
        ["on and clock > 3 or stage = \"busy\"", "heat = if on and stage ≠ \"busy\" then power else 0"]
    {
        assert!(svg.contains(text), "{text}\n{svg}");
    }
    assert!(!svg.contains("on = on") && !svg.contains("stage = stage") && !svg.contains("> 0.5"), "{svg}");
}

#[test]
fn names_of_copies_are_told_apart_from_those_of_all() {
    let folder = Folder::new("copies-names");
    folder.write("house.hsml", HOUSE);
    let run = |arguments: &[&str]| folder.sophy(&[&["run", "house.hsml"], arguments].concat());
    run(&["--set", "heater.power=5"]).ends(0, &[]);
    run(&["--set", "heater[2].power=5"]).ends(1, &["have it in common: it is `heater.power`"]);
    run(&["--set", "tank.n=5"]).ends(1, &["decides the structure"]);
    run(&["--set", "heater.q=5"]).ends(1, &["it has `heater.power`"]);
    run(&["--record", "heater[2].heta"]).ends(1, &["did you mean `heater[2].heat`?"]);
    let recorded = run(&["--record", "*", "--output", "-"]);
    assert!(recorded.out.contains("heater[2].location") && !recorded.out.contains("tank.location"));
}
