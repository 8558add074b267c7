//! Rates that bend: what their segments leave out is bounded by evaluating them again.

use super::engine::Qss;
use sophy_field::{Block, Jet, SourceIndex, sources_of};
use sophy_segment::{cube_root, cubic_leaves};

/// What a rate does that its segment leaves out.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bend {
    /// A quantum over the coefficient of what is left out: QSS1 leaves out ∫ḟs = ḟ·s²/2, QSS2 ∫½f̈s² = ½f̈·s³/3, QSS3
    /// the like of the fourth order. Infinite where nothing is left out.
    room: f64,
    /// How long it is trusted at most, s.
    trust: f64,
    /// Since when the rate was evaluated only because it bends, s.
    coasting: f64,
    /// Whether the rate bends at all; then it is trusted for a bounded time even if its room is infinite.
    pub(super) bends: bool,
    /// Whether the agenda's time is that of evaluating the rate again, not the edge of the band.
    pub(super) due: bool,
}

pub(super) const STRAIGHT: Bend =
    Bend { room: f64::INFINITY, bends: false, trust: f64::INFINITY, coasting: f64::NEG_INFINITY, due: false };

impl Bend {
    /// How long a rate evaluated at `t` may be trusted, exactly if that is less than `enough`: until what its
    /// segment leaves out has moved x by a quantum.
    ///
    /// A rate that coasts for τ, evaluated again and again without any change of a quantised variable, is
    /// allowed only s/τ of a quantum per evaluation, so that what adds up stays of the order of the quantum
    /// and the error converges with it at first order, as that of the method does.
    #[inline]
    pub(super) fn trusted_for<const ORDER: usize>(self, t: f64, enough: f64) -> f64 {
        let Bend { room, coasting, trust, .. } = self;
        let coasted = t - coasting;
        // Roots cost more than the question whether they matter.
        let power = match ORDER {
            1 => enough,
            2 => enough * enough,
            _ => enough * enough * enough,
        };
        if room >= power * enough && room >= power * coasted {
            return trust;
        }
        let (alone, shared) = match ORDER {
            1 => (room.sqrt(), room / coasted),
            2 => (cube_root(room), (room / coasted).sqrt()),
            _ => (room.sqrt().sqrt(), cube_root(room / coasted)),
        };
        alone.min(shared).min(trust)
    }
}

impl<const ORDER: usize, const IMPLICIT: bool> Qss<ORDER, IMPLICIT> {
    /// The rate of a state, just evaluated, bends.
    #[inline]
    pub(super) fn bend(&mut self, i: usize, t: f64, [_, f1, f2, f3]: Jet) {
        let quantum = self.record(i).quantum();
        let trust = self.settings.trust.max(self.still);
        let coasts = self.refreshed == i;
        let Some(bend) = self.bend_of(i) else { return };
        bend.bends = true;
        bend.trust = trust;
        // Evaluated only because it bends it coasts on; anything else ends the coasting.
        if !coasts {
            bend.coasting = t;
        }
        let left_out = match ORDER {
            1 => f1 / 2.0,
            2 => f2 / 3.0,
            _ => f3 / 4.0,
        };
        bend.room = quantum / left_out.abs();
    }

    /// How long, s, no source of a block moves by a quantum: until then its rates are those of the present place, as
    /// far as they are known at all.
    pub(super) fn still_for(&self, block: &Block, copy: u32) -> f64 {
        let still = |source: SourceIndex| {
            let record = self.record(source.position());
            let ([_, q1, q2], quantum) = (record.q(), record.quantum());
            match (q1 == 0.0 && q2 == 0.0, quantum.is_finite()) {
                (true, _) => f64::INFINITY,
                // Inputs and time have no quantum.
                (false, false) => 0.0,
                (false, true) if q2 == 0.0 => quantum / q1.abs(),
                (false, true) => cubic_leaves([0.0, q1, q2, 0.0], quantum),
            }
        };
        sources_of(&block.reads, copy).map(still).fold(f64::INFINITY, f64::min)
    }
}
