//! Random hybrid automata with constant rates against a slow simulator in exact arithmetic, and compositions
//! against what they mean when written by hand as one system.

use crate::support::{METHODS, by, run, to};
use proptest::prelude::*;
use sophy_ir::{Comparison, NodeId, VariableId};
use sophy_record::Side;
use sophy_run::Method;
use sophy_testkit::{Build, Place};

fn methods() -> impl Strategy<Value = Method> {
    prop::sample::select(METHODS.to_vec())
}

/// `state ≥ threshold` or `state ≤ threshold`, in eighths; to a location, with a reset and an event.
#[derive(Clone, Debug)]
struct Edge {
    state: usize,
    above: bool,
    threshold: i64,
    to: usize,
    reset: Reset,
    emits: bool,
}

#[derive(Clone, Copy, Debug)]
enum Reset {
    Nothing,
    /// `x := value/8`
    Value(usize, i64),
    /// `x₀ := x₁, x₁ := x₀`: both read before.
    Swap,
    /// `x := x + value/8`
    Shift(usize, i64),
}

#[derive(Clone, Debug)]
struct Plan {
    /// Per location: rates of both states (powers of two, or zero), edges.
    locations: Vec<([i64; 2], Vec<Edge>)>,
    /// In eighths.
    initial: [i64; 2],
    /// What the event from the other automaton does in every location: to where, shift of x₀ in eighths.
    on_event: (usize, i64),
}

fn edge(state: usize, above: bool, rest: (i64, usize, (u8, usize, i64), bool)) -> Edge {
    let (threshold, to, (kind, target, value), emits) = rest;
    let reset = match kind {
        0 => Reset::Nothing,
        1 => Reset::Value(target, value),
        2 => Reset::Swap,
        _ => Reset::Shift(target, value),
    };
    Edge { state, above, threshold, to, reset, emits }
}

fn plan() -> impl Strategy<Value = Plan> {
    let rate = || prop::sample::select(vec![-4i64, -2, -1, 0, 1, 2, 4]);
    let edges = prop::collection::vec(
        (0usize..2, any::<bool>(), -24i64..24, 0usize..4, (0u8..4, 0usize..2, -16i64..16), any::<bool>())
            .prop_map(|(state, above, threshold, to, reset, emits)| {
                edge(state, above, (threshold, to, reset, emits))
            }),
        1..4,
    );
    let locations = prop::collection::vec(([rate(), rate()], edges), 2..5);
    (locations, [-16i64..16, -16i64..16], (0usize..4, -8i64..8)).prop_map(
        |(mut locations, initial, on_event)| {
            let count = locations.len();
            for edge in locations.iter_mut().flat_map(|location| &mut location.1) {
                edge.to %= count;
            }
            Plan { locations, initial, on_event: (on_event.0 % count, on_event.1) }
        },
    )
}

/// A transition: time in units of 2⁻³³ s, micro-step, automaton, name.
type Happening = (i64, u32, usize, String);

/// Time and values in units of 2⁻³³, all exact: thresholds are eighths and rates powers of two. Crossings need
/// finer and finer fractions as a run goes on; one that would need more is left out.
struct Slow<'a> {
    plans: &'a [Plan],
    location: Vec<usize>,
    x: Vec<[i64; 2]>,
    queue: Vec<u32>,
}

/// An eighth, and a second.
const UNIT: i64 = 1 << 30;
const SECOND: i64 = 8 * UNIT;
/// Runs that go round without end, or too often for a test, are left out.
const MOST: u32 = 12;

impl Slow<'_> {
    /// Whether an edge is enabled just right of now: on the surface, if the state moves to its side or rests
    /// there (the comparisons are not strict).
    fn enabled(&self, a: usize, edge: &Edge) -> bool {
        let distance = self.x[a][edge.state] - edge.threshold * UNIT;
        let rate = self.plans[a].locations[self.location[a]].0[edge.state];
        let (distance, rate) = if edge.above { (distance, rate) } else { (-distance, -rate) };
        distance > 0 || distance == 0 && rate >= 0
    }

    /// How long until an edge that is not enabled is; with the remainder, in parts of the rate.
    fn next(&self, a: usize, edge: &Edge) -> Option<(i64, i64)> {
        let distance = edge.threshold * UNIT - self.x[a][edge.state];
        let rate = self.plans[a].locations[self.location[a]].0[edge.state];
        (distance.signum() * rate.signum() > 0).then(|| (distance / rate, distance % rate))
    }

    /// Takes micro-steps; `None` if there are too many.
    fn react(&mut self, now: i64, log: &mut Vec<Happening>) -> Option<()> {
        for step in 0.. {
            if step > MOST {
                return None;
            }
            let mut chosen: Vec<(usize, Edge, String)> = Vec::new();
            for a in 0..self.plans.len() {
                let edges = &self.plans[a].locations[self.location[a]].1;
                if let Some(k) = edges.iter().position(|edge| self.enabled(a, edge)) {
                    chosen.push((a, edges[k].clone(), format!("t{k}")));
                }
            }
            if chosen.is_empty() {
                let mut waited = false;
                for a in 0..self.plans.len() {
                    if self.queue[a] > 0 {
                        self.queue[a] -= 1;
                        waited = true;
                        let (to, shift) = self.plans[a].on_event;
                        let edge = Edge {
                            state: 0,
                            above: true,
                            threshold: 0,
                            to,
                            reset: Reset::Shift(0, shift),
                            emits: false,
                        };
                        chosen.push((a, edge, "tick".to_owned()));
                    }
                }
                if !waited {
                    return Some(());
                }
            }
            // The event goes to the next automaton; values are read before.
            for (a, edge, name) in chosen {
                let [x0, x1] = self.x[a];
                match edge.reset {
                    Reset::Nothing => {}
                    Reset::Value(target, value) => self.x[a][target] = value * UNIT,
                    Reset::Swap => self.x[a] = [x1, x0],
                    Reset::Shift(target, value) => self.x[a][target] += value * UNIT,
                }
                self.location[a] = edge.to;
                log.push((now, step, a, name));
                if edge.emits && self.plans.len() > 1 {
                    self.queue[(a + 1) % self.plans.len()] += 1;
                }
            }
        }
        Some(())
    }

    /// All transitions up to `stop`; `None` for runs that are left out.
    fn simulate(plans: &[Plan], stop: i64) -> Option<Vec<Happening>> {
        let mut slow = Slow {
            plans,
            location: vec![0; plans.len()],
            x: plans.iter().map(|plan| plan.initial.map(|x| x * UNIT)).collect(),
            queue: vec![0; plans.len()],
        };
        let (mut now, mut log) = (0, Vec::new());
        loop {
            slow.react(now, &mut log)?;
            let mut delay = stop + 1 - now;
            for (a, plan) in plans.iter().enumerate() {
                for edge in &plan.locations[slow.location[a]].1 {
                    let Some((next, rest)) = slow.next(a, edge) else { continue };
                    if rest != 0 {
                        return None;
                    }
                    delay = next.min(delay);
                }
            }
            now += delay;
            if now > stop {
                return Some(log);
            }
            for (a, plan) in plans.iter().enumerate() {
                let rates = plan.locations[slow.location[a]].0;
                for (x, rate) in slow.x[a].iter_mut().zip(rates) {
                    *x += rate * delay;
                }
            }
            if log.len() > 300 {
                return None;
            }
        }
    }
}

fn build(plans: &[Plan]) -> Build {
    let mut b = Build::default();
    let mut components = Vec::new();
    for (a, plan) in plans.iter().enumerate() {
        let component = b.component(&format!("a{a}"));
        components.push(component);
        let eighths = |n: i64| n as f64 / 8.0;
        let x = [b.state("x0", eighths(plan.initial[0])), b.state("x1", eighths(plan.initial[1]))];
        let read = x.map(|id| b.read(id));
        let places: Vec<Place> = (0..plan.locations.len()).map(|l| b.location(&format!("q{l}"))).collect();
        for (&place, (rates, edges)) in places.iter().zip(&plan.locations) {
            for (&state, &rate) in x.iter().zip(rates) {
                let rate = b.number(rate as f64);
                b.rate(place, state, rate);
            }
            for (k, edge) in edges.iter().enumerate() {
                let threshold = b.number(eighths(edge.threshold));
                let comparison = if edge.above { Comparison::GreaterEqual } else { Comparison::LessEqual };
                let guard = b.compare(comparison, read[edge.state], threshold);
                let resets: Vec<(VariableId, NodeId)> = match edge.reset {
                    Reset::Nothing => Vec::new(),
                    Reset::Value(target, value) => vec![(x[target], b.number(eighths(value)))],
                    Reset::Swap => vec![(x[0], read[1]), (x[1], read[0])],
                    Reset::Shift(target, value) => {
                        let value = b.number(eighths(value));
                        vec![(x[target], b.add(read[target], value))]
                    }
                };
                b.when(place, &format!("t{k}"), guard, places[edge.to], &resets);
                if edge.emits {
                    b.emit(place, "tock");
                }
            }
            if plans.len() > 1 {
                let (to, shift) = plan.on_event;
                let shift = b.number(eighths(shift));
                let shifted = b.add(read[0], shift);
                b.on(place, "tick", places[to], &[(x[0], shifted)]);
            }
        }
    }
    for (a, &component) in components.iter().enumerate() {
        if components.len() > 1 {
            b.connect_event((component, "tock"), (components[(a + 1) % components.len()], "tick"));
        }
    }
    b
}

proptest! {
    #![proptest_config(ProptestConfig { max_global_rejects: 20_000, ..ProptestConfig::with_cases(250) })]

    /// The same transitions, at the same times to the bit, in the same micro-steps.
    #[test]
    fn automata_with_constant_rates_take_the_transitions_of_exact_arithmetic(
        plans in prop::collection::vec(plan(), 1..4),
        method in methods(),
    ) {
        let stop = 6;
        let expected = Slow::simulate(&plans, stop * SECOND);
        prop_assume!(expected.as_ref().is_some_and(|log| log.len() > 2));
        let result = run(&build(&plans).model(), &by(method, to(stop as f64, 0.1)));
        let found: Vec<Happening> = result
            .events
            .iter()
            .map(|e| {
                let exact = e.time * SECOND as f64;
                assert!(exact.fract() == 0.0, "{e:?}");
                (exact as i64, e.step, e.component[1..].parse().unwrap(), e.transition.clone())
            })
            .collect();
        prop_assert_eq!(Some(found), expected);
    }
}

/// A sender whose output depends on its location and a receiver that integrates and watches it, against the
/// same written as one automaton.
#[test]
fn signals_that_depend_on_a_location_are_those_of_the_flat_system() {
    for method in METHODS {
        let mut b = Build::default();
        b.component("sender");
        let (clock, y) = (b.state("clock", 0.0), b.output("y"));
        let rc = b.read(clock);
        let places = ["up", "down"].map(|name| b.location(name));
        let [zero, one, two, three] = [0.0, 1.0, 2.0, 3.0].map(|n| b.number(n));
        let falling = b.sub(one, rc);
        let square = b.mul(rc, rc);
        for (place, value) in places.into_iter().zip([square, falling]) {
            b.rate(place, clock, one);
            b.value(place, y, value);
        }
        let over = b.compare(Comparison::GreaterEqual, rc, two);
        b.when(places[0], "fall", over, places[1], &[(clock, zero)]);
        b.when(places[1], "rise", over, places[0], &[(clock, zero)]);
        b.component("receiver");
        let (x, u, z) = (b.state("x", 0.25), b.input("u"), b.output("z"));
        let (rx, ru) = (b.read(x), b.read(u));
        let (low, high) = (b.location("low"), b.location("high"));
        let decay = b.sub(ru, rx);
        let twice = b.mul(two, ru);
        for place in [low, high] {
            b.rate(place, x, decay);
        }
        b.value(low, z, ru);
        b.value(high, z, twice);
        let above = b.greater(ru, three);
        let below = b.less(ru, zero);
        b.when(low, "high", above, high, &[]);
        b.when(high, "low", below, low, &[(x, ru)]);
        b.connect(y, u);
        let composed = run(&b.model(), &by(method, to(9.0, 1e-5)));

        let mut b = Build::default();
        b.component("");
        let (clock, x) = (b.state("clock", 0.0), b.state("x", 0.25));
        let (rc, rx) = (b.read(clock), b.read(x));
        let names = ["up low", "up high", "down low", "down high"];
        let places = names.map(|name| b.location(name));
        let [zero, one, two, three] = [0.0, 1.0, 2.0, 3.0].map(|n| b.number(n));
        let falling = b.sub(one, rc);
        let square = b.mul(rc, rc);
        let over = b.compare(Comparison::GreaterEqual, rc, two);
        for (k, y) in [square, square, falling, falling].into_iter().enumerate() {
            b.rate(places[k], clock, one);
            let decay = b.sub(y, rx);
            b.rate(places[k], x, decay);
            let (name, other) = if k < 2 { ("fall", k + 2) } else { ("rise", k - 2) };
            b.when(places[k], name, over, places[other], &[(clock, zero)]);
            if k % 2 == 0 {
                let above = b.greater(y, three);
                b.when(places[k], "high", above, places[k + 1], &[]);
            } else {
                let below = b.less(y, zero);
                b.when(places[k], "low", below, places[k - 1], &[(x, y)]);
            }
        }
        let flat = run(&b.model(), &by(method, to(9.0, 1e-5)));

        let events = |r: &crate::support::Result| -> Vec<(f64, String)> {
            r.events.iter().map(|e| (e.time, e.transition.clone())).collect()
        };
        let (left, right) = (events(&composed), events(&flat));
        // high at √3, fall at 2, low at 3, rise at 4, …
        assert_eq!(left.len(), 8, "{left:?}");
        assert_eq!(left.len(), right.len(), "{left:?} {right:?}");
        let exact = [3.0f64.sqrt(), 2.0, 3.0, 4.0, 4.0 + 3.0f64.sqrt(), 6.0, 7.0, 8.0];
        for ((a, b), t) in left.iter().zip(&right).zip(exact) {
            assert_eq!(a.1, b.1);
            assert!((a.0 - t).abs() < 1e-12 && (b.0 - t).abs() < 1e-12, "{a:?} {b:?} {t}");
        }
        for k in 0..=900 {
            let t = f64::from(k) / 100.0;
            let off = composed.trajectory.value(1, t, Side::Right) - flat.trajectory.value(1, t, Side::Right);
            assert!(off.abs() < 1e-4, "{method:?}: {off:e} at {t}");
        }
        // The output of the receiver, through both locations.
        let (times, z) = (&composed.table.time, composed.table.real("receiver.z").unwrap());
        let mut seen = 0;
        for (k, &t) in times.iter().enumerate() {
            if exact.iter().any(|e| (e - t).abs() < 1e-9) {
                continue;
            }
            let phase = t % 4.0;
            let y = if phase < 2.0 { phase * phase } else { 1.0 - (phase - 2.0) };
            let high = phase > 3.0f64.sqrt() && phase < 3.0;
            let expected = if high { 2.0 * y } else { y };
            assert!((z[k] - expected).abs() < 1e-9, "{method:?}: {} for {expected} at {t}", z[k]);
            seen += 1;
        }
        assert!(seen > 10);
    }
}

/// Two automata whose transitions fall on one instant exchange their states: both read what was before.
#[test]
fn transitions_of_one_micro_step_read_the_values_before() {
    for method in METHODS {
        let mut b = Build::default();
        let mut states = Vec::new();
        let mut outputs = Vec::new();
        let mut parts = Vec::new();
        for (name, initial) in [("left", 0.0), ("right", 10.0)] {
            b.component(name);
            let (x, other, y) = (b.state("x", initial), b.input("other"), b.output("y"));
            let read = b.read(x);
            let (before, after) = (b.location("before"), b.location("after"));
            let [one, ten] = [1.0, 10.0].map(|n| b.number(n));
            let double = b.mul(ten, read);
            for place in [before, after] {
                b.rate(place, x, one);
            }
            // The output depends on the location: it is an algebraic variable.
            b.value(before, y, read);
            b.value(after, y, double);
            let limit = b.number(initial + 2.0);
            let over = b.compare(Comparison::GreaterEqual, read, limit);
            let ru = b.read(other);
            b.when(before, "exchange", over, after, &[(x, ru)]);
            states.push(x);
            outputs.push(y);
            parts.push(other);
        }
        b.connect(outputs[0], parts[1]);
        b.connect(outputs[1], parts[0]);
        let result = run(&b.model(), &by(method, to(3.0, 0.1)));
        let events: Vec<_> = result.events.iter().map(|e| (e.time, e.step, e.component.as_str())).collect();
        assert_eq!(events, [(2.0, 0, "left"), (2.0, 0, "right")]);
        assert_eq!(result.trajectory.value(0, 2.0, Side::Left), 2.0);
        assert_eq!(result.trajectory.value(0, 2.0, Side::Right), 12.0);
        assert_eq!(result.trajectory.value(1, 2.0, Side::Right), 2.0);
    }
}
