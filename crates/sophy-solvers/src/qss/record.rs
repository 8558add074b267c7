//! A record of memory as this engine keeps it: x, its start, q, its start, and the quantum.

use sophy_field::{Jet, RecordLayout};
use sophy_segment::{cube_reach, cubic_leaves};

/// What stands where in the records of an order.
pub(super) struct Place<const ORDER: usize>;

impl<const ORDER: usize> Place<ORDER> {
    const LAYOUT: RecordLayout = RecordLayout::of_order(ORDER as u32);
    /// Cache lines per record.
    pub(super) const LINES: usize = Self::LAYOUT.stride as usize / 8;
    /// Coefficients of x, which come first.
    pub(super) const X: usize = Self::LAYOUT.integrated as usize;
    /// Start of x, s.
    pub(super) const TX: usize = Self::X;
    /// First coefficient of q.
    pub(super) const Q: usize = Self::LAYOUT.quantised_at() as usize;
    /// Coefficients of q.
    pub(super) const QS: usize = Self::LAYOUT.quantised as usize;
    /// Start of q, s.
    pub(super) const TQ: usize = Self::Q + Self::QS;
    /// Present quantum ΔQ; infinite for inputs and time.
    pub(super) const QUANTUM: usize = Self::LAYOUT.own_at() as usize;
}

/// A source's record, to be read.
///
/// x(t) = Σ xₖ·sᵏ, s = t − tx; q(t) = Σ qₖ·sᵏ, s = t − tq. Inputs and time have q = x.
#[derive(Clone, Copy, Debug)]
pub(super) struct Record<'a, const ORDER: usize>(pub(super) &'a [f64]);

impl<const ORDER: usize> Record<'_, ORDER> {
    #[inline]
    pub(super) fn quantum(self) -> f64 {
        self.0[Place::<ORDER>::QUANTUM]
    }

    /// Start of x, s.
    #[inline]
    pub(super) fn tx(self) -> f64 {
        self.0[Place::<ORDER>::TX]
    }

    /// Start of q, s.
    #[inline]
    pub(super) fn tq(self) -> f64 {
        self.0[Place::<ORDER>::TQ]
    }

    /// Coefficients of q at its start.
    #[inline]
    pub(super) fn q(self) -> [f64; 3] {
        let q = &self.0[Place::<ORDER>::Q..];
        [q[0], q[1], if Place::<ORDER>::QS > 2 { q[2] } else { 0.0 }]
    }

    /// Coefficients of x at its start.
    #[inline]
    pub(super) fn x(self) -> Jet {
        [self.0[0], self.0[1], self.0[2], if Place::<ORDER>::X > 3 { self.0[3] } else { 0.0 }]
    }

    /// x at `time`.
    #[inline]
    pub(super) fn x_at(self, time: f64) -> f64 {
        let [x0, x1, x2, x3] = self.x();
        let s = time - self.tx();
        if Place::<ORDER>::X > 3 { x0 + s * (x1 + s * (x2 + s * x3)) } else { x0 + s * (x1 + s * x2) }
    }

    /// Taylor coefficients of x at `time`.
    #[inline]
    pub(super) fn x_from(self, time: f64) -> Jet {
        let [_, x1, x2, x3] = self.x();
        let (value, s) = (self.x_at(time), time - self.tx());
        if Place::<ORDER>::X > 3 {
            [value, x1 + s * (2.0 * x2 + s * (3.0 * x3)), x2 + s * (3.0 * x3), x3]
        } else {
            [value, x1 + 2.0 * s * x2, x2, 0.0]
        }
    }

    /// q at `time`.
    #[inline]
    pub(super) fn q_at(self, time: f64) -> f64 {
        let [q0, q1, q2] = self.q();
        let s = time - self.tq();
        if Place::<ORDER>::QS > 2 { q0 + s * (q1 + s * q2) } else { q0 + s * q1 }
    }

    /// Taylor coefficients of q at `time`.
    #[inline]
    pub(super) fn q_from(self, time: f64) -> [f64; 3] {
        let [_, q1, q2] = self.q();
        let slope = if Place::<ORDER>::QS > 2 { q1 + 2.0 * (time - self.tq()) * q2 } else { q1 };
        [self.q_at(time), slope, q2]
    }

    /// Time from `time` until |x − q| = ΔQ (eq. 3.6), infinite if never.
    #[inline]
    pub(super) fn band_delay(self, time: f64) -> f64 {
        leaves::<ORDER>(self.x_from(time), self.q_from(time), self.quantum())
    }
}

/// A source's record, to be written.
#[derive(Debug)]
pub(super) struct RecordMut<'a, const ORDER: usize>(pub(super) &'a mut [f64]);

impl<const ORDER: usize> RecordMut<'_, ORDER> {
    #[inline]
    pub(super) fn as_read(&self) -> Record<'_, ORDER> {
        Record(self.0)
    }

    /// x follows these coefficients from `time` on.
    #[inline]
    pub(super) fn set_x(&mut self, jet: Jet, time: f64) {
        for (k, c) in jet.into_iter().enumerate().take(Place::<ORDER>::X) {
            self.0[k] = c;
        }
        self.0[Place::<ORDER>::TX] = time;
    }

    /// q follows these coefficients from `time` on.
    #[inline]
    pub(super) fn set_q(&mut self, q: [f64; 3], time: f64) {
        for (k, c) in q.into_iter().enumerate().take(Place::<ORDER>::QS) {
            self.0[Place::<ORDER>::Q + k] = c;
        }
        self.0[Place::<ORDER>::TQ] = time;
    }

    #[inline]
    pub(super) fn set_quantum(&mut self, quantum: f64) {
        self.0[Place::<ORDER>::QUANTUM] = quantum;
    }

    /// A source that follows `value + slope·(t − time)` exactly.
    pub(super) fn set_line(&mut self, value: f64, slope: f64, time: f64) {
        self.set_x([value, slope, 0.0, 0.0], time);
        self.set_q([value, slope, 0.0], time);
        self.set_quantum(f64::INFINITY);
    }
}

/// Delay until |x − q|, given by their coefficients, reaches the quantum (eq. 3.6), infinite if never.
#[inline]
pub(super) fn leaves<const ORDER: usize>([x0, x1, x2, x3]: Jet, [q0, q1, q2]: [f64; 3], quantum: f64) -> f64 {
    if Place::<ORDER>::X > 3 {
        return cubic_leaves([x0 - q0, x1 - q1, x2 - q2, x3], quantum);
    }
    parabola_leaves([x0 - q0, x1 - q1, x2], quantum)
}

/// That delay where q has just taken all coefficients of x but the highest.
#[inline]
pub(super) fn leaves_from_middle<const ORDER: usize>([_, x1, x2, x3]: Jet, quantum: f64) -> f64 {
    match ORDER {
        1 => quantum / x1.abs(),
        2 => 2.0 * quantum / (4.0 * x2.abs() * quantum).sqrt(),
        _ => cube_reach(x3, quantum),
    }
}

/// Delay until |d₀ + d₁s + d₂s²| reaches the quantum.
///
/// Only the edge that it can reach first is solved for, in the form of the root that does not cancel. No delay is given
/// where a coefficient is not finite: it is 0 or not a number.
#[inline]
fn parabola_leaves([d0, d1, d2]: [f64; 3], quantum: f64) -> f64 {
    // Mirrored so that the parabola opens upwards and ends at the upper edge.
    let side = if d2 < 0.0 || (d2 == 0.0 && d1 < 0.0) { -1.0 } else { 1.0 };
    let (d0, d1, d2) = (side * d0, side * d1, side * d2);
    let (up, down) = (quantum - d0, quantum + d0);
    let is_inside = up > 0.0 && down > 0.0;
    if !is_inside {
        return 0.0;
    }
    if d2 == 0.0 {
        return if d1 == 0.0 { f64::INFINITY } else { up / d1 };
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

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn there_is_no_delay_of_what_is_not_finite(
            numbers in prop::array::uniform3(prop_oneof![Just(0.0), -5.0f64..5.0, Just(1e300), Just(-1e-300)]),
            which in 0..3_usize,
            odd in prop::sample::select(vec![f64::NAN, f64::INFINITY, f64::NEG_INFINITY]),
        ) {
            let mut d = numbers;
            d[which] = odd;
            let delay = parabola_leaves(d, 1.0);
            prop_assert!(delay.is_nan() || delay == 0.0, "{d:?}");
        }

        /// The delay is the first time at which |x − q| reaches the quantum, by dense search.
        #[test]
        fn the_band_is_left_when_predicted(
            d0 in -0.99f64..0.99, d1 in -5.0f64..5.0, d2 in prop_oneof![Just(0.0), -5.0f64..5.0]
        ) {
            let record = [d0, d1, d2, 0.0, 0.0, 0.0, 0.0, 1.0];
            let delay = Record::<2>(&record).band_delay(0.0);
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
