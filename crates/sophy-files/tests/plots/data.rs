//! Results with the looks of the examples, from formulas.

use std::collections::BTreeMap;

use sophy_record::{Column, ColumnKind, EventRecord, Metadata, Row, Schema, Sink, Table};

fn real(name: &str, unit: Option<&str>) -> Column {
    Column { name: name.to_owned(), unit: unit.map(str::to_owned), kind: ColumnKind::Real }
}

fn locations(name: &str, names: &[&str]) -> Column {
    let names = names.iter().map(|name| (*name).to_owned()).collect();
    Column { name: name.to_owned(), unit: None, kind: ColumnKind::Label(names) }
}

fn table(columns: Vec<Column>) -> Table {
    let pairs = [("model", "Hopper"), ("model_hash", "5f1e…"), ("seed", "1"), ("version", "0.1.0")];
    let entries: BTreeMap<String, String> =
        pairs.iter().map(|(k, v)| ((*k).to_owned(), (*v).to_owned())).collect();
    Table::new(Schema { columns, with_step: false }, Metadata { entries })
}

fn push(table: &mut Table, row: Row<'_>) {
    assert!(table.row(row).is_ok());
}

fn event(time: f64, transition: &str, from: &str, to: &str) -> EventRecord {
    let (transition, from, to) = (transition.to_owned(), from.to_owned(), to.to_owned());
    EventRecord { time, step: 0, component: String::new(), transition, from, to }
}

/// A mass that flies above the ground and pushes itself off a spring leg below one metre.
pub(crate) fn hopper(stop: f64) -> (Table, Vec<EventRecord>) {
    let names = ["Flight", "Compression", "Thrust", "Decompression"];
    let mut table =
        table(vec![real("position", Some("m")), real("speed", Some("m/s")), locations("location", &names)]);
    let mut events = Vec::new();
    let (mut t, mut y, mut v, mut location, mut pushed) = (0.0, 1.4, 0.0, 0_u32, 0.0);
    let step = 1e-3;
    let mut count = 0_u32;
    while t <= stop {
        if count.is_multiple_of(8) {
            push(&mut table, Row { time: t, step: 0, reals: &[y, v], labels: &[location] });
        }
        let force = match location {
            0 => 0.0,
            2 => 400.0 * (1.0 - y) + 38.0,
            _ => 400.0 * (1.0 - y),
        };
        v += step * (force - 9.81 - if location == 0 { 0.0 } else { 1.5 * v });
        y += step * v;
        count += 1;
        t = f64::from(count) * step;
        pushed += step;
        let next = match location {
            0 if y < 1.0 && v < 0.0 => Some((1, "touch-down")),
            1 if v >= 0.0 => Some((2, "bottom")),
            2 if pushed > 0.03 => Some((3, "thrust-end")),
            3 if y >= 1.0 => Some((0, "lift-off")),
            _ => None,
        };
        if let Some((to, transition)) = next {
            push(&mut table, Row { time: t, step: 0, reals: &[y, v], labels: &[location] });
            events.push(event(t, transition, names[location as usize], names[to as usize]));
            (location, pushed) = (to, 0.0);
            if location == 0 {
                v *= 0.98;
            }
            push(&mut table, Row { time: t, step: 0, reals: &[y, v], labels: &[location] });
        }
    }
    (table, events)
}

/// A charge that falls in eclipse, rises in sun and stays when full.
pub(crate) fn battery() -> (Table, Vec<EventRecord>) {
    let names = ["Charging", "Full", "Discharging"];
    let mut table = table(vec![real("battery.charge", Some("J")), locations("battery.location", &names)]);
    let corners =
        [(0.0, 60e3, 2), (1500.0, 21e3, 0), (3700.0, 90e3, 1), (4600.0, 90e3, 2), (5600.0, 48e3, 0)];
    let mut events = Vec::new();
    for (i, &(start, charge, location)) in corners.iter().enumerate() {
        let (end, to) = corners.get(i + 1).map_or((6000.0, 62e3), |next| (next.0, next.1));
        if i > 0 {
            let from = corners[i - 1].2;
            events.push(event(start, "switch", names[from as usize], names[location as usize]));
        }
        for k in 0..=20 {
            let share = f64::from(k) / 20.0;
            let time = start + share * (end - start);
            push(
                &mut table,
                Row { time, step: 0, reals: &[charge + share * (to - charge)], labels: &[location] },
            );
        }
    }
    (table, events)
}

/// A damped oscillation, without units for two of its variables.
pub(crate) fn oscillator() -> Table {
    let mut table = table(vec![real("x", None), real("v", None), real("energy", Some("J"))]);
    for i in 0..600 {
        let time = f64::from(i) * 0.05;
        let decay = libm::exp(-0.08 * time);
        let (x, v) = (decay * libm::cos(2.0 * time), -2.0 * decay * libm::sin(2.0 * time));
        let x = if (280..290).contains(&i) { f64::NAN } else { x };
        push(&mut table, Row { time, step: 0, reals: &[x, v, 1e-3 * decay * decay], labels: &[] });
    }
    table
}

/// Two noisy signals and one with a single peak, and two automata of which one is restless.
pub(crate) fn many_rows(rows: u32) -> Table {
    let mut table = table(vec![
        real("a.signal", Some("V")),
        real("b.signal", Some("V")),
        real("peak", Some("m/s^2")),
        locations("a.mode", &["on", "off"]),
        locations("b.mode", &["idle", "busy", "failed"]),
    ]);
    let mut state = 12345_u64;
    let mut noise = || {
        state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (state >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
    };
    for i in 0..rows {
        let time = f64::from(i) * 1e-4;
        let a = libm::sin(0.4 * time) + 0.2 * noise();
        let b = libm::cos(0.23 * time) + 0.1 * noise();
        let peak = if i == rows / 3 { 40.0 } else { 9.81 };
        let labels = [(i / 500) % 2, (i / (rows / 7 + 1)) % 3];
        push(&mut table, Row { time, step: 0, reals: &[a, b, peak], labels: &labels });
    }
    table
}

/// A constant, a zero and a number with late digits.
pub(crate) fn constant(rows: u32) -> Table {
    let mut table = table(vec![
        real("five", Some("N")),
        real("zero", None),
        real("pressure", Some("Pa")),
        locations("mode", &["only"]),
    ]);
    for i in 0..rows {
        let pressure = 101_325.0 + 1e-3 * libm::sin(0.3 * f64::from(i));
        push(&mut table, Row { time: f64::from(i), step: 0, reals: &[5.0, 0.0, pressure], labels: &[0] });
    }
    table
}
