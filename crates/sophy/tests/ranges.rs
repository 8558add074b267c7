//! A declared range holds: for what an experiment sets, for what a variable starts with and is assigned.

#![allow(
    clippy::unwrap_used,
    clippy::panic,
    clippy::disallowed_methods,
    reason = "a test stops at the first surprise"
)]

use sophy::{Error, Experiment, Failure, MemoryWorld, Method, Quantum, QuantumRule, Signal, load, simulate};
use std::path::Path;

const GEARBOX: &str = "\
CTC Gearbox is
interface
  knob(pull, (0.5, most), \"m/s2\");
end interface;
body
  declarations
    state speed in (0, 3) := 0 \"m/s\";
    mode gear : integer in (1, 3) := 1;
    mode feel : string in {\"calm\", \"wild\"} := \"calm\";
  end declarations;
  location Driving
    dynamics
      der(speed) = pull;
    end dynamics;
    transition faster when speed >= 1 goto Driving do
      speed := 0;
      gear := gear + 1;
    end transition;
  end location;
  assignments
    most : 2;
    pull : 1;
  end assignments;
end body;
";

fn run(stop: f64, change: impl FnOnce(&mut Experiment)) -> Result<(), Error> {
    let world = MemoryWorld::default().with("gearbox.hsml", GEARBOX);
    let loaded = load(&world, Path::new("gearbox.hsml"));
    let messages = loaded.messages();
    assert!(messages.is_empty(), "{messages:#?}");
    let mut experiment = Experiment { stop, ..Experiment::default() };
    change(&mut experiment);
    simulate(&loaded.model.unwrap(), &experiment).map(|_| ())
}

fn refused(change: impl FnOnce(&mut Experiment)) -> String {
    match run(1.0, change) {
        Err(Error::Experiment(errors)) => {
            errors.iter().map(ToString::to_string).collect::<Vec<_>>().join("\n")
        }
        other => panic!("{other:?}"),
    }
}

#[test]
fn a_knob_outside_its_range_is_refused() {
    let set = |value: f64| move |e: &mut Experiment| e.knobs.push(("pull".to_owned(), value));
    run(1.0, set(0.5)).unwrap();
    run(1.0, set(2.0)).unwrap();
    assert!(refused(set(0.25)).contains("`pull` is 0.25 m/s2, outside its range (0.5, 2) m/s2"));
    assert!(refused(set(2.5)).contains("`pull` is 2.5 m/s2, outside its range (0.5, 2) m/s2"));
}

#[test]
fn an_initial_value_outside_its_range_is_refused() {
    let set = |e: &mut Experiment| e.initial.push(("speed".to_owned(), -1.0));
    assert!(refused(set).contains("`speed` is -1 m/s, outside its range (0, 3) m/s, at the start"));
}

#[test]
fn an_assignment_outside_a_range_stops_the_run() {
    run(2.5, |_| ()).unwrap();
    let Err(Error::Failure(failure)) = run(5.0, |_| ()) else { panic!("it should stop") };
    assert_eq!(failure.code.0, "SR0011");
    assert!((failure.time - 3.0).abs() < 1e-6, "{}", failure.time);
    assert!(failure.message.starts_with("`gear` is 4, outside its range (1, 3), at t = "), "{failure}");
    assert_eq!(failure.notes, ["`faster` (Driving → Driving) gives it this value"]);
}

const MOTION: &str = "\
CTC Tank is
interface
  input(inflow, signal, (0, 2), \"m/s\");
  output(level, signal, (0, full), \"m\");
  output(force, signal, (-1, 60));
  knob(grade, {1, 2});
end interface;
body
  declarations
    state h in (0, 10) := 0 \"m\";
    mode stage : integer in {0, 1, 4} := 0;
  end declarations;
  location Filling
    dynamics
      der(h) = inflow - 0.1*h;
    end dynamics;
    transition high when h >= grade*4 and stage = 0 goto Filling do
      stage := stage + floor(grade);
    end transition;
  end location;
  output
    level = h;
    force = h^2;
  end output;
  assignments
    full : 9.5;
    grade : 1;
  end assignments;
end body;
";

fn fill(stop: f64, change: impl FnOnce(&mut Experiment)) -> Result<(), Error> {
    let world = MemoryWorld::default().with("tank.hsml", MOTION);
    let loaded = load(&world, Path::new("tank.hsml"));
    let messages = loaded.messages();
    assert!(messages.is_empty(), "{messages:#?}");
    let mut experiment = Experiment { stop, ..Experiment::default() };
    change(&mut experiment);
    simulate(&loaded.model.unwrap(), &experiment).map(|_| ())
}

fn with(inflow: f64, quantum: f64) -> impl FnOnce(&mut Experiment) {
    move |e: &mut Experiment| {
        e.inputs.push(("inflow".to_owned(), Signal::constant(inflow)));
        e.quanta.push(QuantumRule { pattern: "*".to_owned(), quantum: Quantum::absolute(quantum) });
    }
}

fn left(stop: f64, change: impl FnOnce(&mut Experiment)) -> Box<Failure> {
    match fill(stop, change) {
        Err(Error::Failure(failure)) => {
            assert_eq!(failure.code.0, "SR0011", "{failure}");
            failure
        }
        other => panic!("{other:?}"),
    }
}

/// h = 10 u (1 − e^(−t/10)).
fn when(level: f64, inflow: f64) -> f64 {
    -10.0 * (-level / (10.0 * inflow)).ln_1p()
}

#[test]
fn a_motion_that_leaves_its_range_stops_the_run() {
    fill(500.0, with(0.5, 1e-3)).unwrap();
    // The output leaves first: force = h² > 60.
    let failure = left(500.0, with(0.8, 1e-3));
    assert!(failure.message.starts_with("`force` is 60.0"), "{failure}");
    assert!((failure.time - when(60.06_f64.sqrt(), 0.8)).abs() < 0.05, "{failure}");
    assert!(failure.notes.iter().any(|note| note.starts_with("with h = 7.7")), "{:?}", failure.notes);
    let failure = left(500.0, with(-0.1, 1e-3));
    assert!(failure.message.starts_with("`inflow` is -0.1 m/s, outside its range (0, 2) m/s"), "{failure}");
    assert_eq!(failure.time, 0.0);
}

#[test]
fn a_motion_may_rest_at_its_bound_whatever_the_quanta() {
    // h → 10. The quanta of what is not affine are known roughly: the coarsest of `force` would take 2.
    let model = MOTION.replace("(0, full)", "(0, 10)").replace("(-1, 60)", "(0, 102)");
    let world = MemoryWorld::default().with("tank.hsml", model);
    let loaded = load(&world, Path::new("tank.hsml"));
    let model = loaded.model.unwrap();
    for method in [Method::Qss1, Method::Qss2, Method::Qss3, Method::Liqss1, Method::Liqss2, Method::Liqss3] {
        for quantum in [1e-1, 1e-2, 1e-3] {
            let mut experiment = Experiment { stop: 300.0, method, ..Experiment::default() };
            with(1.0, quantum)(&mut experiment);
            simulate(&model, &experiment).unwrap();
        }
    }
}

#[test]
fn a_set_of_numbers_holds_for_knobs_and_assignments() {
    let set = |grade: f64| {
        move |e: &mut Experiment| {
            with(0.5, 1e-3)(e);
            e.knobs.push(("grade".to_owned(), grade));
        }
    };
    match fill(1.0, set(3.0)) {
        Err(Error::Experiment(errors)) => {
            assert!(errors[0].to_string().contains("`grade` is 3, which is none of {1, 2}"), "{errors:?}");
        }
        other => panic!("{other:?}"),
    } // Where h is 4, `stage` becomes 1; with grade = 2 it would become 2 where h is 8.
    fill(100.0, set(1.0)).unwrap();
    let gear = MOTION.replace("grade*4", "4").replace("(-1, 60)", "(-1, 100)");
    let world = MemoryWorld::default().with("tank.hsml", gear);
    let mut experiment = Experiment { stop: 100.0, ..Experiment::default() };
    set(2.0)(&mut experiment);
    match simulate(&load(&world, Path::new("tank.hsml")).model.unwrap(), &experiment) {
        Err(Error::Failure(failure)) => {
            assert!(failure.message.starts_with("`stage` is 2, which is none of {0, 1, 4}"), "{failure}");
        }
        other => panic!("{:?}", other.map(|_| ())),
    }
}
