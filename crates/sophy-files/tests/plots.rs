//! Pictures of results like those that the examples give. They stay in the target folder to be looked at.

#![allow(clippy::unwrap_used, reason = "a test stops at the first surprise")]

mod plots {
    pub(super) mod data;
}

use std::path::{Path, PathBuf};

use plots::data::{battery, constant, hopper, many_rows, oscillator};
use sophy_files::{PlotOptions, plot};
use sophy_record::{EventRecord, Table};

fn folder() -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("plots");
    std::fs::create_dir_all(&folder).unwrap();
    folder
}

/// Draws `NAME.svg`, `NAME.png` and `NAME.html` and gives the SVG and the page.
fn drawn(name: &str, table: &Table, events: &[EventRecord], options: &PlotOptions) -> (String, String) {
    let path = |extension| folder().join(format!("{name}.{extension}"));
    for extension in ["svg", "png", "html"] {
        plot(&path(extension), table, events, options).unwrap();
    }
    let png = std::fs::read(path("png")).unwrap();
    assert!(png.starts_with(b"\x89PNG"));
    let read = |extension| std::fs::read_to_string(path(extension)).unwrap();
    (read("svg"), read("html"))
}

/// The texts of a picture, which must be well-formed XML.
fn texts(svg: &str) -> Vec<String> {
    let document = roxmltree::Document::parse(svg).unwrap();
    let texts = document.descendants().filter(|node| node.has_tag_name("text"));
    texts.map(|node| node.text().unwrap_or("").to_owned()).collect()
}

fn has(texts: &[String], wanted: &[&str]) {
    for text in wanted {
        assert!(texts.iter().any(|t| t == text), "no \"{text}\" in {texts:?}");
    }
}

#[test]
fn hopper_has_units_locations_and_transitions() {
    let (table, events) = hopper(20.0);
    let (svg, page) = drawn("hopper", &table, &events, &PlotOptions::default());
    has(&texts(&svg), &["position (m)", "speed (m/s)", "time (s)", "Flight", "Compression", "location"]);
    has(&texts(&svg), &[&format!("{} transitions", events.len())]);
    assert!(svg.len() < 500_000);
    assert!(page.contains("position (m)") && !page.contains("http://") && !page.contains("src="));
}

#[test]
fn hopper_phase_portrait_is_its_own_figure() {
    let (table, events) = hopper(20.0);
    let phase = Some(("position".to_owned(), "speed".to_owned()));
    let (svg, page) =
        drawn("hopper-phase", &table, &events, &PlotOptions { phase, ..PlotOptions::default() });
    has(&texts(&svg), &["position (m)", "speed (m/s)", "Flight", "transition", "start", "end"]);
    assert!(!texts(&svg).iter().any(|text| text == "time (s)"));
    assert!(page.contains("Phase portrait"));
}

#[test]
fn long_hopper_run_shows_its_many_transitions_in_the_strip_only() {
    let (table, events) = hopper(1000.0);
    let (svg, _) = drawn("hopper-long", &table, &events, &PlotOptions::default());
    assert!(svg.len() < 500_000, "{}", svg.len());
    has(&texts(&svg), &["position (m)", "changes too fast to show"]);
    has(&texts(&svg), &[&format!("{} transitions, too many to mark", events.len())]);
}

/// Two components that take theirs at the same instant have taken two.
#[test]
fn transitions_at_one_instant_are_counted_each() {
    let (table, mut events) = battery();
    events.extend(events.clone());
    let (svg, _) = drawn("simultaneous", &table, &events, &PlotOptions::default());
    has(&texts(&svg), &["8 transitions"]);
}

#[test]
fn battery_over_hours() {
    let (table, events) = battery();
    let title = Some("Battery and solar array".to_owned());
    let (svg, _) = drawn("battery", &table, &events, &PlotOptions { title, ..PlotOptions::default() });
    has(&texts(&svg), &["Battery and solar array", "battery.charge (J)", "Charging", "Discharging"]);
}

#[test]
fn oscillator_without_locations() {
    let (svg, _) = drawn("oscillator", &oscillator(), &[], &PlotOptions::default());
    has(&texts(&svg), &["time (s)", "x", "v", "energy (10⁻³ J)"]);
    let size = Some((500, 300));
    let variables = Some(vec!["x".to_owned(), "v".to_owned()]);
    let options = PlotOptions { size, variables, ..PlotOptions::default() };
    let (svg, _) = drawn("oscillator-small", &oscillator(), &[], &options);
    assert!(svg.contains("width=\"500\" height=\"300\""), "{}", &svg[..200]);
    let phase = Some(("x".to_owned(), "v".to_owned()));
    drawn("oscillator-phase", &oscillator(), &[], &PlotOptions { phase, ..PlotOptions::default() });
}

#[test]
fn a_million_rows_stay_small() {
    let table = many_rows(1_000_000);
    let (svg, page) = drawn("many-rows", &table, &[], &PlotOptions::default());
    assert!(svg.len() < 500_000, "{}", svg.len());
    assert!(page.len() < 8_000_000, "{}", page.len());
    assert!(page.contains("of 1000000 rows"));
    let phase = Some(("a.signal".to_owned(), "b.signal".to_owned()));
    let (svg, _) = drawn("many-rows-phase", &table, &[], &PlotOptions { phase, ..PlotOptions::default() });
    assert!(svg.len() < 500_000, "{}", svg.len());
}

#[test]
fn constants_single_rows_gaps_and_nothing_at_all() {
    drawn("constant", &constant(50), &[], &PlotOptions::default());
    drawn("one-row", &constant(1), &[], &PlotOptions::default());
    drawn("no-row", &constant(0), &[], &PlotOptions::default());
    let (svg, _) = drawn("no-column", &Table::default(), &[], &PlotOptions::default());
    has(&texts(&svg), &["time (s)"]);
}

#[test]
fn names_cannot_break_out() {
    let (mut table, mut events) = hopper(2.0);
    let evil = "</script><script>alert(1)</script>{{data}}&\"'";
    table.schema.columns[0].name = evil.to_owned();
    table.schema.columns[0].unit = Some("<b>".to_owned());
    table.metadata.entries.insert(evil.to_owned(), evil.to_owned());
    events[0].transition = evil.to_owned();
    let title = Some(evil.to_owned());
    let phase = Some((evil.to_owned(), "speed".to_owned()));
    let (svg, page) =
        drawn("names", &table, &events, &PlotOptions { title, phase, ..PlotOptions::default() });
    texts(&svg);
    assert!(!page.contains("<script>alert") && !page.contains("<b>"));
    assert_eq!(page.matches("</script>").count(), 3);
}

#[test]
fn an_unknown_variable_is_named() {
    let (table, _) = hopper(1.0);
    let options = PlotOptions { variables: Some(vec!["height".to_owned()]), ..PlotOptions::default() };
    let error = plot(&folder().join("x.svg"), &table, &[], &options).unwrap_err().to_string();
    assert!(error.contains("height") && error.contains("position, speed"), "{error}");
    let error = plot(Path::new("x.pdf"), &table, &[], &PlotOptions::default()).unwrap_err().to_string();
    assert!(error.contains(".svg, .png, .html"), "{error}");
}
