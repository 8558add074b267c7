//! Input signals and events from outside: the satellite's battery under a sampled profile of solar power.

use crate::support::{METHODS, by, is_first_order, order, run, to, try_run};
use sophy_ir::{Comparison, Model};
use sophy_record::Side;
use sophy_run::{AtEnd, Experiment, Interpolation, Method, Signal, SimulateError};
use sophy_testkit::{Build, Reference};

/// C′ = k (M·Pin − Pload)/V, V = 18 + 10.6 C; see the README of the reference data.
fn satellite(k: f64, safe_load: f64) -> Model {
    let mut b = Build::default();
    b.component("");
    let (c, m) = (b.state("C", 0.55), b.state("M", 1.0));
    let pin = b.input("Pin");
    let [rc, rm, rp] = [c, m, pin].map(|id| b.read(id));
    let k = b.parameter("k", k);
    let places = ["Nominal", "Payload", "Safe"].map(|name| b.location(name));
    let [base, slope, zero, one] = [18.0, 10.6, 0.0, 1.0].map(|n| b.number(n));
    let rise = b.mul(slope, rc);
    let voltage = b.add(base, rise);
    for (place, load) in places.into_iter().zip([20.0, 100.0, safe_load]) {
        let load = b.number(load);
        let gain = b.mul(rm, rp);
        let net = b.sub(gain, load);
        let scaled = b.mul(k, net);
        let rate = b.div(scaled, voltage);
        b.rate(place, c, rate);
        b.rate(place, m, zero);
    }
    let [nominal, payload, safe] = places;
    let [full, low, critical, recovered] = [0.68, 0.62, 0.2, 0.4].map(|n| b.number(n));
    let guard = b.greater(rc, full);
    b.when(nominal, "toPayload", guard, payload, &[(m, zero)]);
    let guard = b.less(rc, critical);
    b.when(nominal, "toSafe", guard, safe, &[]);
    let guard = b.less(rc, low);
    b.when(payload, "toNominal", guard, nominal, &[(m, one)]);
    let guard = b.greater(rc, recovered);
    b.when(safe, "toNominal", guard, nominal, &[]);
    b.model()
}

fn profile(interpolation: Interpolation) -> Signal {
    let reference = Reference::read("power-system/pin_10s.csv");
    Signal {
        times: reference.numbers("t"),
        values: reference.numbers("Pin_W"),
        interpolation,
        at_end: AtEnd::Error,
        origin: "pin_10s.csv".to_owned(),
    }
}

fn powered(method: Method, stop: f64, quantum: f64, interpolation: Interpolation) -> Experiment {
    Experiment { inputs: vec![("Pin".to_owned(), profile(interpolation))], ..by(method, to(stop, quantum)) }
}

#[test]
fn the_satellite_converges_at_first_order() {
    for (name, k, safe_load) in [("text", 1.0 / 3600.0, 10.0), ("xml", 0.00027, 20.0)] {
        let model = satellite(k, safe_load);
        let events = Reference::read(&format!("power-system/{name}_events.csv"));
        let states = Reference::read(&format!("power-system/{name}_states.csv"));
        let (times, grid, capacity) = (events.numbers("t"), states.numbers("t"), states.numbers("C_Ah"));
        let charging = states.numbers("M");
        for (method, quanta) in [
            (Method::Qss1, [1e-3, 3e-4, 1e-4, 3e-5, 1e-5].as_slice()),
            (Method::Qss2, [1e-3, 3e-4, 1e-4, 3e-5, 1e-5, 3e-6].as_slice()),
        ] {
            let (mut instants, mut values) = (Vec::new(), Vec::new());
            for &quantum in quanta {
                let result = run(&model, &powered(method, 6000.0, quantum, Interpolation::Hold));
                let taken: Vec<&str> = result.events.iter().map(|e| e.transition.as_str()).collect();
                assert_eq!(taken, events.text("transition"), "{name} {method:?} {quantum:e}");
                let to: Vec<&str> = result.events.iter().map(|e| e.to.as_str()).collect();
                assert_eq!(to, events.text("to"), "{name} {method:?} {quantum:e}");
                let late = result.events.iter().zip(&times).map(|(e, t)| (e.time - t).abs());
                instants.push((quantum, late.fold(0.0, f64::max)));
                let at = |state, t: f64| result.trajectory.value(state, t, Side::Right);
                let off = grid.iter().zip(&capacity).map(|(&t, c)| (at(0, t) - c).abs());
                values.push((quantum, off.fold(0.0, f64::max)));
                for (&t, &m) in grid.iter().zip(&charging) {
                    // Where an event and a row of the reference are closer than the error, either is right.
                    if times.iter().all(|e| (e - t).abs() > 5.0) {
                        assert_eq!(at(1, t), m, "M at {t}");
                    }
                }
            }
            for (what, errors) in [("times", &instants), ("states", &values)] {
                let slope = order(errors);
                assert!((0.7..1.35).contains(&slope), "{name} {method:?} {what}: order {slope}, {errors:?}");
            }
            let (quantum, late) = *instants.last().unwrap();
            assert!(late < 3e5 * quantum, "{name} {method:?}: {instants:?}");
        }
    }
}

#[test]
fn the_payload_is_on_for_as_long_as_the_closed_form_says() {
    for (k, safe_load) in [(1.0 / 3600.0, 10.0), (0.00027, 20.0)] {
        let result = run(&satellite(k, safe_load), &powered(Method::Qss2, 3000.0, 1e-6, Interpolation::Hold));
        let exact = (18.0 * 0.06 + 5.3 * (0.68 * 0.68 - 0.62 * 0.62)) / (100.0 * k);
        for pair in result.events.chunks_exact(2) {
            let duration = pair[1].time - pair[0].time;
            assert!((duration - exact).abs() < 5e-3, "{duration} for {exact}");
        }
        assert_eq!(result.events.len(), 6);
    }
}

#[test]
fn lines_between_samples_move_the_events_by_seconds() {
    let model = satellite(1.0 / 3600.0, 10.0);
    let first = |interpolation| run(&model, &powered(Method::Qss2, 1500.0, 1e-6, interpolation)).events;
    let (held, linear) = (first(Interpolation::Hold), first(Interpolation::Linear));
    assert_eq!(held.len(), linear.len());
    let moved = (held[0].time - linear[0].time).abs();
    assert!((0.5..30.0).contains(&moved), "{moved}");

    // A closed form: E = 18 C + 5.3 C² grows by k·∫(Pin − 20), Pin a polygon.
    let signal = profile(Interpolation::Linear);
    let energy = |c: f64| 18.0 * c + 5.3 * c * c;
    let mut missing = (energy(0.68) - energy(0.55)) * 3600.0;
    let mut exact = f64::NAN;
    for (t, v) in signal.times.windows(2).zip(signal.values.windows(2)) {
        let (step, a, slope) = (t[1] - t[0], v[0] - 20.0, (v[1] - v[0]) / (t[1] - t[0]));
        let gain = step * (a + 0.5 * slope * step);
        if gain >= missing {
            let root = (a * a + 2.0 * slope * missing).sqrt();
            exact = t[0] + 2.0 * missing / (a + root);
            break;
        }
        missing -= gain;
    }
    assert!((linear[0].time - exact).abs() < 0.01, "{} for {exact}", linear[0].time);
}

#[test]
fn a_signal_that_ends_early_is_an_error_or_holds() {
    let model = satellite(1.0 / 3600.0, 10.0);
    let cut = |at_end| {
        let mut experiment = powered(Method::Qss2, 2500.0, 1e-4, Interpolation::Hold);
        let signal = &mut experiment.inputs[0].1;
        signal.times.truncate(51);
        signal.values.truncate(51);
        signal.at_end = at_end;
        experiment
    };
    let Err(SimulateError::Experiment(errors)) = try_run(&model, &cut(AtEnd::Error)) else {
        panic!("the signal ends at 500 s")
    };
    let text = errors[0].to_string();
    assert!(errors.len() == 1 && text.contains("`Pin`"), "{text}");
    assert!(text.contains("500 s") && text.contains("2500 s"), "{text}");
    assert!(errors[0].help.as_deref().is_some_and(|help| help.contains("hold")), "{errors:?}");

    let mut short = cut(AtEnd::Hold);
    let result = run(&model, &short);
    let last = *short.inputs[0].1.values.last().unwrap();
    // The same signal with the last value written out.
    let signal = &mut short.inputs[0].1;
    signal.times.push(2500.0);
    signal.values.push(last);
    signal.at_end = AtEnd::Error;
    let written = run(&model, &short);
    assert_eq!(result.events, written.events);
    let at = |r: &crate::support::Result| r.trajectory.value(0, 2500.0, Side::Right);
    assert!((at(&result) - at(&written)).abs() < 1e-9);
    assert!(result.events.len() >= 2, "{:?}", result.events);
}

/// An input is read at its exact breakpoints, in rates and in guards, held and linear.
#[test]
fn guards_on_inputs_switch_at_breakpoints_and_on_lines() {
    for method in METHODS {
        let mut b = Build::default();
        b.component("");
        let (x, u) = (b.state("x", 0.0), b.input("u"));
        let read = b.read(u);
        let places = ["a", "b", "c"].map(|name| b.location(name));
        for place in places {
            b.rate(place, x, read);
        }
        let [three, one] = [3.0, 1.0].map(|n| b.number(n));
        let high = b.compare(Comparison::GreaterEqual, read, three);
        let low = b.less(read, one);
        b.when(places[0], "high", high, places[1], &[]);
        b.when(places[1], "low", low, places[2], &[]);
        let signal = |interpolation| Signal {
            times: vec![0.0, 1.0, 2.0, 4.0, 4.0, 5.0],
            values: vec![0.0, 2.0, 4.0, 2.0, 0.5, 0.5],
            interpolation,
            at_end: AtEnd::Error,
            origin: "a test".to_owned(),
        };
        for (interpolation, times, end) in [
            (Interpolation::Hold, [2.0, 4.0], 0.0 + 2.0 + 8.0 + 0.5),
            (Interpolation::Linear, [1.5, 4.0], 1.0 + 3.0 + 6.0 + 0.5),
        ] {
            let inputs = vec![("u".to_owned(), signal(interpolation))];
            let result = run(&b.model(), &Experiment { inputs, ..by(method, to(5.0, 1e-3)) });
            let found: Vec<f64> = result.events.iter().map(|e| e.time).collect();
            assert_eq!(found, times, "{method:?} {interpolation:?}");
            let x = result.trajectory.value(0, 5.0, Side::Right);
            // QSS1 holds rates that time bends, for about a quantum each.
            let slack = if is_first_order(method) { 2e-2 } else { 1e-9 };
            assert!((x - end).abs() < slack, "{method:?} {interpolation:?}: {x} for {end}");
        }
    }
}

#[test]
fn events_from_outside_are_taken_at_their_time() {
    let mut b = Build::default();
    b.component("");
    let x = b.state("x", 0.0);
    let read = b.read(x);
    let (off, on) = (b.location("off"), b.location("on"));
    let [zero, one, half] = [0.0, 1.0, 0.5].map(|n| b.number(n));
    b.rate(off, x, zero);
    b.rate(on, x, one);
    let halved = b.mul(half, read);
    b.on(off, "start", on, &[]);
    b.on(on, "stop", off, &[]);
    b.on(on, "halve", on, &[(x, halved)]);
    let labelled = |events: &[(f64, &str)]| Experiment {
        events: events.iter().map(|(t, label)| (*t, (*label).to_owned())).collect(),
        ..to(10.0, 1e-3)
    };
    // 0.7: in `off` nobody waits for `stop`. 3.0: two at one instant, one per micro-step, in their order.
    let events = [(0.7, "stop"), (1.25, "start"), (3.0, "halve"), (3.0, "stop"), (10.0, "start")];
    let result = run(&b.model(), &labelled(&events));
    let taken: Vec<_> = result.events.iter().map(|e| (e.time, e.step, e.transition.as_str())).collect();
    let expected = [(1.25, 0, "start"), (3.0, 0, "halve"), (3.0, 1, "stop"), (10.0, 0, "start")];
    assert_eq!(taken, expected);
    assert!((result.trajectory.value(0, 5.0, Side::Right) - 0.875).abs() < 1e-12);

    let Err(SimulateError::Experiment(errors)) = try_run(&b.model(), &labelled(&[(1.0, "strat")])) else {
        panic!("there is no `strat`")
    };
    assert!(errors[0].to_string().contains("`strat`"), "{errors:?}");
    assert_eq!(errors[0].help.as_deref(), Some("did you mean `start`?"));
}
