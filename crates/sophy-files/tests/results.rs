//! Results in and out of every format.

#![allow(clippy::unwrap_used, reason = "a test stops at the first surprise")]

use std::fs;
use std::path::PathBuf;

use proptest::prelude::*;
use sophy_files::{EventLog, FileError, open_sink, read_events, read_table, write_table};
use sophy_record::{Column, ColumnKind, EventRecord, Metadata, Row, Schema, Sink, Table};

const EXTENSIONS: [&str; 3] = ["csv", "arrow", "parquet"];

fn path(name: &str) -> PathBuf {
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("results");
    fs::create_dir_all(&folder).unwrap();
    folder.join(name)
}

fn metadata(pairs: &[(&str, &str)]) -> Metadata {
    Metadata { entries: pairs.iter().map(|(k, v)| ((*k).to_owned(), (*v).to_owned())).collect() }
}

fn schema(with_step: bool) -> Schema {
    let real = |name: &str, unit: Option<&str>| Column {
        name: name.to_owned(),
        unit: unit.map(str::to_owned),
        kind: ColumnKind::Real,
    };
    let names = ["Flight", "a, \"quoted\" name", "Thrust"].map(str::to_owned).to_vec();
    let location = Column { name: "hopper.location".to_owned(), unit: None, kind: ColumnKind::Label(names) };
    Schema { columns: vec![real("position", Some("m")), real("a[1,2]", None), location], with_step }
}

/// Equal to the bit, except that one NaN is like another.
fn same(a: &Table, b: &Table) -> Result<(), TestCaseError> {
    let bits = |column: &[f64]| -> Vec<u64> {
        column.iter().map(|v| if v.is_nan() { u64::MAX } else { v.to_bits() }).collect()
    };
    prop_assert_eq!(&a.schema, &b.schema);
    prop_assert_eq!(&a.metadata, &b.metadata);
    prop_assert_eq!(bits(&a.time), bits(&b.time));
    prop_assert_eq!(&a.step, &b.step);
    prop_assert_eq!(&a.labels, &b.labels);
    for (a, b) in a.reals.iter().zip(&b.reals) {
        prop_assert_eq!(bits(a), bits(b));
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 48, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn what_is_written_is_read(
        rows in prop::collection::vec((0.0..1e3f64, any::<f64>(), any::<f64>(), 0..3u32, any::<u32>()), 0..40),
        with_step: bool,
        flush_after in 0..40usize,
    ) {
        let mut times: Vec<f64> = rows.iter().map(|row| row.0).collect();
        times.sort_by(f64::total_cmp);
        let mut expected = Table::new(schema(with_step), metadata(&[("model", "Hopper"), ("seed", "7")]));
        for extension in EXTENSIONS {
            let path = path(&format!("round.{extension}"));
            let mut table = Table::new(schema(with_step), expected.metadata.clone());
            let mut sink = open_sink(&path, &table.schema, &metadata(&[("model", "Hopper")])).unwrap();
            for (i, (time, row)) in times.iter().zip(&rows).enumerate() {
                let step = if with_step { row.4 } else { 0 };
                let row = Row { time: *time, step, reals: &[row.1, row.2], labels: &[row.3] };
                sink.row(row).unwrap();
                table.row(row).unwrap();
                if i == flush_after {
                    sink.flush().unwrap();
                }
            }
            sink.finish(&metadata(&[("seed", "7")])).unwrap();
            same(&read_table(&path).unwrap(), &table)?;
            expected = table;
        }
        // And from any format to any other.
        let again = path("again.csv");
        write_table(&again, &read_table(&path("round.parquet")).unwrap()).unwrap();
        same(&read_table(&again).unwrap(), &expected)?;
    }
}

/// Several batches and row groups.
#[test]
fn many_rows_come_back() {
    let mut table = Table::new(schema(false), metadata(&[]));
    for i in 0..300_000_u32 {
        let reals = [f64::from(i) / 3.0, libm::sin(f64::from(i))];
        table.row(Row { time: f64::from(i / 2), step: 0, reals: &reals, labels: &[i % 3] }).unwrap();
    }
    for extension in EXTENSIONS {
        let path = path(&format!("many.{extension}"));
        write_table(&path, &table).unwrap();
        assert_eq!(read_table(&path).unwrap(), table, "{extension}");
        fs::remove_file(path).unwrap();
    }
}

#[test]
fn parquet_leaves_nothing_else_behind() {
    let path = path("alone.parquet");
    fs::write(&path, "an older result").unwrap();
    let mut sink = open_sink(&path, &schema(false), &Metadata::default()).unwrap();
    assert!(!path.exists(), "an older result must not pass for this run's");
    sink.row(Row { time: 0.0, step: 0, reals: &[1.0, 2.0], labels: &[0] }).unwrap();
    sink.flush().unwrap();
    // The journal is read under its own name and, as long as there is nothing better, under the result's.
    let journal = path.with_extension("parquet.journal");
    assert_eq!(read_table(&journal).unwrap().len(), 1);
    assert_eq!(read_table(&path).unwrap().len(), 1);
    sink.finish(&Metadata::default()).unwrap();
    assert!(path.exists() && !journal.exists() && !path.with_extension("parquet.unfinished").exists());
}

#[test]
fn a_foreign_csv_is_read_without_its_description() {
    let path = path("foreign.csv");
    fs::write(&path, "time,step,x,mode,y\n0,0,1.5,idle,\n1,0,2.5,busy,NaN\n1,1,-3,idle,4\n2,0,tor").unwrap();
    let _ = fs::remove_file(path.with_extension("csv.meta.json"));
    let error = read_table(&path).map(|table| table.len());
    assert_eq!(error.unwrap(), 3, "the torn line is left out");
    let table = read_table(&path).unwrap();
    assert_eq!(table.step, [0, 0, 1]);
    assert_eq!(table.real("x").unwrap(), [1.5, 2.5, -3.0]);
    assert!(table.real("y").unwrap()[0].is_nan());
    let (positions, names) = table.label("mode").unwrap();
    assert_eq!((positions, names), (&[0, 1, 0][..], &["idle".to_owned(), "busy".to_owned()][..]));
}

/// `tests/foreign/README.md` says how the files were made.
#[test]
fn files_of_another_program_are_read() {
    for name in ["foreign.parquet", "foreign.arrow"] {
        let table =
            read_table(&PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/foreign").join(name)).unwrap();
        assert_eq!(table.time, [0.0, 1.0, 2.0], "{name}");
        assert_eq!(table.real("n").unwrap(), [1.0, 2.0, 3.0], "{name}");
        let x = table.real("x").unwrap();
        assert!(x[0] == 1.5 && x[1].is_nan() && x[2] == 3.0, "{name}: {x:?}");
        let (positions, names) = table.label("mode").unwrap();
        let texts: Vec<&str> = positions.iter().map(|&p| names[p as usize].as_str()).collect();
        assert_eq!(texts, ["a", "", "b"], "{name}");
    }
}

#[test]
fn mistakes_in_a_csv_are_located() {
    let check = |content: &str, expected: &str| {
        let path = path("wrong.csv");
        fs::write(&path, content).unwrap();
        let error = read_table(&path).unwrap_err().to_string();
        assert!(error.contains(expected), "{error}");
    };
    check("time,x\n0,1\n1,1.2.3\n", "wrong.csv:3: column x: expected a number, found \"1.2.3\"");
    check("time,x\n0,1\n1\n", "wrong.csv:3: 1 cells where the first line has 2");
    check("time,x\n0,1\n2,1\n1,1\n", "wrong.csv:4: time falls from 2 s to 1 s");
    check("", "no header line");
}

#[test]
fn unknown_extensions_list_the_known_ones() {
    let error = open_sink(&path("x.xlsx"), &schema(false), &Metadata::default()).err().unwrap();
    assert!(matches!(error, FileError::UnknownExtension { .. }));
    assert!(error.to_string().contains(".csv, .arrow, .parquet"), "{error}");
    assert!(read_table(&path("x")).unwrap_err().to_string().contains(".journal"));
}

#[test]
fn rows_that_do_not_fit_are_refused() {
    for extension in EXTENSIONS {
        let mut sink =
            open_sink(&path(&format!("fit.{extension}")), &schema(false), &Metadata::default()).unwrap();
        let row = Row { time: 0.0, step: 0, reals: &[1.0], labels: &[0] };
        assert!(sink.row(row).unwrap_err().to_string().contains("1 numbers"));
        let row = Row { time: 0.0, step: 0, reals: &[1.0, 2.0], labels: &[3] };
        assert!(sink.row(row).unwrap_err().to_string().contains("hopper.location"));
    }
}

#[test]
fn damaged_arrow_is_an_error_and_not_a_torn_tail() {
    let path = path("damaged.arrow");
    let mut table = Table::new(schema(false), Metadata::default());
    table.row(Row { time: 0.0, step: 0, reals: &[1.0, 2.0], labels: &[0] }).unwrap();
    write_table(&path, &table).unwrap();
    let bytes = fs::read(&path).unwrap();
    let mut damaged = bytes.clone();
    damaged[0] = 0;
    fs::write(&path, damaged).unwrap();
    assert!(matches!(read_table(&path), Err(FileError::Format { .. })));
    // Every prefix is either no result yet or one with at most the rows that were written.
    for length in 0..bytes.len() {
        fs::write(&path, &bytes[..length]).unwrap();
        match read_table(&path) {
            Ok(table) => assert!(table.len() <= 1),
            Err(error) => assert!(matches!(error, FileError::Missing { .. }), "{length}: {error}"),
        }
    }
}

#[test]
fn the_event_log_comes_back() {
    let path = path("events.csv");
    let event = |time, step, transition: &str| EventRecord {
        time,
        step,
        component: "hopper".to_owned(),
        transition: transition.to_owned(),
        from: "Flight".to_owned(),
        to: "Compression, \"deep\"".to_owned(),
    };
    let events =
        [event(0.1 + 0.2, 0, "touch-down"), event(0.1 + 0.2, 1, ""), event(1e-300, 4_000_000_000, "x")];
    let mut log = EventLog::create(&path, &metadata(&[("seed", "3")])).unwrap();
    for event in &events {
        log.append(event).unwrap();
    }
    log.flush().unwrap();
    assert_eq!(read_events(&path).unwrap(), events);
    log.finish(&metadata(&[("outcome", "done")])).unwrap();
    let description = fs::read_to_string(path.with_extension("csv.meta.json")).unwrap();
    assert!(description.contains("\"seed\": \"3\"") && description.contains("\"outcome\": \"done\""));

    let text = fs::read_to_string(&path).unwrap();
    fs::write(&path, &text[..text.len() - 2]).unwrap();
    assert_eq!(read_events(&path).unwrap(), events[..2], "a torn last line is left out");
}
