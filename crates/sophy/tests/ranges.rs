//! A declared range holds: for what an experiment sets, for what a variable starts with and is assigned.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test stops at the first surprise")]

use sophy::{Error, Experiment, MemoryWorld, load, simulate};
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
