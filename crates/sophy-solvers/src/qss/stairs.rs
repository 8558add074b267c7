//! Stairs: the whole number below a quantity, or the piece of a table that it is in. Two watches move with it.

use super::engine::Qss;
use sophy_field::{Equations, Fault, WatchIndex};
use sophy_segment::Sign;

impl<const ORDER: usize, const IMPLICIT: bool> Qss<ORDER, IMPLICIT> {
    /// A stair is stepped when its lower watch is negative or its upper one is not; whether it was.
    pub(super) fn step_stair(
        &mut self,
        e: &Equations,
        watch: WatchIndex,
        sign: Sign,
        located: bool,
        t: f64,
    ) -> Result<bool, Fault> {
        let (watched, copy) = e.watch(watch);
        let Some((stair, step)) = watched.stair else { return Ok(false) };
        let stair = stair.of(copy);
        let code = &e.stairs[stair as usize];
        let inside = if step < 0.0 { sign != Sign::Negative } else { sign == Sign::Negative };
        if inside {
            if step < 0.0 && !code.knots.is_empty() {
                // On the last knot of a table this sign says whether it is left: see `beyond`.
                self.mark(code.watches[1]);
            }
            return Ok(false);
        }
        let at = e.layout.stairs + stair;
        let now = self.memory[at as usize];
        let Some(edge) = code.edge(&self.memory, if step < 0.0 { now } else { now + 1.0 }) else {
            return Ok(false);
        };
        let argument = self.value_of(e, (&watched.left, copy), t, 1)[0];
        // On the edge, located or to rounding: the next one. Thrown further by a jump: where it is.
        let on_edge = located || (argument - edge).abs() <= 4.0 * (edge.abs().next_up() - edge.abs());
        let next = if on_edge { now + step } else { code.step(&self.memory, argument) };
        self.set_scalar(e, at, next);
        for other in code.watches {
            let index = other.position();
            if self.watches[index].armed > 0 {
                self.mark(other);
                if self.beyond(e, other).is_some() {
                    continue;
                }
                let raw = self.raw_difference(e, other, t)?[0];
                let takes_over = on_edge && other != watch;
                self.watches[index].bias = if takes_over { raw } else { 0.0 };
                let c = self.difference(e, other, t)?;
                self.watches[index].sign = self.sign_after(e, other, t, &c)?;
            }
        }
        Ok(true)
    }

    /// For the watch of a table's stair that has no edge on its side: whether the argument is outside of the range.
    ///
    /// The range includes both ends, so that on the last knot the sign of the lower watch tells staying from leaving.
    pub(super) fn beyond(&self, e: &Equations, watch: WatchIndex) -> Option<bool> {
        let (watched, copy) = e.watch(watch);
        let (stair, step) = watched.stair.map(|(stair, step)| (stair.of(copy), step))?;
        let code = &e.stairs[stair as usize];
        let now = self.memory[(e.layout.stairs + stair) as usize];
        let edge = if step < 0.0 { now } else { now + 1.0 };
        if code.edge(&self.memory, edge).is_some() {
            return None;
        }
        let ends = edge >= code.knots.len() as f64;
        Some(step < 0.0 || ends && self.watches[code.watches[0].position()].sign == Sign::Positive)
    }

    /// The instant at which a table was left is over.
    pub(super) fn outside(&mut self, e: &Equations, watch: WatchIndex, t: f64) -> Result<(), Fault> {
        if self.beyond(e, watch) != Some(true) {
            return self.predict(e, watch, t);
        }
        let time = t.next_down();
        let (code, copy) = e.watch(watch);
        let value = self.value_of(e, (&code.left, copy), time, 1)[0];
        Err(Fault::OutsideTable { watch, time, value })
    }
}
