//! Watches: the first sign change of a guard's or switch's quantity, located on x.

use super::engine::Qss;
use super::steps::MOST_REPEATS;
use sophy_field::{
    Enclosing, Equations, Fault, Formula, Jet, Journal, NOW, Record, SourceIndex, WatchIndex, sign_bit,
    sources_of, turns_of,
};
use sophy_segment::{Interval, Search, Sign, Start, cubic_crossing, first_crossing, parabola_crossing};
use std::cmp::Reverse;

/// What is known of a watch.
///
/// **Truth at zero.** The sign is that just right of the present instant. `bias` makes "the surface just
/// located *is* zero" last: it is the residue of rounding that the watched difference had when it was located,
/// and is taken off from then on. A difference within 4 ulp of its larger side, on entry or after a reset, is
/// treated likewise.
#[derive(Clone, Copy, Debug)]
pub(super) struct WatchRecord {
    /// Decided sign.
    pub(super) sign: Sign,
    /// How many active locations want it.
    pub(super) armed: u32,
    /// Waits to be looked at.
    pub(super) dirty: bool,
    /// Must be decided anew: just armed, or a state it reads was reset.
    pub(super) fresh: Fresh,
    /// What the agenda's time is: a root ahead, or a change at the joint of two segments.
    due: Due,
    /// Taken off the difference.
    pub(super) bias: f64,
    /// Where it was located on the surface, what the difference may then be beside 0.
    blur: f64,
    /// The instant, s, for which the following hold.
    instant: f64,
    /// How often its sign has changed, or what was taken for that.
    changes: u32,
    /// Whether it was located on the surface.
    located: bool,
    /// Whether a crossing of it was doubted.
    doubted: bool,
}

impl WatchRecord {
    /// What holds at `t`, s.
    fn at(&mut self, t: f64) -> &mut Self {
        if self.instant != t {
            (self.instant, self.changes, self.located, self.doubted) = (t, 0, false, false);
        }
        self
    }

    /// Counts a sign change at `t`, or what was taken for one; whether there are too many.
    fn repeats_at(&mut self, t: f64) -> bool {
        self.at(t).changes += 1;
        self.changes > MOST_REPEATS + 1
    }

    /// Whether a crossing at `t` was doubted before; from now on it was.
    pub(super) fn was_doubted_at(&mut self, t: f64) -> bool {
        std::mem::replace(&mut self.at(t).doubted, true)
    }

    /// Whether it was located at `t` and a jump since has left it on the surface.
    fn is_still_there(&self, c: &Jet, t: f64) -> bool {
        self.instant == t && self.located && c[0].abs() <= self.blur.max(blur(c, t))
    }
}

/// Why a watch must be decided anew.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Fresh {
    /// It need not.
    No,
    /// A source it reads was set: what was on the surface and did not move stays on it.
    Reset,
    /// It was not armed before.
    Armed,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Due {
    /// A root located on the present segments.
    Root,
    /// The present segments begin on the other side.
    Joint,
    /// The end of what was searched so far.
    Search,
    /// The stair of a table is outside of its range, and no instant is left to bring it back.
    Outside,
}

/// Sides that differ by no more than so many relative roundings are equal.
const EQUAL: f64 = 64.0;
/// So many parts of a window are looked at quickly if one look at all of it was not enough.
const GLANCES: u32 = 4;
/// What a quick look must leave of a difference, for its own rounding.
const SURE: f64 = 1.0 - 1e-12;
/// The least part of its window that a search must decide.
const LEAST_PROGRESS: f64 = 1e-4;

/// What a difference may be beside 0 at its root, because instants are numbers.
fn blur(c: &Jet, t: f64) -> f64 {
    2.0 * c[1].abs() * (t.abs().next_up() - t.abs())
}

impl Default for WatchRecord {
    fn default() -> Self {
        WatchRecord {
            sign: Sign::Zero,
            armed: 0,
            dirty: false,
            fresh: Fresh::No,
            due: Due::Root,
            bias: 0.0,
            blur: 0.0,
            instant: f64::NAN,
            changes: 0,
            located: false,
            doubted: false,
        }
    }
}

impl<const ORDER: usize, const IMPLICIT: bool> Qss<ORDER, IMPLICIT> {
    pub(super) fn arm(&mut self, watch: WatchIndex) {
        let record = &mut self.watches[watch.position()];
        record.armed += 1;
        if record.armed == 1 {
            record.fresh = Fresh::Armed;
            record.bias = 0.0;
            self.mark(watch);
        }
    }

    pub(super) fn disarm(&mut self, e: &Equations, watch: WatchIndex) {
        let record = &mut self.watches[watch.position()];
        record.armed -= 1;
        if record.armed == 0 {
            self.agenda.set(e.layout.states + watch.0, f64::INFINITY);
        }
    }

    /// A source was set from outside: the watches that read it are decided anew.
    pub(super) fn touch(&mut self, e: &Equations, source: SourceIndex) {
        self.decide_again(e.watches_of_source.row(source.position()).iter().copied());
    }

    /// What watches read has jumped.
    pub(super) fn decide_again(&mut self, watches: impl Iterator<Item = WatchIndex>) {
        for watch in watches {
            let record = &mut self.watches[watch.position()];
            if record.armed > 0 && record.fresh == Fresh::No {
                record.fresh = Fresh::Reset;
            }
            self.mark(watch);
        }
    }

    /// Predicts every marked watch anew; nothing was set from outside.
    pub(super) fn predict_dirty(&mut self, e: &Equations, t: f64) -> Result<(), Fault> {
        let mut position = 0;
        while let Some(&watch) = self.dirty.get(position) {
            position += 1;
            self.watches[watch.position()].dirty = false;
            if self.watches[watch.position()].armed > 0 {
                self.predict(e, watch, t)?;
            }
        }
        self.dirty.clear();
        Ok(())
    }

    /// A watch whose time has come.
    pub(super) fn watch_due(
        &mut self,
        e: &Equations,
        watch: WatchIndex,
        t: f64,
        journal: &mut Journal,
    ) -> Result<(), Fault> {
        let due = self.watches[watch.position()].due;
        if due == Due::Search {
            return self.predict(e, watch, t);
        }
        if due == Due::Outside {
            return self.outside(e, watch, t);
        }
        let c = self.difference(e, watch, t)?;
        let decided = self.watches[watch.position()].sign;
        if IMPLICIT && self.turns_back(e, watch, t)? {
            return self.begin_at_x(e, watch, t, journal);
        }
        let sign = if due == Due::Root && decided != Sign::Zero {
            // The difference is zero here, by what was located: the residue of rounding is taken off.
            let record = &mut self.watches[watch.position()];
            record.bias += c[0];
            record.at(t).located = true;
            record.blur = 2.0 * record.bias.abs() + blur(&c, t);
            decided.opposite()
        } else {
            self.sign_after(e, watch, t, &c)?
        };
        if sign == decided {
            // The search found noise of rounding about zero: the difference counts as zero, and the search
            // goes on behind it.
            let record = &mut self.watches[watch.position()];
            record.bias += c[0];
            if record.repeats_at(t) {
                return Err(Fault::Undecided { watch, time: t });
            }
            return self.predict(e, watch, t);
        }
        self.take_sign(e, watch, sign, due == Due::Root, t, journal)?;
        self.predict(e, watch, t)
    }

    /// Decides every marked watch at an instant of change, in the order of watches, until nothing changes any
    /// more: a switch that changes may change rates, and these other signs.
    pub(super) fn settle(&mut self, e: &Equations, t: f64, journal: &mut Journal) -> Result<(), Fault> {
        let mut rounds = 0;
        loop {
            self.settling.extend(self.dirty.drain(..).map(Reverse));
            let Some(Reverse(watch)) = self.settling.pop() else { break };
            let record = &mut self.watches[watch.position()];
            record.dirty = false;
            let fresh = std::mem::replace(&mut record.fresh, Fresh::No);
            if record.armed == 0 {
                continue;
            }
            if self.beyond(e, watch).is_some() {
                self.predict(e, watch, t)?;
                continue;
            }
            let mut c = match fresh {
                Fresh::No => self.difference(e, watch, t)?,
                fresh => self.difference_afresh(e, watch, t, fresh)?,
            };
            if IMPLICIT && c[0] == 0.0 && self.reads_hidden_rates(e, watch, t) {
                self.step_sources_from_x(e, watch, t, journal)?;
                c = self.difference(e, watch, t)?;
            }
            let sign = self.sign_after(e, watch, t, &c)?;
            if fresh == Fresh::Armed {
                // It has no past that it could have left.
                self.watches[watch.position()].sign = sign;
            } else if sign != self.watches[watch.position()].sign {
                rounds += 1;
                if rounds > 100 * (1 + self.watches.len()) {
                    return Err(Fault::Chattering { watch, time: t });
                }
            }
            self.take_sign(e, watch, sign, false, t, journal)?;
            self.predict(e, watch, t)?;
        }
        Ok(())
    }

    /// Truths and stairs of fresh watches by value alone, before rates are known; [`Qss::settle`] corrects
    /// them. What reads one that changes is evaluated with the change.
    pub(super) fn guess_truths(&mut self, e: &Equations, t: f64) {
        // Whoever makes a watch fresh marks it; more may be marked here, but none becomes fresh.
        self.dirty.sort_unstable();
        let marked = self.dirty.len();
        for position in 0..marked {
            let watch = self.dirty[position];
            let index = watch.position();
            let record = self.watches[index];
            if record.armed == 0 || record.fresh == Fresh::No {
                continue;
            }
            let mut changed = false;
            let (code, copy) = e.watch(watch);
            if let Some((stair, _)) = code.stair {
                let stair = stair.of(copy);
                let argument = self.value_of(e, (&code.left, copy), t, 1)[0];
                let step = e.stairs[stair as usize].step(&self.memory, argument);
                changed |= self.set_scalar(e, e.layout.stairs + stair, step);
            }
            let value = self.value_of(e, (&code.formula, copy), t, 1)[0];
            changed |= self.publish(e, watch, Sign::of(value - record.bias));
            if changed {
                self.turns.extend(turns_of(&code.on_change, copy));
                self.mark_dependents(e, watch);
            }
        }
    }

    fn mark_dependents(&mut self, e: &Equations, watch: WatchIndex) {
        let (code, copy) = e.watch(watch);
        for dependent in &code.dependents {
            self.mark(WatchIndex(dependent.of(copy)));
        }
    }

    /// The difference of a watch that was set from outside, and its bias from scratch.
    fn difference_afresh(
        &mut self,
        e: &Equations,
        watch: WatchIndex,
        t: f64,
        fresh: Fresh,
    ) -> Result<Jet, Fault> {
        let (code, copy) = e.watch(watch);
        let left = self.value_of(e, (&code.left, copy), t, 1)[0];
        let right = self.value_of(e, (&code.right, copy), t, 1)[0];
        let mut c = self.raw_difference(e, watch, t)?;
        let record = &mut self.watches[watch.position()];
        let stays = fresh == Fresh::Reset
            && (record.bias != 0.0 && c[0] == record.bias || record.is_still_there(&c, t));
        let larger = if left.abs() > right.abs() { left.abs() } else { right.abs() };
        if stays || c[0].abs() <= 4.0 * (larger.next_up() - larger) {
            record.bias = c[0];
            c[0] = 0.0;
        } else {
            record.bias = 0.0;
        }
        Ok(c)
    }

    /// The sign just right of `t`: the first coefficient that is not zero decides. Where all that the engine
    /// carries vanish, a watch that is not affine may still leave zero at a higher order: enclosures decide.
    pub(super) fn sign_after(
        &mut self,
        e: &Equations,
        watch: WatchIndex,
        t: f64,
        c: &Jet,
    ) -> Result<Sign, Fault> {
        if *c != [0.0; 4] || e.watch(watch).0.affine {
            return Ok(Sign::after(c));
        }
        let start = Start { sign: Sign::Zero, on_surface: true };
        match self.search_from(e, watch, t, t + self.settings.window, start) {
            Search::Crossing(time) => Ok(Sign::of(self.difference(e, watch, time)?[0])),
            Search::None => Ok(Sign::Zero),
            Search::Blurred(since, _) | Search::Undecided(since) if since > t => Ok(Sign::Zero),
            Search::Blurred(..) if self.are_equal(e, watch, t) => Ok(Sign::Zero),
            Search::Blurred(time, _) | Search::Undecided(time) => Err(Fault::Undecided { watch, time }),
        }
    }

    /// Whether the two sides of a watch are equal to rounding at `t`: what is lost in rounding is small beside
    /// them. Otherwise large numbers cancel in one of them, and the sign means nothing.
    fn are_equal(&mut self, e: &Equations, watch: WatchIndex, t: f64) -> bool {
        let (code, copy) = e.watch(watch);
        let left = self.value_of(e, (&code.left, copy), t, 1)[0];
        let right = self.value_of(e, (&code.right, copy), t, 1)[0];
        let noise = self.enclose(e, watch, Interval::point(t))[0].width();
        noise <= EQUAL * f64::EPSILON * left.abs().max(right.abs())
    }

    /// A watch takes a sign: if it is another one, that is noted; if truths or a stair change with it, what
    /// reads them is evaluated.
    fn take_sign(
        &mut self,
        e: &Equations,
        watch: WatchIndex,
        sign: Sign,
        located: bool,
        t: f64,
        journal: &mut Journal,
    ) -> Result<(), Fault> {
        let (code, copy) = e.watch(watch);
        let record = &mut self.watches[watch.position()];
        if record.sign != sign {
            record.sign = sign;
            if record.repeats_at(t) {
                return Err(Fault::Chattering { watch, time: t });
            }
            self.statistics.crossings += 1;
            if code.guard {
                self.changed.push(watch);
            }
            if journal.wanted && !code.on_change.is_empty() {
                journal.push(Record::Switch { time: t, watch, sign });
            }
        }
        let changed = self.publish(e, watch, sign);
        let stepped = self.step_stair(e, watch, sign, located, t)?;
        if changed || stepped {
            for turn in turns_of(&code.on_change, copy) {
                self.evaluate_turn(e, turn, t, journal).map_err(|failed| self.why(failed))?;
            }
            self.mark_dependents(e, watch);
        }
        Ok(())
    }

    /// Writes the truths that a sign means; whether one changed.
    fn publish(&mut self, e: &Equations, watch: WatchIndex, sign: Sign) -> bool {
        let mut changed = false;
        let (code, copy) = e.watch(watch);
        for &(truth, signs) in &code.truths {
            let holds = if signs & sign_bit(sign) != 0 { 1.0 } else { 0.0 };
            changed |= self.set_scalar(e, e.layout.truths + truth.of(copy), holds);
        }
        changed
    }

    /// Writes a truth or stair; whether it changed.
    #[allow(clippy::float_cmp)] // the same whole number or not
    pub(super) fn set_scalar(&mut self, e: &Equations, at: u32, value: f64) -> bool {
        if self.memory[at as usize] == value {
            return false;
        }
        self.switchings += 1;
        self.memory[at as usize] = value;
        if !self.enclosed.is_empty() {
            let behind = (at - e.layout.rest) as usize;
            self.enclosed[behind] = Interval::point(value);
            self.bounded[behind] = [value, 0.0];
        }
        true
    }

    /// When the decided sign is first lost on the present segments (thesis §8.3.2, timeToHit).
    pub(super) fn predict(&mut self, e: &Equations, watch: WatchIndex, t: f64) -> Result<(), Fault> {
        self.statistics.predictions += 1;
        if let Some(outside) = self.beyond(e, watch) {
            self.watches[watch.position()].due = Due::Outside;
            // What else happens at this instant may still bring it back.
            let time = if outside { t.next_up() } else { f64::INFINITY };
            self.agenda.set(e.layout.states + watch.0, time);
            return Ok(());
        }
        let c = self.difference(e, watch, t)?;
        let sign = self.watches[watch.position()].sign;
        let (code, copy) = e.watch(watch);
        let (time, due) = if code.clock && sign == Sign::Negative && c[0] < 0.0 {
            // Not `t` plus the rest, which would be rounded.
            (self.value_of(e, (&code.right, copy), t, 1)[0].max(t), Due::Root)
        } else if code.affine {
            let [c0, c1, c2, _] = c;
            let crossing =
                if ORDER > 2 { cubic_crossing(c, sign) } else { parabola_crossing([c0, c1, c2], sign) };
            match crossing {
                Some(delay) => (t + delay, if delay > 0.0 { Due::Root } else { Due::Joint }),
                None => (f64::INFINITY, Due::Root),
            }
        } else if c != [0.0; 4] && Sign::after(&c) != sign {
            (t, Due::Joint)
        } else {
            self.search(e, watch, t, c[0] == 0.0)?
        };
        self.watches[watch.position()].due = due;
        self.agenda.set(e.layout.states + watch.0, time);
        Ok(())
    }

    /// The first crossing of a watch that is not affine, by enclosures, as far ahead as is worth while.
    fn search(
        &mut self,
        e: &Equations,
        watch: WatchIndex,
        t: f64,
        on_surface: bool,
    ) -> Result<(f64, Due), Fault> {
        let (code, copy) = e.watch(watch);
        // Segments change with the next step of a source: no need to look much further.
        let next = sources_of(&code.formula.reads, copy)
            .filter(|source| source.0 < e.layout.states)
            .map(|source| self.agenda.time(source.0))
            .fold(f64::INFINITY, f64::min);
        let far = t + self.settings.window;
        let end = if next > t && next < far { next } else { far };
        let mut start = Start { sign: self.watches[watch.position()].sign, on_surface };
        let sure = self.stays_until(e, watch, t, end, start.sign);
        if sure == end {
            return Ok((end, Due::Search));
        }
        start.on_surface &= sure == t;
        let until = match self.search_from(e, watch, sure, end, start) {
            Search::Crossing(time) => return Ok((time, if time > t { Due::Root } else { Due::Joint })),
            Search::None => end,
            // Equal sides keep the sign that was decided until they certainly differ.
            Search::Blurred(since, until) if self.are_equal(e, watch, since) => until,
            // Not decided ahead: the segments may be others by then.
            Search::Blurred(since, _) | Search::Undecided(since) => since,
        };
        if until - t > LEAST_PROGRESS * (end - t) {
            Ok((until, Due::Search))
        } else {
            Err(Fault::Undecided { watch, time: t })
        }
    }

    /// How long a watched difference keeps its sign for all that quick looks can tell: until `end`, or part of the way.
    fn stays_until(&mut self, e: &Equations, watch: WatchIndex, t: f64, end: f64, sign: Sign) -> f64 {
        if self.stays(e, watch, t, end, sign) {
            return end;
        }
        let mut sure = t;
        for part in 1..=GLANCES {
            let next =
                if part < GLANCES { t + (end - t) * (f64::from(part) / f64::from(GLANCES)) } else { end };
            if !(next > sure && self.stays(e, watch, sure, next, sign)) {
                break;
            }
            sure = next;
        }
        sure
    }

    /// Whether a quick look is enough to see that a watched difference keeps its sign between two times.
    fn stays(&mut self, e: &Equations, watch: WatchIndex, t: f64, end: f64, sign: Sign) -> bool {
        self.statistics.enclosures += 1;
        let (code, copy) = e.watch(watch);
        let (middle, half) = (t.midpoint(end), (0.5 * (end - t)).next_up());
        // The middle is rounded: what lies beside it is in the radius.
        let now = [middle, half + (middle.abs().next_up() - middle.abs())];
        let rest = e.layout.rest;
        let mut memory = Enclosing { numbers: &self.memory, enclosed: &mut self.bounded, rest, now };
        let [difference, radius] = e.formula_bounded((&code.formula, copy), &self.locations, &mut memory);
        let difference = difference - self.watches[watch.position()].bias;
        difference.abs() * SURE > radius && Sign::of(difference) == sign
    }

    fn search_from(&mut self, e: &Equations, watch: WatchIndex, t: f64, end: f64, start: Start) -> Search {
        let budget = self.settings.search_budget;
        first_crossing(&mut |times| self.enclose(e, watch, times), t, end, start, budget)
    }

    /// Enclosures of the Taylor coefficients of the watched difference over `times`, the bias taken off.
    fn enclose(&mut self, e: &Equations, watch: WatchIndex, times: Interval) -> [Interval; 3] {
        self.statistics.enclosures += 1;
        let (code, copy) = e.watch(watch);
        let rest = e.layout.rest;
        let mut memory = Enclosing { numbers: &self.memory, enclosed: &mut self.enclosed, rest, now: times };
        let mut jet = e.formula_enclosed((&code.formula, copy), &self.locations, &mut memory);
        jet[0] = jet[0] - Interval::point(self.watches[watch.position()].bias);
        jet
    }

    /// Taylor coefficients of the watched difference at `t`, the bias taken off.
    pub(super) fn difference(&mut self, e: &Equations, watch: WatchIndex, t: f64) -> Result<Jet, Fault> {
        let mut c = self.raw_difference(e, watch, t)?;
        let record = &mut self.watches[watch.position()];
        c[0] -= record.bias;
        if record.is_still_there(&c, t) {
            record.bias += c[0];
            c[0] = 0.0;
        }
        Ok(c)
    }

    pub(super) fn raw_difference(&mut self, e: &Equations, watch: WatchIndex, t: f64) -> Result<Jet, Fault> {
        let (code, copy) = e.watch(watch);
        let c = match code.level {
            Some((source, number)) => {
                let mut c = self.record(source.of(copy) as usize).x_from(t);
                c[0] = number.map_or(c[0], |at| c[0] - self.memory[at.of(copy) as usize]);
                c
            }
            None => self.value_of(e, (&code.formula, copy), t, ORDER + 1),
        };
        let [value, rest @ ..] = c;
        if !value.is_finite() {
            return Err(Fault::WatchNotFinite { watch, time: t, value });
        }
        // A derivative may be infinite where the value is not (√x at 0): then only enclosures help.
        if rest.iter().all(|c| c.is_finite()) { Ok(c) } else { Ok([value, 0.0, 0.0, 0.0]) }
    }

    /// A formula over x at `t`.
    #[inline]
    pub(super) fn value_of(&mut self, e: &Equations, formula: (&Formula, u32), t: f64, orders: usize) -> Jet {
        self.memory[NOW] = t;
        e.formula(formula, &self.locations, &mut self.memory, orders)
    }
}
