use super::notation::{tidy, without_index};
use super::*;
use crate::load_as;
use sophy_analysis::Root;
use sophy_diagnostics::MemoryWorld;
use sophy_files::{BoxKind, Symbol};
use std::path::Path;

fn model(text: &str, root: &str) -> Model {
    let world = MemoryWorld::default().with("m.hsml", text);
    let loaded = load_as(&world, Path::new("m.hsml"), Root::Named(root));
    let messages: Vec<String> = loaded.messages().iter().map(|message| message.message.clone()).collect();
    loaded.model.unwrap_or_else(|| panic!("{messages:?}"))
}

const BALL: &str = "
CTC Ball is
interface
  output(height, signal, \"m\");
  output(hit, event);
end interface;
body
  declarations
    state height := 5.0;
    state speed := 0;
  end declarations;
  location Falling
    dynamics
      der(height) = speed;
      der(speed) = -g;
    end dynamics;
    transition caught when height <= 0 goto Caught do speed := 0; emit hit; end transition;
  end location;
  location Caught
    dynamics
      der(height) = 0;
      der(speed) = 0;
    end dynamics;
  end location;
  assignments g : 9.82; end assignments;
end body;
";

const CHAIN: &str = "
CTC Cell is
interface
  input(inp, signal, \"m\"); output(out, signal, \"m\");
end interface;
body
  declarations state x := 0; end declarations;
  dynamics der(x) = inp - x; end dynamics;
  output out = x; end output;
end body;

CC Chain is
interface
  input(u, signal, \"m\"); output(y, signal, \"m\");
end interface;
body
  components cell : Cell[100]; end components;
  connections
    u -> cell[1].inp;
    for i in 1..99 loop cell[i].out -> cell[i+1].inp; end loop;
    cell[100].out -> y;
  end connections;
end body;
";

#[test]
fn an_automaton_shows_locations_and_transitions() {
    let diagram = diagram(&model(BALL, "Ball"), None).expect("drawn");
    let kinds: Vec<_> = diagram.boxes.iter().map(|one| (one.name.as_str(), one.kind)).collect();
    assert_eq!(kinds, [("Falling", BoxKind::Initial), ("Caught", BoxKind::Single)]);
    let lines: Vec<_> =
        diagram.boxes[0].lines.iter().map(|l| (l.derivative_of.as_deref(), l.text.as_str())).collect();
    assert_eq!(lines, [(Some("height"), "= speed"), (Some("speed"), "= −g")]);
    assert_eq!(diagram.boxes[1].lines[0].text, "height, speed constant");
    let [caught] = diagram.arrows.as_slice() else { panic!("{:?}", diagram.arrows) };
    assert_eq!((caught.from.of, caught.to.of), (0, 1));
    assert_eq!(caught.above, ["height ≤ 0"]);
    assert_eq!(caught.below, ["speed := 0", "!hit"]);
    assert!(caught.tip.starts_with("caught: "), "{}", caught.tip);
}

#[test]
fn copies_are_one_box_and_parallel_connections_one_arrow() {
    let diagram = diagram(&model(CHAIN, "Chain"), None).expect("drawn");
    let boxes: Vec<_> =
        diagram.boxes.iter().map(|one| (one.name.as_str(), one.caption.as_str(), one.kind)).collect();
    let expected = [
        ("cell", "Cell[100]", BoxKind::Stack),
        ("u [m]", "", BoxKind::Input),
        ("y [m]", "", BoxKind::Output),
    ];
    assert_eq!(boxes, expected);
    assert_eq!(diagram.boxes[0].inputs[0].symbol, Symbol::Signal);
    assert_eq!(diagram.boxes[0].outputs[0].name, "out [m]");
    let mut arrows: Vec<_> = diagram.arrows.iter().map(|a| (a.from.of, a.to.of, a.above.join(""))).collect();
    arrows.sort();
    assert_eq!(arrows, [(0, 0, "×99".to_owned()), (0, 2, String::new()), (1, 0, String::new())]);
}

#[test]
fn elements_that_differ_are_one_box() {
    let text = "
CTC Pilot is
interface
  input(p, signal[3]); output(u, signal);
end interface;
body
  declarations state x := 0; end declarations;
  dynamics der(x) = p[id]; end dynamics;
  output u = x; end output;
  assignments id : 1; end assignments;
end body;

SYSTEM Crew is
body
  components
    for i in 1..3 loop pilot[i] : Pilot(id : i); end loop;
  end components;
  connections
    for i in 1..3 loop
      for j in 1..3 loop pilot[i].u -> pilot[j].p[i]; end loop;
    end loop;
  end connections;
end body;
";
    let diagram = diagram(&model(text, "Crew"), None).expect("drawn");
    let [pilot] = diagram.boxes.as_slice() else { panic!("{:?}", diagram.boxes) };
    assert_eq!((pilot.caption.as_str(), pilot.inputs[0].name.as_str()), ("Pilot[3]", "p (3)"));
    assert_eq!(diagram.arrows.iter().map(|arrow| arrow.above.join("")).collect::<Vec<_>>(), ["×9"]);
}

#[test]
fn a_component_is_found_by_path_or_by_its_kind() {
    let chain = model(CHAIN, "Chain");
    for name in ["cell", "cell[3]", "Cell"] {
        assert_eq!(diagram(&chain, Some(name)).expect("found").title, "Cell", "{name}");
    }
    let error = diagram(&chain, Some("cel")).expect_err("unknown");
    assert_eq!(error.to_string(), "the model has no component `cel`; there is `cell`");

    let whole = format!(
        "{CHAIN}SYSTEM Whole is body components left : Chain; end components; \
         connections left.y -> left.u; end connections; end body;"
    );
    let error = diagram(&model(&whole, "Whole"), Some("left.cel")).expect_err("unknown");
    assert_eq!(error.closest.as_deref(), Some("left.cell"));
}

#[test]
fn expressions_are_written_as_on_paper() {
    let cases = [
        ("2.0 * x - 1.0 <= y", "2·x − 1 ≤ y"),
        ("x / -0.5 <> 1e-5", "x/−0.5 ≠ 1e-5"),
        ("a.0b + x1.0", "a.0b + x1.0"),
        ("10.0", "10"),
        ("1.05 + 3.0)", "1.05 + 3)"),
    ];
    for (written, set) in cases {
        assert_eq!(tidy(written), set);
    }
    assert_eq!((without_index("omega[2,3]"), without_index("omega")), ("omega", "omega"));
}
