//! SOPHY XML to HSML and back.

use plain::Plain;
use proptest::prelude::*;
use sophy_analysis::*;
use sophy_diagnostics::{Diagnostics, SourceId, Sources, Span, Style, TextMap, render};
use sophy_xml::{Writing, read, write};

#[path = "../../sophy-analysis/src/hsml/plain.rs"]
mod plain;

fn messages(sources: &Sources, diagnostics: &Diagnostics) -> String {
    let drawn = diagnostics.clone().sorted(sources).into_iter().map(|d| render(&d, sources, Style::Plain));
    drawn.collect::<Vec<_>>().join("\n\n")
}

/// The declarations of an HSML text without mistakes of grammar.
fn hsml(text: &str) -> (Sources, Declarations) {
    let mut sources = Sources::default();
    let reading = read_hsml(&mut sources, "m.hsml", text.as_bytes());
    assert_eq!(messages(&sources, &reading.diagnostics), "", "{text}");
    (sources, reading.declarations)
}

fn written(declarations: &Declarations) -> Writing {
    write(&declarations.components[0], &declarations.functions, &declarations.constants)
}

#[test]
fn the_examples_survive_the_way_through_hsml() {
    for text in [
        include_str!("../../../examples/hopper/hopper.xml"),
        include_str!("../../../examples/battery/battery.xml"),
    ] {
        let first = read(&mut Sources::default(), "m.xml", text.as_bytes()).declarations.expect("a system");
        let (_, between) = hsml(&write_hsml(&first));
        let writing = written(&between);
        let again = writing.text.expect("nothing that cannot be said");
        let second = read(&mut Sources::default(), "m.xml", again.as_bytes()).declarations.expect("a system");
        assert_eq!(second.plain(), first.plain());
    }
}

/// The component `C` with these parts, on the lines from 3 on.
fn ctc(interface: &str, body: &str) -> String {
    format!("CTC C is\ninterface\n{interface}\nend interface;\nbody\n{body}\nend body;\n")
}

/// Elements of the SOPHY XML of an HSML text, one on a line, without the tags of what contains them.
fn elements(text: &str) -> (String, String) {
    let (sources, declarations) = hsml(text);
    let writing = written(&declarations);
    let messages = messages(&sources, &writing.diagnostics);
    assert!(writing.text.is_some(), "{messages}");
    let text = writing.text.unwrap_or_default();
    let kept = text
        .lines()
        .map(str::trim)
        .filter(|line| line.contains("</") && !line.starts_with("</") && !line.starts_with("<name>C<"));
    (kept.collect::<Vec<_>>().join("\n"), messages)
}

#[test]
fn what_holds_everywhere_stands_in_every_location() {
    let (text, messages) = elements(&ctc(
        "output(y, signal, \"m\"); output(x, signal);\n%% how hard\nknob(k, (0, 1)); view(x);",
        "declarations state x := 2; local v; local w; mode m : real := 1; end declarations;
         dynamics der(x) = -v*x; v = w + 1; w = m; end dynamics;
         output y = v^2; end output;
         location A
           transition t when v > 3 goto B do m := 2*v; end transition;
         end location;
         location B end location;
         assignments k : 1/2; end assignments;",
    ));
    assert_eq!(
        text,
        "<hint hintname=\"initial x\">2</hint>
<hint hintname=\"initial m\">1</hint>
<hint hintname=\"unit y\">m</hint>
<hint hintname=\"knob k\">(0, 1)</hint>
<hint hintname=\"view x\"></hint>
<hint hintname=\"documentation k\">how hard</hint>
<constant symbol=\"k\">1/2</constant>
<state>x</state>
<state>m</state>
<inputs></inputs>
<output>y</output>
<output>x</output>
<name>A</name>
<diffequation state=\"x\">-(m + 1)*x</diffequation>
<diffequation state=\"m\">0</diffequation>
<outputmap output=\"y\">(m + 1)^2</outputmap>
<outputmap output=\"x\">x</outputmap>
<name>t</name>
<domain>(m + 1) > 3</domain>
<destination>B</destination>
<statereset state=\"m\">2*(m + 1)</statereset>
<name>B</name>
<diffequation state=\"x\">-(m + 1)*x</diffequation>
<diffequation state=\"m\">0</diffequation>
<outputmap output=\"y\">(m + 1)^2</outputmap>
<outputmap output=\"x\">x</outputmap>"
    );
    for said in ["mode `m` becomes a state", "local `v` is replaced", "local `w` is replaced"] {
        assert!(messages.contains(said), "{messages}");
    }
    // Knob, view and documentation come back.
    let (_, first) = hsml(&ctc(
        "%% how\n knob(k, (0, 1)); view(k);",
        "location A end location;\nassignments k : 1; end assignments;",
    ));
    let xml = written(&first).text.expect("a text");
    let back = read(&mut Sources::default(), "m.xml", xml.as_bytes()).declarations.expect("a system");
    assert_eq!(back.plain(), first.plain());
}

#[test]
fn transitions_and_events_are_one_and_two() {
    let both = ctc(
        "input(hit, event); input(go, event); input(never, event); output(done, event);",
        "location A
           transition t when time > 1 goto B do emit done; end transition;
           transition t on hit, go goto B do emit done; end transition;
           transition u on go goto A;
         end location;
         location B end location;",
    );
    let (text, messages) = elements(&both);
    assert!(text.contains("time > 1</domain>\n<destination>B</destination>\n<inputevent>hit</inputevent>\n<inputevent>go</inputevent>\n<outputevent>done</outputevent>\n<name>u"), "{text}");
    assert!(
        text.contains("<domain>false</domain>\n<destination>A</destination>\n<inputevent>go</inputevent>"),
        "{text}"
    );
    assert!(messages.contains("event `never` is left out"), "{messages}");
    // And back: two again, and the labels declared.
    let (_, first) = hsml(&both.replace("input(never, event);", ""));
    let xml = written(&first).text.expect("a text");
    let back = read(&mut Sources::default(), "m.xml", xml.as_bytes()).declarations.expect("a system");
    let (_, again) = hsml(&write_hsml(&back));
    assert_eq!(again.plain(), first.plain());
}

#[test]
fn a_file_and_a_body_without_locations() {
    let text = "%% of the earth\nconstant g = 9.82 \"m/s2\";\nfunction f(a, b) = a*b;\n".to_owned()
        + &ctc(
            "output(y, signal);",
            "declarations state x; end declarations; dynamics der(x) = -g*x; end dynamics; output y = f(x, 1); end output;",
        );
    let (text, messages) = elements(&text);
    assert_eq!(
        text,
        "<hint hintname=\"unit g\">m/s2</hint>
<hint hintname=\"function f(a, b)\">a*b</hint>
<hint hintname=\"documentation g\">of the earth</hint>
<constant symbol=\"g\">9.82</constant>
<state>x</state>
<inputs></inputs>
<output>y</output>
<name>Main</name>
<diffequation state=\"x\">-g*x</diffequation>
<outputmap output=\"y\">f(x, 1)</outputmap>"
    );
    assert!(
        messages.contains("`C` has no locations; its equations become those of one, `Main`"),
        "{messages}"
    );
}

/// Declarations of a body, or a section, and what is said of it.
const UNSAYABLE: &[(&str, &str, &str)] = &[
    ("input(n, integer);", "", "3:10 SOPHY XML has real numbers only, and `n` is integer"),
    ("input(u, signal[3]);", "", "3:10 SOPHY XML has no vectors, as `u` is"),
    ("output(y, signal, (0, 1));", "", "3:8 SOPHY XML has no ranges, as `y` has"),
    ("sync(l);", "", "3:6 SOPHY XML has no transitions taken together, as those labelled `l`"),
    (
        "knob(k, {\"a\"});",
        "",
        "3:10 SOPHY XML cannot say this expression: a string cannot be part of this expression",
    ),
    ("", "declarations flag S; end declarations;", "6:19 SOPHY XML has no flags, as `S` is"),
    (
        "",
        "declarations mode m := true; end declarations;",
        "6:19 SOPHY XML has no modes that are not real, as `m` is",
    ),
    (
        "",
        "declarations mode m : integer; end declarations;",
        "6:23 SOPHY XML has real numbers only, and `m` is integer",
    ),
    ("", "declarations state x := u; end declarations;", ""),
    (
        "input(u, signal);",
        "declarations state x := u; end declarations;",
        "6:25 in SOPHY XML the initial value of `x` cannot depend on `u`",
    ),
    (
        "",
        "declarations state location; end declarations;",
        "6:20 in a hint of SOPHY XML, `location` is the first location",
    ),
    (
        "",
        "initial if true then x := 1; end if; end initial;",
        "6:12 SOPHY XML has initial values only, no statements",
    ),
    ("", "constraints x = y; end constraints;", "6:13 SOPHY XML has no constraints"),
    (
        "",
        "dynamics if a > 1 then der(x) = 1; end if; end dynamics;",
        "6:10 SOPHY XML has no equations under conditions",
    ),
    ("", "dynamics for i in 1..3 loop der(x[i]) = 1; end loop; end dynamics;", "6:14 SOPHY XML has no loops"),
    ("", "dynamics der(x[1]) = 1; end dynamics;", "6:16 SOPHY XML has no vectors, as `x` is"),
    ("", "event(S) end event;", "6:7 SOPHY XML has no event sections"),
    ("", "rules when x > 1 do end when; end rules;", "6:7 SOPHY XML has no rules"),
    ("", "location A invariant x < 1; end location;", "6:22 SOPHY XML has no invariants"),
    (
        "",
        "location A declarations state z; end declarations; end location;",
        "6:31 SOPHY XML has no variables of one location, as `z` is",
    ),
    (
        "",
        "location A transition t rate 2 goto A; end location;",
        "6:23 SOPHY XML has no transitions at a rate",
    ),
    (
        "",
        "location A transition t sync l goto A; end location;",
        "6:23 SOPHY XML has no transitions taken together with others",
    ),
    (
        "",
        "location A transition t on e when x > 1 goto A; end location;",
        "6:23 SOPHY XML has no events under a condition",
    ),
    ("", "location A transition t on invariant goto A; end location;", "6:23 SOPHY XML has no invariants"),
    (
        "",
        "location A transition t when true priority 2 goto A; end location;",
        "6:44 SOPHY XML has no priorities",
    ),
    (
        "",
        "location A transition t when true goto A do hold S; end transition; end location;",
        "6:50 SOPHY XML has only assignments to states and output events here",
    ),
    (
        "output(y, signal);",
        "location A transition t when true goto A do y := 1; end transition; end location;",
        "6:45 SOPHY XML assigns to states only, and `y` is none",
    ),
    (
        "",
        "declarations local v; end declarations; location A transition t when v > 1 goto A; end location;",
        "6:70 local `v` has no equation here that could stand in its place",
    ),
    (
        "",
        "declarations local v; end declarations; location A dynamics v = v; der(x) = v; end dynamics; end location;",
        "6:65 local `v` depends on too many others, or on itself, to be replaced by its equation",
    ),
    (
        "",
        "declarations local v; end declarations; location A dynamics v = 1; der(x) = sum(i in 1..2 : i*v); end dynamics; end location;",
        "6:77 local `v` cannot be replaced by its equation inside `sum`, `min` …",
    ),
    (
        "view(v);",
        "declarations local v; end declarations;",
        "3:6 SOPHY XML has no locals, and `v` is to be viewed",
    ),
    (
        "",
        "dynamics der(x) = table(\"a.csv\", \"Cl\", x); end dynamics;",
        "6:19 SOPHY XML cannot say this expression: a string cannot be part of this expression",
    ),
];

#[test]
fn what_cannot_be_said_has_a_place_and_a_way_out() {
    for (interface, body, expected) in UNSAYABLE {
        let (sources, declarations) = hsml(&ctc(interface, body));
        let writing = written(&declarations);
        let errors: Vec<_> = writing.diagnostics.iter().filter(|d| d.code.0 == "SX0401").collect();
        let said: Vec<String> = errors
            .iter()
            .map(|d| {
                let span = d.span().expect("a place");
                format!("{} {}", sources.line_column(span.source, span.start), d.message)
            })
            .collect();
        assert_eq!(said.join("\n"), *expected, "{interface} {body}");
        assert!(errors.iter().all(|d| d.helps.len() == 1));
        assert_eq!(writing.text.is_some(), expected.is_empty());
    }
    let (sources, declarations) =
        hsml("DTC D is body declarations tsample every 1; end declarations; end body;");
    let said = messages(&sources, &written(&declarations).diagnostics);
    assert!(said.contains("`D` is a DTC; SOPHY XML has continuous-time components only"), "{said}");
}

#[test]
fn long_chains_of_locals_end() {
    let declared: String = (0..200).map(|n| format!("local v{n};")).collect();
    let doubled: String = (0..199).map(|n| format!("v{n} = v{0} + v{0};", n + 1)).collect();
    let body = format!(
        "declarations {declared} end declarations; location A dynamics {doubled} v199 = 1; der(x) = v150; end dynamics; end location;"
    );
    let (_, declarations) = hsml(&ctc("", &body));
    let writing = written(&declarations);
    assert!(
        writing.diagnostics.iter().any(|d| d.message.contains("becomes too long")),
        "{:?}",
        writing.diagnostics
    );
}

fn source() -> SourceId {
    Sources::default().add("", "")
}

fn spanned(text: &str) -> Spanned<String> {
    Spanned::new(text.to_owned(), Span::new(source(), 0..0))
}

fn whole(name: &str) -> Target {
    Target { name: spanned(name), indices: Vec::new() }
}

fn expression(text: &str) -> ExpressionText {
    let (expression, parse) = ExpressionText::parse(text, TextMap::empty(source(), 0));
    assert!(parse.errors().is_empty(), "{text}");
    expression
}

/// Expressions of SOPHY XML, in which no word is reserved.
fn formula() -> impl Strategy<Value = ExpressionText> {
    let texts = [
        "1",
        "x",
        "-end*'Ground Height'",
        "if x > 1 then g else 2",
        "x = 1",
        "not x = 1",
        "priority > 2",
        "output^2 + initial/delay",
        "x % note\n  + 1",
        "sum(i in 1..3 : i*x)",
        "f(event, τ) && !(x <> 2)",
        "location",
        "false",
        "(x == 1)",
        "in + where",
        "max(is, y)",
    ];
    prop::sample::select(texts.to_vec()).prop_map(expression)
}

fn documentation() -> impl Strategy<Value = String> {
    prop_oneof![Just(String::new()), "[A-Z<&%][a-z \"&<>%]{0,9}[.>](\n{1,2}[a-z][a-z <&]{0,9}[.>]){0,3}"]
}

/// Some of `names`, in their order.
fn some(names: &[&'static str]) -> impl Strategy<Value = Vec<&'static str>> + use<> {
    prop::sample::subsequence(names.to_vec(), 0..=names.len())
}

fn map(derivative: bool, name: &str, right: ExpressionText) -> EquationItem {
    EquationItem::Equation(EquationDeclaration { derivative, target: whole(name), right })
}

const STATES: &[&str] = &["x", "Ground Height", "output", "τ", "location_2"];
const OUTPUTS: &[&str] = &["y", "event", "a%b"];
const INPUTS: &[&str] = &["u", "priority", "in"];
const CONSTANTS: &[&str] = &["g", "end", "delay"];
const FUNCTIONS: &[&str] = &["f", "initial"];
const LABELS: &[&str] = &["hit", "on", "Panic Button"];
const LOCATIONS: &[&str] = &["A", "location", "In Flight"];

fn transition(name: &'static str) -> impl Strategy<Value = TransitionDeclaration> {
    let parts = (
        documentation(),
        formula(),
        some(LABELS),
        prop::sample::select(LOCATIONS.to_vec()),
        prop::collection::vec((prop::sample::select(STATES.to_vec()), formula()), 0..3),
        some(&["done", "sync"]),
    );
    parts.prop_map(move |(documentation, guard, labels, destination, resets, emitted)| {
        let labels: Vec<_> = labels.into_iter().map(spanned).collect();
        let resets = resets.into_iter().map(|(name, right)| Statement::Assign { target: whole(name), right });
        TransitionDeclaration {
            name: spanned(name),
            documentation,
            trigger: match labels.as_slice() {
                [] => TriggerDeclaration::When(Some(guard)),
                _ => TriggerDeclaration::WhenOrOn(Some(guard), labels),
            },
            priority: None,
            destination: spanned(destination),
            actions: resets.chain(emitted.into_iter().map(|label| Statement::Emit(spanned(label)))).collect(),
        }
    })
}

/// A location; `outputs` in the order of their declaration.
fn location(name: &'static str, outputs: Vec<&'static str>) -> impl Strategy<Value = LocationDeclaration> {
    let maps: Vec<_> =
        outputs.into_iter().map(|output| formula().prop_map(move |right| (output, right))).collect();
    let dynamics = prop::collection::vec((prop::sample::select(STATES.to_vec()), formula()), 0..4);
    let transitions = (transition("t"), transition("when"), 0..3_usize);
    (documentation(), dynamics, maps, transitions).prop_map(
        move |(documentation, dynamics, maps, (t, w, count))| {
            let right = |output: &str, right: ExpressionText| {
                if STATES.contains(&output) { expression(&format!("'{output}'")) } else { right }
            };
            LocationDeclaration {
                name: spanned(name),
                documentation,
                variables: Vec::new(),
                equations: Equations {
                    dynamics: dynamics.into_iter().map(|(state, right)| map(true, state, right)).collect(),
                    constraints: Vec::new(),
                    output: maps
                        .into_iter()
                        .map(|(name, formula)| map(false, name, right(name, formula)))
                        .collect(),
                },
                invariant: None,
                transitions: [t, w].into_iter().take(count).collect(),
            }
        },
    )
}

/// Shown by its content.
struct Shown(Declarations);

impl std::fmt::Debug for Shown {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.0.plain())
    }
}

/// What both languages can say, in the order in which both say it.
fn declarations() -> impl Strategy<Value = Shown> {
    let names: Vec<&'static str> = OUTPUTS.iter().chain(STATES).copied().collect();
    let interface = (some(INPUTS), some(&names));
    let locations = some(LOCATIONS).prop_filter("one at least", |names| !names.is_empty());
    (interface, locations).prop_flat_map(|((inputs, outputs), locations)| {
        let locations: Vec<_> = locations.into_iter().map(|name| location(name, outputs.clone())).collect();
        let texts = prop::collection::vec(documentation(), 40);
        let head = (some(CONSTANTS), some(FUNCTIONS), some(CONSTANTS), some(STATES), some(STATES));
        let units = prop::collection::vec(prop::option::of("[a-z/2]{1,4}"), 40);
        let formulas = prop::collection::vec(formula(), 40);
        let tail = (prop::option::of(prop::sample::select(LOCATIONS.to_vec())), Just((inputs, outputs)));
        (locations, texts, head, units, formulas, tail).prop_map(declared)
    })
}

type Parts = (
    Vec<LocationDeclaration>,
    Vec<String>,
    (Vec<&'static str>, Vec<&'static str>, Vec<&'static str>, Vec<&'static str>, Vec<&'static str>),
    Vec<Option<String>>,
    Vec<ExpressionText>,
    (Option<&'static str>, (Vec<&'static str>, Vec<&'static str>)),
);

fn declared((locations, texts, head, units, formulas, tail): Parts) -> Shown {
    let (constants, functions, knobs, initial, views) = head;
    let (initial_location, (inputs, outputs)) = tail;
    let (mut texts, mut units, mut formulas) = (texts.into_iter(), units.into_iter(), formulas.into_iter());
    let mut text = || texts.next().unwrap_or_default();
    let mut formula = || formulas.next().unwrap_or_else(|| expression("1"));
    let mut component = ComponentDeclaration::new(ComponentKind::Ctc, spanned("My System"), Dialect::Xml);
    component.documentation = text();
    for &name in STATES {
        component.variables.push(VariableDeclaration {
            role: VariableRole::State,
            name: spanned(name),
            documentation: text(),
            kind: None,
            range: None,
            initial: None,
            unit: None,
        });
    }
    let ports = inputs.iter().map(|name| (Direction::Input, name));
    for (direction, name) in ports.chain(outputs.iter().map(|name| (Direction::Output, name))) {
        component.ports.push(PortDeclaration {
            name: spanned(name),
            documentation: text(),
            direction,
            kind: None,
            range: None,
            unit: None,
        });
    }
    for &name in &knobs {
        component.knobs.push(KnobDeclaration {
            name: spanned(name),
            documentation: text(),
            range: Some(RangeText::Bounds(formula(), formula())),
            unit: None,
        });
    }
    for &name in &constants {
        // The documentation of a knob is that of the constant.
        let documentation = if knobs.contains(&name) { String::new() } else { text() };
        component.parameters.push(ParameterDeclaration {
            name: spanned(name),
            documentation,
            kind: None,
            value: formula(),
            unit: None,
        });
    }
    let mut named: Vec<&str> = STATES.to_vec();
    for name in inputs.iter().chain(&outputs).chain(&knobs).chain(&constants) {
        if !named.contains(name) {
            named.push(name);
        }
    }
    for name in named {
        if let Some(unit) = units.next().flatten() {
            component.units.push((spanned(name), spanned(&unit)));
        }
    }
    for (name, right) in initial.into_iter().zip(["2*g", "end^2", "-1", "1", "delay"]) {
        component.initial.push(Statement::Assign { target: whole(name), right: expression(right) });
    }
    component.views = views.into_iter().map(spanned).collect();
    component.initial_location = initial_location.map(spanned);
    component.locations = locations;
    let functions = functions.into_iter().map(|name| FunctionDeclaration {
        name: spanned(name),
        documentation: text(),
        parameters: vec![(spanned("a"), None), (spanned("is"), None)],
        result: None,
        body: formula(),
    });
    Shown(Declarations {
        functions: functions.collect(),
        components: vec![component],
        ..Declarations::default()
    })
}

proptest! {
    #[test]
    fn sophy_xml_survives_the_way_through_hsml(original in declarations()) {
        let written_first = written(&original.0).text.expect("it is SOPHY XML");
        let first = read(&mut Sources::default(), "m.xml", written_first.as_bytes());
        let first = first.declarations.expect("a system");
        prop_assert_eq!(first.plain(), original.0.plain());
        let between = write_hsml(&first);
        let (sources, declarations) = hsml(&between);
        let writing = written(&declarations);
        prop_assert!(writing.text.is_some(), "{}\n{}", messages(&sources, &writing.diagnostics), between);
        let second = read(&mut Sources::default(), "m.xml", writing.text.expect("just seen").as_bytes());
        prop_assert_eq!(second.declarations.expect("a system").plain(), original.0.plain(), "{}", between);
    }
}
