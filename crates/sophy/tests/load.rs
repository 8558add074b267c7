//! Models of several files and several components, and what is said of them.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test stops at the first surprise")]

mod load {
    mod memory;
}

use sophy::{
    Loaded, MemoryWorld, Quantum, Root, Style, check, load, load_as, load_experiment, render, to_hsml, to_xml,
};
use sophy_testkit::repository;
use std::path::Path;

const PARTS: &str = "\
CTC Lag is
interface
  input(u, signal);
  output(x, signal);
end interface;
body
  declarations
    state x := 1;
  end declarations;
  dynamics
    der(x) = u - k*x;
  end dynamics;
  assignments
    k : 1;
  end assignments;
end body;

CTC Gain is
interface
  input(u, signal);
  output(y, signal);
end interface;
body
  output
    y = k*u;
  end output;
  assignments
    k : 2;
  end assignments;
end body;
";

/// A system of `members` and `connections` that imports the parts.
fn system(members: &str, connections: &str) -> String {
    format!(
        "import \"parts/parts.hsml\";\nSYSTEM Loop is\nbody\n  components\n    {members}\n  end components;\n  \
         connections\n    {connections}\n  end connections;\nend body;\n"
    )
}

fn world(system: &str) -> MemoryWorld {
    MemoryWorld::default().with("models/loop.hsml", system).with("models/parts/parts.hsml", PARTS)
}

fn shown(loaded: &Loaded) -> String {
    let messages = loaded.messages();
    messages.iter().map(|message| render(message, &loaded.sources, Style::Plain) + "\n").collect()
}

#[test]
fn imported_components_are_found_and_count_in_the_hash() {
    let text = system("lag : Lag; gain : Gain(k : -1);", "lag.x -> gain.u; gain.y -> lag.u;");
    let loaded = load(&world(&text), Path::new("models/loop.hsml"));
    assert_eq!(shown(&loaded), "");
    assert_eq!(loaded.model.as_ref().unwrap().name(), "Loop");
    let declarations = loaded.declarations.as_ref().unwrap();
    let files: Vec<&str> =
        declarations.components.iter().map(|c| loaded.sources.name(c.name.span.source)).collect();
    assert_eq!(files, ["models/loop.hsml", "models/parts/parts.hsml", "models/parts/parts.hsml"]);
    // The hash is that of the two files, one after the other.
    let joined = MemoryWorld::default().with("both.hsml", format!("{text}{PARTS}"));
    let hash = |world: &MemoryWorld, path: &str| load(world, Path::new(path)).provenance.model_hash;
    assert_eq!(loaded.provenance.model_hash, hash(&joined, "both.hsml"));
    let other = world(&text).with("models/parts/parts.hsml", PARTS.replace("k : 2", "k : 3"));
    assert_ne!(loaded.provenance.model_hash, hash(&other, "models/loop.hsml"));
}

#[test]
fn the_root_is_what_is_asked_for() {
    let world = MemoryWorld::default()
        .with("parts.hsml", PARTS)
        .with("gain.toml", "model = \"parts.hsml\"\nsystem = \"Gain\"\n[inputs]\nu = 1.0\n");
    let name = |path: &str, root: Root<'_>| {
        let loaded = load_as(&world, Path::new(path), root);
        loaded
            .model
            .map(|model| model.name().to_owned())
            .ok_or_else(|| loaded.diagnostics.iter().map(|message| message.code.0).collect::<Vec<_>>())
    };
    assert_eq!(name("parts.hsml", Root::Implied), Err(vec!["HS0142"]));
    assert_eq!(name("parts.hsml", Root::IfClear), Err(vec![]));
    assert_eq!(name("parts.hsml", Root::Named("Lag")), Ok("Lag".to_owned()));
    assert_eq!(name("parts.hsml", Root::Named("Leg")), Err(vec!["HS0142"]));
    // The experiment's word counts, unless somebody says otherwise.
    assert_eq!(name("gain.toml", Root::Implied), Ok("Gain".to_owned()));
    assert_eq!(name("gain.toml", Root::IfClear), Ok("Gain".to_owned()));
    assert_eq!(name("gain.toml", Root::Named("Lag")), Ok("Lag".to_owned()));
}

#[test]
fn an_algebraic_loop_across_components_is_printed_equation_by_equation() {
    let text = system("a : Gain; b : Gain(k : 3);", "a.y -> b.u; b.y -> a.u;");
    let mut loaded = load(&world(&text), Path::new("models/loop.hsml"));
    assert_eq!(shown(&loaded), "");
    let found = check(&loaded);
    loaded.diagnostics.extend(found);
    let shown = shown(&loaded);
    for part in ["error[HS0303]", "a.y = k * u", "b.y = k * u", "models/parts/parts.hsml"] {
        assert!(shown.contains(part), "{part} is missing:\n{shown}");
    }
}

#[test]
fn what_was_understood_is_printed_as_hsml_that_means_the_same() {
    let text = system("lag : Lag; gain : Gain(k : -1);", "lag.x -> gain.u; gain.y -> lag.u;");
    let loaded = load(&world(&text), Path::new("models/loop.hsml"));
    let tree = sophy::declarations_text(loaded.declarations.as_ref().unwrap());
    assert!(!tree.contains("import"), "{tree}");
    let again = load(&MemoryWorld::default().with("tree.hsml", tree.clone()), Path::new("tree.hsml"));
    let model = |loaded: &Loaded| sophy::model_text(loaded.model.as_ref().unwrap());
    assert_eq!(model(&loaded), model(&again));
}

#[test]
fn a_conversion_names_what_cannot_be_said() {
    let there = |root: Root<'_>, text: &str| {
        let world = MemoryWorld::default().with("m.hsml", text);
        let loaded = load_as(&world, Path::new("m.hsml"), root);
        let conversion = to_xml(&loaded);
        let codes: Vec<&str> = conversion.diagnostics.iter().map(|message| message.code.0).collect();
        (conversion.text, codes.join(" "))
    };
    let (text, said) = there(Root::IfClear, PARTS);
    assert_eq!((text, said.as_str()), (None, "SX0401"));
    let (text, said) = there(Root::Named("Lag"), PARTS);
    assert!(text.is_some_and(|text| text.contains("<state>x</state>")), "{said}");
    let (text, said) = there(
        Root::IfClear,
        &system("lag : Gain;", "lag.y -> lag.u;").replace("import \"parts/parts.hsml\";", PARTS),
    );
    assert_eq!(text, None);
    assert!(!said.is_empty());
    // A model with errors is not converted, and that has been said by its messages.
    let (text, said) = there(Root::Named("Lag"), &PARTS.replace("k*x", "kk*x"));
    assert_eq!((text, said.as_str()), (None, ""));
}

#[test]
fn a_transition_of_sophy_xml_with_two_triggers_becomes_two() {
    let xml = "<SophySystem><name>M</name><states><state>x</state></states><inputs/><outputs/><locations>\
        <location><name>A</name><diffequation state=\"x\">1</diffequation><transitions><transition>\
        <name>leave</name><domain>DOMAIN</domain><reset><destination>A</destination>\
        <statereset state=\"x\">0</statereset></reset><inputevent>go</inputevent>\
        </transition></transitions></location></locations></SophySystem>";
    for (domain, notes, transitions) in [("x &gt; 1", 1, 2), ("false", 0, 1)] {
        let world = MemoryWorld::default().with("m.xml", xml.replace("DOMAIN", domain));
        let conversion = to_hsml(&load(&world, Path::new("m.xml")));
        assert_eq!(conversion.diagnostics.iter().filter(|d| d.code.0 == "FI0004").count(), notes, "{domain}");
        let text = conversion.text.unwrap();
        assert_eq!(text.matches("transition leave").count(), transitions, "{text}");
    }
}

/// The rule of a tolerance, said as a quantum, means the same.
#[test]
fn a_quantum_can_count_from_the_largest_value_so_far() {
    let experiment = "model = \"ball.hsml\"\n[engine]\nquantum = { default = 1e-3, y = { absolute = 1e-14, relative = 1e-5, largest = true } }\n";
    let ball =
        std::fs::read_to_string(repository().join("examples/bouncing-ball/bouncing-ball.hsml")).unwrap();
    let world = MemoryWorld::default().with("ball.hsml", ball).with("ball.toml", experiment);
    let loaded = load_experiment(&world, Path::new("ball.toml"));
    assert_eq!(shown(&loaded), "");
    let [default, y] = &loaded.setup.experiment.quanta[..] else { panic!("two quanta") };
    assert_eq!((default.pattern.as_str(), default.quantum), ("*", Quantum::absolute(1e-3)));
    let (found, expected) = (y.quantum, Quantum::from_tolerance(1e-4));
    assert!(found.largest && expected.largest);
    let near = |a: f64, b: f64| (a / b - 1.0).abs() < 1e-12;
    assert!(near(found.absolute, expected.absolute) && near(found.relative, expected.relative), "{found:?}");
}
