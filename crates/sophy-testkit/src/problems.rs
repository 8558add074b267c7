//! Problems with known solutions, built by hand.

use crate::Build;
use sophy_ir::{Comparison, Model, Unary};

/// Constants of Raibert's hopper (thesis §8.5.2): g 9.82 m/s², l 0.5 m, η 8 m²/s² are common to all sets.
#[derive(Clone, Copy, Debug)]
pub struct Hopper {
    /// Thrust, m/s².
    pub tau: f64,
    /// Friction, 1/s.
    pub gamma: f64,
    /// Longest thrust, s.
    pub tp: f64,
    /// Whether friction in Thrust reads the position, as the listing of appendix A.6 prints it.
    pub friction_misprint: bool,
}

impl Hopper {
    /// τ = 40: a stable orbit.
    pub const TAU40: Hopper = Hopper { tau: 40.0, gamma: 0.2, tp: 0.1, friction_misprint: false };
    /// τ = 20: stuck in Decompression.
    pub const TAU20: Hopper = Hopper { tau: 20.0, ..Hopper::TAU40 };
    /// The constants of appendix A.6.
    pub const APPENDIX: Hopper = Hopper { tau: 40.0, gamma: 0.1, tp: 0.35, friction_misprint: true };

    /// The model: states y, ydot, timer, eta2; locations Flight, Compression, Thrust, Decompression.
    pub fn model(self) -> Model {
        let mut b = Build::default();
        b.component("");
        let (y, v) = (b.state("y", 1.9), b.state("ydot", 0.1));
        let (timer, eta2) = (b.state("timer", 0.0), b.state("eta2", 0.0));
        let [ry, rv, rt, re] = [y, v, timer, eta2].map(|id| b.read(id));
        let (g, l, tp) = (b.parameter("g", 9.82), b.parameter("l", 0.5), b.parameter("tp", self.tp));
        let (tau, gamma) = (b.parameter("tau", self.tau), b.parameter("gamma", self.gamma));
        let eta = b.parameter("eta", 8.0);
        let (zero, one) = (b.number(0.0), b.number(1.0));
        let [flight, compression, thrust, decompression] =
            ["Flight", "Compression", "Thrust", "Decompression"].map(|name| b.location(name));
        for (place, clock) in [(flight, zero), (compression, zero), (thrust, one), (decompression, zero)] {
            b.rate(place, y, rv);
            b.rate(place, timer, clock);
            b.rate(place, eta2, zero);
        }
        let friction = b.mul(gamma, rv);
        let fall = b.unary(Unary::Negate, g);
        b.rate(flight, v, fall);
        for (place, spring) in [(compression, eta), (decompression, re)] {
            let force = b.div(spring, ry);
            let net = b.sub(force, friction);
            let net = b.sub(net, g);
            b.rate(place, v, net);
        }
        let friction = if self.friction_misprint { b.mul(gamma, ry) } else { friction };
        let net = b.sub(tau, friction);
        let net = b.sub(net, g);
        b.rate(thrust, v, net);

        let touches = b.less(ry, l);
        b.when(flight, "touchdown", touches, compression, &[]);
        let turns = b.greater(rv, zero);
        b.when(compression, "bottom", turns, thrust, &[(timer, zero)]);
        let (expires, extends) = (b.greater(rt, tp), b.greater(ry, l));
        let force = b.mul(ry, tau);
        b.when(thrust, "timer", expires, decompression, &[(eta2, force)]);
        b.when(thrust, "extended", extends, decompression, &[(eta2, force)]);
        b.when(decompression, "liftoff", extends, flight, &[]);
        b.model()
    }
}

/// x₁′ = x₂, x₂′ = −0.95 x₁ − 0.1 x₂ from (2, 0) (thesis §3.3.3).
pub fn oscillator() -> Model {
    let mut b = Build::default();
    b.component("");
    let (x1, x2) = (b.state("x1", 2.0), b.state("x2", 0.0));
    let (r1, r2) = (b.read(x1), b.read(x2));
    let here = b.location("all");
    b.rate(here, x1, r2);
    let (k, d) = (b.number(-0.95), b.number(0.1));
    let (spring, damper) = (b.mul(k, r1), b.mul(d, r2));
    let net = b.sub(spring, damper);
    b.rate(here, x2, net);
    b.model()
}

/// x₁′ = x₂, x₂′ = −x₁ from (1, 0): an oscillator without damping.
pub fn circle() -> Model {
    let mut b = Build::default();
    b.component("");
    let (x1, x2) = (b.state("x1", 1.0), b.state("x2", 0.0));
    let (r1, r2) = (b.read(x1), b.read(x2));
    let here = b.location("all");
    b.rate(here, x1, r2);
    let back = b.unary(Unary::Negate, r1);
    b.rate(here, x2, back);
    b.model()
}

/// x₁′ = −100 (x₁ + sin x₂), x₂′ = 1 from (1, 0) (thesis §3.3.3).
pub fn two_timescale() -> Model {
    let mut b = Build::default();
    b.component("");
    let (x1, x2) = (b.state("x1", 1.0), b.state("x2", 0.0));
    let (r1, r2) = (b.read(x1), b.read(x2));
    let here = b.location("all");
    let sine = b.unary(Unary::Sin, r2);
    let sum = b.add(r1, sine);
    let k = b.number(-100.0);
    let net = b.mul(k, sum);
    b.rate(here, x1, net);
    let one = b.number(1.0);
    b.rate(here, x2, one);
    b.model()
}

/// x₁ = (t − 1)² + offset, watched for `x₁ < 0`; then x₁′ = −1 (a thin dip if the offset is small).
pub fn dip(offset: f64) -> Model {
    let mut b = Build::default();
    b.component("");
    let (x1, x2) = (b.state("x1", 1.0 + offset), b.state("x2", -2.0));
    let (r1, r2) = (b.read(x1), b.read(x2));
    let (outside, inside) = (b.location("outside"), b.location("inside"));
    let [zero, minus, two] = [0.0, -1.0, 2.0].map(|n| b.number(n));
    b.rate(outside, x1, r2);
    b.rate(outside, x2, two);
    b.rate(inside, x1, minus);
    b.rate(inside, x2, zero);
    let below = b.less(r1, zero);
    b.when(outside, "enter", below, inside, &[]);
    b.model()
}

/// (x₁, x₂) = (cos(t − 1), sin(t − 1)), watched for the corner `x₁ > 0.99 && x₂ > corner`.
pub fn corner(corner: f64) -> Model {
    let mut b = Build::default();
    b.component("");
    let (x1, x2) = (b.state("x1", COS_1), b.state("x2", -SIN_1));
    let (r1, r2) = (b.read(x1), b.read(x2));
    let (outside, inside) = (b.location("outside"), b.location("inside"));
    let back = b.unary(Unary::Negate, r2);
    for place in [outside, inside] {
        b.rate(place, x1, back);
        b.rate(place, x2, r1);
    }
    let (a, c) = (b.number(0.99), b.number(corner));
    let (right, high) = (b.greater(r1, a), b.greater(r2, c));
    let both = b.graph().and(right, high);
    b.when(outside, "enter", both, inside, &[]);
    b.model()
}

const COS_1: f64 = 0.540_302_305_868_139_8;
const SIN_1: f64 = 0.841_470_984_807_896_5;

/// Two guards true at one instant and a chain of transitions, in exact arithmetic (thesis §8.3.2: the first
/// declared wins, guards are looked at again at once).
pub fn simultaneous() -> Model {
    let mut b = Build::default();
    b.component("");
    let (x1, x2) = (b.state("x1", 0.0), b.state("x2", -1.0));
    let (r1, r2) = (b.read(x1), b.read(x2));
    let places = ["A", "B", "C", "D"].map(|name| b.location(name));
    for (place, (first, second)) in places.iter().zip([(1.0, 2.0), (1.0, 0.5), (1.0, 1.0), (0.5, 1.0)]) {
        let (first, second) = (b.number(first), b.number(second));
        b.rate(*place, x1, first);
        b.rate(*place, x2, second);
    }
    let [a, bb, c, d] = places;
    let [zero, one, two, three, minus] = [0.0, 1.0, 2.0, 3.0, -1.0].map(|n| b.number(n));
    let a1 = b.compare(Comparison::GreaterEqual, r1, one);
    let a2 = b.compare(Comparison::GreaterEqual, r2, one);
    let c1 = b.compare(Comparison::GreaterEqual, r1, two);
    let d1 = b.compare(Comparison::GreaterEqual, r2, zero);
    let opposite = b.unary(Unary::Negate, r2);
    let lower = b.sub(r2, three);
    b.when(a, "a1", a1, bb, &[(x1, zero)]);
    b.when(a, "a2", a2, c, &[(x2, opposite)]);
    b.when(bb, "b", a2, d, &[(x2, lower)]);
    b.when(c, "c", c1, a, &[(x1, zero), (x2, minus)]);
    b.when(d, "d", d1, a, &[]);
    b.model()
}

/// Two timers (periods ½ and ¾ s) and a counter that receives both ticks: y + 1 and 2y, timer 1 first.
pub fn two_timers() -> Model {
    let mut b = Build::default();
    let mut timers = Vec::new();
    for (name, period, label) in [("timer1", 0.5, "tick1"), ("timer2", 0.75, "tick2")] {
        let component = b.component(name);
        let clock = b.state("clock", 0.0);
        let read = b.read(clock);
        let here = b.location("on");
        let [zero, one, period] = [0.0, 1.0, period].map(|n| b.number(n));
        b.rate(here, clock, one);
        let over = b.compare(Comparison::GreaterEqual, read, period);
        b.when(here, label, over, here, &[(clock, zero)]);
        b.emit(here, label);
        timers.push((component, label));
    }
    let counter = b.component("counter");
    let y = b.state("y", 0.0);
    let read = b.read(y);
    let here = b.location("on");
    let [zero, one, two] = [0.0, 1.0, 2.0].map(|n| b.number(n));
    b.rate(here, y, zero);
    let (more, twice) = (b.add(read, one), b.mul(two, read));
    b.on(here, "tick1", here, &[(y, more)]);
    b.on(here, "tick2", here, &[(y, twice)]);
    for (component, label) in timers {
        b.connect_event((component, label), (counter, label));
    }
    b.model()
}
