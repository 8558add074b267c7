//! Generated models: what a formatter, a listing or a conversion makes of a text is the same model, and runs to the
//! same bits.

#![allow(
    clippy::unwrap_used,
    clippy::panic,
    clippy::expect_used,
    reason = "a test stops at the first surprise"
)]

use proptest::prelude::*;
use proptest::sample::select;
use proptest::test_runner::{Config, RngAlgorithm, TestRng, TestRunner};
use sophy::{
    Experiment, FileWorld, Loaded, MemoryWorld, Root, World, WorldError, declarations_text, format, load_as,
    model_text, simulate, to_hsml, to_xml,
};
use sophy_testkit::repository;
use std::cell::Cell;
use std::path::{Path, PathBuf};

const CASES: u32 = 48;

fn load(file: &str, text: &str) -> Loaded {
    let world = MemoryWorld::default().with(file, text);
    let loaded = load_as(&world, Path::new(file), Root::IfClear);
    assert!(!loaded.diagnostics.has_errors(), "{:#?}\n{text}", loaded.messages());
    loaded
}

fn model(loaded: &Loaded) -> String {
    model_text(loaded.model.as_ref().expect("a model"))
}

/// The bits of all rows and events, or the message of the run that stopped.
fn outcome(loaded: &Loaded) -> Result<Vec<String>, String> {
    let record = Some(vec!["*".to_owned()]);
    let experiment = Experiment { stop: 2.0, record, ..Experiment::default() };
    let simulation = simulate(loaded.model.as_ref().unwrap(), &experiment).map_err(|e| e.to_string())?;
    let table = &simulation.table;
    let columns = std::iter::once(&table.time).chain(&table.reals);
    let columns =
        columns.map(|column| format!("{:x?}", column.iter().map(|v| v.to_bits()).collect::<Vec<_>>()));
    let labels = table.labels.iter().map(|column| format!("{column:?}"));
    let events = simulation.events.iter();
    let events = events.map(|e| {
        format!("{:x} {} {} {} {} {}", e.time.to_bits(), e.step, e.component, e.transition, e.from, e.to)
    });
    Ok(columns.chain(labels).chain(events).collect())
}

/// A number, a variable, or a function of these; every value of it is finite.
fn expression(names: Vec<String>) -> impl Strategy<Value = String> {
    let number = select(vec!["0.5", "1", "2", "1e-1", "0.25", "3"]).prop_map(str::to_owned);
    let leaf = prop_oneof![number, select(names)];
    leaf.prop_recursive(3, 8, 3, |inner| {
        let pair = (inner.clone(), inner.clone());
        prop_oneof![
            (pair.clone(), select(vec!["+", "-", "*"]))
                .prop_map(|((a, b), sign)| format!("( {a} {sign} {b} )")),
            (inner.clone(), select(vec!["sin", "cos", "abs", "-"])).prop_map(|(a, f)| format!("{f} ( {a} )")),
            (pair.clone(), select(vec!["min", "max"])).prop_map(|((a, b), f)| format!("{f} ( {a} , {b} )")),
            (pair, inner).prop_map(|((a, b), c)| format!("( if {a} > {b} then {c} else {a} )")),
        ]
    })
}

#[derive(Clone, Debug)]
struct Transition {
    state: usize,
    above: bool,
    level: String,
    to: usize,
    resets: Vec<Option<String>>,
}

/// A component of states that are drawn towards bounded values, with a ring of locations.
fn component(name: &'static str, open: bool) -> impl Strategy<Value = String> {
    (1_usize..4, 1_usize..4).prop_flat_map(move |(states, locations)| {
        let mut names: Vec<String> = (0..states).map(|x| format!("x{x}")).collect();
        names.extend(["k".to_owned(), "m".to_owned()]);
        names.extend(open.then(|| "u".to_owned()));
        let expressions = |count| prop::collection::vec(expression(names.clone()), count);
        let resets = prop::collection::vec(prop::option::of(expression(names.clone())), states + 1);
        let level = select(vec!["-1.5", "-0.25", "0.75", "1.5"]).prop_map(str::to_owned);
        let transition = (0..states, any::<bool>(), level, 0..locations, resets)
            .prop_map(|(state, above, level, to, resets)| Transition { state, above, level, to, resets });
        let transitions = prop::collection::vec(prop::collection::vec(transition, 0..3), locations);
        let words = any::<(bool, bool)>();
        (expressions(states * locations), expressions(1), transitions, words).prop_map(
            move |(rates, output, transitions, words)| {
                text(name, open, states, (&rates, &output[0]), &transitions, words)
            },
        )
    })
}

fn text(
    name: &str,
    open: bool,
    states: usize,
    (rates, output): (&[String], &str),
    transitions: &[Vec<Transition>],
    (shared, mode): (bool, bool),
) -> String {
    let mut lines =
        vec![format!("CTC {name} is interface"), "output ( y , signal ) ; knob ( k ) ;".to_owned()];
    lines.extend(open.then(|| "input ( u , signal ) ;".to_owned()));
    let word = if mode { "mode" } else { "state" };
    lines.push(format!("end interface ; body declarations {word} m := 0.5 ;"));
    lines.extend((0..states).map(|x| format!("state x{x} := 0.{x} ;")));
    lines.push("end declarations ;".to_owned());
    let rate = |x: usize, from: &str| format!("der ( x{x} ) = sin ( {from} ) * 2 - x{x} ;");
    if shared {
        lines.push(format!("dynamics {} end dynamics ;", rate(0, &rates[0])));
    }
    lines.push(format!("output y = sin ( {output} ) ; end output ;"));
    for (l, leaving) in transitions.iter().enumerate() {
        lines.push(format!("location L{l} dynamics"));
        lines.extend((usize::from(shared)..states).map(|x| rate(x, &rates[l * states + x])));
        lines.extend((!mode).then(|| "der ( m ) = 0 ;".to_owned()));
        lines.push("end dynamics ;".to_owned());
        for (t, transition) in leaving.iter().enumerate() {
            let Transition { state, above, level, to, resets } = transition;
            let sign = if *above { ">" } else { "<" };
            lines.push(format!("transition t{t} when x{state} {sign} {level} goto L{to} do"));
            // Beyond the level again only after a while.
            lines.push(format!("x{state} := {} ;", if *above { "-1" } else { "1" }));
            for (x, reset) in resets.iter().enumerate().filter(|(x, _)| x != state) {
                let target = if x == states { "m".to_owned() } else { format!("x{x}") };
                lines.extend(reset.iter().map(|value| format!("{target} := sin ( {value} ) ;")));
            }
            lines.push("end transition ;".to_owned());
        }
        lines.push("end location ;".to_owned());
    }
    lines.push("assignments k : 1.5 ; end assignments ; end body ;".to_owned());
    lines.join(" ") + "\n"
}

/// Two components, the one feeding the other.
fn composition() -> impl Strategy<Value = String> {
    (component("A", false), component("B", true)).prop_map(|(a, b)| {
        format!(
            "SYSTEM S is body components a : A ; b : B ( k : 2 ) ; end components ; \
             connections a.y -> b.u ; end connections ; end body ;\n{a}{b}"
        )
    })
}

/// The same words with other blanks and comments between them.
fn scattered(text: &str, gaps: &[u8]) -> String {
    let gap =
        |i: usize| [" ", "\n", "  ", "\t", " % a note\n", "\n\n\n"][usize::from(gaps[i % gaps.len()]) % 6];
    text.split_whitespace().enumerate().map(|(i, word)| format!("{word}{}", gap(i))).collect()
}

/// Checks all cases; at least half of the models must run to the end.
fn for_all(models: impl Strategy<Value = String>, check: impl Fn(&str, &[u8]) -> bool) {
    let config = Config { cases: CASES, failure_persistence: None, ..Config::default() };
    let ran = Cell::new(0);
    let gaps = prop::collection::vec(any::<u8>(), 7..40);
    // The same models every time, unless others are asked for: `GENERATED_SEED=7 cargo test -p sophy-sim …`.
    let seed: u64 = std::env::var("GENERATED_SEED").map_or(0, |seed| seed.parse().unwrap());
    let bytes: Vec<u8> =
        (0..32).map(|i| seed.wrapping_mul(2 * i + 1).to_le_bytes()[i as usize % 8]).collect();
    let rng = TestRng::from_seed(RngAlgorithm::ChaCha, &bytes);
    let result = TestRunner::new_with_rng(config, rng).run(&(models, gaps), |(text, gaps)| {
        ran.set(ran.get() + u32::from(check(&text, &gaps)));
        Ok(())
    });
    if let Err(error) = result {
        panic!("{error}");
    }
    assert!(ran.get() >= CASES / 2, "only {} of {CASES} ran to the end", ran.get());
}

#[test]
fn a_model_survives_the_way_through_xml() {
    for_all(component("C", false), |text, _| {
        let first = load("c.hsml", text);
        let there = to_xml(&first);
        let xml = there.text.unwrap_or_else(|| panic!("{:#?}\n{text}", there.diagnostics));
        let between = load("c.xml", &xml);
        let back = to_hsml(&between).text.expect("all that XML says");
        let second = load("c.hsml", &back);
        assert_eq!(model(&between), model(&second), "{text}\n{back}");
        let bits = outcome(&first);
        assert!(bits == outcome(&between), "XML runs otherwise:\n{text}\n{xml}");
        assert!(bits == outcome(&second), "the model that came back runs otherwise:\n{text}\n{back}");
        // What stands for all locations stands in each of them now; from there on nothing changes.
        let again = to_xml(&second).text.expect("it came from there");
        assert_eq!(model(&load("c.xml", &again)), model(&between), "{xml}\n{again}");
        // XML has no modes: one comes back as a state that only transitions change.
        if !text.contains(" mode ") {
            assert_eq!(model(&first), model(&second), "{text}\n{back}");
        }
        bits.is_ok()
    });
}

#[test]
fn the_layout_does_not_change_a_generated_model() {
    for_all(composition(), |text, gaps| {
        let first = load("s.hsml", text);
        let scattered = scattered(text, gaps);
        let formatted = format("s.hsml", scattered.as_bytes()).text.expect("no mistakes");
        let listed = declarations_text(first.declarations.as_ref().unwrap());
        let bits = outcome(&first);
        for other in [&scattered, &formatted, &listed] {
            let second = load("s.hsml", other);
            assert_eq!(model(&first), model(&second), "{other}");
            assert!(bits == outcome(&second), "it runs otherwise:\n{other}");
        }
        bits.is_ok()
    });
}

/// The files on disk, but for one.
struct Instead(PathBuf, Vec<u8>);

impl World for Instead {
    fn read(&self, path: &Path) -> Result<Vec<u8>, WorldError> {
        if path == self.0 { Ok(self.1.clone()) } else { FileWorld.read(path) }
    }

    fn identity(&self, path: &Path) -> PathBuf {
        FileWorld.identity(path)
    }
}

#[test]
fn the_layout_does_not_change_the_models_of_the_suite_and_the_examples() {
    let root = repository();
    let mut folders =
        vec![root.join("tests/suite/good"), root.join("tests/suite/run"), root.join("examples")];
    let mut compared = 0;
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
                continue;
            }
            if path.extension().is_none_or(|extension| extension != "hsml") {
                continue;
            }
            let bytes = std::fs::read(&path).unwrap();
            let formatted = format("m.hsml", &bytes).text.expect("no mistakes");
            let text =
                |world: &dyn World| load_as(world, &path, Root::IfClear).model.as_ref().map(model_text);
            let before = text(&FileWorld);
            compared += usize::from(before.is_some());
            assert_eq!(before, text(&Instead(path.clone(), formatted.into_bytes())), "{}", path.display());
        }
    }
    assert!(compared > 80, "{compared}");
}
