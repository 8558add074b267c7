//! What runs, conversions and pictures leave behind.

use crate::support::{Folder, OSCILLATOR};

#[test]
fn a_run_without_files_says_what_happened() {
    let folder = Folder::with_oscillator("summary");
    let answer = folder.sophy(&["run", "oscillator.xml", "--stop", "10", "--stats"]);
    answer.ends(0, &["reached t = 10 s after 3 transitions, in Left", "real time", "--output"]);
    assert!(answer.out.is_empty());
}

/// Every kind of work has its line: a plain label, then the number.
#[test]
fn stats_say_what_the_work_was() {
    let folder = Folder::with_oscillator("stats");
    let answer = folder.sophy(&["run", "oscillator.xml", "--stop", "10", "--stats"]);
    let number = |label: &str| -> u64 {
        let lines: Vec<&str> =
            answer.err.lines().filter_map(|line| line.trim().strip_prefix(label)).collect();
        let [line] = lines[..] else { panic!("{label}: {lines:?} of {}", answer.err) };
        let digits: String = line.trim_end_matches("ns, recording included").split_whitespace().collect();
        digits.parse().unwrap_or_else(|_| panic!("{label}: {line}"))
    };
    assert!(number("steps ") > 100);
    assert!(number("evaluations of rates") >= number("steps "));
    assert_eq!(number("events (transitions)"), 3);
    assert_eq!(number("rejected steps"), 0);
    assert!(number("crossings located") >= 3);
    assert_eq!(number("rejected predictions"), number("predicted") - number("crossings located"));
    assert!(number("time per step") > 0);
    // Without the flag they are not shown.
    let answer = folder.sophy(&["run", "oscillator.xml", "--stop", "10"]);
    assert!(!answer.err.contains("evaluations of rates"), "{}", answer.err);
}

#[test]
fn the_result_is_a_csv_on_stdout_for_a_dash() {
    let folder = Folder::with_oscillator("stdout");
    let answer = folder.sophy(&["run", "oscillator.xml", "--stop", "10", "--every", "0.5", "--output", "-"]);
    answer.ends(0, &["reached t = 10 s"]);
    let lines: Vec<&str> = answer.out.lines().collect();
    assert_eq!(lines[0], "time,x,v,location");
    assert_eq!(lines.len(), 22);
    for line in &lines[1..] {
        let cells: Vec<&str> = line.split(',').collect();
        let (time, x): (f64, f64) = (cells[0].parse().expect("time"), cells[1].parse().expect("x"));
        assert!((x - libm::cos(time)).abs() < 1e-2, "x({time}) = {x}");
    }
}

#[test]
fn every_file_asked_for_is_written_and_says_where_it_comes_from() {
    let folder = Folder::with_oscillator("files_written");
    folder
        .sophy(&[
            "run",
            "oscillator.xml",
            "--stop",
            "10",
            "-o",
            "a.csv",
            "-o",
            "a.arrow",
            "-o",
            "a.parquet",
            "--plot",
            "a.svg",
            "--plot",
            "a.html",
            "--events",
            "events.csv",
            "--set",
            "stiffness=1",
            "--seed",
            "7",
        ])
        .ends(0, &["wrote a.csv, a.arrow, a.parquet, events.csv, a.svg, a.html"]);
    let metadata: serde_json::Value = serde_json::from_str(&folder.read("a.csv.meta.json")).expect("JSON");
    let metadata = &metadata["metadata"];
    assert_eq!(metadata["model"], "Oscillator");
    assert_eq!(metadata["seed"], "7");
    assert_eq!(metadata["outcome"], "reached the stop time");
    assert!(metadata["model_hash"].as_str().expect("hash").starts_with("sha256:"));
    assert!(metadata["experiment"].as_str().expect("experiment").contains("\"stiffness\" = 1.0"));
    assert_eq!(folder.read("events.csv").lines().count(), 4);

    // All three formats hold the same.
    for format in ["arrow", "parquet"] {
        folder.sophy(&["convert", &format!("a.{format}"), "b.csv"]).ends(0, &["wrote b.csv"]);
        assert_eq!(folder.read("a.csv"), folder.read("b.csv"), "{format}");
    }
    folder
        .sophy(&["plot", "a.parquet", "--phase", "x,v", "--events", "events.csv"])
        .ends(0, &["wrote a.png"]);
    assert!(folder.has("a.png"));
    folder.sophy(&["plot", "a.csv", "--variables", "y"]).ends(2, &["y"]);
}

#[test]
fn an_experiment_is_run_in_its_folder_and_flags_win() {
    let folder = Folder::with_oscillator("experiment_run");
    std::fs::create_dir_all(folder.0.join("deep")).expect("folder");
    folder.write(
        "deep/swing.toml",
        "model = \"../oscillator.xml\"\n[run]\nstop = 5\n[engine]\nquantum = { default = 1e-3, x = 1e-4 }\n\
         [initial]\nx = 2\n[record]\noutput = \"swing.csv\"\n",
    );
    folder.sophy(&["check", "deep/swing.toml"]).ends(0, &["no mistakes found"]);
    assert!(!folder.has("deep/swing.csv"));
    folder.sophy(&["run", "deep/swing.toml", "--stop-time", "10"]).ends(0, &["t = 10 s after 3 transitions"]);
    assert!(folder.read("deep/swing.csv").lines().nth(1).expect("row").starts_with("0,2,0,Right"));
}

#[test]
fn inputs_come_from_files_and_constants() {
    let folder = Folder::new("inputs");
    let model = OSCILLATOR
        .replace("<inputs></inputs>", "<inputs><input>u</input></inputs>")
        .replace("-stiffness*x", "u");
    folder.write("driven.xml", &model);
    folder.write("u.csv", "t,u\n0,1\n1,-1\n3,0\n");
    folder.sophy(&["run", "driven.xml", "--stop", "3"]).ends(1, &["input `u`", "--input u="]);
    folder
        .sophy(&["run", "driven.xml", "--stop", "4", "--input", "u=u.csv"])
        .ends(1, &["ends at 3 s", "hold"]);
    let held = ["run", "driven.xml", "--stop", "4", "--input", "u=u.csv:u", "--after", "hold", "-o", "-"];
    let answer = folder.sophy(&held);
    answer.ends(0, &[]);
    // v is 1 after 1 s and −1 after 3 s; x = 1 + ½ + (1·2 − ½·4) − 1 at 4 s.
    let last: Vec<&str> = answer.out.lines().last().expect("a row").split(',').collect();
    let (x, v): (f64, f64) = (last[1].parse().expect("x"), last[2].parse().expect("v"));
    assert!((x - 0.5).abs() < 1e-2 && (v + 1.0).abs() < 1e-2, "{last:?}");
    folder.sophy(&["run", "driven.xml", "--stop", "1", "--input", "u=0.5"]).ends(0, &[]);
    folder.sophy(&["run", "driven.xml", "--input", "u=u.csv:w"]).ends(1, &["no column `w`"]);
}

#[test]
fn a_model_converts_to_its_canonical_form_and_stays_the_same() {
    let folder = Folder::with_oscillator("convert");
    folder.sophy(&["convert", "oscillator.xml", "one.xml"]).ends(0, &["wrote one.xml"]);
    folder.sophy(&["convert", "one.xml", "two.xml"]).ends(0, &[]);
    assert_eq!(folder.read("one.xml"), folder.read("two.xml"));
    folder.sophy(&["convert", "one.xml", "one.csv"]).ends(2, &["cannot convert"]);
}

#[test]
fn info_and_emit_show_the_model() {
    let folder = Folder::with_oscillator("info");
    let info = folder.sophy(&["info", "oscillator.xml"]);
    info.ends(0, &[]);
    for text in ["2 states", "stiffness", "to the left", "affine", "der(v)", "(initial)"] {
        assert!(info.out.contains(text), "{text}\n{}", info.out);
    }
    for stage in ["tree", "model", "system"] {
        let emitted = folder.sophy(&["run", "oscillator.xml", "--emit", stage]);
        emitted.ends(0, &[]);
        assert!(emitted.out.contains("Oscillator") && emitted.out.contains("stiffness"), "{}", emitted.out);
    }
}

#[test]
fn a_run_that_fails_leaves_complete_files_and_says_why() {
    let folder = Folder::new("failure");
    // x comes down to 2 too fast to turn round: the logarithm of what is left has no value.
    let model =
        OSCILLATOR.replace("<domain>x &lt; 0", "<domain>x &lt; -9").replace("-stiffness*x", "-log(x-2)");
    folder.write("falls.xml", &model);
    let answer = folder.sophy(&[
        "run",
        "falls.xml",
        "--initial",
        "x=3",
        "--initial",
        "v=-2",
        "-o",
        "falls.csv",
        "--stop",
        "50",
    ]);
    answer.ends(3, &["error[SR", "falls.xml:", "falls.csv"]);
    assert!(folder.read("falls.csv.meta.json").contains("failed: "));
    assert!(folder.read("falls.csv").lines().count() > 3);
}

/// Truth values and texts beside numbers.
const VALVE: &str = r#"
CTC Valve is
interface
  output(level, signal, "m");
  output(full, boolean);
end interface;
body
  declarations
    state level := 0 "m";
    mode stage in {"filling", "resting"} := "filling";
    flag top;
  end declarations;
  dynamics
    der(level) = if stage = "filling" then 1 else 0;
    top = level - 1;
  end dynamics;
  output
    full = level > 0.5;
  end output;
  event(top)
    negative-to-positive
      stage := "resting";
    end negative-to-positive;
  end event;
end body;
"#;

#[test]
fn texts_and_truth_values_are_recorded_as_they_are_written() {
    let folder = Folder::new("texts");
    folder.write("valve.hsml", VALVE);
    let answer = folder.sophy(&["run", "valve.hsml", "--stop", "2", "-o", "-"]);
    let lines: Vec<&str> = answer.ends(0, &[]).out.lines().collect();
    assert_eq!((lines[0], lines[1]), ("time,level,full", "0,0,false"));
    assert!(lines.last().expect("rows").ends_with(",true"), "{lines:?}");

    // Columns come in the order in which they are asked for.
    let recorded = "full,stage,level,full";
    let files = ["a.csv", "a.arrow", "a.parquet"].map(|file| ["-o", file]).concat();
    let run =
        [&["run", "valve.hsml", "--stop", "2", "--record", recorded, "--plot", "a.svg"][..], &files].concat();
    folder.sophy(&run).ends(0, &["wrote a.csv"]);
    let csv = folder.read("a.csv");
    assert!(csv.starts_with("time,full,stage,level\n0,false,filling,0\n"), "{csv}");
    assert!(csv.lines().last().expect("rows").starts_with("2,true,resting,1"), "{csv}");
    for format in ["arrow", "parquet"] {
        folder.sophy(&["convert", &format!("a.{format}"), "b.csv"]).ends(0, &["wrote b.csv"]);
        assert_eq!(csv, folder.read("b.csv"), "{format}");
    }
    let svg = folder.read("a.svg");
    for text in ["filling", "resting", "false", "true", "full", "stage", "level (m)"] {
        assert!(svg.contains(&format!(">{text}</text>")), "{text}\n{svg}");
    }
}

#[test]
fn the_summary_of_many_components_is_short() {
    let folder = Folder::new("many_locations");
    folder.write(
        "many.hsml",
        "CTC C is body declarations state x := 1; end declarations; location A dynamics der(x) = -1; end dynamics; \
         transition go when x < 0 goto B; end location; location B end location; end body;\n\
         SYSTEM Many is body components c : C[1000]; end components; end body;",
    );
    let answer = folder.sophy(&["run", "many.hsml", "--stop", "0.5"]);
    answer.ends(0, &["c[6] in A, and 994 more"]);
    assert!(!answer.err.contains("c[7]"), "{}", answer.err);
}

#[test]
fn a_picture_says_what_it_has_no_room_for() {
    let folder = Folder::new("no_room");
    folder.write(
        "many.hsml",
        "CTC C is interface output(y, signal, \"m\"); end interface; body declarations state y := 1; end \
         declarations; dynamics der(y) = -rate*y; end dynamics; assignments rate : 1; end assignments; end body;\n\
         SYSTEM Many is body components c : C[20]; end components; end body;",
    );
    let names = "8 of 20 variables, c[13].y … c[20].y";
    let run = ["run", "many.hsml", "--stop", "1", "--record", "*.y", "--plot", "a.svg", "-o", "a.csv"];
    folder.sophy(&run).ends(0, &[&format!("not shown in the picture: {names}"), "--record"]);
    assert!(folder.read("a.svg").contains(&format!("not shown: {names}")));
    folder
        .sophy(&["plot", "a.csv", "-o", "b.html"])
        .ends(0, &[&format!("not shown: {names}"), "--variables"]);
    assert!(folder.read("b.html").contains(&format!("Not shown: {names}.")));
}
