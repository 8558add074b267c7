use sophy_segment::Interval;

/// A source (state, input or time) in one cache line.
///
/// x(t) = x + ẋ·s + ½ẍ·s², s = t − tx; q(t) = q + q̇·(t − tq). Inputs and time have q = x.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(align(64))]
pub(super) struct Record {
    /// x, ẋ, ½ẍ at `tx`.
    pub(super) x: [f64; 3],
    /// Start of x, s.
    pub(super) tx: f64,
    /// q, q̇ at `tq`.
    pub(super) q: [f64; 2],
    /// Start of q, s.
    pub(super) tq: f64,
    /// Present quantum ΔQ.
    pub(super) quantum: f64,
}

impl Record {
    /// A source that follows `value + slope·(t − time)` exactly.
    pub(super) fn line(value: f64, slope: f64, time: f64) -> Self {
        Record { x: [value, slope, 0.0], tx: time, q: [value, slope], tq: time, quantum: f64::INFINITY }
    }

    /// x at `time`.
    #[inline]
    pub(super) fn x_at(&self, time: f64) -> f64 {
        let s = time - self.tx;
        self.x[0] + s * (self.x[1] + s * self.x[2])
    }

    /// ẋ at `time`.
    #[inline]
    pub(super) fn slope_at(&self, time: f64) -> f64 {
        let s = time - self.tx;
        self.x[1] + 2.0 * s * self.x[2]
    }

    /// Taylor coefficients of x at `time`.
    #[inline]
    pub(super) fn jet_at(&self, time: f64) -> [f64; 3] {
        [self.x_at(time), self.slope_at(time), self.x[2]]
    }

    /// q at `time`.
    #[inline]
    pub(super) fn q_at(&self, time: f64) -> f64 {
        self.q[0] + self.q[1] * (time - self.tq)
    }

    /// Enclosures of the Taylor coefficients of x over `times`.
    pub(super) fn enclose(&self, times: Interval) -> [Interval; 3] {
        let [c0, c1, c2] = self.x.map(Interval::point);
        let s = times - Interval::point(self.tx);
        let slope = c1 + Interval::point(2.0) * c2 * s;
        // The mean-value form is the tighter one on short spans, the power form keeps exact points.
        let middle = Interval::point(s.midpoint());
        let power = c0 + c1 * s + c2 * s.square();
        let centred = c0 + middle * (c1 + middle * c2) + slope * (s - middle);
        let value = power.intersection(centred).unwrap_or(power);
        [value, slope, c2]
    }

    /// Time from `time` until |x − q| = ΔQ (eq. 3.6), infinite if never.
    ///
    /// Only the band edge that the parabola x − q can reach first is solved for, in the form of the root that
    /// does not cancel.
    #[inline]
    pub(super) fn band_delay(&self, time: f64) -> f64 {
        let d0 = self.x_at(time) - self.q_at(time);
        let d1 = self.slope_at(time) - self.q[1];
        let d2 = self.x[2];
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
            let record = Record { x: [d0, d1, d2], tx: 0.0, q: [0.0, 0.0], tq: 0.0, quantum: 1.0 };
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
