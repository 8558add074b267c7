use super::state::State;

/// What the hand-written loop gives.
pub struct Oscillation {
    /// Changes of q.
    pub steps: u64,
    /// x₁ and x₂ at the end.
    pub end: [f64; 2],
}

/// x₁′ = x₂, x₂′ = −0.95 x₁ − 0.1 x₂ from (2, 0), by QSS2.
pub fn run(stop: f64, quantum: f64) -> Oscillation {
    let [mut a, mut b] = [State::at(2.0), State::at(0.0)];
    // q starts with its slope: the rates by value.
    let slopes = [b.q[0], -0.95 * a.q[0] - 0.1 * b.q[0]];
    a.q[1] = slopes[0];
    b.q[1] = slopes[1];
    let mut next = [rate_a(&mut a, &b, 0.0, quantum), rate_b(&a, &mut b, 0.0, quantum)];
    let mut steps = 0;
    loop {
        let first = next[0] <= next[1];
        let t = if first { next[0] } else { next[1] };
        if t > stop {
            return Oscillation { steps, end: [a.x_at(stop), b.x_at(stop)] };
        }
        steps += 1;
        if first {
            a.quantise(t);
            next[1] = rate_b(&a, &mut b, t, quantum);
            next[0] = t + a.band_delay(t, quantum);
        } else {
            b.quantise(t);
            next[0] = rate_a(&mut a, &b, t, quantum);
            next[1] = rate_b(&a, &mut b, t, quantum);
        }
    }
}

#[inline]
fn rate_a(a: &mut State, b: &State, t: f64, quantum: f64) -> f64 {
    a.rate(t, b.q_at(t), b.q[1]);
    t + a.band_delay(t, quantum)
}

#[inline]
fn rate_b(a: &State, b: &mut State, t: f64, quantum: f64) -> f64 {
    let f = a.q_at(t) * -0.95 - b.q_at(t) * 0.1;
    let f1 = a.q[1] * -0.95 - b.q[1] * 0.1;
    b.rate(t, f, f1);
    t + b.band_delay(t, quantum)
}
