use crate::control::Taken;
use crate::queues::Queues;
use sophy_field::{Changes, Engine, Equations, LocationIndex, SourceIndex, TransitionIndex};

/// Finds a round of micro-steps that returns exactly to where it began (Brent's algorithm: compare with a
/// state kept at the last power of two).
#[derive(Debug, Default)]
pub(crate) struct Livelock {
    kept: Vec<u64>,
    kept_at: u32,
}

/// Rounds shorter than this are not looked for; ordinary chains of transitions end before.
const FIRST: u32 = 16;

impl Livelock {
    pub(crate) fn begin(&mut self) {
        self.kept_at = 0;
    }

    /// Looks at the situation after micro-step `step`; the transitions of the round if it closes.
    #[allow(clippy::too_many_arguments)] // each is a different part of the situation
    pub(crate) fn after(
        &mut self,
        step: u32,
        engine: &dyn Engine,
        e: &Equations,
        t: f64,
        waiting: &Queues,
        changes: &Changes,
        taken: &[Taken],
    ) -> Option<Vec<TransitionIndex>> {
        if step < FIRST {
            return None;
        }
        let states = (0..e.layout.states).map(|s| engine.value(SourceIndex(s), t).to_bits());
        let locations = engine.locations().iter().map(|LocationIndex(l)| u64::from(*l));
        // An event has one receiver: what waits says for whom.
        let situation = states.chain(locations).chain(waiting.all().map(|event| u64::from(event.0)));
        // What the micro-step itself changed tells most situations apart, without looking at all states.
        let first_location = e.layout.states as usize;
        let may_return = self.kept_at > 0
            && changes
                .states
                .iter()
                .all(|(s, _)| self.kept[s.position()] == engine.value(SourceIndex(s.0), t).to_bits())
            && changes
                .locations
                .iter()
                .all(|(a, location)| self.kept[first_location + a.position()] == u64::from(location.0));
        if may_return && situation.clone().eq(self.kept.iter().copied()) {
            let round = taken.iter().filter(|taken| taken.step >= self.kept_at && taken.time == t);
            return Some(round.map(|taken| taken.transition).collect());
        }
        if step.is_power_of_two() {
            self.kept.clear();
            self.kept.extend(situation);
            self.kept_at = step;
        }
        None
    }
}
