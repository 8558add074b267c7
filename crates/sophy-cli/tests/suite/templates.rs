//! `sophy new`: templates that are right as they are.

use crate::support::Folder;

const KINDS: [&str; 6] = ["ctc", "dtc", "lbc", "cc", "system", "hybrid"];

#[test]
fn every_template_is_laid_out_and_has_no_mistakes() {
    let folder = Folder::new("templates");
    for kind in KINDS {
        let file = format!("{kind}.hsml");
        folder.sophy(&["new", kind, "Pump_2", "-o", &file]).ends(0, &["wrote"]);
        assert!(folder.read(&file).contains("Pump_2 is"), "{kind}");
        assert!(!folder.read(&file).contains("Template"), "{kind}");
        let check = folder.sophy(&["check", &file]);
        check.ends(0, &["no mistakes found"]);
        // Not even a note.
        assert_eq!(check.err.lines().count(), 1, "{}", check.err);
        folder.sophy(&["fmt", "--check", &file]).ends(0, &["is laid out"]);
        // What is printed is what is written.
        assert_eq!(folder.sophy(&["new", kind, "Pump_2"]).out, folder.read(&file), "{kind}");
    }
}

#[test]
fn the_next_step_that_is_named_works() {
    let folder = Folder::new("templates_next");
    for kind in KINDS {
        let file = format!("{kind}.hsml");
        let new = folder.sophy(&["new", kind, "Thing", "-o", &file]);
        if ["dtc", "lbc"].contains(&kind) {
            new.ends(0, &[&format!("`sophy check {file}`"), "does not run"]);
            folder.sophy(&["check", &file]).ends(0, &["no mistakes found"]);
        } else {
            let plot = format!("{kind}.html");
            let stop = if kind == "system" { &["--stop", "1000"][..] } else { &[] };
            let run = [&["run", &file], stop, &["--plot", &plot]].concat();
            new.ends(0, &[&format!("`sophy {}`", run.join(" "))]);
            folder.sophy(&run).ends(0, &[&format!("wrote {plot}")]);
        }
    }
    folder.sophy(&["new", "experiment", "ctc", "-o", "ctc.toml"]).ends(0, &["`sophy run ctc.toml`"]);
    folder.sophy(&["run", "ctc.toml"]).ends(0, &["ctc.csv"]);
}

#[test]
fn a_component_with_an_input_runs_alone_when_it_is_given() {
    let folder = Folder::new("templates_alone");
    folder.sophy(&["new", "ctc", "Tank", "-o", "tank.hsml"]).ends(0, &[]);
    let alone = ["run", "tank.hsml", "--system", "Tank", "--input", "inflow=0.4"];
    folder.sophy(&alone).ends(0, &[]);
    folder.sophy(&alone[..4]).ends(1, &["--input inflow="]);
}

#[test]
fn an_experiment_fits_the_system_of_its_name() {
    let folder = Folder::new("templates_experiment");
    folder.sophy(&["new", "system", "Heating", "-o", "Heating.hsml"]).ends(0, &[]);
    folder.sophy(&["new", "experiment", "Heating", "-o", "Heating.toml"]).ends(0, &[]);
    folder.sophy(&["check", "Heating.toml"]).ends(0, &["no mistakes found"]);
    folder.sophy(&["run", "Heating.toml"]).ends(0, &["Heating.csv", "Heating.png"]);
}

#[test]
fn a_file_stays_unless_it_may_be_replaced() {
    let folder = Folder::new("templates_keep");
    folder.write("a.hsml", "mine");
    folder.sophy(&["new", "ctc", "A", "-o", "a.hsml"]).ends(4, &["a.hsml exists", "--force"]);
    assert_eq!(folder.read("a.hsml"), "mine");
    folder.sophy(&["new", "ctc", "A", "-o", "a.hsml", "--force"]).ends(0, &["wrote a.hsml"]);
    assert!(folder.read("a.hsml").contains("CTC A is"));
    folder.sophy(&["new", "ctc", "A", "--force"]).ends(2, &["--output"]);
}

#[test]
fn a_wrong_name_or_kind_is_wrong_use() {
    let folder = Folder::new("templates_names");
    folder.sophy(&["new", "ctc", "Ground Impact"]).ends(2, &["contains ` `", "write `Ground_Impact`"]);
    folder.sophy(&["new", "ctc", "end"]).ends(2, &["a word of the language"]);
    folder.sophy(&["new", "ctc", "2nd", "-o", "a.hsml"]).ends(2, &["begins with the digit 2"]);
    assert!(!folder.has("a.hsml"));
    folder.sophy(&["new", "robot", "A"]).ends(2, &["hybrid"]);
}

#[test]
fn answers_are_json_on_request() {
    let folder = Folder::new("templates_json");
    let answer = folder.sophy(&["new", "ctc", "A", "--format", "json"]);
    let value: serde_json::Value = serde_json::from_str(answer.out.trim()).expect("JSON");
    assert_eq!(value["kind"], "new");
    assert!(value["text"].as_str().is_some_and(|text| text.contains("CTC A is")));
}
