//! Trigonometric functions and their inverses.

use std::f64::consts::{FRAC_2_PI, PI};

use super::Interval;
use super::elementary::{image, increasing, widened};

/// Beyond this argument the quadrant is no longer known from one product; the range is the answer.
const QUADRANT_LIMIT: f64 = 35_184_372_088_832.0; // 2^45

impl Interval {
    /// The sine; [−1, 1] for arguments beyond 2^45.
    #[must_use]
    pub fn sin(self) -> Interval {
        self.wave(libm::sin, 1.0)
    }

    /// The cosine; [−1, 1] for arguments beyond 2^45.
    #[must_use]
    pub fn cos(self) -> Interval {
        self.wave(libm::cos, 0.0)
    }

    /// The tangent; the whole line if a pole may be inside.
    #[must_use]
    pub fn tan(self) -> Interval {
        match self.quadrants() {
            // poles at odd quarter turns
            Some(q) if !meets(q, 1.0, 2.0) => increasing(libm::tan, self),
            _ => Interval::ENTIRE,
        }
    }

    /// The inverse sine, defined on [−1, 1].
    #[must_use]
    pub fn asin(self) -> Interval {
        self.on_domain(-1.0, 1.0, |x| increasing(libm::asin, x))
    }

    /// The inverse cosine, defined on [−1, 1].
    #[must_use]
    pub fn acos(self) -> Interval {
        self.on_domain(-1.0, 1.0, |x| Interval {
            lo: image(libm::acos, x.hi).lo.max(0.0),
            hi: image(libm::acos, x.lo).hi,
        })
    }

    /// The inverse tangent.
    #[must_use]
    pub fn atan(self) -> Interval {
        increasing(libm::atan, self)
    }

    /// The angle of the vector (x, y) with y = `self`, in [−π, π]; both signs of π on the negative x axis.
    #[must_use]
    pub fn atan2(self, x: Interval) -> Interval {
        let y = self;
        if y.contains_zero() && x.lo <= 0.0 {
            let half_turn = PI.next_up();
            return Interval { lo: -half_turn, hi: half_turn };
        }
        // Seen from outside, a box is widest at its corners. The ray y = 0, x > 0 keeps its exact 0.
        let corner = |y: f64, x: f64| if y == 0.0 { Interval::ZERO } else { widened(libm::atan2(y, x)) };
        (corner(y.lo, x.lo).hull(corner(y.lo, x.hi))).hull(corner(y.hi, x.lo).hull(corner(y.hi, x.hi)))
    }

    /// A wave with maxima at quarter turns `crest + 4k`, minima half a period later, and monotone between.
    fn wave(self, f: fn(f64) -> f64, crest: f64) -> Interval {
        let Some(q) = self.quadrants() else {
            return Interval { lo: -1.0, hi: 1.0 };
        };
        let ends = image(f, self.lo).hull(image(f, self.hi));
        Interval {
            lo: if meets(q, crest + 2.0, 4.0) { -1.0 } else { ends.lo.max(-1.0) },
            hi: if meets(q, crest, 4.0) { 1.0 } else { ends.hi.min(1.0) },
        }
    }

    /// The argument counted in quarter turns, unless it is too large to tell.
    fn quadrants(self) -> Option<Interval> {
        let per_radian = Interval { lo: FRAC_2_PI.next_down(), hi: FRAC_2_PI.next_up() };
        (self.magnitude() <= QUADRANT_LIMIT).then(|| self * per_radian)
    }
}

/// Whether `x` contains a number `first + k period`.
fn meets(x: Interval, first: f64, period: f64) -> bool {
    // Rounding is monotone and keeps the candidates, so k is never too large; if it is too small, the
    // extremum is only assumed, which is safe.
    let k = ((x.lo - first) / period).ceil();
    first + k * period <= x.hi
}

#[cfg(test)]
mod tests {
    use super::Interval;
    use std::f64::consts::{FRAC_PI_2, PI};

    fn i(lo: f64, hi: f64) -> Interval {
        Interval { lo, hi }
    }

    #[test]
    fn crests_and_troughs() {
        assert_eq!(i(1.0, 2.0).sin().hi, 1.0);
        assert!(i(1.0, 1.5).sin().hi < 1.0);
        assert_eq!(i(-2.0, 2.0).sin(), i(-1.0, 1.0));
        assert_eq!(i(4.0, 5.0).sin().lo, -1.0);
        assert_eq!(i(-0.1, 0.1).cos().hi, 1.0);
        assert_eq!(i(3.0, 3.2).cos().lo, -1.0);
        assert!(i(0.1, 3.0).cos().lo > -1.0);
        assert_eq!(i(0.0, 7.0).cos(), i(-1.0, 1.0));
        assert_eq!(i(1000.0 * PI - 0.1, 1000.0 * PI + 0.1).cos().hi, 1.0);
        assert_eq!(i(1e18, 1e18).sin(), i(-1.0, 1.0));
    }

    #[test]
    fn zero_stays_zero() {
        for f in [Interval::sin, Interval::tan, Interval::asin, Interval::atan] {
            assert_eq!(f(Interval::ZERO), Interval::ZERO);
        }
        assert_eq!(Interval::ZERO.cos().hi, 1.0);
        assert_eq!(Interval::point(1.0).acos(), Interval::ZERO);
        assert_eq!(Interval::ZERO.atan2(i(1.0, 2.0)), Interval::ZERO);
    }

    #[test]
    fn poles_of_the_tangent() {
        assert!(i(-1.5, 1.5).tan().is_finite());
        assert_eq!(i(1.5, 1.6).tan(), Interval::ENTIRE);
        assert_eq!(Interval::point(FRAC_PI_2).tan(), Interval::ENTIRE);
        assert!(i(2.0, 4.0).tan().is_finite());
    }

    #[test]
    fn the_cut_of_the_angle() {
        assert!(i(-1.0, 1.0).atan2(i(-2.0, -1.0)).contains(PI));
        assert!(i(-1.0, 1.0).atan2(i(-2.0, -1.0)).contains(-PI));
        let upper = i(1.0, 2.0).atan2(i(-2.0, 2.0));
        assert!(upper.lo > 0.4 && upper.hi < 2.7);
        assert!(i(-1.0, 1.0).atan2(i(1.0, 2.0)).magnitude() < 0.8);
    }
}
