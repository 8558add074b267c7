//! From classes, members and wires to one system: names, parameters, connections, sizes.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)] // a test may panic

use sophy_field::EventIndex;
use sophy_ir::{
    Body, Class, ClassIndex, Composite, EventEnd, EventPort, EventWire, Feature, HybridAutomaton, Leaf,
    Location, Member, Model, Node, NodeId, Port, Quantity, Repeated, Sources, Special, System, Trigger,
    Variable, VariableId, VariableKind, Wire,
};
use sophy_passes::{FlattenError, PassError, flatten, lower};
use sophy_testkit::Build;
use std::time::{Duration, Instant};

/// The only component of a builder, as a class.
fn class(name: &str, b: &Build) -> Class {
    let mut class = b.model().classes.remove(0);
    class.name = name.to_owned();
    class
}

fn variable(name: &str, kind: VariableKind) -> Variable {
    Variable {
        name: name.to_owned(),
        kind,
        quantity: Quantity::Real,
        range: None,
        choices: Vec::new(),
        viewed: false,
        structural: false,
        unit: None,
        documentation: String::new(),
        span: None,
    }
}

const INPUT: VariableKind = VariableKind::Input { continuous: true };

fn member(name: &str, class: u32, extents: &[u32]) -> Member {
    Member {
        name: name.to_owned(),
        class: ClassIndex(class),
        extents: extents.to_vec(),
        element: Vec::new(),
        parameters: Vec::new(),
        documentation: String::new(),
        span: None,
    }
}

fn port(member: Option<u32>, copy: u32, variable: u32) -> Port {
    Port { member, copy, variable: VariableId(variable) }
}

fn wire(from: Port, to: Port) -> Wire {
    Wire { from: Sources::One(from), to, span: None }
}

fn composite(name: &str, members: Vec<Member>, wires: Vec<Wire>) -> Class {
    let body = Body::Composite(Composite { members, wires: wires.into(), event_wires: Repeated::default() });
    Class { name: name.to_owned(), body, ..Class::default() }
}

fn model(mut classes: Vec<Class>, root: Class) -> Model {
    classes.push(root);
    Model { root: ClassIndex(classes.len() as u32 - 1), classes, ..Model::default() }
}

fn names<T>(items: impl IntoIterator<Item = T>, name: impl Fn(T) -> String) -> Vec<String> {
    items.into_iter().map(name).collect()
}

fn row_text(system: &System, row: &sophy_ir::Row) -> String {
    assert!(system.is_constant(*row));
    system.text(system.nodes(*row)[0])
}

/// der(x1) = (u − x1)/tau, der(x2) = x1 − x2, der(x3) = x2 − x3, y = x3. Variables: u 0, y 1, x 2 3 4, tau 5.
fn cell() -> Class {
    let mut b = Build::default();
    b.component("");
    let (u, y) = (b.input("u"), b.output("y"));
    let x = [b.state("x1", 1.0), b.state("x2", 0.0), b.state("x3", 0.0)];
    let tau = b.parameter("tau", 2.0);
    let [r1, r2, r3] = x.map(|id| b.read(id));
    let ru = b.read(u);
    let here = b.location("here");
    let lag = b.sub(ru, r1);
    let lag = b.div(lag, tau);
    b.rate(here, x[0], lag);
    let difference = b.sub(r1, r2);
    b.rate(here, x[1], difference);
    let difference = b.sub(r2, r3);
    b.rate(here, x[2], difference);
    b.value(here, y, r3);
    class("Cell", &b)
}

/// y = u + 1. Variables: u 0, y 1.
fn gain() -> Class {
    let mut b = Build::default();
    b.component("");
    let (u, y) = (b.input("u"), b.output("y"));
    let (read, one) = (b.read(u), b.number(1.0));
    let here = b.location("here");
    let sum = b.add(read, one);
    b.value(here, y, sum);
    class("Gain", &b)
}

#[test]
fn a_ring_of_a_hundred_thousand_cells_is_flat_in_seconds() {
    const COUNT: u32 = 100_000;
    let wires = (0..COUNT).map(|k| wire(port(Some(0), k, 1), port(Some(0), (k + 1) % COUNT, 0))).collect();
    let model = model(vec![cell()], composite("Ring", vec![member("cell", 0, &[COUNT])], wires));
    // On its own it is one second; machines may be busy.
    let begin = Instant::now();
    let system = flatten(&model).unwrap();
    let elapsed = begin.elapsed();
    assert!(elapsed < Duration::from_secs(30), "{elapsed:?}");
    assert_eq!((system.states.len(), system.inputs.len()), (300_000, 0));
    assert_eq!(names(&system.parameters, |p| p.name.clone()), ["cell.tau"]);
    assert_eq!(system.states.at(50).name(&system), "cell[17].x3");
    assert_eq!(row_text(&system, &system.states.at(51).rate), "(cell[17].x3 - cell[18].x1) / cell.tau");
    assert_eq!(row_text(&system, &system.states.at(0).rate), "(cell[100000].x3 - cell[1].x1) / cell.tau");
    assert_eq!(system.outputs.at(99_999).name(&system), "cell[100000].y");
    // A copy costs what is new in it: three states and four operations.
    assert!(system.graph.len() < 8 * COUNT as usize, "{}", system.graph.len());
}

#[test]
fn a_chain_of_outputs_needs_no_stack() {
    const COUNT: u32 = 100_000;
    // Written backwards: the first output needs all others.
    let wires = (1..COUNT).map(|k| wire(port(Some(0), k, 1), port(Some(0), k - 1, 0))).collect();
    let model = model(vec![gain()], composite("Chain", vec![member("gain", 0, &[COUNT])], wires));
    let run = move || {
        let system = flatten(&model).unwrap();
        assert_eq!(names(&system.inputs, |u| u.name(&system)), ["gain[100000].u"]);
        assert_eq!(row_text(&system, &system.outputs.at(99_998).value), "gain[100000].u + 1.0 + 1.0");
        // One addition per copy: what is read is what was made.
        assert_eq!(system.graph.len(), COUNT as usize + 2);
    };
    std::thread::Builder::new().stack_size(256 * 1024).spawn(run).unwrap().join().unwrap();
}

/// Plant(u, y) holds `cell : Cell[2,2](tau : k*3)`; the whole holds `plant : Plant[2](k : scale + 1)`.
#[test]
fn names_parameters_and_ports_through_two_composites() {
    let mut plant = composite("Plant", vec![member("cell", 0, &[2, 2])], Vec::new());
    plant.variables = vec![variable("u", INPUT), variable("y", VariableKind::Output)];
    let (three, four) = (plant.graph.number(3.0), plant.graph.number(4.0));
    plant.variables.push(variable("k", VariableKind::Parameter { value: four, knob: true }));
    let k = plant.graph.leaf(Leaf::Variable(VariableId(2)));
    let tau = plant.graph.multiply(k, three);
    let Body::Composite(body) = &mut plant.body else { panic!() };
    body.members[0].parameters.push((VariableId(5), tau));
    body.wires.push(wire(port(None, 0, 0), port(Some(0), 0, 0)));
    body.wires.push(wire(port(Some(0), 0, 1), port(Some(0), 1, 0)));
    // The sum of two weighted outputs, and one of weight 1.
    let terms = vec![(2.0, port(Some(0), 2, 1)), (1.0, port(Some(0), 3, 1)), (-1.0, port(Some(0), 1, 1))];
    body.wires.push(Wire { to: port(None, 0, 1), from: Sources::Sum(terms.into()), span: None });
    body.wires.push(Wire { to: port(Some(0), 2, 0), from: Sources::Sum([].into()), span: None });

    let mut whole = composite("Whole", vec![member("plant", 1, &[2])], Vec::new());
    let five = whole.graph.number(5.0);
    whole.variables = vec![
        variable("scale", VariableKind::Parameter { value: five, knob: false }),
        variable("z", VariableKind::Output),
        variable("drive", INPUT),
    ];
    let scale = whole.graph.leaf(Leaf::Variable(VariableId(0)));
    let one = whole.graph.number(1.0);
    let sum = whole.graph.add(scale, one);
    let Body::Composite(body) = &mut whole.body else { panic!() };
    body.members[0].parameters.push((VariableId(2), sum));
    body.wires.push(wire(port(None, 0, 2), port(Some(0), 0, 0)));
    body.wires.push(wire(port(Some(0), 1, 1), port(None, 0, 1)));
    let model = model(vec![cell(), plant], whole);
    let system = lower(&model).unwrap();

    assert_eq!(names(&system.parameters, |p| p.name.clone()), ["scale", "plant.k", "plant.cell.tau"]);
    let parameter = |k: usize| system.text(system.parameters[k].value);
    assert_eq!([parameter(1), parameter(2)], ["scale + 1.0", "plant.k * 3.0"]);
    assert_eq!(system.states.at(9).name(&system), "plant[1].cell[2,2].x1");
    let inputs = ["drive", "plant[1].cell[2,2].u", "plant[2].u", "plant[2].cell[2,2].u"];
    assert_eq!(names(&system.inputs, |u| u.name(&system)), inputs);
    let rate = |k: usize| row_text(&system, &system.states.at(k).rate);
    assert_eq!(rate(0), "(drive - plant[1].cell[1,1].x1) / plant.cell.tau");
    assert_eq!(rate(3), "(plant[1].cell[1,1].x3 - plant[1].cell[1,2].x1) / plant.cell.tau");
    assert_eq!(rate(6), "(0.0 - plant[1].cell[2,1].x1) / plant.cell.tau");
    assert_eq!(system.outputs.at(0).name(&system), "z");
    assert_eq!(
        row_text(&system, &system.outputs.at(0).value),
        "2.0 * plant[2].cell[2,1].x3 + plant[2].cell[2,2].x3 + -1.0 * plant[2].cell[1,2].x3"
    );
    // One output of the whole, one per cell; those of inner composites are no outputs of the system.
    assert_eq!(system.outputs.len(), 1 + 8);
}

/// Elements that differ are members of their own.
#[test]
fn elements_of_arrays_may_have_parameters_of_their_own() {
    let mut root = composite("Fleet", Vec::new(), Vec::new());
    let values: Vec<NodeId> = (0..3).map(|k| root.graph.number(f64::from(k) + 10.0)).collect();
    let Body::Composite(body) = &mut root.body else { panic!() };
    for (k, value) in values.into_iter().enumerate() {
        let element = vec![k as u32 + 1];
        body.members.push(Member {
            element,
            parameters: vec![(VariableId(5), value)],
            ..member("craft", 0, &[])
        });
    }
    let system = flatten(&model(vec![cell()], root)).unwrap();
    assert_eq!(
        names(&system.parameters, |p| p.name.clone()),
        ["craft[1].tau", "craft[2].tau", "craft[3].tau"]
    );
    assert_eq!(system.text(system.parameters[2].value), "12.0");
    assert_eq!(system.states.at(3).name(&system), "craft[2].x1");
}

#[test]
fn an_algebraic_loop_is_given_equation_by_equation() {
    let wires = vec![
        wire(port(Some(0), 0, 1), port(Some(0), 1, 0)),
        wire(port(Some(0), 1, 1), port(Some(1), 0, 0)),
        wire(port(Some(1), 0, 1), port(Some(0), 0, 0)),
    ];
    let members = vec![member("g", 0, &[2]), member("last", 0, &[])];
    let model = model(vec![gain()], composite("Loop", members, wires));
    let Err(PassError::Flatten(FlattenError::AlgebraicLoop(equations))) = lower(&model) else {
        panic!("a loop")
    };
    let texts: Vec<(&str, &str)> = equations.iter().map(|e| (e.name.as_str(), e.text.as_str())).collect();
    let expected = [
        ("g[1].y", "y = u + 1.0"),
        ("g[1].u", "g[1].u = last.y"),
        ("last.y", "y = u + 1.0"),
        ("last.u", "last.u = g[2].y"),
        ("g[2].y", "y = u + 1.0"),
        ("g[2].u", "g[2].u = g[1].y"),
    ];
    assert_eq!(texts, expected);
}

/// A value of one location that reads another, and the other way round in another location, is no loop; what
/// another component reads of it is an algebraic variable.
#[test]
fn values_are_written_out_location_by_location() {
    let mut b = Build::default();
    b.component("");
    let (x, a, c) = (b.state("x", 1.0), b.output("a"), b.output("c"));
    let [rx, ra, rc] = [x, a, c].map(|id| b.read(id));
    let two = b.number(2.0);
    let (double_a, double_c) = (b.mul(two, ra), b.mul(two, rc));
    let (left, right) = (b.location("left"), b.location("right"));
    b.value(left, a, rx);
    b.value(left, c, double_a);
    b.value(right, c, rx);
    b.value(right, a, double_c);
    for place in [left, right] {
        b.rate(place, x, rc);
    }
    let wires = vec![wire(port(Some(0), 0, 1), port(Some(1), 0, 0))];
    let members = vec![member("p", 0, &[]), member("q", 1, &[])];
    let system = lower(&model(vec![class("P", &b), gain()], composite("W", members, wires))).unwrap();
    let rate = &system.states.at(0).rate;
    let texts: Vec<String> = system.nodes(*rate).iter().map(|&node| system.text(node)).collect();
    assert_eq!(texts, ["2.0 * p.x", "p.x"]);
    assert_eq!(names(system.algebraics.iter(), |z| z.name(&system)), ["p.a"]);
    assert_eq!(row_text(&system, &system.outputs.at(2).value), "p.a + 1.0");
}

/// A label leaves two composites and enters two others.
#[test]
fn events_cross_the_boundaries_of_composites() {
    let event = |name: &str| EventPort { name: name.into(), documentation: String::new(), span: None };
    let mut b = Build::default();
    b.component("");
    let x = b.state("x", 0.0);
    let (read, zero) = (b.read(x), b.number(0.0));
    let here = b.location("here");
    let guard = b.greater(read, zero);
    b.when(here, "go", guard, here, &[]);
    b.emit(here, "out");
    b.on(here, "in", here, &[]);
    let end = |member: Option<u32>, copy: u32, label: &str| EventEnd { member, copy, label: label.into() };
    let joined = |from: EventEnd, to: EventEnd| EventWire { from, to, synchronised: false, span: None };
    let shell = |inner: u32, name: &str| {
        let mut shell = composite(name, vec![member("m", inner, &[2])], Vec::new());
        (shell.input_events, shell.output_events) = (vec![event("entry")], vec![event("exit")]);
        let Body::Composite(body) = &mut shell.body else { panic!() };
        let labels = if inner == 0 { ("out", "in") } else { ("exit", "entry") };
        body.event_wires.push(joined(end(Some(0), 1, labels.0), end(None, 0, "exit")));
        for copy in 0..2 {
            body.event_wires.push(joined(end(None, 0, "entry"), end(Some(0), copy, labels.1)));
        }
        shell
    };
    let (inner, outer) = (shell(0, "Inner"), shell(1, "Outer"));
    let mut root = composite("Root", vec![member("a", 2, &[]), member("b", 2, &[])], Vec::new());
    root.input_events = vec![event("start")];
    let Body::Composite(body) = &mut root.body else { panic!() };
    body.event_wires.push(joined(end(Some(0), 0, "exit"), end(Some(1), 0, "entry")));
    body.event_wires.push(joined(end(None, 0, "start"), end(Some(0), 0, "entry")));
    let system = lower(&model(vec![class("Leaf", &b), inner, outer], root)).unwrap();
    let name = |e: &EventIndex| system.events.at(e.position()).name(&system);
    let of = |k: usize| system.transitions.at(2 * k).emits[0].receivers.iter().map(name).collect::<Vec<_>>();
    // Leaves in order: a.m[1].m[1], a.m[1].m[2], a.m[2].m[1], a.m[2].m[2], b. …; only the last of a is heard.
    assert_eq!(of(0), Vec::<&str>::new());
    assert_eq!(of(3), ["b.m[1].m[1].in", "b.m[1].m[2].in", "b.m[2].m[1].in", "b.m[2].m[2].in"]);
    assert_eq!(system.event_inputs[0].name, "start");
    let started: Vec<String> = system.event_inputs[0].receivers.iter().map(name).collect();
    assert_eq!(started, ["a.m[1].m[1].in", "a.m[1].m[2].in", "a.m[2].m[1].in", "a.m[2].m[2].in"]);
}

/// Conditions are stored as numbers and numbers are read as conditions, wherever they meet.
#[test]
fn truth_values_are_numbers_where_numbers_are_wanted() {
    let mut b = Build::default();
    b.component("");
    let (alarm, x, y) = (b.mode("alarm", Some(0.0)), b.state("x", 0.0), b.output("y"));
    let [ra, rx] = [alarm, x].map(|id| b.read(id));
    let (one, three) = (b.number(1.0), b.number(3.0));
    let here = b.location("here");
    let high = b.greater(rx, one);
    let quiet = b.graph().not(ra);
    let both = b.graph().and(high, quiet);
    let rate = b.graph().select(ra, one, three);
    b.value(here, y, both);
    b.rate(here, x, rate);
    b.when(here, "raise", both, here, &[(alarm, both)]);
    let system = lower(&b.model()).unwrap();
    assert!(system.states.at(0).discrete && !system.states.at(1).discrete);
    let assigned = system.text(system.transitions.at(0).resets[0].value);
    assert_eq!(assigned, "if x > 1.0 and not alarm > 0.5 then 1.0 else 0.0");
    assert_eq!(row_text(&system, &system.outputs.at(0).value), assigned);
    assert_eq!(row_text(&system, &system.states.at(1).rate), "if (alarm > 0.5) then 1.0 else 3.0");
    assert_eq!(
        system.trigger_text(&system.transitions.at(0).trigger),
        "when (x > 1.0) and not (alarm > 0.5)"
    );
}

#[test]
fn what_cannot_be_run_yet_is_listed_once_per_member() {
    let mut late = Class { name: "Late".to_owned(), ..Class::default() };
    late.variables = vec![variable("u", INPUT), variable("x", VariableKind::State(None))];
    let u = late.graph.leaf(Leaf::Variable(VariableId(0)));
    let half = late.graph.number(0.5);
    late.specials.push(Special::Delayed { value: u, delay: half, before: None });
    let delayed = late.graph.leaf(Leaf::Special(0));
    let location = Location {
        name: "here".to_owned(),
        dynamics: vec![sophy_ir::Equation { variable: VariableId(1), right: delayed, span: None }],
        transitions: vec![sophy_ir::Transition {
            name: "fail".into(),
            documentation: String::new(),
            span: None,
            trigger: Trigger::Rate { rate: half, guard: None },
            destination: 0,
            actions: sophy_ir::Actions::default(),
            priority: 0,
        }],
        ..Location::default()
    };
    late.body = Body::Automaton(HybridAutomaton { locations: vec![location], ..HybridAutomaton::default() });
    let mut control = Class { name: "Control".to_owned(), ..Class::default() };
    control.variables = vec![variable("u", INPUT), variable("y", VariableKind::Output)];
    control.body = Body::Discrete(sophy_ir::Discrete::default());
    // The discrete component holds its output: no loop.
    let wires =
        vec![wire(port(Some(1), 0, 1), port(Some(1), 0, 0)), wire(port(Some(1), 0, 1), port(Some(0), 0, 0))];
    let members = vec![member("late", 0, &[3]), member("control", 1, &[])];
    let system = lower(&model(vec![late, control], composite("W", members, wires))).unwrap();
    let found: Vec<(Feature, &str, &str)> =
        system.awaits.iter().map(|a| (a.what, a.component.as_str(), a.text.as_str())).collect();
    let mut sorted = found;
    sorted.sort_by_key(|(_, component, text)| (*component, *text));
    let expected = [
        (Feature::DiscreteTime, "control", "Control"),
        (Feature::Delayed, "late", "delayed(u, 0.5)"),
        (Feature::Rate, "late", "rate 0.5"),
    ];
    assert_eq!(sorted, expected);
    assert!(system.states.at(3).discrete && system.states.at(3).name(&system) == "control.y");
    assert!(matches!(
        system.graph.node(system.nodes(system.states.at(0).rate)[0]),
        Node::Leaf(Leaf::Special(_))
    ));
}
