//! Crossings that implicit quantisation makes up.
//!
//! LIQSS puts q where a stiff state comes to rest and leaves x up to a quantum beside it, with a rate along q: x may drift
//! over a surface that the motion would never reach, because it pulls x back a thousand times as fast. Before such a
//! crossing is believed, the watched difference is asked where it goes with the rates at x itself; if it turns back, the
//! states it reads begin anew at x.

use super::engine::Qss;
use sophy_field::{Equations, Fault, Journal, WatchIndex, sources_of};
use sophy_segment::Sign;

impl<const ORDER: usize, const IMPLICIT: bool> Qss<ORDER, IMPLICIT> {
    /// Whether a watch that is about to lose its sign at `t` would keep it, had its states the rates that belong to
    /// their places. It is asked once at an instant.
    pub(super) fn turns_back(&mut self, e: &Equations, watch: WatchIndex, t: f64) -> Result<bool, Fault> {
        let record = &mut self.watches[watch.position()];
        let sign = record.sign;
        if record.was_doubted_at(t) || sign == Sign::Zero {
            return Ok(false);
        }
        let (code, copy) = e.watch(watch);
        let mut kept = std::mem::take(&mut self.doubting);
        let mut stiff = false;
        for source in sources_of(&code.formula.reads, copy) {
            let i = source.position();
            if i >= self.ahead.len() {
                continue;
            }
            let linear = self.linear(e, i, t);
            let record = self.record(i);
            let (x, start, [now, mut slope, ..]) = (record.x(), record.tx(), record.x_from(t));
            if is_hidden(linear.a, t - record.tq()) {
                slope = linear.a * now + linear.u[0];
                stiff = true;
            }
            kept.push((i, x, start));
            self.record_mut(i).set_x([now, slope, 0.0, 0.0], t);
        }
        let difference = self.raw_difference(e, watch, t);
        for (i, x, start) in kept.drain(..) {
            self.record_mut(i).set_x(x, start);
        }
        self.doubting = kept;
        let slope = difference?[1];
        Ok(stiff && if sign == Sign::Positive { slope > 0.0 } else { slope < 0.0 })
    }

    /// The states a watch reads begin anew at x; the watch stays on the surface with its sign.
    pub(super) fn begin_at_x(
        &mut self,
        e: &Equations,
        watch: WatchIndex,
        t: f64,
        journal: &mut Journal,
    ) -> Result<(), Fault> {
        self.step_sources_from_x(e, watch, t, journal)?;
        let residue = self.difference(e, watch, t)?[0];
        self.watches[watch.position()].bias += residue;
        self.predict(e, watch, t)
    }

    /// Whether a watch on the surface cannot be decided by the rates there are, because they hide those at x.
    pub(super) fn reads_hidden_rates(&mut self, e: &Equations, watch: WatchIndex, t: f64) -> bool {
        let (code, copy) = e.watch(watch);
        sources_of(&code.formula.reads, copy).any(|source| {
            let i = source.position();
            i < self.ahead.len() && is_hidden(self.linear(e, i, t).a, t - self.record(i).tq())
        })
    }

    /// The states a watch reads begin anew at x, with its rates.
    pub(super) fn step_sources_from_x(
        &mut self,
        e: &Equations,
        watch: WatchIndex,
        t: f64,
        journal: &mut Journal,
    ) -> Result<(), Fault> {
        let (code, copy) = e.watch(watch);
        for source in sources_of(&code.formula.reads, copy) {
            if source.position() < self.ahead.len() {
                self.step_from_x(e, source.position(), t, journal).map_err(|failed| self.why(failed))?;
            }
        }
        Ok(())
    }
}

/// Whether a state would have come to rest long since its last step, so that its rate along q is not the one at x.
fn is_hidden(a: f64, since: f64) -> bool {
    -a * since > 1.0
}
