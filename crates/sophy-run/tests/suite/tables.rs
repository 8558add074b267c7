//! Tables in rates, guards, outputs and resets; signal files.

use crate::support::{METHODS, by, is_first_order, run, to, try_run};
use sophy_ir::{Comparison, Interpolation as Between, Model, NodeId, Table};
use sophy_record::Side;
use sophy_run::{AtEnd, Experiment, Failure, Interpolation, Signal, SimulateError};
use sophy_testkit::Build;

fn table(knots: &[f64], values: &[f64], between: Between) -> Table {
    let (knots, values) = (knots.to_vec(), values.to_vec());
    Table { name: "lift.csv: Cl".to_owned(), knots, values, between, extends: false }
}

/// x′ = 1 from −2, y′ = table(x).
fn driven(table: &Table) -> Model {
    let mut b = Build::default();
    b.component("");
    let (x, y) = (b.state("x", -2.0), b.state("y", 0.0));
    let read = b.read(x);
    let here = b.location("all");
    let one = b.number(1.0);
    b.rate(here, x, one);
    let value = b.table(table, read);
    b.rate(here, y, value);
    b.model()
}

const KNOTS: [f64; 5] = [-2.0, -1.0, 0.5, 1.0, 3.0];
const VALUES: [f64; 5] = [1.0, -1.0, 2.0, 0.0, 4.0];

/// ∫ over whole pieces: rectangles and trapezia.
#[test]
fn a_rate_from_a_table_integrates_to_its_area() {
    let areas = |area: fn(f64, f64) -> f64| {
        let pieces = KNOTS.windows(2).zip(VALUES.windows(2));
        let areas = pieces.map(move |(k, v)| (k[1] - k[0]) * area(v[0], v[1]));
        areas.scan(0.0, |sum: &mut f64, area| {
            *sum += area;
            Some(*sum)
        })
    };
    for method in METHODS {
        for (between, expected) in [
            (Between::Hold, areas(|a, _| a).collect::<Vec<_>>()),
            (Between::Linear, areas(|a, b| (a + b) / 2.0).collect()),
        ] {
            let quantum = if is_first_order(method) { 1e-4 } else { 1e-6 };
            let model = driven(&table(&KNOTS, &VALUES, between));
            let result = run(&model, &by(method, to(5.0, quantum)));
            for (knot, expected) in KNOTS[1..].iter().zip(expected) {
                let found = result.trajectory.value(1, knot + 2.0, Side::Left);
                assert!(
                    (found - expected).abs() < 30.0 * quantum,
                    "{method:?} {between:?}: {found} at {knot}"
                );
            }
        }
    }
}

/// The natural spline through (0, 0), (1, 1), (2, 0) is 3/2·x − x³/2 up to 1, and symmetric.
#[test]
fn a_cubic_table_is_the_natural_spline() {
    let mut b = Build::default();
    b.component("");
    let (x, y) = (b.state("x", 0.0), b.state("y", 0.0));
    let read = b.read(x);
    let here = b.location("all");
    let one = b.number(1.0);
    b.rate(here, x, one);
    let value = b.table(&table(&[0.0, 1.0, 2.0], &[0.0, 1.0, 0.0], Between::Cubic), read);
    b.rate(here, y, value);
    let result = run(&b.model(), &to(2.0, 1e-6));
    for t in [0.25, 0.5, 1.0] {
        let expected = 0.75 * t * t - t * t * t * t / 8.0;
        let found = result.trajectory.value(1, t, Side::Left);
        assert!((found - expected).abs() < 1e-5, "{found} against {expected} at {t}");
    }
    assert!((result.trajectory.value(1, 2.0, Side::Left) - 1.25).abs() < 1e-5);
}

/// The same as nested choices: `if x < k₁ then … else if x < k₂ …`.
fn nested(b: &mut Build, table: &Table, at: NodeId) -> NodeId {
    let number = |b: &mut Build, value: f64| b.number(value);
    let last = table.knots.len() - 1;
    let piece = |b: &mut Build, i: usize| {
        let value = number(b, table.values[i]);
        if table.between == Between::Hold || i == last {
            return value;
        }
        let slope = (table.values[i + 1] - table.values[i]) / (table.knots[i + 1] - table.knots[i]);
        let (knot, slope) = (number(b, table.knots[i]), number(b, slope));
        let distance = b.sub(at, knot);
        let rise = b.mul(distance, slope);
        b.add(value, rise)
    };
    let mut rest = piece(b, last);
    for i in (0..last).rev() {
        let (knot, here) = (number(b, table.knots[i + 1]), piece(b, i));
        let below = b.less(at, knot);
        rest = b.graph().select(below, here, rest);
    }
    rest
}

/// x = sin t swings over the knots; y′ = table(x) and guards on that.
fn swinging(table: &Table, as_table: bool) -> Model {
    let mut b = Build::default();
    b.component("");
    let (x, v, y) = (b.state("x", 0.0), b.state("v", 1.0), b.state("y", 0.0));
    let [rx, rv] = [x, v].map(|id| b.read(id));
    let (here, there) = (b.location("here"), b.location("there"));
    let opposite = b.unary(sophy_ir::Unary::Negate, rx);
    let value = if as_table { b.table(table, rx) } else { nested(&mut b, table, rx) };
    for place in [here, there] {
        b.rate(place, x, rv);
        b.rate(place, v, opposite);
        b.rate(place, y, value);
    }
    let (up, down) = (b.number(0.35), b.number(0.15));
    let over = b.greater(value, up);
    let under = b.less(value, down);
    b.when(here, "over", over, there, &[]);
    b.when(there, "under", under, here, &[]);
    b.model()
}

/// No knot is missed and none is crossed twice, whatever the direction.
#[test]
fn swinging_over_knots_is_what_nested_choices_are() {
    let knots = [-2.0, -0.9, -0.25, 0.0, 0.3, 0.31, 0.7, 2.0];
    let values = [0.5, -1.0, 0.8, -0.4, 1.0, -0.7, 0.2, 0.0];
    for between in [Between::Hold, Between::Linear] {
        for method in METHODS {
            let table = table(&knots, &values, between);
            let experiment = Experiment { all_events: true, ..by(method, to(25.0, 1e-3)) };
            let [found, expected] =
                [true, false].map(|as_table| run(&swinging(&table, as_table), &experiment));
            for (state, quantity) in ["x", "v", "y"].iter().enumerate() {
                for t in [5.0, 12.5, 25.0] {
                    let [a, b] = [&found, &expected].map(|r| r.trajectory.value(state, t, Side::Left));
                    assert!((a - b).abs() < 1e-9, "{between:?} {method:?}: {quantity} is {a}, {b} at {t}");
                }
            }
            let transitions = |result: &crate::support::Result| -> Vec<(String, f64)> {
                let named = result.events.iter().filter(|e| !e.transition.contains("< 0"));
                named.map(|e| (e.transition.clone(), e.time)).collect()
            };
            let (a, b) = (transitions(&found), transitions(&expected));
            assert!(a.len() > 3 && a.len() == b.len(), "{between:?} {method:?}: {a:?} {b:?}");
            assert!(a.iter().zip(&b).all(|(a, b)| a.0 == b.0 && (a.1 - b.1).abs() < 1e-9));
            // Every crossing of a knot once: those of the choices are one truth each.
            let crossings = |result: &crate::support::Result| {
                let kinks = result.events.iter().filter(|e| e.transition.contains("< 0"));
                let mut times: Vec<f64> = kinks.map(|e| e.time).collect();
                times.sort_by(f64::total_cmp);
                times.dedup_by(|a, b| (*a - *b).abs() < 1e-9);
                times
            };
            let (a, b) = (crossings(&found), crossings(&expected));
            assert!(
                a.len() == b.len() && a.iter().zip(&b).all(|(a, b)| (a - b).abs() < 1e-9),
                "{a:?}\n{b:?}"
            );
        }
    }
}

/// y′ = the signal, a guard on y.
fn fed(signal: Option<&Table>) -> Model {
    let mut b = Build::default();
    b.component("");
    let y = b.state("y", 0.0);
    let value = match signal {
        Some(table) => {
            let time = b.time();
            b.table(table, time)
        }
        None => {
            let u = b.input("u");
            b.read(u)
        }
    };
    let read = b.read(y);
    let places = ["a", "b", "c", "d"].map(|name| b.location(name));
    for place in places {
        b.rate(place, y, value);
    }
    for (pair, level) in places.windows(2).zip([0.7, 1.23, 1.6]) {
        let level = b.number(level);
        let over = b.greater(read, level);
        b.when(pair[0], "over", over, pair[1], &[]);
    }
    b.model()
}

#[test]
fn a_signal_file_is_what_an_input_is() {
    let times = [0.1, 0.3, 0.7, 1.1, 1.9, 3.3];
    let values = [1.0, 3.0, -0.5, 0.75, 0.25, 2.0];
    for start in [0.1, 0.2] {
        for method in METHODS {
            for (between, interpolation) in
                [(Between::Hold, Interpolation::Hold), (Between::Linear, Interpolation::Linear)]
            {
                let signal = Signal {
                    times: times.to_vec(),
                    values: values.to_vec(),
                    interpolation,
                    at_end: AtEnd::Error,
                    origin: "a test".to_owned(),
                };
                // The last line is the last instant: it is still in the file.
                let experiment = Experiment { start, ..by(method, to(3.3, 1e-5)) };
                let given = Experiment { inputs: vec![("u".to_owned(), signal)], ..experiment.clone() };
                let read = run(&fed(Some(&table(&times, &values, between))), &experiment);
                let given = run(&fed(None), &given);
                let events = |r: &crate::support::Result| r.events.iter().map(|e| e.time).collect::<Vec<_>>();
                let (a, b) = (events(&read), events(&given));
                assert!(a.len() == 3 && b.len() == 3, "{a:?} {b:?}");
                for (a, b) in a.iter().zip(&b) {
                    assert!((a - b).abs() < 1e-4, "{method:?} {between:?}: {a} against {b}");
                    if between == Between::Hold && !is_first_order(method) {
                        assert_eq!(a.to_bits(), b.to_bits());
                    }
                }
                let [a, b] = [&read, &given].map(|r| r.trajectory.value(0, 3.3, Side::Left));
                assert!((a - b).abs() < 1e-3, "{method:?} {between:?}: {a} against {b}");
            }
        }
    }
}

/// The crossing of a knot by time is the knot, to the bit.
#[test]
fn a_table_of_time_switches_exactly_at_its_knots() {
    let knots: Vec<f64> = (1..200).map(|k| 0.1 * f64::from(k)).collect();
    let values: Vec<f64> = (1..200).map(|k| f64::from(k % 7)).collect();
    let held = table(&knots, &values, Between::Hold);
    let experiment = Experiment { start: knots[0], all_events: true, ..to(knots[198], 1e-3) };
    let result = run(&fed(Some(&held)), &experiment);
    let mut found: Vec<f64> =
        result.events.iter().filter(|e| e.transition.contains("lookup")).map(|e| e.time).collect();
    found.dedup();
    assert_eq!(found, knots[1..]);
}

fn failure(model: &Model, experiment: &Experiment) -> Failure {
    match try_run(model, experiment) {
        Err(SimulateError::Failure(failure)) => *failure,
        Err(other) => panic!("{other}"),
        Ok(_) => panic!("the run goes on"),
    }
}

#[test]
fn leaving_a_table_stops_the_run_where_it_is_left() {
    for between in [Between::Hold, Between::Linear, Between::Cubic] {
        let model = driven(&table(&KNOTS, &VALUES, between));
        run(&model, &to(5.0, 1e-3));
        let failure = failure(&model, &to(6.0, 1e-3));
        assert_eq!(failure.code.0, "SR0009");
        assert!((failure.time - 5.0).abs() < 1e-12, "{}", failure.time);
        for word in ["lift.csv", "`x` is", "-2 … 3", "t = "] {
            assert!(failure.message.contains(word), "{word}: {}", failure.message);
        }
    }
}

/// x′ = −1 below the first knot; the start below it.
#[test]
fn a_table_has_a_lower_end_too() {
    let mut b = Build::default();
    b.component("");
    let (x, y) = (b.state("x", 1.0), b.state("y", 0.0));
    let read = b.read(x);
    let here = b.location("all");
    let minus = b.number(-1.0);
    b.rate(here, x, minus);
    let value = b.table(&table(&[0.25, 2.0], &[1.0, 2.0], Between::Linear), read);
    b.rate(here, y, value);
    let stopped = failure(&b.model(), &to(2.0, 1e-3));
    assert!((stopped.time - 0.75).abs() < 1e-12 && stopped.code.0 == "SR0009", "{stopped:?}");
    let low = Experiment { initial: vec![("x".to_owned(), 0.1)], ..to(2.0, 1e-3) };
    let stopped = failure(&b.model(), &low);
    assert_eq!((stopped.time, stopped.code.0), (0.0, "SR0009"));
    assert!(stopped.message.contains("`x` is 0.1"), "{}", stopped.message);
}

#[test]
fn a_signal_file_begins_in_time_and_ends_in_time() {
    let mut signal = table(&[1.0, 2.0], &[3.0, 4.0], Between::Hold);
    let late = failure(&fed(Some(&signal)), &to(1.5, 1e-3));
    assert_eq!((late.time, late.code.0), (0.0, "SR0009"));
    let over = Experiment { start: 1.0, ..to(2.5, 1e-3) };
    let stopped = failure(&fed(Some(&signal)), &over);
    assert_eq!((stopped.time, stopped.code.0), (2.0, "SR0009"));
    assert!(stopped.helps[0].contains("`last`"));
    signal.extends = true;
    let result = run(&fed(Some(&signal)), &over);
    assert_eq!(result.trajectory.value(0, 2.5, Side::Left), 5.0);
}

/// Turning round on the last knot, touching it from below, and a transition that turns just there.
#[test]
fn the_ends_belong_to_the_range() {
    let mut b = Build::default();
    b.component("");
    let (x, v, y) = (b.state("x", 0.0), b.state("v", 2.0), b.state("y", 0.0));
    let [rx, rv] = [x, v].map(|id| b.read(id));
    let here = b.location("all");
    let minus = b.number(-2.0);
    b.rate(here, x, rv);
    b.rate(here, v, minus);
    let value = b.table(&table(&[0.0, 1.0], &[0.0, 1.0], Between::Linear), rx);
    b.rate(here, y, value);
    run(&b.model(), &to(2.0, 0.25));

    let mut b = Build::default();
    b.component("");
    let (x, y) = (b.state("x", 0.5), b.state("y", 0.0));
    let read = b.read(x);
    let (up, down) = (b.location("up"), b.location("down"));
    let [one, minus, low] = [1.0, -1.0, 0.25].map(|n| b.number(n));
    let value = b.table(&table(&[0.25, 1.0], &[1.0, 1.0], Between::Linear), read);
    for (place, rate) in [(up, one), (down, minus)] {
        b.rate(place, x, rate);
        b.rate(place, y, value);
    }
    let over = b.compare(Comparison::GreaterEqual, read, one);
    let under = b.compare(Comparison::LessEqual, read, low);
    b.when(up, "turn", over, down, &[]);
    b.when(down, "return", under, up, &[]);
    let result = run(&b.model(), &to(10.0, 1e-3));
    assert_eq!(result.events.len(), 13);
    assert!((result.trajectory.value(1, 10.0, Side::Left) - 10.0).abs() < 1e-2);
}

/// A table that only an output or a reset reads is evaluated as written, but its range holds there, too.
#[test]
fn outputs_and_resets_keep_to_the_range() {
    let clock = |outside: bool| {
        let mut b = Build::default();
        b.component("");
        let (x, z, y) = (b.state("x", 0.0), b.state("z", 0.0), b.output("y"));
        let read = b.read(x);
        let (here, there) = (b.location("here"), b.location("there"));
        let one = b.number(1.0);
        let values = table(&[0.0, 1.0, 4.0], &[0.0, 10.0, 40.0], Between::Linear);
        let value = b.table(&values, read);
        b.rate(here, x, one);
        b.rate(there, x, one);
        b.value(here, y, value);
        b.value(there, y, value);
        let over = b.compare(Comparison::GreaterEqual, read, one);
        let at = if outside { b.number(7.0) } else { one };
        let sum = b.add(read, at);
        let new = b.table(&values, sum);
        b.when(here, "over", over, there, &[(z, new)]);
        b.model()
    };
    let result = run(&clock(false), &to(4.0, 1e-3));
    assert_eq!(result.trajectory.value(1, 4.0, Side::Left), 20.0);
    let recorded = result.table.real("y").expect("recorded");
    assert!(recorded.iter().all(|y| (0.0..=40.0).contains(y)));
    let stopped = failure(&clock(false), &to(5.0, 1e-3));
    assert!((stopped.time - 4.0).abs() < 1e-12 && stopped.code.0 == "SR0009", "{stopped:?}");
    let stopped = failure(&clock(true), &to(3.0, 1e-3));
    assert!(stopped.notes.iter().any(|note| note.contains("lift.csv") && note.contains('8')), "{stopped:?}");
}

/// A guard on a table of a state: exact for straight pieces, by enclosures for cubic ones.
#[test]
fn a_guard_reads_a_table() {
    for between in [Between::Linear, Between::Cubic] {
        let mut b = Build::default();
        b.component("");
        let x = b.state("x", 0.0);
        let read = b.read(x);
        let (here, there) = (b.location("here"), b.location("there"));
        let one = b.number(1.0);
        b.rate(here, x, one);
        b.rate(there, x, one);
        let value = b.table(&table(&[0.0, 1.0, 2.0, 3.0], &[0.0, 0.0, 8.0, 8.0], between), read);
        let four = b.number(4.0);
        let over = b.greater(value, four);
        b.when(here, "over", over, there, &[]);
        let result = run(&b.model(), &to(3.0, 1e-3));
        assert_eq!(result.events.len(), 1);
        // By symmetry both pass the middle at 1.5.
        assert!((result.events[0].time - 1.5).abs() < 1e-9, "{}", result.events[0].time);
    }
}

/// Two tables of one file at one argument share their watches, and a long one has as few as a short one.
#[test]
fn a_long_table_costs_two_watches() {
    let count = 20_000;
    let knots: Vec<f64> = (0..=count).map(|k| 1e-3 * f64::from(k)).collect();
    let values: Vec<f64> = knots.iter().map(|k| libm::sin(*k)).collect();
    let long = table(&knots, &values, Between::Linear);
    let other = Table { name: "lift.csv: Cd".to_owned(), ..table(&knots, &knots, Between::Hold) };
    let mut b = Build::default();
    b.component("");
    let (x, y, z) = (b.state("x", 0.0), b.state("y", 0.0), b.state("z", 0.0));
    let read = b.read(x);
    let here = b.location("all");
    let one = b.number(1.0);
    b.rate(here, x, one);
    let (first, second) = (b.table(&long, read), b.table(&other, read));
    b.rate(here, y, first);
    b.rate(here, z, second);
    let system = sophy_passes::lower(&b.model()).expect("lowers");
    assert_eq!((system.watches.len(), system.stairs.len()), (2, 1));
    let begin = std::time::Instant::now();
    let result = run(&b.model(), &to(20.0, 1e-3));
    let found = result.trajectory.value(1, 20.0, Side::Left);
    assert!((found - (1.0 - libm::cos(20.0))).abs() < 1e-3, "{found}");
    assert!(result.report.statistics.engine.crossings < 3 * u64::from(count as u32));
    assert!(begin.elapsed().as_secs() < 10);
}

/// Many copies with one of two tables of equal shape: each reads its own.
#[test]
fn copies_share_programs_but_not_tables() {
    let tables = [VALUES, VALUES.map(|v| 2.0 * v)].map(|values| table(&KNOTS, &values, Between::Linear));
    let mut b = Build::default();
    for copy in 0..20 {
        b.component(&format!("c{copy}"));
        let (x, y) = (b.state("x", -2.0), b.state("y", 0.0));
        let read = b.read(x);
        let here = b.location("all");
        let one = b.number(1.0);
        b.rate(here, x, one);
        let value = b.table(&tables[copy % 2], read);
        b.rate(here, y, value);
    }
    let result = run(&b.model(), &to(5.0, 1e-4));
    for (copy, table) in tables.iter().cycle().enumerate().take(20) {
        let alone = run(&driven(table), &to(5.0, 1e-4)).trajectory.value(1, 5.0, Side::Left);
        let found = result.trajectory.value(2 * copy + 1, 5.0, Side::Left);
        assert_eq!(found.to_bits(), alone.to_bits(), "copy {copy}");
    }
}
