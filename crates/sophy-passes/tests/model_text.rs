//! The text form of a model: everything that is in it, in the notation of the language.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)] // a test may panic

use sophy_ir::{
    Allowed, Body, ClassIndex, Composite, Leaf, Member, Port, Quantity, Repeated, Sources, Special,
    VariableId, Wire,
};
use sophy_testkit::Build;

#[test]
fn classes_members_and_wires_are_shown_as_they_are_written() {
    let mut b = Build::default();
    b.component("");
    let (u, y, h, m, s) = (b.input("u"), b.output("y"), b.state("h", 1.0), b.mode("m", None), b.flag("S"));
    let k = b.parameter("k", 2.0);
    let [ru, rh, rm] = [u, h, m].map(|id| b.read(id));
    let (up, down) = (b.location("Up"), b.location("Down"));
    let product = b.mul(k, rh);
    let smooth = b.smooth(product);
    b.rate(up, h, smooth);
    b.rate(down, h, rm);
    for place in [up, down] {
        b.value(place, y, rh);
        b.value(place, s, ru);
    }
    let over = b.greater(rh, ru);
    b.when(up, "fall", over, down, &[(h, ru)]);
    b.priority(up, 2);
    b.emit_if(up, "fell", Some(over));
    b.on(down, "back", up, &[]);
    b.initial(h, ru);
    b.event(s, 1, Some(&[(m, rh)]), None);
    let mut model = b.model();
    let class = &mut model.classes[0];
    class.name = "Thing".to_owned();
    class.variables[3].quantity = Quantity::Text;
    class.variables[3].choices = vec![0, 1];
    class.variables[2].unit = Some("m".to_owned());
    class.variables[2].viewed = true;
    let low = class.graph.number(0.0);
    let reads_k = class.graph.leaf(Leaf::Variable(VariableId(5)));
    class.variables[0].range = Some(Allowed::Between([low, reads_k]));
    let input = class.graph.leaf(Leaf::Variable(VariableId(0)));
    let delay = class.graph.number(0.1);
    class.specials.push(Special::Delayed { value: input, delay, before: None });
    let delayed = class.graph.leaf(Leaf::Special(1));
    if let Body::Automaton(automaton) = &mut class.body {
        automaton.locations[1].dynamics[0].right = delayed;
    }
    model.texts = vec!["idle".to_owned(), "tracking".to_owned()];
    let mut root = sophy_ir::Class { name: "Whole".to_owned(), ..sophy_ir::Class::default() };
    let five = root.graph.number(5.0);
    let member = Member {
        name: "thing".to_owned(),
        class: ClassIndex(0),
        extents: vec![2, 2],
        element: Vec::new(),
        parameters: vec![(VariableId(5), five)],
        documentation: String::new(),
        span: None,
    };
    let port = |copy, variable| Port { member: Some(0), copy, variable: VariableId(variable) };
    let sum = Sources::Sum([(1.0, port(1, 1)), (-2.0, port(2, 1))].into());
    let wires = vec![
        Wire { to: port(0, 0), from: Sources::One(port(3, 1)), span: None },
        Wire { to: port(1, 0), from: sum, span: None },
    ];
    root.body = Body::Composite(Composite {
        members: vec![member],
        wires: wires.into(),
        event_wires: Repeated::default(),
    });
    model.classes.push(root);
    model.root = ClassIndex(1);
    let expected = r#"model Whole
text 0 "idle"
text 1 "tracking"
component Thing
  input u in (0.0, k)
  output y
  state h := 1.0 "m" (viewed)
  mode m : string in {"idle", "tracking"}
  flag S
  constant k = 2.0
  input event back
  output event fell
  initial h := u
  location Up (initial)
    der(h) = smooth(k * h)
    y = h
    S = u
    transition fall when h > u priority 2 goto Down
      h := u
      emit fell if h > u
  location Down
    der(h) = delayed(u, 0.1)
    y = h
    S = u
    transition back on back goto Up
  event(S) priority 1
    negative-to-positive
      m := h
composite Whole
  thing : Thing(k : 5.0)[2,2]
  thing[2,2].y -> thing[1,1].u
  1.0*thing[1,2].y + -2.0*thing[2,1].y -> thing[1,2].u
"#;
    assert_eq!(model.to_string(), expected);
}
