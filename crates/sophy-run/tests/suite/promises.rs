//! The promises of a run, as properties: the band, determinism, pausing, snapshots.

use crate::support::{METHODS, by, run, to};
use proptest::prelude::*;
use sophy_field::StateIndex;
use sophy_ir::Model;
use sophy_passes::lower;
use sophy_record::Table;
use sophy_run::{Experiment, Method, Pause, Recorder, Run, simulate};
use sophy_testkit::Build;
use sophy_testkit::problems::{self, Hopper};
use std::sync::Arc;

fn start(model: &Model, experiment: &Experiment) -> Run {
    Run::new(Arc::new(lower(model).expect("lowers")), experiment).expect("starts")
}

fn methods() -> impl Strategy<Value = Method> {
    prop::sample::select(METHODS.to_vec())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    /// |x − q| ≤ ΔQ at every instant, to rounding.
    #[test]
    fn x_stays_in_the_band_of_q(
        method in methods(),
        quantum in 1e-4f64..1e-2,
        instants in prop::collection::vec(0.0f64..6.0, 40),
        hopper in prop::bool::ANY,
    ) {
        let model = if hopper { Hopper::TAU40.model() } else { problems::oscillator() };
        let mut run = start(&model, &by(method, to(6.0, quantum)));
        let mut instants = instants;
        instants.sort_by(f64::total_cmp);
        let states = run.system().states.len();
        for t in instants {
            run.advance(t, u64::MAX).expect("goes on");
            for state in (0..states).map(StateIndex::new) {
                let (q, x) = run.quantised(state, t);
                prop_assert!((x - q).abs() <= quantum * (1.0 + 1e-9) + 1e-13, "{state} at {t}: {x} {q}");
            }
        }
    }

    /// Stopping anywhere and going on gives the bits of not stopping; so does going back to a snapshot.
    #[test]
    fn pausing_and_snapshots_leave_no_trace(
        method in methods(),
        pauses in prop::collection::vec((0.0f64..12.0, 1u64..3000), 1..6),
        back in 0.0f64..12.0,
    ) {
        let experiment = by(method, to(12.0, 1e-3));
        let model = Hopper::TAU40.model();
        let whole = fingerprint(&mut start(&model, &experiment), 12.0);
        let mut run = start(&model, &experiment);
        let mut pauses = pauses;
        pauses.sort_by(|a, b| a.0.total_cmp(&b.0));
        for (t, budget) in pauses {
            while run.advance(t, budget).expect("goes on") == Pause::Budget {}
        }
        prop_assert_eq!(&fingerprint(&mut run, 12.0), &whole);

        let mut run = start(&model, &experiment);
        run.advance(back, u64::MAX).expect("goes on");
        let snapshot = run.snapshot();
        let before = fingerprint(&mut run, 12.0);
        run.restore(&snapshot);
        prop_assert_eq!(run.time(), back);
        let after = fingerprint(&mut run, 12.0);
        prop_assert_eq!(before, after.clone());
        prop_assert_eq!(after, whole);
    }
}

/// The bits of all states and the counts of work at a time.
fn fingerprint(run: &mut Run, until: f64) -> (Vec<u64>, sophy_run::RunStatistics) {
    while run.advance(until, u64::MAX).expect("goes on") == Pause::Budget {}
    let states = (0..run.system().states.len()).map(StateIndex::new);
    (states.map(|s| run.state(s).to_bits()).collect(), run.statistics())
}

fn table(experiment: &Experiment) -> Table {
    let mut run = start(&Hopper::TAU40.model(), experiment);
    let mut recorder = Recorder::new(&run, experiment).expect("records");
    let mut table = Table::new(recorder.schema().clone(), Default::default());
    simulate(&mut run, &mut recorder, experiment, &mut [&mut table], &mut ()).expect("runs");
    table
}

#[test]
fn two_runs_are_bit_identical_and_do_not_depend_on_what_is_recorded() {
    let experiment = to(20.0, 1e-3);
    let first = table(&experiment);
    assert_eq!(first, table(&experiment));
    let grid = Experiment { every: Some(0.25), record: Some(vec!["y".to_owned()]), ..experiment };
    let sampled = table(&grid);
    assert_eq!(sampled.len(), 81);
    assert_eq!(sampled.time[3], 0.75);
    assert_eq!(sampled.reals[0].last(), first.real("y").unwrap().last());
}

#[test]
fn a_jump_has_a_row_before_and_a_row_after() {
    let table = table(&to(1.0, 1e-3));
    let (locations, names) = table.label("location").unwrap();
    let touchdown = (1..table.len()).find(|&k| locations[k] != locations[k - 1]).unwrap();
    assert_eq!(table.time[touchdown - 1], table.time[touchdown]);
    assert_eq!(names[locations[touchdown - 1] as usize], "Flight");
    assert_eq!(names[locations[touchdown] as usize], "Compression");
    assert_eq!(*table.time.last().unwrap(), 1.0);
    assert!(table.time.windows(2).all(|w| w[0] <= w[1]));
}

/// x′ = w with w = 1 before 1 s and −1 after, and what only outputs show: a sine of time and whether x < 0.5.
fn kinked() -> Model {
    let mut b = Build::default();
    b.component("");
    let x = b.state("x", 0.0);
    let [w, sine, low] = ["w", "sine", "low"].map(|name| b.output(name));
    let here = b.location("all");
    let [one, minus, half] = [1.0, -1.0, 0.5].map(|number| b.number(number));
    let (t, now, read) = (b.time(), b.read(x), b.read(w));
    let (early, small) = (b.less(t, one), b.less(now, half));
    let [rate, shown] = [(early, one, minus), (small, one, minus)].map(|(c, a, z)| b.graph().select(c, a, z));
    let wave = b.unary(sophy_ir::Unary::Sin, t);
    b.rate(here, x, read);
    for (output, value) in [(w, rate), (sine, wave), (low, shown)] {
        b.value(here, output, value);
    }
    b.model()
}

#[test]
fn where_a_value_jumps_with_a_condition_there_are_two_rows_and_curves_have_rows_between() {
    let table = run(&kinked(), &to(3.0, 1e-3)).table;
    let (w, sine, low) = (table.real("w").unwrap(), table.real("sine").unwrap(), table.real("low").unwrap());
    let jump = (1..table.len()).find(|&k| w[k] != w[k - 1]).unwrap();
    assert_eq!((table.time[jump - 1], table.time[jump]), (1.0, 1.0));
    assert_eq!((w[jump - 1], w[jump]), (1.0, -1.0));
    assert!(table.len() > 500 && table.time.windows(2).all(|w| w[1] - w[0] < 0.0061), "{}", table.len());
    assert!(table.time.iter().zip(sine).all(|(t, y)| (libm::sin(*t) - y).abs() < 1e-12));
    let falls = (1..table.len()).find(|&k| low[k] < low[k - 1]).unwrap();
    assert!((table.time[falls] - 0.5).abs() < 0.0061, "{}", table.time[falls]);
}

/// A throw of two seconds up to 4.905 m is one step of QSS3: without rows in it a picture shows its chord, nothing.
#[test]
fn segments_of_the_third_order_have_rows_within_them() {
    let mut b = Build::default();
    b.component("");
    let (x, v) = (b.state("x", 0.0), b.state("v", 9.81));
    let here = b.location("all");
    let (speed, gravity) = (b.read(v), b.number(-9.81));
    b.rate(here, x, speed);
    b.rate(here, v, gravity);
    let table = run(&b.model(), &by(Method::Qss3, to(2.0, 1e-3))).table;
    let highest = table.real("x").unwrap().iter().copied().fold(0.0, f64::max);
    assert!(table.len() >= 9 && (highest - 4.905).abs() < 1e-9, "{} rows up to {highest} m", table.len());
}

/// A reset from outside (an estimator's): guards are decided again, and what is enabled is taken at once.
#[test]
fn a_reset_from_outside_is_seen_by_the_guards() {
    let mut run = start(&Hopper::TAU40.model(), &to(5.0, 1e-3));
    run.advance(0.2, u64::MAX).expect("goes on");
    run.reset_states(&[(StateIndex(0), 0.4)]).expect("resets");
    assert_eq!(run.taken.len(), 1);
    assert_eq!(run.taken[0].time, 0.2);
    assert_eq!(run.location(sophy_field::AutomatonIndex(0)).0, 1, "Compression");
    assert_eq!(run.state(StateIndex(0)), 0.4);
    run.advance(1.0, u64::MAX).expect("goes on");
    assert!(run.taken.len() >= 3);
}

/// The Jacobian at any time is that of the closed form: Compression's ∂(η/y − γẏ − g)/∂(y, ẏ).
#[test]
fn the_jacobian_is_exact() {
    let mut run = start(&Hopper::TAU40.model(), &to(5.0, 1e-3));
    run.advance(0.6, u64::MAX).expect("goes on");
    let y = run.state(StateIndex(0));
    let jacobian = run.jacobian();
    let entry =
        |row: u32, column: u32| jacobian.iter().find(|e| e.0.0 == row && e.1.0 == column).map(|e| e.2);
    assert_eq!(entry(0, 1), Some(1.0));
    assert!((entry(1, 0).unwrap() + 8.0 / (y * y)).abs() < 1e-12);
    assert_eq!(entry(1, 1), Some(-0.2));
    assert_eq!(entry(2, 0), None);
}
