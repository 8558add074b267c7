//! Several things at one instant (control cases in exact arithmetic).

use crate::support::{run, to};
use sophy_record::Side;
use sophy_testkit::{Reference, problems};

#[test]
fn the_first_written_wins_and_guards_are_looked_at_again_at_once() {
    let reference = Reference::read("simultaneous-events/one_automaton_events.csv");
    let result = run(&problems::simultaneous(), &to(20.0, 1e-3));
    let names: Vec<&str> = result.events.iter().map(|e| e.transition.as_str()).collect();
    assert_eq!(names, reference.text("transition"));
    let times: Vec<f64> = result.events.iter().map(|e| e.time).collect();
    assert_eq!(times, reference.numbers("t"), "dyadic times are exact");
    let (x1, x2) = (reference.numbers("x1"), reference.numbers("x2"));
    for (k, time) in times.iter().enumerate() {
        // The last transition of an instant leaves the state that the reference prints.
        if times.get(k + 1) != Some(time) {
            assert_eq!(result.trajectory.value(0, *time, Side::Right), x1[k], "x1 at {time}");
            assert_eq!(result.trajectory.value(1, *time, Side::Right), x2[k], "x2 at {time}");
        }
    }
}

#[test]
fn events_of_two_timers_arrive_in_the_order_of_components() {
    let reference = Reference::read("simultaneous-events/two_timers_events.csv");
    let result = run(&problems::two_timers(), &to(6.0, 1e-3));
    let received: Vec<_> = result.events.iter().filter(|e| e.component == "counter").collect();
    let names: Vec<&str> = received.iter().map(|e| e.transition.as_str()).collect();
    assert_eq!(names, reference.text("event"));
    let times: Vec<f64> = received.iter().map(|e| e.time).collect();
    assert_eq!(times, reference.numbers("t"));
    let y = reference.numbers("y_after");
    assert_eq!(result.trajectory.value(2, 6.0, Side::Right), *y.last().unwrap());
}
