//! What is said of mistakes, and with which exit code.

use crate::support::{Folder, OSCILLATOR};

/// A model of the repository's test suite.
fn printed(name: &str) -> String {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/suite/xml");
    std::fs::read_to_string(format!("{path}/{name}")).expect("listing")
}

#[test]
fn a_wrong_flag_is_wrong_use_and_its_name_is_suggested() {
    let folder = Folder::with_oscillator("wrong_flag");
    folder.sophy(&["run", "oscillator.xml", "--quantm", "1"]).ends(2, &["--quantum"]);
    folder.sophy(&["run", "oscillator.xml", "--stop", "soon"]).ends(2, &["--stop", "expected a number"]);
    folder.sophy(&["run", "oscillator.xml", "--set", "stiffness"]).ends(2, &["NAME=VALUE"]);
    folder.sophy(&["run", "oscillator.xml", "--method", "qss9"]).ends(2, &["qss2"]);
    folder.sophy(&[]).ends(2, &["Usage"]);
}

#[test]
fn a_mistake_in_a_flag_is_shown_at_the_flag() {
    let folder = Folder::with_oscillator("mistaken_flag");
    folder.sophy(&["run", "oscillator.xml", "--set", "stifness=2", "--record", "x,vv"]).ends(
        1,
        &["no parameter `stifness`", "did you mean `stiffness`?", "command line:1:", "--set stifness=2"],
    );
    folder
        .sophy(&["run", "oscillator.xml", "--plot", "a.jpg"])
        .ends(1, &["--plot a.jpg", ".png, .svg and .html"]);
    assert!(!folder.has("a.jpg"));
}

#[test]
fn all_mistakes_of_an_experiment_are_said_at_once_at_their_keys() {
    let folder = Folder::with_oscillator("experiment");
    folder.write(
        "wrong.toml",
        "model = \"oscillator.xml\"\nspeed = 1\n[run]\nstop = \"20\"\nsed = 1\n[engine]\nmethod = \"qss\"\n\
         [inputs]\nu = { file = \"nothing.csv\", interpolate = \"cubic\" }\n",
    );
    folder.sophy(&["check", "wrong.toml"]).ends(
        1,
        &[
            "no key `speed`",
            "wrong.toml:2:1",
            "expected a finite number",
            "wrong.toml:4:8",
            "did you mean `seed`?",
            "did you mean `qss1`?",
            "`cubic` is not known here",
            "nothing.csv",
        ],
    );
    folder.write(
        "unfit.toml",
        "model = \"oscillator.xml\"\n[knobs]\nstifness = 1\n[initial]\ny = 1\n[record]\nvariables = [\"x\", \"w\"]\n",
    );
    folder
        .sophy(&["run", "unfit.toml"])
        .ends(1, &["no parameter `stifness`", "unfit.toml:3:1", "unfit.toml:5:1"]);
}

#[test]
fn check_counts_what_it_finds_in_the_printed_listings() {
    let folder = Folder::with_oscillator("listings");
    folder.write("battery.xml", &printed("paper_battery.xml"));
    folder.write("hopper.xml", &printed("thesis_a6_raiberts_hopper.xml"));
    let answer = folder.sophy(&["check", "battery.xml", "hopper.xml", "oscillator.xml"]);
    answer.ends(1, &["battery.xml: ", " errors", "hopper.xml: ", "oscillator.xml: no mistakes found"]);
    assert!(answer.out.is_empty());
    folder.sophy(&["check", "oscillator.xml"]).ends(0, &["no mistakes found"]);
    folder.sophy(&["run", "battery.xml"]).ends(1, &["nothing was run"]);
}

#[test]
fn what_cannot_be_read_or_written_is_a_failure_of_files() {
    let folder = Folder::with_oscillator("files");
    folder.sophy(&["run", "missing.xml"]).ends(4, &["cannot read missing.xml"]);
    folder.sophy(&["check", "missing.toml"]).ends(4, &["cannot read missing.toml"]);
    folder.sophy(&["plot", "missing.csv"]).ends(4, &["missing.csv"]);
    folder.sophy(&["run", "oscillator.xml", "--output", "nowhere/a.csv"]).ends(4, &["nowhere/a.csv"]);
    folder.sophy(&["run", "oscillator.xml", "--output", "a.xls"]).ends(2, &["a.xls", ".parquet"]);
    folder.write("model.txt", "?");
    folder.sophy(&["run", "model.txt"]).ends(1, &["model.txt", ".xml"]);
}

#[test]
fn messages_are_json_lines_on_request() {
    let folder = Folder::with_oscillator("json");
    folder.write("broken.xml", &OSCILLATOR.replace("<domain>x &lt; 0", "<domain>xx &lt; 0"));
    let lines = |arguments: &[&str]| -> Vec<serde_json::Value> {
        let answer = folder.sophy(arguments);
        assert!(answer.err.is_empty(), "{}", answer.err);
        answer.out.lines().map(|line| serde_json::from_str(line).expect("JSON")).collect()
    };
    let check = lines(&["--format", "json", "check", "broken.xml"]);
    let unknown = check.iter().find(|line| line["code"] == "HS0101").expect("unknown name");
    assert_eq!(unknown["kind"], "diagnostic");
    assert_eq!(unknown["labels"][0]["file"], "broken.xml");
    assert_eq!(unknown["labels"][0]["line"], 21);
    assert_eq!(check.last().expect("a line")["errors"], 1);

    let run = lines(&["run", "oscillator.xml", "--stop", "10", "--format", "json"]);
    let summary = run.last().expect("a line");
    assert_eq!((&summary["kind"], &summary["outcome"]), (&"summary".into(), &"reached".into()));
    // cos t changes its sign at π/2, 3π/2 and 5π/2.
    assert_eq!(summary["transitions"], 3);
    let info = lines(&["info", "oscillator.xml", "--format", "json"]);
    assert_eq!(info[0]["states"][0]["name"], "x");
    folder.sophy(&["run", "oscillator.xml", "--format", "json", "--output", "-"]).ends(2, &[]);
}
