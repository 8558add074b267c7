/// One state of QSS2: x(t) = x₀ + x₁ s + x₂ s², s = t − tx, and q(t) = q₀ + q₁ (t − tq).
#[derive(Clone, Copy, Debug)]
#[repr(align(64))]
pub(crate) struct State {
    pub(crate) x: [f64; 3],
    pub(crate) tx: f64,
    pub(crate) q: [f64; 2],
    pub(crate) tq: f64,
}

impl State {
    pub(crate) fn at(x: f64) -> Self {
        State { x: [x, 0.0, 0.0], tx: 0.0, q: [x, 0.0], tq: 0.0 }
    }

    #[inline]
    pub(crate) fn x_at(&self, t: f64) -> f64 {
        let s = t - self.tx;
        self.x[0] + s * (self.x[1] + s * self.x[2])
    }

    #[inline]
    pub(crate) fn slope_at(&self, t: f64) -> f64 {
        let s = t - self.tx;
        self.x[1] + 2.0 * s * self.x[2]
    }

    #[inline]
    pub(crate) fn jet_at(&self, t: f64) -> [f64; 3] {
        [self.x_at(t), self.slope_at(t), self.x[2]]
    }

    #[inline]
    pub(crate) fn q_at(&self, t: f64) -> f64 {
        self.q[0] + self.q[1] * (t - self.tq)
    }

    /// q takes value and slope of x.
    #[inline]
    pub(crate) fn quantise(&mut self, t: f64) {
        self.q = [self.x_at(t), self.slope_at(t)];
        self.tq = t;
    }

    /// x is set from outside.
    #[inline]
    pub(crate) fn set(&mut self, x: f64, t: f64) {
        self.x = [x, 0.0, 0.0];
        self.tx = t;
    }

    /// q starts on x with a slope that comes later.
    #[inline]
    pub(crate) fn synchronise(&mut self, t: f64) {
        self.q = [self.x_at(t), 0.0];
        self.tq = t;
    }

    /// A new rate and its derivative arrive.
    #[inline]
    pub(crate) fn rate(&mut self, t: f64, f: f64, f1: f64) {
        self.x = [self.x_at(t), f, 0.5 * f1];
        self.tx = t;
    }

    /// Time until |x − q| reaches `quantum`.
    #[inline]
    pub(crate) fn band_delay(&self, t: f64, quantum: f64) -> f64 {
        let d0 = self.x_at(t) - self.q_at(t);
        let d1 = self.slope_at(t) - self.q[1];
        let d2 = self.x[2];
        let side = if d2 < 0.0 || (d2 == 0.0 && d1 < 0.0) { -1.0 } else { 1.0 };
        let (d0, d1, d2) = (side * d0, side * d1, side * d2);
        let (up, down) = (quantum - d0, quantum + d0);
        if up <= 0.0 || down <= 0.0 {
            return 0.0;
        }
        if d2 == 0.0 {
            return if d1 > 0.0 { up / d1 } else { f64::INFINITY };
        }
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
