//! `read` after `write` gives back what was written, places aside.

use plain::Plain;
use proptest::prelude::*;
use sophy_analysis::*;
use sophy_diagnostics::{SourceId, Sources, Span, TextMap};
use sophy_xml::{read, write};

#[path = "../../sophy-analysis/src/hsml/plain.rs"]
mod plain;

fn source() -> SourceId {
    Sources::default().add("", "")
}

fn spanned(text: String) -> Spanned<String> {
    Spanned::new(text, Span::new(source(), 0..0))
}

fn expression(text: String) -> ExpressionText {
    ExpressionText::parse(&text, TextMap::empty(source(), 0)).0
}

/// Names with whatever needs a reference, without blanks at the ends.
fn name() -> impl Strategy<Value = Spanned<String>> {
    "[A-Zτ_][a-z0-9 <>&'\"\\n\\t]{0,6}[a-z&]".prop_map(spanned)
}

fn identifier() -> impl Strategy<Value = Spanned<String>> {
    "[a-z_][a-z0-9_]{0,4}".prop_map(spanned)
}

fn formula() -> impl Strategy<Value = ExpressionText> {
    "[a-z0-9<(][a-z0-9<>&|+*() \\]\"'\\r\\n%]{0,12}[a-z0-9>)]".prop_map(expression)
}

/// One line or several, with indentation of their own; without blanks at the ends.
fn documentation() -> impl Strategy<Value = String> {
    prop_oneof![
        Just(String::new()),
        "[A-Z<&][a-z \"&<>\\r\\]]{0,9}[.>](\n{1,2} {0,3}[a-z][a-z <&]{0,9}[.>]){0,3}"
    ]
}

fn list<T: std::fmt::Debug>(of: impl Strategy<Value = T>) -> impl Strategy<Value = Vec<T>> {
    prop::collection::vec(of, 0..3)
}

fn state() -> impl Strategy<Value = VariableDeclaration> {
    (name(), documentation()).prop_map(|(name, documentation)| VariableDeclaration {
        role: VariableRole::State,
        name,
        documentation,
        kind: None,
        range: None,
        initial: None,
        unit: None,
    })
}

fn port(direction: Direction) -> impl Strategy<Value = PortDeclaration> {
    (name(), documentation()).prop_map(move |(name, documentation)| PortDeclaration {
        name,
        documentation,
        direction,
        kind: None,
        range: None,
        unit: None,
    })
}

fn whole(name: Spanned<String>) -> Target {
    Target { name, indices: Vec::new() }
}

fn equations(derivative: bool) -> impl Strategy<Value = Vec<EquationItem>> {
    list((name(), formula()).prop_map(move |(name, right)| {
        EquationItem::Equation(EquationDeclaration { derivative, target: whole(name), right })
    }))
}

fn assignments() -> impl Strategy<Value = Vec<Statement>> {
    list((name(), formula()).prop_map(|(name, right)| Statement::Assign { target: whole(name), right }))
}

fn transition() -> impl Strategy<Value = TransitionDeclaration> {
    let parts = (name(), documentation(), formula(), name(), assignments(), list(name()), list(name()));
    parts.prop_map(|(name, documentation, guard, destination, mut actions, input_events, output_events)| {
        actions.extend(output_events.into_iter().map(Statement::Emit));
        let trigger = match input_events.as_slice() {
            [] => TriggerDeclaration::When(Some(guard)),
            _ => TriggerDeclaration::WhenOrOn(Some(guard), input_events),
        };
        TransitionDeclaration { name, documentation, trigger, priority: None, destination, actions }
    })
}

fn location() -> impl Strategy<Value = LocationDeclaration> {
    (name(), documentation(), equations(true), equations(false), list(transition())).prop_map(
        |(name, documentation, dynamics, output, transitions)| LocationDeclaration {
            name,
            documentation,
            variables: Vec::new(),
            equations: Equations { dynamics, constraints: Vec::new(), output },
            invariant: None,
            transitions,
        },
    )
}

fn range() -> impl Strategy<Value = Option<RangeText>> {
    let bound = || {
        "[a-z0-9<(][a-z0-9<>&|+*\"'%]{0,5}[a-z0-9>)]"
            .prop_map(|text| expression(text.replace(['(', ')'], "x")))
    };
    prop::option::of(prop_oneof![
        (bound(), bound()).prop_map(|(low, high)| RangeText::Bounds(low, high)),
        prop::collection::vec(bound(), 1..4).prop_map(RangeText::Set),
    ])
}

/// Knobs `k…` and constants of other names, so that each documentation has one place.
fn knob() -> impl Strategy<Value = KnobDeclaration> {
    (identifier(), documentation(), range()).prop_map(|(name, documentation, range)| KnobDeclaration {
        name: spanned(format!("k{}", name.value)),
        documentation,
        range,
        unit: None,
    })
}

fn declarations() -> impl Strategy<Value = Declarations> {
    let constant = (name(), documentation(), formula()).prop_map(|(name, documentation, value)| {
        ParameterDeclaration { name, documentation, kind: None, value, unit: None }
    });
    let function = (identifier(), documentation(), list(identifier()), formula()).prop_map(
        |(name, documentation, parameters, body)| FunctionDeclaration {
            name,
            documentation,
            parameters: parameters.into_iter().map(|name| (name, None)).collect(),
            result: None,
            body,
        },
    );
    // No name that has a meaning.
    let hint = ("[A-Z]colour[a-z ]{0,5}[.]", name()).prop_map(|(name, value)| (spanned(name), value));
    let head = (name(), documentation(), list(constant), list(function), list(state()), list(knob()));
    let ports = (list(port(Direction::Input)), list(port(Direction::Output)));
    let tail = (assignments(), prop::option::of(name()), list((name(), name())), list(hint), list(name()));
    (head, ports, tail, prop::collection::vec(location(), 1..3)).prop_map(|(head, ports, tail, locations)| {
        let (name, documentation, mut parameters, mut functions, variables, mut knobs) = head;
        let (inputs, outputs) = ports;
        let (initial, initial_location, units, hints, views) = tail;
        // What is documented in a hint is found by its name, so that of two of one name only one is.
        let mut seen = std::collections::HashSet::new();
        knobs.retain(|knob| seen.insert(knob.name.value.clone()));
        parameters.retain(|parameter| seen.insert(parameter.name.value.clone()));
        functions.retain(|function| seen.insert(function.name.value.clone()));
        let component = ComponentDeclaration {
            documentation,
            ports: inputs.into_iter().chain(outputs).collect(),
            knobs,
            views,
            parameters,
            variables,
            initial,
            initial_location,
            units,
            hints,
            locations,
            ..ComponentDeclaration::new(ComponentKind::Ctc, name, Dialect::Xml)
        };
        Declarations { functions, components: vec![component], ..Declarations::default() }
    })
}

fn written(declarations: &Declarations) -> String {
    let writing = write(&declarations.components[0], &declarations.functions, &[]);
    assert!(writing.diagnostics.is_empty(), "{:?}", writing.diagnostics);
    writing.text.unwrap_or_default()
}

proptest! {
    #[test]
    fn what_is_written_is_read_again(original in declarations()) {
        let text = written(&original);
        let reading = read(&mut Sources::default(), "m.xml", text.as_bytes());
        let complaint = reading.diagnostics.iter().find(|d| d.code.0.starts_with("SX"));
        prop_assert!(complaint.is_none(), "{complaint:?}\n{text}");
        let read = reading.declarations.expect("a system");
        prop_assert_eq!(read.plain(), original.plain(), "{}", text);
        prop_assert_eq!(written(&read), text);
    }
}

#[test]
fn the_examples_come_back_as_they_are_but_for_comments() {
    for text in [
        include_str!("../../../examples/hopper/hopper.xml"),
        include_str!("../../../examples/battery/battery.xml"),
    ] {
        let lines = |text: &str| {
            let kept = text.lines().filter(|line| !line.trim_start().starts_with("<!--"));
            kept.map(|line| line.replace("&gt;", ">")).collect::<Vec<_>>()
        };
        let reading = read(&mut Sources::default(), "example.xml", text.as_bytes());
        let again = written(&reading.declarations.expect("a system"));
        assert_eq!(lines(&again), lines(text));
    }
}

#[test]
fn a_character_that_xml_lacks_is_replaced() {
    let text = include_str!("../../../examples/hopper/hopper.xml");
    let reading = read(&mut Sources::default(), "hopper.xml", text.as_bytes());
    let mut hopper = reading.declarations.expect("a system");
    hopper.components[0].documentation = "bell \u{7}".to_owned();
    let again = written(&hopper);
    assert!(again.contains("<documentation>bell \u{FFFD}</documentation>"), "{again}");
}
