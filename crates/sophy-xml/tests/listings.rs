//! The two printed listings with all their mistakes of this layer, and the corrected models without any.

use sophy_analysis::{Statement, TriggerDeclaration};
use sophy_diagnostics::{Sources, Style, render};
use sophy_xml::read;

fn messages(name: &str, text: &str) -> String {
    let mut sources = Sources::default();
    let reading = read(&mut sources, name, text.as_bytes());
    assert!(reading.declarations.is_some());
    let drawn = reading.diagnostics.sorted(&sources).into_iter().map(|d| render(&d, &sources, Style::Plain));
    drawn.collect::<Vec<_>>().join("\n\n")
}

#[test]
fn the_battery_of_the_paper() {
    insta::assert_snapshot!(messages(
        "paper_battery.xml",
        include_str!("../../../tests/suite/xml/paper_battery.xml")
    ));
}

#[test]
fn the_hopper_of_the_thesis() {
    let text = include_str!("../../../tests/suite/xml/thesis_a6_raiberts_hopper.xml");
    assert_eq!(messages("thesis_a6_raiberts_hopper.xml", text), "");
}

#[test]
fn the_corrected_hopper() {
    let text = include_str!("../../../examples/hopper/hopper.xml");
    assert_eq!(messages("hopper.xml", text), "");
    let mut sources = Sources::default();
    let declarations = read(&mut sources, "hopper.xml", text.as_bytes()).declarations.expect("a system");
    let [hopper] = declarations.components.as_slice() else { panic!("one component") };
    assert_eq!(hopper.name.value, "RaibertsHopper");
    assert!(
        hopper
            .documentation
            .starts_with("This file implements a model of the one legged robot called\n\"Raibert's")
    );
    let constants: Vec<_> =
        hopper.parameters.iter().map(|c| format!("{}={}", c.name.value, c.value.text)).collect();
    assert_eq!(constants.join(" "), "G=9.82 Tp=0.1 L=0.5 GAMMA=0.2 TAU=40 ETA=8");
    let initial = hopper.initial.iter().map(|statement| match statement {
        Statement::Assign { target, right } => format!("{}={}", target.name.value, right.text),
        other => panic!("{other:?}"),
    });
    let initial: Vec<_> = initial.collect();
    assert_eq!(initial.join(" "), "Position=1.9 Speed=0.1 Time=0 ETA2=0");
    assert_eq!(hopper.initial_location.as_ref().map(|l| l.value.as_str()), Some("Flight"));
    let units: Vec<_> = hopper.units.iter().map(|(n, u)| format!("{}:{}", n.value, u.value)).collect();
    assert_eq!(units.join(" "), "Position:m Speed:m/s Time:s ETA2:m2/s2");
    assert_eq!(hopper.variables[2].documentation, "Only used in the thrust location");
    for location in &hopper.locations {
        let [transition] = location.transitions.as_slice() else { panic!("one transition each") };
        assert_eq!(location.equations.dynamics.len(), 4, "{}", location.name.value);
        assert_eq!(location.equations.output.len(), 2, "{}", location.name.value);
        let TriggerDeclaration::When(Some(guard)) = &transition.trigger else { panic!("a domain") };
        let span = guard.map.whole();
        let arrow = format!("{} --{}--> {}", location.name.value, guard.text, transition.destination.value);
        let expected = match location.name.value.as_str() {
            "Flight" => "Flight --Position < L--> Compression",
            "Compression" => "Compression --Speed > 0--> Thrust",
            "Thrust" => "Thrust --(Time > Tp) || (Position > L)--> Decompression",
            _ => "Decompression --Position > L--> Flight",
        };
        assert_eq!(arrow, expected);
        let decoded = sources.excerpt(span).replace("&lt;", "<").replace("&gt;", ">");
        assert_eq!(decoded, *guard.text);
    }
}

#[test]
fn the_corrected_battery() {
    let text = include_str!("../../../examples/battery/battery.xml");
    assert_eq!(messages("battery.xml", text), "");
}
