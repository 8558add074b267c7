use sophy_field::Jet;
use sophy_segment::{Interval, cubic_leaves};

/// A source (state, input or time): one cache line up to the second order, two for the third.
///
/// x(t) = Σ xₖ·sᵏ, s = t − tx; q(t) = Σ qₖ·sᵏ, s = t − tq. Inputs and time have q = x.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(align(64))]
pub(super) struct Record<const Q: usize, const X: usize> {
    /// x, ẋ, ½ẍ … at `tx`.
    pub(super) x: [f64; X],
    /// Start of x, s.
    pub(super) tx: f64,
    /// q, q̇ … at `tq`.
    pub(super) q: [f64; Q],
    /// Start of q, s.
    pub(super) tq: f64,
    /// Present quantum ΔQ.
    pub(super) quantum: f64,
}

impl<const Q: usize, const X: usize> Record<Q, X> {
    /// A source that follows `value + slope·(t − time)` exactly.
    pub(super) fn line(value: f64, slope: f64, time: f64) -> Self {
        let (mut x, mut q) = ([0.0; X], [0.0; Q]);
        (x[0], x[1], q[0], q[1]) = (value, slope, value, slope);
        Record { x, tx: time, q, tq: time, quantum: f64::INFINITY }
    }

    /// x at `time`.
    #[inline]
    pub(super) fn x_at(&self, time: f64) -> f64 {
        horner(&self.x, time - self.tx)
    }

    /// Taylor coefficients of x at `time`.
    #[inline]
    pub(super) fn x_from(&self, time: f64) -> [f64; X] {
        moved(&self.x, time - self.tx)
    }

    /// The same, as many as any order has.
    #[inline]
    pub(super) fn jet_at(&self, time: f64) -> Jet {
        let mut jet = Jet::default();
        jet[..X].copy_from_slice(&self.x_from(time));
        jet
    }

    /// q at `time`.
    #[inline]
    pub(super) fn q_at(&self, time: f64) -> f64 {
        horner(&self.q, time - self.tq)
    }

    /// Taylor coefficients of q at `time`.
    #[inline]
    pub(super) fn q_from(&self, time: f64) -> [f64; Q] {
        moved(&self.q, time - self.tq)
    }

    /// Enclosures of value, slope and half the curvature of x over `times`.
    pub(super) fn enclose(&self, times: Interval) -> [Interval; 3] {
        let mut c = [Interval::point(0.0); 4];
        for (c, &x) in c.iter_mut().zip(&self.x) {
            *c = Interval::point(x);
        }
        let [c0, c1, c2, c3] = c;
        let number = Interval::point;
        let s = times - number(self.tx);
        let curved = X > 3;
        let curvature = if curved { c2 + number(3.0) * c3 * s } else { c2 };
        // The mean-value form is the tighter one on short spans, the power form keeps exact points.
        let middle = number(s.midpoint());
        let square = s.square();
        let slope = if curved {
            let power = c1 + number(2.0) * c2 * s + number(3.0) * c3 * square;
            let centred = c1
                + middle * (number(2.0) * c2 + number(3.0) * c3 * middle)
                + number(2.0) * curvature * (s - middle);
            power.intersection(centred).unwrap_or(power)
        } else {
            c1 + number(2.0) * c2 * s
        };
        let highest = if curved { c2 * square + c3 * square * s } else { c2 * square };
        let power = c0 + c1 * s + highest;
        let inner = if curved { c2 + middle * c3 } else { c2 };
        let centred = c0 + middle * (c1 + middle * inner) + slope * (s - middle);
        let value = power.intersection(centred).unwrap_or(power);
        [value, slope, curvature]
    }

    /// Time from `time` until |x − q| = ΔQ (eq. 3.6), infinite if never.
    #[inline]
    pub(super) fn band_delay(&self, time: f64) -> f64 {
        let (x, q) = (self.x_from(time), self.q_from(time));
        if X > 3 {
            let mut d = Jet::default();
            d[..X].copy_from_slice(&x);
            for (d, q) in d.iter_mut().zip(q) {
                *d -= q;
            }
            return cubic_leaves(d, self.quantum);
        }
        self.parabola_leaves(x[0] - q[0], x[1] - q[1], x[2])
    }

    /// Delay until the parabola x − q leaves the band.
    ///
    /// Only the edge that it can reach first is solved for, in the form of the root that does not cancel.
    #[inline]
    fn parabola_leaves(&self, d0: f64, d1: f64, d2: f64) -> f64 {
        // Mirrored so that the parabola opens upwards and ends at the upper edge.
        let side = if d2 < 0.0 || (d2 == 0.0 && d1 < 0.0) { -1.0 } else { 1.0 };
        let (d0, d1, d2) = (side * d0, side * d1, side * d2);
        let (up, down) = (self.quantum - d0, self.quantum + d0);
        if up <= 0.0 || down <= 0.0 {
            return 0.0;
        }
        if d2 == 0.0 {
            return if d1 > 0.0 { up / d1 } else { f64::INFINITY };
        }
        // What is chosen rather than branched to costs nothing: signs of curvatures cannot be foreseen.
        let square = d1 * d1;
        let low = square - 4.0 * d2 * down;
        let falls = d1 < 0.0;
        let leaves_below = falls && low >= 0.0;
        let root = (if leaves_below { low } else { square + 4.0 * d2 * up }).sqrt() + d1.abs();
        let edge = if leaves_below { down } else { up };
        let (above, below) = if falls && !leaves_below { (root, 2.0 * d2) } else { (2.0 * edge, root) };
        above / below
    }
}

/// Σ cₖ·sᵏ.
#[inline]
fn horner<const N: usize>(c: &[f64; N], s: f64) -> f64 {
    let mut sum = c[N - 1];
    for k in (0..N - 1).rev() {
        sum = c[k] + s * sum;
    }
    sum
}

/// Coefficients about a point moved by s.
#[inline]
fn moved<const N: usize>(c: &[f64; N], s: f64) -> [f64; N] {
    let mut moved = *c;
    moved[0] = horner(c, s);
    match N {
        2 | 3 => moved[1] = if N == 2 { c[1] } else { c[1] + 2.0 * s * c[2] },
        _ => {
            moved[1] = c[1] + s * (2.0 * c[2] + s * (3.0 * c[3]));
            moved[2] = c[2] + s * (3.0 * c[3]);
        }
    }
    moved
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        /// The delay is the first time at which |x − q| reaches the quantum, by dense search.
        #[test]
        fn the_band_is_left_when_predicted(
            d0 in -0.99f64..0.99, d1 in -5.0f64..5.0, d2 in prop_oneof![Just(0.0), -5.0f64..5.0]
        ) {
            let record = Record::<2, 3> { x: [d0, d1, d2], tx: 0.0, q: [0.0, 0.0], tq: 0.0, quantum: 1.0 };
            let delay = record.band_delay(0.0);
            let d = |s: f64| (d0 + s * (d1 + s * d2)).abs();
            if delay.is_finite() {
                prop_assert!((d(delay) - 1.0).abs() < 1e-9 * (1.0 + delay * d1.abs() + delay * delay * d2.abs()));
            }
            let end = delay.min(50.0);
            for k in 0..2000 {
                let s = end * f64::from(k) / 2000.0;
                prop_assert!(d(s) < 1.0 + 1e-9, "left the band at {s}, predicted {delay}");
            }
        }
    }
}
