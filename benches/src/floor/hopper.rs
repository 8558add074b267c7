use super::state::State;
use sophy_segment::{Sign, parabola_crossing};
use sophy_testkit::problems::Hopper;

/// What the hand-written loop gives.
pub struct Hops {
    /// Changes of q.
    pub steps: u64,
    /// Rates of ẏ evaluated again only because they bend.
    pub refreshes: u64,
    /// Times of the transitions, s.
    pub transitions: Vec<f64>,
    /// y and ẏ at the end.
    pub end: [f64; 2],
}

/// Raibert's hopper (thesis §8.5.2) with the constants of `h` by QSS2, from 0 s to `stop` with one quantum for
/// all states.
pub fn run(h: Hopper, stop: f64, quantum: f64) -> Hops {
    let mut floor = Floor {
        h,
        quantum,
        trust: stop / 100.0,
        location: FLIGHT,
        y: State::at(1.9),
        v: State::at(0.1),
        timer: State::at(0.0),
        eta2: State::at(0.0),
        refresh: f64::INFINITY,
        coasting: 0.0,
        watches: [Watch { sign: Sign::Zero, bias: 0.0, root: true }; 3],
        next: [f64::INFINITY; 5],
        steps: 0,
        refreshes: 0,
        transitions: Vec::new(),
    };
    floor.start();
    floor.advance(stop);
    Hops {
        steps: floor.steps,
        refreshes: floor.refreshes,
        transitions: floor.transitions,
        end: [floor.y.x_at(stop), floor.v.x_at(stop)],
    }
}

const G: f64 = 9.82;
const L: f64 = 0.5;
const ETA: f64 = 8.0;

const FLIGHT: usize = 0;
const COMPRESSION: usize = 1;
const THRUST: usize = 2;
const DECOMPRESSION: usize = 3;

/// Watches y − l, ẏ and timer − tp.
const LENGTH: usize = 0;
const SPEED: usize = 1;
const TIMER: usize = 2;
/// Which of them a location needs.
const ARMED: [[bool; 3]; 4] =
    [[true, false, false], [false, true, false], [true, false, true], [true, false, false]];

/// Slots of `next`: y, ẏ, then the watches. The timer and η₂ never leave their bands.
const Y: usize = 0;
const V: usize = 1;
const WATCHES: usize = 2;

struct Floor {
    h: Hopper,
    quantum: f64,
    trust: f64,
    location: usize,
    y: State,
    v: State,
    timer: State,
    eta2: State,
    refresh: f64,
    coasting: f64,
    watches: [Watch; 3],
    next: [f64; 5],
    steps: u64,
    refreshes: u64,
    transitions: Vec<f64>,
}

#[derive(Clone, Copy)]
struct Watch {
    sign: Sign,
    bias: f64,
    /// The time in `next` is a root ahead, not a change at the joint of two segments.
    root: bool,
}

impl Floor {
    fn start(&mut self) {
        let slopes = (self.v.q[0], self.rate_v(0.0)[0], self.clock());
        (self.y.q[1], self.v.q[1], self.timer.q[1]) = slopes;
        self.all_rates(0.0);
        self.watches[LENGTH].sign = self.decide(LENGTH, 0.0);
        self.predict(LENGTH, 0.0);
        self.react(0.0);
    }

    fn advance(&mut self, stop: f64) {
        let mut crossed = false;
        let mut now = f64::NEG_INFINITY;
        loop {
            let (mut slot, mut t) = (0, self.next[0]);
            for (other, &time) in self.next.iter().enumerate().skip(1) {
                if time < t {
                    (slot, t) = (other, time);
                }
            }
            if crossed && t > now {
                crossed = false;
                self.react(now);
                continue;
            }
            if t > stop {
                return;
            }
            now = t;
            match slot {
                Y => self.step_y(t),
                V => self.due_v(t),
                _ => crossed |= self.due_watch(slot - WATCHES, t),
            }
        }
    }

    #[inline]
    fn step_y(&mut self, t: f64) {
        self.y.quantise(t);
        self.steps += 1;
        if self.location == COMPRESSION || self.location == DECOMPRESSION {
            self.set_v(t);
        }
        self.next[Y] = t + self.y.band_delay(t, self.quantum);
    }

    #[inline]
    fn due_v(&mut self, t: f64) {
        let step = self.refresh > t || self.v.band_delay(t, self.quantum) <= 0.0;
        if !step {
            self.refreshes += 1;
            self.set_v(t);
            return;
        }
        self.v.quantise(t);
        self.steps += 1;
        self.set_y(t);
        if self.location == FLIGHT {
            self.schedule_v(t);
        } else {
            self.set_v(t);
        }
    }

    /// Whether a sign changed.
    #[inline]
    fn due_watch(&mut self, w: usize, t: f64) -> bool {
        let c = self.difference(w, t);
        let watch = &mut self.watches[w];
        if watch.root && watch.sign != Sign::Zero {
            watch.bias += c[0];
            watch.sign = watch.sign.opposite();
        } else {
            watch.sign = Sign::after(&c);
        }
        self.predict(w, t);
        true
    }

    /// The rate of ẏ and its two next Taylor coefficients along q.
    #[inline]
    fn rate_v(&self, t: f64) -> [f64; 3] {
        let (v, v1) = (self.v.q_at(t), self.v.q[1]);
        let gamma = self.h.gamma;
        match self.location {
            FLIGHT => [-G, 0.0, 0.0],
            THRUST => [self.h.tau - v * gamma - G, -(v1 * gamma), 0.0],
            location => {
                let (e, e1) =
                    if location == COMPRESSION { (ETA, 0.0) } else { (self.eta2.q_at(t), self.eta2.q[1]) };
                let (y, y1) = (self.y.q_at(t), self.y.q[1]);
                let c0 = e / y;
                let c1 = (e1 - y1 * c0) / y;
                let c2 = -(y1 * c1) / y;
                [c0 - v * gamma - G, c1 - v1 * gamma, c2]
            }
        }
    }

    #[inline]
    fn clock(&self) -> f64 {
        if self.location == THRUST { 1.0 } else { 0.0 }
    }

    #[inline]
    fn set_y(&mut self, t: f64) {
        self.y.rate(t, self.v.q_at(t), self.v.q[1]);
        self.next[Y] = t + self.y.band_delay(t, self.quantum);
        if ARMED[self.location][LENGTH] {
            self.predict(LENGTH, t);
        }
    }

    #[inline]
    fn set_v(&mut self, t: f64) {
        let [f, f1, f2] = self.rate_v(t);
        self.v.rate(t, f, f1);
        if self.refresh > t {
            self.coasting = t;
        }
        self.refresh = if self.location == COMPRESSION || self.location == DECOMPRESSION {
            let moved = 3.0 * self.quantum / f2.abs();
            let shared = (moved / (t - self.coasting)).sqrt();
            t + libm::cbrt(moved).min(shared).min(self.trust)
        } else {
            f64::INFINITY
        };
        self.schedule_v(t);
        if self.location == COMPRESSION {
            self.predict(SPEED, t);
        }
    }

    #[inline]
    fn schedule_v(&mut self, t: f64) {
        let band = t + self.v.band_delay(t, self.quantum);
        self.next[V] = if self.refresh < band { self.refresh } else { band };
    }

    fn all_rates(&mut self, t: f64) {
        self.set_y(t);
        self.set_v(t);
        self.timer.rate(t, self.clock(), 0.0);
        self.eta2.rate(t, 0.0, 0.0);
    }

    /// Takes the transitions that are enabled.
    fn react(&mut self, t: f64) {
        loop {
            let positive = |w: usize| self.watches[w].sign == Sign::Positive;
            let to = match self.location {
                FLIGHT if self.watches[LENGTH].sign == Sign::Negative => COMPRESSION,
                COMPRESSION if positive(SPEED) => THRUST,
                THRUST if positive(TIMER) || positive(LENGTH) => DECOMPRESSION,
                DECOMPRESSION if positive(LENGTH) => FLIGHT,
                _ => return,
            };
            self.transitions.push(t);
            self.enter(to, t);
        }
    }

    fn enter(&mut self, to: usize, t: f64) {
        let from = std::mem::replace(&mut self.location, to);
        self.v.synchronise(t);
        let clock_changes = from == THRUST || to == THRUST;
        if to == THRUST {
            self.timer.set(0.0, t);
        }
        if clock_changes {
            self.timer.synchronise(t);
        }
        if from == THRUST {
            self.eta2.set(self.y.x_at(t) * self.h.tau, t);
            self.eta2.synchronise(t);
        }
        self.v.q[1] = self.rate_v(t)[0];
        if clock_changes {
            self.timer.q[1] = self.clock();
        }
        self.all_rates(t);
        for w in [LENGTH, SPEED, TIMER] {
            self.next[WATCHES + w] = f64::INFINITY;
            if ARMED[to][w] {
                let stays = ARMED[from][w];
                self.watches[w].sign =
                    if stays { Sign::after(&self.difference(w, t)) } else { self.decide(w, t) };
                self.predict(w, t);
            }
        }
    }

    /// The sign of a watch from scratch: equal within rounding counts as equal.
    fn decide(&mut self, w: usize, t: f64) -> Sign {
        self.watches[w].bias = 0.0;
        let (left, right) = match w {
            LENGTH => (self.y.x_at(t), L),
            SPEED => (self.v.x_at(t), 0.0),
            _ => (self.timer.x_at(t), self.h.tp),
        };
        let mut c = self.difference(w, t);
        let larger = if left.abs() > right.abs() { left.abs() } else { right.abs() };
        if c[0].abs() <= 4.0 * (larger.next_up() - larger) {
            self.watches[w].bias = c[0];
            c[0] = 0.0;
        }
        Sign::after(&c)
    }

    #[inline]
    fn difference(&self, w: usize, t: f64) -> [f64; 3] {
        let mut c = match w {
            LENGTH => self.y.jet_at(t),
            SPEED => self.v.jet_at(t),
            _ => self.timer.jet_at(t),
        };
        c[0] -= [L, 0.0, self.h.tp][w];
        c[0] -= self.watches[w].bias;
        c
    }

    #[inline]
    fn predict(&mut self, w: usize, t: f64) {
        let c = self.difference(w, t);
        let (time, root) = match parabola_crossing(c, self.watches[w].sign) {
            Some(delay) => (t + delay, delay > 0.0),
            None => (f64::INFINITY, true),
        };
        self.watches[w].root = root;
        self.next[WATCHES + w] = time;
    }
}
