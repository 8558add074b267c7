use super::state::State;

/// What the hand-written loop gives.
pub struct Line {
    /// Changes of q.
    pub steps: u64,
    /// Currents, then voltages, at the end.
    pub end: Vec<f64>,
}

/// i′ₖ = uₖ₋₁ − uₖ, u′ₖ = iₖ − iₖ₊₁ from rest, u₀ = 1, a matched resistance at the end, by QSS2.
pub fn run(sections: usize, stop: f64, quantum: f64) -> Line {
    let mut line = Sections {
        sections,
        quantum,
        states: vec![State::at(0.0); 2 * sections],
        queue: Queue::new(2 * sections),
    };
    // q starts with its slope.
    line.states[0].q[1] = 1.0;
    for k in 0..sections {
        line.current(k, 0.0);
        line.voltage(k, 0.0);
    }
    let mut steps = 0;
    loop {
        let (t, i) = line.queue.nodes[0];
        if t > stop {
            return Line { steps, end: line.states.iter().map(|state| state.x_at(stop)).collect() };
        }
        steps += 1;
        let i = i as usize;
        line.states[i].quantise(t);
        if let Some(k) = i.checked_sub(sections) {
            line.current(k, t);
            if k + 1 < sections {
                line.current(k + 1, t);
            } else {
                // The resistance: its current is the voltage.
                line.voltage(k, t);
                continue;
            }
        } else {
            if i > 0 {
                line.voltage(i - 1, t);
            }
            line.voltage(i, t);
        }
        line.schedule(i, t);
    }
}

struct Sections {
    sections: usize,
    quantum: f64,
    states: Vec<State>,
    queue: Queue,
}

impl Sections {
    #[inline]
    fn current(&mut self, k: usize, t: f64) {
        let out = &self.states[self.sections + k];
        let (q, q1) = (out.q_at(t), out.q[1]);
        let (f, f1) = if k == 0 {
            (1.0 - q, 0.0 - q1)
        } else {
            let before = &self.states[self.sections + k - 1];
            (before.q_at(t) - q, before.q[1] - q1)
        };
        self.states[k].rate(t, f, f1);
        self.schedule(k, t);
    }

    #[inline]
    fn voltage(&mut self, k: usize, t: f64) {
        let into = &self.states[k];
        let out = &self.states[if k + 1 < self.sections { k + 1 } else { self.sections + k }];
        let (f, f1) = (into.q_at(t) - out.q_at(t), into.q[1] - out.q[1]);
        self.states[self.sections + k].rate(t, f, f1);
        self.schedule(self.sections + k, t);
    }

    #[inline]
    fn schedule(&mut self, i: usize, t: f64) {
        let next = t + self.states[i].band_delay(t, self.quantum);
        self.queue.set(i as u32, if next > t { next } else { t });
    }
}

/// A 4-ary heap with the keys in its nodes; all slots are always in it.
struct Queue {
    nodes: Vec<(f64, u32)>,
    position: Vec<u32>,
}

impl Queue {
    fn new(slots: usize) -> Self {
        Queue {
            nodes: (0..slots as u32).map(|slot| (f64::INFINITY, slot)).collect(),
            position: (0..slots as u32).collect(),
        }
    }

    #[inline]
    fn set(&mut self, slot: u32, time: f64) {
        let item = (time, slot);
        let mut at = self.position[slot as usize] as usize;
        while at > 0 && earlier(item, self.nodes[(at - 1) / 4]) {
            self.place(at, self.nodes[(at - 1) / 4]);
            at = (at - 1) / 4;
        }
        loop {
            let first = 4 * at + 1;
            let mut least = first;
            for child in first + 1..(first + 4).min(self.nodes.len()) {
                if earlier(self.nodes[child], self.nodes[least]) {
                    least = child;
                }
            }
            if first >= self.nodes.len() || !earlier(self.nodes[least], item) {
                break;
            }
            self.place(at, self.nodes[least]);
            at = least;
        }
        self.place(at, item);
    }

    #[inline]
    fn place(&mut self, at: usize, item: (f64, u32)) {
        self.nodes[at] = item;
        self.position[item.1 as usize] = at as u32;
    }
}

#[inline]
fn earlier(a: (f64, u32), b: (f64, u32)) -> bool {
    a.0 < b.0 || (a.0 == b.0 && a.1 < b.1)
}
