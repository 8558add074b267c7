//! Enclosures of a function's Taylor coefficients g, g′, g″/2 over an interval of time.

use std::ops::{Add, Mul, Neg, Sub};

use sophy_segment::Interval;

#[derive(Clone, Copy, Debug)]
pub(crate) struct Jet(pub(crate) [Interval; 3]);

impl Jet {
    pub(crate) fn variable(t: Interval) -> Jet {
        Jet([t, Interval::point(1.0), Interval::ZERO])
    }

    pub(crate) fn constant(c: f64) -> Jet {
        Jet([Interval::point(c), Interval::ZERO, Interval::ZERO])
    }

    pub(crate) fn square(self) -> Jet {
        let [g0, g1, g2] = self.0;
        let two = Interval::point(2.0);
        Jet([g0.square(), two * g0 * g1, two * g0 * g2 + g1.square()])
    }

    pub(crate) fn sin(self) -> Jet {
        let (sin, cos) = (self.0[0].sin(), self.0[0].cos());
        self.compose([sin, cos, -sin])
    }

    pub(crate) fn cos(self) -> Jet {
        let (sin, cos) = (self.0[0].sin(), self.0[0].cos());
        self.compose([cos, -sin, -cos])
    }

    pub(crate) fn exp(self) -> Jet {
        self.compose([self.0[0].exp(); 3])
    }

    /// f ∘ g from f, f′, f″ at g: (f ∘ g)″/2 = f′ g″/2 + f″ g′²/2.
    fn compose(self, [f, df, ddf]: [Interval; 3]) -> Jet {
        let [_, g1, g2] = self.0;
        Jet([f, df * g1, df * g2 + Interval::point(0.5) * ddf * g1.square()])
    }
}

impl Add for Jet {
    type Output = Jet;
    fn add(self, other: Jet) -> Jet {
        let ([a0, a1, a2], [b0, b1, b2]) = (self.0, other.0);
        Jet([a0 + b0, a1 + b1, a2 + b2])
    }
}

impl Neg for Jet {
    type Output = Jet;
    fn neg(self) -> Jet {
        Jet(self.0.map(|g| -g))
    }
}

impl Sub for Jet {
    type Output = Jet;
    fn sub(self, other: Jet) -> Jet {
        self + -other
    }
}

impl Mul for Jet {
    type Output = Jet;
    fn mul(self, other: Jet) -> Jet {
        let ([a0, a1, a2], [b0, b1, b2]) = (self.0, other.0);
        Jet([a0 * b0, a0 * b1 + a1 * b0, a0 * b2 + a1 * b1 + a2 * b0])
    }
}
