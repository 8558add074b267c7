//! `read` after `write` gives back what was written, places aside.

use proptest::prelude::*;
use sophy_analysis::{
    ConstantDeclaration, Declarations, EquationDeclaration, ExpressionText, FunctionDeclaration,
    LocationDeclaration, Spanned, TransitionDeclaration, VariableDeclaration,
};
use sophy_diagnostics::{SourceId, Sources, Span, TextMap};
use sophy_syntax::parse_expression;
use sophy_xml::{read, write};

fn source() -> SourceId {
    Sources::default().add("", "")
}

fn spanned(text: String) -> Spanned<String> {
    Spanned::new(text, Span::new(source(), 0..0))
}

fn expression(text: String) -> ExpressionText {
    ExpressionText { parse: parse_expression(&text), text, map: TextMap::empty(source(), 0) }
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

fn variables() -> impl Strategy<Value = Vec<VariableDeclaration>> {
    list(
        (name(), documentation())
            .prop_map(|(name, documentation)| VariableDeclaration { name, documentation }),
    )
}

fn equations() -> impl Strategy<Value = Vec<EquationDeclaration>> {
    list((name(), formula()).prop_map(|(target, right)| EquationDeclaration { target, right }))
}

fn transition() -> impl Strategy<Value = TransitionDeclaration> {
    let parts = (name(), documentation(), formula(), name(), equations(), list(name()), list(name()));
    parts.prop_map(|(name, documentation, guard, destination, resets, input_events, output_events)| {
        TransitionDeclaration {
            name,
            documentation,
            guard: Some(guard),
            destination,
            resets,
            input_events,
            output_events,
        }
    })
}

fn location() -> impl Strategy<Value = LocationDeclaration> {
    (name(), documentation(), equations(), equations(), list(transition())).prop_map(
        |(name, documentation, dynamics, outputs, transitions)| LocationDeclaration {
            name,
            documentation,
            dynamics,
            outputs,
            transitions,
        },
    )
}

fn declarations() -> impl Strategy<Value = Declarations> {
    let constant = (name(), formula()).prop_map(|(name, value)| ConstantDeclaration { name, value });
    let function = (identifier(), list(identifier()), formula())
        .prop_map(|(name, parameters, body)| FunctionDeclaration { name, parameters, body });
    // No name that has a meaning.
    let hint = ("[A-Z]colour[a-z ]{0,5}[.]", name()).prop_map(|(name, value)| (spanned(name), value));
    let head =
        (name(), documentation(), list(constant), list(function), variables(), variables(), variables());
    let tail = (equations(), prop::option::of(name()), list((name(), name())), list(hint));
    (head, tail, prop::collection::vec(location(), 1..3)).prop_map(|(head, tail, locations)| {
        let (name, documentation, constants, functions, states, inputs, outputs) = head;
        let (initial, initial_location, units, hints) = tail;
        Declarations {
            name,
            documentation,
            constants,
            functions,
            states,
            inputs,
            outputs,
            initial,
            initial_location,
            units,
            hints,
            locations,
        }
    })
}

/// Everything but places and trees, in one text.
fn content(d: &Declarations) -> String {
    let equations = |list: &[EquationDeclaration]| {
        list.iter().map(|e| (e.target.value.clone(), e.right.text.clone())).collect::<Vec<_>>()
    };
    let variables = |list: &[VariableDeclaration]| {
        list.iter().map(|v| (v.name.value.clone(), v.documentation.clone())).collect::<Vec<_>>()
    };
    let values = |list: &[Spanned<String>]| list.iter().map(|s| s.value.clone()).collect::<Vec<_>>();
    let pairs = |list: &[(Spanned<String>, Spanned<String>)]| {
        list.iter().map(|(a, b)| (a.value.clone(), b.value.clone())).collect::<Vec<_>>()
    };
    let mut lines = vec![
        format!("{:?} {:?}", d.name.value, d.documentation),
        format!("{:?}", d.constants.iter().map(|c| (&c.name.value, &c.value.text)).collect::<Vec<_>>()),
        format!("{:?} {:?} {:?}", variables(&d.states), variables(&d.inputs), variables(&d.outputs)),
        format!("{:?} {:?}", equations(&d.initial), d.initial_location.as_ref().map(|l| &l.value)),
        format!("{:?} {:?}", pairs(&d.units), pairs(&d.hints)),
    ];
    for f in &d.functions {
        lines.push(format!("{:?} {:?} {:?}", f.name.value, values(&f.parameters), f.body.text));
    }
    for l in &d.locations {
        lines.push(format!("{:?} {:?}", l.name.value, l.documentation));
        lines.push(format!("{:?} {:?}", equations(&l.dynamics), equations(&l.outputs)));
        for t in &l.transitions {
            let guard = t.guard.as_ref().map(|guard| &guard.text);
            lines.push(format!(
                "{:?} {:?} {guard:?} {:?}",
                t.name.value, t.documentation, t.destination.value
            ));
            let events = (values(&t.input_events), values(&t.output_events));
            lines.push(format!("{:?} {events:?}", equations(&t.resets)));
        }
    }
    lines.join("\n")
}

proptest! {
    #[test]
    fn what_is_written_is_read_again(written in declarations()) {
        let text = write(&written);
        let reading = read(&mut Sources::default(), "m.xml", text.as_bytes());
        let complaint = reading.diagnostics.iter().find(|d| d.code.0.starts_with("SX"));
        prop_assert!(complaint.is_none(), "{complaint:?}\n{text}");
        let read = reading.declarations.expect("a system");
        prop_assert_eq!(content(&read), content(&written), "{}", text);
        prop_assert_eq!(write(&read), text);
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
        let again = write(&reading.declarations.expect("a system"));
        assert_eq!(lines(&again), lines(text));
    }
}

#[test]
fn a_character_that_xml_lacks_is_replaced() {
    let text = include_str!("../../../examples/hopper/hopper.xml");
    let reading = read(&mut Sources::default(), "hopper.xml", text.as_bytes());
    let mut hopper = reading.declarations.expect("a system");
    hopper.documentation = "bell \u{7}".to_owned();
    let again = write(&hopper);
    assert!(again.contains("<documentation>bell \u{FFFD}</documentation>"), "{again}");
}
