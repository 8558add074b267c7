//! Raibert's hopper (thesis §8.5): events, states and the order of convergence against a reference of 1e-12.

use crate::support::{Result, by, order, run, to};
use sophy_record::Side;
use sophy_run::Method;
use sophy_testkit::{Reference, problems::Hopper};

const LOCATIONS: [&str; 4] = ["Flight", "Compression", "Thrust", "Decompression"];

/// The names of the locations in the reference's events, as a chain from/to.
fn chain(reference: &Reference) -> Vec<(String, String)> {
    let name = |cell: &&str| LOCATIONS[cell.parse::<usize>().unwrap()].to_owned();
    let (from, to) = (reference.text("from"), reference.text("to"));
    from.iter().map(name).zip(to.iter().map(name)).collect()
}

fn taken(result: &Result) -> Vec<(String, String)> {
    result.events.iter().map(|e| (e.from.clone(), e.to.clone())).collect()
}

/// Largest difference of event times; the sequences must be equal.
fn event_error(result: &Result, reference: &Reference) -> f64 {
    assert_eq!(taken(result), chain(reference));
    let times = reference.numbers("t");
    result.events.iter().zip(times).map(|(event, t)| (event.time - t).abs()).fold(0.0, f64::max)
}

/// Largest difference of height and speed over the reference's times, away from events.
fn state_error(result: &Result, states: &Reference, events: &Reference, away: f64) -> f64 {
    let (times, y, v) = (states.numbers("t"), states.numbers("y"), states.numbers("ydot"));
    let instants = events.numbers("t");
    let far = |t: f64| instants.iter().all(|instant| (instant - t).abs() > away);
    let error = |k: usize| {
        let at = |state| result.trajectory.value(state, times[k], Side::Right);
        (at(0) - y[k]).abs().max((at(1) - v[k]).abs())
    };
    (0..times.len()).filter(|&k| far(times[k])).map(error).fold(0.0, f64::max)
}

#[test]
fn events_and_states_converge_with_the_quantum_at_first_order() {
    let hoppers = [(Hopper::TAU40, "tau40"), (Hopper::TAU20, "tau20"), (Hopper::APPENDIX, "appendix")];
    let methods = [Method::Qss2, Method::Qss3, Method::Liqss2, Method::Liqss3];
    for ((hopper, name), method) in hoppers.iter().flat_map(|h| methods.map(|method| (h, method))) {
        let events = Reference::read(&format!("hopper/{name}_events.csv"));
        let states = Reference::read(&format!("hopper/{name}_states.csv"));
        let quanta = [1e-3, 1e-4, 1e-5, 1e-6, 1e-7];
        let (mut event_errors, mut state_errors) = (Vec::new(), Vec::new());
        for quantum in quanta {
            let result = run(&hopper.model(), &by(method, to(20.0, quantum)));
            event_errors.push((quantum, event_error(&result, &events)));
            state_errors.push((quantum, state_error(&result, &states, &events, 1e-2)));
        }
        for (what, errors) in [("events", &event_errors), ("states", &state_errors)] {
            let slope = order(errors);
            assert!((0.75..1.25).contains(&slope), "{name}, {method:?}, {what}: order {slope}, {errors:?}");
            assert!(errors[4].1 < 1e-4, "{name}, {method:?}, {what}: {errors:?}");
        }
    }
}

#[test]
fn qss1_gives_the_same_events_at_first_order() {
    let events = Reference::read("hopper/tau40_events.csv");
    let errors: Vec<(f64, f64)> = [1e-3, 3e-4, 1e-4, 3e-5]
        .into_iter()
        .map(|quantum| {
            let result = run(&Hopper::TAU40.model(), &by(Method::Qss1, to(20.0, quantum)));
            (quantum, event_error(&result, &events))
        })
        .collect();
    let slope = order(&errors);
    assert!((0.7..1.3).contains(&slope), "order {slope}, {errors:?}");
}

#[test]
fn a_thousand_seconds_have_3460_transitions_in_order() {
    for (method, most) in [(Method::Qss2, 4e-4), (Method::Qss3, 1e-2)] {
        let result = run(&Hopper::TAU40.model(), &by(method, to(1000.0, 1e-3)));
        assert_eq!(result.events.len(), 3460);
        for (k, event) in result.events.iter().enumerate() {
            let (from, to) = (LOCATIONS[k % 4], LOCATIONS[(k + 1) % 4]);
            assert_eq!((event.from.as_str(), event.to.as_str()), (from, to), "transition {k} by {method:?}");
        }
        // How far the last event of the reference, located on x, is off at this quantum, s.
        let reference = Reference::read("hopper/tau40_events.csv").numbers("t");
        let error = (result.events[67].time - reference[67]).abs();
        assert!(error < most, "{method:?}: {error:e}");
    }
    let long = Reference::read("hopper/tau40_states_long.csv");
    let (times, heights) = (long.numbers("t"), long.numbers("y"));
    let fine = run(&Hopper::TAU40.model(), &to(1000.0, 1e-6));
    for (t, y) in times.iter().zip(heights) {
        let error = (fine.trajectory.value(0, *t, Side::Right) - y).abs();
        assert!(error < 1e-3, "{error:e} at {t} s");
    }
}

#[test]
fn too_little_thrust_ends_in_decompression() {
    let result = run(&Hopper::TAU20.model(), &to(1000.0, 1e-4));
    assert_eq!(result.events.len(), 3);
    assert_eq!(result.trajectory.location(0, 1000.0, Side::Right), Some(3));
    // At rest where the spring carries the weight.
    let rest = 0.213_836_676_455;
    assert!((result.trajectory.value(0, 1000.0, Side::Right) - rest).abs() < 1e-3);
}

/// A leg fully extended in Thrust leaves Decompression in the same instant: y = l to rounding, moving up,
/// counts as crossed.
#[test]
fn extension_chains_two_transitions_at_one_instant() {
    let result = run(&Hopper::APPENDIX.model(), &to(1000.0, 1e-4));
    assert_eq!(result.events.len(), 2978);
    let chains: Vec<_> = result.events.windows(2).filter(|w| w[0].from == "Thrust").collect();
    assert!(chains.len() > 700);
    for pair in chains {
        assert_eq!(pair[0].time.to_bits(), pair[1].time.to_bits());
        assert_eq!((pair[0].step, pair[1].step), (0, 1));
        assert_eq!(pair[0].transition, "extended");
        assert_eq!(pair[1].transition, "liftoff");
    }
}

#[test]
fn the_orbit_has_the_reported_top() {
    let result = run(&Hopper::TAU40.model(), &to(40.0, 1e-3));
    let top = result.table.real("y").unwrap().iter().zip(&result.table.time).filter(|(_, t)| **t > 20.0);
    let apex = top.map(|(y, _)| *y).fold(0.0, f64::max);
    assert!((apex - 1.389_922).abs() < 5e-3, "{apex}");
}
