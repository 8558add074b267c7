//! Input signals and events as people write them.

#![allow(clippy::unwrap_used, reason = "a test stops at the first surprise")]

use std::fs;
use std::path::PathBuf;

use sophy_files::{read_columns, read_event_labels};

fn file(name: &str, content: &str) -> PathBuf {
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("inputs");
    fs::create_dir_all(&folder).unwrap();
    let path = folder.join(name);
    fs::write(&path, content).unwrap();
    path
}

#[test]
fn every_separator_gives_the_same_columns() {
    for (i, content) in [
        "time,power,load\n0,1.5,-2\n1,2e3,0\n",
        "time;power;load\r\n0;1.5;-2\r\n1;2e3;0\r\n",
        "time\tpower\tload\n0\t1.5\t-2\n1\t2e3\t0",
        "  time   power load\n  0  1.5   -2\n 1 2e3 0\n",
        "\u{feff}# measured\n% on a Monday\n\"time\", \"power\" ,load\n\n0, 1.5,-2\n1, 2e3, 0\n\n",
        "power,Time (s),load\n1.5,0,-2\n2e3,1,0\n",
        "t,power,mode,load\n0,1.5,idle,-2\n1,2e3,busy,0\n",
    ]
    .into_iter()
    .enumerate()
    {
        let input = read_columns(&file(&format!("separator{i}.csv"), content)).unwrap();
        assert_eq!(input.time, [0.0, 1.0], "{content}");
        let expected = [("power".to_owned(), vec![1.5, 2e3]), ("load".to_owned(), vec![-2.0, 0.0])];
        assert_eq!(input.columns, expected, "{content}");
    }
}

#[test]
fn a_file_without_header_numbers_its_columns() {
    let input = read_columns(&file("bare.txt", "0 5\n0.5 6\n0.5 7\n")).unwrap();
    assert_eq!(input.time, [0.0, 0.5, 0.5], "equal times are a jump");
    assert_eq!(input.columns, [("2".to_owned(), vec![5.0, 6.0, 7.0])]);
}

#[test]
fn mistakes_are_located() {
    let check = |content: &str, expected: &str| {
        let error = read_columns(&file("wrong.csv", content)).unwrap_err().to_string();
        assert!(error.contains(expected), "{error}");
    };
    check("time,p\n0,1\n1,2x\n", "wrong.csv:3: column p: expected a number, found \"2x\"");
    check("# head\n\ntime,p\n0,1\n1,\n", "wrong.csv:5: column p: expected a number, found \"\"");
    check("time;p\n0;1\n1;2,5\n", "expected a number with a decimal point instead of a comma, found \"2,5\"");
    check("time,p\n0,1\n1,nan\n", "wrong.csv:3: column p: expected a finite number, found \"nan\"");
    check("time,p\n0,1\nx,2\n", "wrong.csv:3: column time: expected a number, found \"x\"");
    check("time,p\n0,1\n2,2\n1,3\n", "wrong.csv:4: time falls from 2 s to 1 s");
    check("time,p\n0,1\n1,2,3\n", "wrong.csv:3: 3 cells where the first line has 2");
    check("time,p\n", "a header line but no rows");
    check("# nothing\n", "no rows");
    check("time,mode\n0,idle\n", "no column of numbers beside time");
}

#[test]
fn event_labels() {
    let expected = [(0.5, "go".to_owned()), (0.5, "stop, now".to_owned()), (2.0, "go".to_owned())];
    let with_header = file("events.csv", "time,label\n0.5,go\n0.5,\"stop, now\"\n2,go\n");
    assert_eq!(read_event_labels(&with_header).unwrap(), expected);
    let bare = file("bare-events.csv", "# pilot\n0.5;go\n0.5;stop, now\n2;go\n");
    assert_eq!(read_event_labels(&bare).unwrap(), expected);
    assert_eq!(read_event_labels(&file("no-events.csv", "time,label\n")).unwrap(), []);
    let check = |content: &str, expected: &str| {
        let error = read_event_labels(&file("wrong-events.csv", content)).unwrap_err().to_string();
        assert!(error.contains(expected), "{error}");
    };
    check("time,label\n1,\n", "wrong-events.csv:2: column label: expected an event label");
    check("time,label\nsoon,go\n", "expected a number, found \"soon\"");
    check("1,go\n0,go\n", "wrong-events.csv:2: time falls");
    check("1,go,now\n", "3 cells where the first line has 2");
}
