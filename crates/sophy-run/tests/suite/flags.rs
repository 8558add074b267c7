//! Event sections, modes, initial sections, priorities, conditional events: what happens, against closed forms.

use crate::support::{METHODS, by, run, to, try_run};
use sophy_ir::{Comparison, Feature, Unary, VariableId};
use sophy_passes::lower;
use sophy_run::{Experiment, Run, Signal, SimulateError, StartError};
use sophy_testkit::Build;
use std::sync::Arc;

/// Name and time of every event.
fn events(result: &crate::support::Result) -> Vec<(&str, f64)> {
    result.events.iter().map(|e| (e.transition.as_str(), e.time)).collect()
}

/// The last row.
fn last(result: &crate::support::Result) -> Vec<f64> {
    result.table.reals.iter().filter_map(|column| column.last().copied()).collect()
}

fn near(found: &[(&str, f64)], expected: &[(&str, f64)]) {
    let names = |list: &[(&str, f64)]| list.iter().map(|e| e.0.to_owned()).collect::<Vec<_>>();
    assert_eq!(names(found), names(expected), "{found:?}");
    for (a, b) in found.iter().zip(expected) {
        assert!((a.1 - b.1).abs() < 1e-9, "{found:?} for {expected:?}");
    }
}

/// A relay with hysteresis (seed 001): S = e + h·m, m := ±1; e′ = −m. The mode takes the sign of its flag at the
/// start. From e = 0.5: m = 1, e falls to −h = −1 at 1.5 s, rises to 1 at 3.5 s, …
#[test]
fn a_relay_with_hysteresis_switches_where_its_surface_moved_to() {
    for method in METHODS {
        let mut b = Build::default();
        b.component("");
        let (e, m, flag) = (b.state("e", 0.5), b.mode("m", None), b.flag("S"));
        let [re, rm] = [e, m].map(|id| b.read(id));
        let h = b.parameter("h", 1.0);
        let here = b.location("here");
        let band = b.mul(h, rm);
        let surface = b.add(re, band);
        let back = b.unary(Unary::Negate, rm);
        b.value(here, flag, surface);
        b.rate(here, e, back);
        let (one, minus) = (b.number(1.0), b.number(-1.0));
        b.event(flag, 0, Some(&[(m, one)]), Some(&[(m, minus)]));
        let result = run(&b.model(), &by(method, to(6.0, 1e-3)));
        let (up, down) = ("S negative-to-positive", "S positive-to-negative");
        near(&events(&result), &[(down, 1.5), (up, 3.5), (down, 5.5)]);
        assert!(result.events.iter().all(|e| e.component.is_empty()));
        assert_eq!(result.events[0].from, "+");
        // e and m are recorded, the sides of the flag are not.
        let names: Vec<&str> = result.table.schema.columns.iter().map(|c| c.name.as_str()).collect();
        assert_eq!(names, ["e", "m"]);
        let start = Experiment { initial: vec![("e".to_owned(), -0.5)], ..by(method, to(2.0, 1e-3)) };
        near(&events(&run(&b.model(), &start)), &[(up, 1.5)]);
    }
}

/// S = h, falling: v := −e·v. The reset puts the flag back: the ball bounces off, each bounce one event.
#[test]
fn a_flag_that_its_own_reset_puts_back_has_not_crossed_again() {
    for method in METHODS {
        let mut b = Build::default();
        b.component("");
        let (h, v, flag) = (b.state("h", 1.0), b.state("v", 0.0), b.flag("S"));
        let n = b.mode("n", Some(0.0));
        let [rh, rv] = [h, v].map(|id| b.read(id));
        let here = b.location("here");
        let (g, factor) = (b.number(-2.0), b.number(-0.5));
        b.value(here, flag, rh);
        b.rate(here, h, rv);
        b.rate(here, v, g);
        let bounced = b.mul(factor, rv);
        let one = b.number(1.0);
        b.event(flag, 0, Some(&[(n, one)]), Some(&[(v, bounced)]));
        let result = run(&b.model(), &by(method, to(2.7, 1e-6)));
        // Falls for 1 s, then flies 1, 1/2, 1/4 s …
        let found = events(&result);
        assert_eq!(found.len(), 3, "{found:?}");
        for ((name, time), expected) in found.into_iter().zip([1.0, 2.0, 2.5]) {
            assert_eq!(name, "S positive-to-negative");
            assert!((time - expected).abs() < 1e-3, "{time} for {expected}");
        }
    }
}

/// A sine crosses zero both ways, the section has one direction: the other crossing is no event and takes no
/// micro-step.
#[test]
fn a_section_with_one_direction_is_silent_about_the_other() {
    for method in METHODS {
        let mut b = Build::default();
        b.component("");
        let (n, flag) = (b.mode("n", Some(0.0)), b.flag("S"));
        let rn = b.read(n);
        let here = b.location("here");
        let t = b.time();
        let sine = b.unary(Unary::Sin, t);
        b.value(here, flag, sine);
        let one = b.number(1.0);
        let next = b.add(rn, one);
        b.event(flag, 0, Some(&[(n, next)]), None);
        let result = run(&b.model(), &by(method, to(14.0, 1e-3)));
        // Not at 0, where it starts to be positive.
        let (name, turn) = ("S negative-to-positive", 2.0 * std::f64::consts::PI);
        near(&events(&result), &[(name, turn), (name, 2.0 * turn)]);
        assert_eq!(result.report.statistics.hybrid.transitions, 2);
        assert_eq!(result.report.statistics.hybrid.instants, 2);
    }
}

/// Two flags cross at one instant. The more urgent section moves the surface of the other one: what is not yet
/// executed counts only while it holds.
#[test]
fn a_section_that_waits_is_executed_only_if_its_flag_is_still_there() {
    for (shift, expected) in [(0.0, vec!["A", "B"]), (5.0, vec!["A"])] {
        let mut b = Build::default();
        b.component("");
        let (x, limit) = (b.state("x", 0.0), b.mode("limit", Some(1.0)));
        let (first, second) = (b.flag("A"), b.flag("B"));
        let [rx, rl] = [x, limit].map(|id| b.read(id));
        let here = b.location("here");
        let (one, shift) = (b.number(1.0), b.number(shift));
        b.rate(here, x, one);
        let (over, over_limit) = (b.sub(rx, one), b.sub(rx, rl));
        b.value(here, first, over);
        b.value(here, second, over_limit);
        // B is written first, A is more urgent.
        b.event(second, 2, Some(&[]), None);
        let moved = b.add(rl, shift);
        b.event(first, 1, Some(&[(limit, moved)]), None);
        let result = run(&b.model(), &to(2.0, 1e-3));
        let found: Vec<(&str, f64, u32)> =
            result.events.iter().map(|e| (&e.transition[..1], e.time, e.step)).collect();
        assert_eq!(found.iter().map(|e| e.0).collect::<Vec<_>>(), expected);
        assert!(found.iter().enumerate().all(|(k, e)| e.1 == 1.0 && e.2 as usize == k), "{found:?}");
    }
}

/// All right-hand sides read the values before the event, also those of another section of the same instant.
#[test]
fn sections_of_one_micro_step_read_the_values_before() {
    let mut b = Build::default();
    b.component("");
    let (x, p, q) = (b.state("x", -1.0), b.mode("p", Some(2.0)), b.mode("q", Some(3.0)));
    let flags = [b.flag("A"), b.flag("B")];
    let [rx, rp, rq] = [x, p, q].map(|id| b.read(id));
    let here = b.location("here");
    let (one, two) = (b.number(1.0), b.number(2.0));
    b.rate(here, x, one);
    b.value(here, flags[0], rx);
    let double = b.mul(two, rx);
    b.value(here, flags[1], double);
    b.event(flags[0], 0, Some(&[(p, rq)]), None);
    b.event(flags[1], 0, Some(&[(q, rp)]), None);
    let result = run(&b.model(), &to(1.5, 1e-3));
    assert_eq!(result.events.len(), 2);
    let row = last(&result);
    assert_eq!(&row[1..], [3.0, 2.0]);
}

/// Comparisons on modes are guards like others, and hold exactly while the mode has the value.
#[test]
fn equality_of_modes_holds_exactly_while_it_holds() {
    for method in METHODS {
        let mut b = Build::default();
        b.component("");
        let (clock, m, n) = (b.state("clock", 0.0), b.mode("m", Some(0.0)), b.mode("n", Some(0.1)));
        let (x, alarm) = (b.state("x", 0.0), b.mode("alarm", Some(0.0)));
        let [rc, rm, rn, ra] = [clock, m, n, alarm].map(|id| b.read(id));
        let here = b.location("here");
        let [zero, half, one, two, step] = [0.0, 0.5, 1.0, 2.0, 0.1].map(|k| b.number(k));
        b.rate(here, clock, one);
        // x runs while m = 2.
        let is_two = b.compare(Comparison::Equal, rm, two);
        let rate = b.graph().select(is_two, one, zero);
        b.rate(here, x, rate);
        let over = b.compare(Comparison::GreaterEqual, rc, one);
        let more = b.add(rm, one);
        let next = b.add(rn, step);
        b.when(here, "tick", over, here, &[(clock, zero), (m, more), (n, next)]);
        let three = b.number(3.0);
        let reached = b.compare(Comparison::Equal, rm, three);
        let calm = b.less(ra, half);
        let ring = b.graph().and(reached, calm);
        b.when(here, "ring", ring, here, &[(alarm, one)]);
        let loud = b.greater(ra, half);
        let off = b.compare(Comparison::NotEqual, rm, three);
        let both = b.graph().and(loud, off);
        b.when(here, "quiet", both, here, &[(alarm, zero)]);
        let result = run(&b.model(), &by(method, to(4.5, 1e-3)));
        let expected =
            [("tick", 1.0), ("tick", 2.0), ("tick", 3.0), ("ring", 3.0), ("tick", 4.0), ("quiet", 4.0)];
        near(&events(&result), &expected);
        // clock, m, n, x, alarm
        let row = last(&result);
        assert_eq!(row[1], 4.0);
        assert!((row[3] - 1.0).abs() < 1e-12, "{row:?}");
    }
}

/// b starts from what a gives it; a's own section reads its input; the experiment wins over all.
#[test]
fn initial_sections_are_evaluated_in_the_order_of_their_dependencies() {
    let mut b = Build::default();
    b.component("b");
    let (u, y, z) = (b.input("u"), b.state("y", 7.0), b.state("z", 0.0));
    let [ru, ry] = [u, y].map(|id| b.read(id));
    let here = b.location("here");
    let zero = b.number(0.0);
    let ten = b.number(10.0);
    let sum = b.add(ru, ten);
    let both = b.add(ry, ru);
    b.initial(y, sum);
    b.initial(z, both);
    for state in [y, z] {
        b.rate(here, state, zero);
    }
    b.component("a");
    let (v, x, w) = (b.input("v"), b.state("x", 1.0), b.output("w"));
    let [rv, rx] = [v, x].map(|id| b.read(id));
    let places = [b.location("low"), b.location("high")];
    let two = b.number(2.0);
    let double = b.mul(two, rx);
    // The output depends on the location: an algebraic variable.
    b.value(places[0], w, double);
    b.value(places[1], w, rx);
    b.initial(x, rv);
    b.connect(w, u);
    let given = |initial: &[(&str, f64)], location: &str| Experiment {
        inputs: vec![("a.v".to_owned(), Signal::constant(5.0))],
        initial: initial.iter().map(|(name, value)| ((*name).to_owned(), *value)).collect(),
        initial_locations: vec![("a".to_owned(), location.to_owned())],
        record: Some(vec!["b.y".to_owned(), "b.z".to_owned(), "a.x".to_owned()]),
        ..to(1.0, 1e-3)
    };
    let start = |experiment: &Experiment| last(&run(&b.model(), experiment));
    assert_eq!(start(&given(&[], "low")), [20.0, 30.0, 5.0]);
    assert_eq!(start(&given(&[], "high")), [15.0, 20.0, 5.0]);
    assert_eq!(start(&given(&[("a.x", 1.5)], "low")), [13.0, 16.0, 1.5]);
    assert_eq!(start(&given(&[("b.y", 0.0)], "low")), [0.0, 10.0, 5.0]);
}

/// `emit` under a condition reads the values before the micro-step.
#[test]
fn an_event_is_emitted_only_if_its_condition_held_before() {
    let mut b = Build::default();
    let sender = b.component("sender");
    let (clock, n) = (b.state("clock", 0.0), b.mode("n", Some(0.0)));
    let [rc, rn] = [clock, n].map(|id| b.read(id));
    let here = b.location("here");
    let [zero, one, two] = [0.0, 1.0, 2.0].map(|k| b.number(k));
    b.rate(here, clock, one);
    let over = b.compare(Comparison::GreaterEqual, rc, one);
    let next = b.add(rn, one);
    b.when(here, "tick", over, here, &[(clock, zero), (n, next)]);
    let later = b.compare(Comparison::GreaterEqual, rn, two);
    b.emit_if(here, "out", Some(later));
    let receiver = b.component("receiver");
    let here = b.location("here");
    b.on(here, "in", here, &[]);
    b.connect_event((sender, "out"), (receiver, "in"));
    let result = run(&b.model(), &to(4.5, 1e-3));
    // n is 0, 1, 2, 3 before the ticks.
    let expected = [("tick", 1.0), ("tick", 2.0), ("tick", 3.0), ("in", 3.0), ("tick", 4.0), ("in", 4.0)];
    near(&events(&result), &expected);
}

/// Of receivers that wait at one instant those with the smallest priority number go first.
#[test]
fn waiting_events_go_to_the_most_urgent_receiver_first() {
    let mut b = Build::default();
    let sender = b.component("sender");
    let clock = b.state("clock", 0.0);
    let rc = b.read(clock);
    let here = b.location("here");
    let [one, never] = [1.0, -9.0].map(|k| b.number(k));
    b.rate(here, clock, one);
    let over = b.compare(Comparison::GreaterEqual, rc, one);
    b.when(here, "tick", over, here, &[(clock, never)]);
    b.emit(here, "out");
    let mut receivers = Vec::new();
    for (name, priority) in [("late", 3), ("early", 1), ("also", 1)] {
        receivers.push(b.component(name));
        let here = b.location("here");
        b.on(here, "in", here, &[]);
        b.priority(here, priority);
    }
    for receiver in receivers {
        b.connect_event((sender, "out"), (receiver, "in"));
    }
    let result = run(&b.model(), &to(2.0, 1e-3));
    let found: Vec<(&str, u32)> = result.events.iter().map(|e| (e.component.as_str(), e.step)).collect();
    assert_eq!(found, [("sender", 0), ("early", 1), ("also", 1), ("late", 2)]);
}

/// A run of what only a later version can run ends before it starts, with one message for all of it.
#[test]
fn what_cannot_be_run_is_refused_with_a_list() {
    let mut b = Build::default();
    b.component("plant");
    let x = b.state("x", 0.0);
    let here = b.location("here");
    let zero = b.number(0.0);
    b.rate(here, x, zero);
    let mut system = lower(&b.model()).unwrap();
    for (what, component, text) in [
        (Feature::DiscreteTime, "control", "Control"),
        (Feature::Delayed, "plant", "delayed(u, 0.1)"),
        (Feature::Rule, "", "when x > 1"),
    ] {
        let (component, text) = (component.to_owned(), text.to_owned());
        system.awaits.push(sophy_ir::Awaited { what, component, text, span: None });
    }
    let Err(StartError::Failure(failure)) = Run::new(Arc::new(system), &Experiment::default()) else {
        panic!("it should be refused")
    };
    assert_eq!(failure.code.0, "SR0008");
    let message = "`control` is a discrete-time component: this version checks it but cannot run it";
    assert_eq!(failure.message, message);
    assert_eq!(
        failure.notes,
        ["`delayed(u, 0.1)` of `plant` is a transport delay", "`when x > 1` is a rule"]
    );
}

/// A mode that no flag can initialise needs a value like any state.
#[test]
fn a_mode_without_value_and_flag_is_asked_for() {
    let mut b = Build::default();
    b.component("");
    let m: VariableId = b.mode("m", None);
    b.location("here");
    let Err(SimulateError::Experiment(errors)) = try_run(&b.model(), &to(1.0, 1e-3)) else {
        panic!("it should be asked for")
    };
    assert_eq!((m.0, errors[0].item.as_str()), (0, "initial.m"));
}

/// ∫|sin t| with `smooth`: the same value, no kinks; in a guard the switch is located in any case.
#[test]
fn smooth_switches_are_no_events() {
    let mut b = Build::default();
    b.component("");
    let (x, y) = (b.state("x", 0.0), b.output("y"));
    let (low, high) = (b.location("low"), b.location("high"));
    let t = b.time();
    let sine = b.unary(Unary::Sin, t);
    let size = b.unary(Unary::Abs, sine);
    let size = b.smooth(size);
    for place in [low, high] {
        b.rate(place, x, size);
        b.value(place, y, size);
    }
    let ry = b.read(y);
    let (half, zero) = (b.number(0.5), b.number(0.0));
    let over = b.greater(ry, half);
    let shifted = b.sub(ry, half);
    let under = b.less(shifted, zero);
    b.when(low, "up", over, high, &[]);
    b.when(high, "down", under, low, &[]);
    let system = lower(&b.model()).unwrap();
    let rate = system.text(system.nodes(system.states.at(0).rate)[0]);
    assert_eq!(rate, "smooth(abs(sin(time)))");
    let result = run(&b.model(), &Experiment { all_events: true, ..to(6.0, 1e-4) });
    let sixth = std::f64::consts::PI / 6.0;
    let expected = [("up", sixth), ("down", 5.0 * sixth), ("up", 7.0 * sixth), ("down", 11.0 * sixth)];
    let found = events(&result);
    let taken: Vec<_> = found.iter().copied().filter(|e| e.0 == "up" || e.0 == "down").collect();
    near(&taken, &expected);
    let area = 4.0 - (1.0 - libm::cos(2.0 * std::f64::consts::PI - 6.0));
    let row = last(&result);
    assert!(
        (result.trajectory.value(0, 6.0, sophy_record::Side::Left) - area).abs() < 1e-2,
        "{row:?} for {area}"
    );
}

/// The flag of a component with locations: S = x − 1 in `low`, 3 − x in `high`. Entering `high` at x = 2 moves S
/// from 1 to 1, at x = 4 from 3 to −1: a jump through zero is a crossing.
#[test]
fn a_flag_that_jumps_with_the_location_has_crossed() {
    for (threshold, expected) in [(2.0, vec!["S+", "enter", "S-"]), (4.0, vec!["S+", "enter", "S-"])] {
        for method in METHODS {
            let mut b = Build::default();
            b.component("");
            let (x, n, flag) = (b.state("x", 0.0), b.mode("n", Some(0.0)), b.flag("S"));
            let [rx, rn] = [x, n].map(|id| b.read(id));
            let (low, high) = (b.location("low"), b.location("high"));
            let [one, three, threshold] = [1.0, 3.0, threshold].map(|k| b.number(k));
            for place in [low, high] {
                b.rate(place, x, one);
            }
            let (rising, falling) = (b.sub(rx, one), b.sub(three, rx));
            b.value(low, flag, rising);
            b.value(high, flag, falling);
            let over = b.compare(Comparison::GreaterEqual, rx, threshold);
            b.when(low, "enter", over, high, &[]);
            // The location is read whatever it is: before the transition of the same instant it is the old one.
            let next = b.add(rn, one);
            b.event(flag, 0, Some(&[(n, next)]), Some(&[(n, next)]));
            let result = run(&b.model(), &by(method, to(5.0, 1e-3)));
            let name = |e: &sophy_record::EventRecord| match e.transition.as_str() {
                "S negative-to-positive" => "S+",
                "S positive-to-negative" => "S-",
                _ => "enter",
            };
            assert_eq!(result.events.iter().map(name).collect::<Vec<_>>(), expected);
            let last_time = result.events[2].time;
            let threshold = if expected.len() == 3 && result.events[1].time < 3.0 { 3.0 } else { 4.0 };
            assert!((last_time - threshold).abs() < 1e-9, "{last_time}");
        }
    }
}
