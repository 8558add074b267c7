use sophy_field::{AutomatonIndex, TransitionIndex};

/// Transitions whose times accumulate.
#[derive(Clone, Debug, PartialEq)]
pub struct Accumulation {
    /// Where they accumulate, s: the sum of the geometric series that the last rounds follow.
    pub limit: f64,
    /// Time of the last transition taken, s.
    pub last: f64,
    /// By what factor each round is shorter than the one before; NaN if there is no steady one.
    pub ratio: f64,
    /// The transitions of one round.
    pub cycle: Vec<TransitionIndex>,
}

/// Watches the transitions of every automaton for rounds that become shorter and shorter.
///
/// A Zeno run takes infinitely many transitions before a finite time. It is recognised when the last
/// [`ROUNDS`] rounds of one cycle shrink by a steady factor and what remains of their geometric series is
/// within the resolution of time; the limit is then known to rounding. Accumulation without a steady factor
/// is recognised when [`CROWD`] transitions fall within that resolution.
#[derive(Clone, Debug)]
pub struct Zeno {
    /// Per automaton.
    watched: Vec<Watched>,
    /// Of those whose transitions follow each other closely; the others need none.
    histories: Vec<History>,
    /// Histories that are nobody's at present.
    free: Vec<u32>,
}

/// An automaton.
#[derive(Clone, Copy, Debug)]
struct Watched {
    /// Its last transition, s, for what is near: a few digits are enough.
    last: f32,
    /// Its history; [`NONE`] while it has none.
    history: u32,
}

/// The last transitions of an automaton, oldest first.
#[derive(Clone, Debug, Default)]
struct History(Vec<(f64, TransitionIndex)>);

/// No history.
const NONE: u32 = u32::MAX;
/// Rounds that must follow the series, and those that are enough where each is shorter than [`STEEP`] times the one
/// before: more are not to be had between [`PAUSE`] and [`RESOLUTION`].
const ROUNDS: usize = 6;
const STEEP_ROUNDS: usize = 3;
const STEEP: f64 = 0.1;
/// The longest cycle looked for.
const LONGEST_CYCLE: usize = 8;
/// Remaining time, relative to |t|, that counts as none.
const RESOLUTION: f64 = 1e-12;
/// Time without a transition, relative to |t|, after which what came before does not matter any more.
const PAUSE: f64 = 1e-5;
/// Transitions within the resolution that count as accumulating.
const CROWD: usize = 2000;

impl Zeno {
    /// Nothing has happened to any of so many automata.
    pub fn new(automata: usize) -> Self {
        let nothing = Watched { last: f32::NEG_INFINITY, history: NONE };
        Zeno { watched: vec![nothing; automata], histories: Vec::new(), free: Vec::new() }
    }

    /// A transition of an automaton is taken at `t` (s).
    pub fn taken(
        &mut self,
        automaton: AutomatonIndex,
        t: f64,
        transition: TransitionIndex,
    ) -> Option<Accumulation> {
        let watched = &mut self.watched[automaton.position()];
        // Its few digits may make a pause longer or shorter than it was, which does not matter.
        let is_pause = t - f64::from(watched.last) > PAUSE * scale(t);
        watched.last = t as f32;
        if is_pause {
            if watched.history != NONE {
                self.histories[watched.history as usize].0.clear();
                self.free.push(watched.history);
                watched.history = NONE;
            }
            return None;
        }
        if watched.history == NONE {
            watched.history = self.free.pop().unwrap_or(self.histories.len() as u32);
            if watched.history as usize == self.histories.len() {
                self.histories.push(History::default());
            }
        }
        self.histories[watched.history as usize].taken(t, transition)
    }
}

impl History {
    fn taken(&mut self, t: f64, transition: TransitionIndex) -> Option<Accumulation> {
        if self.0.len() > 2 * CROWD {
            self.0.drain(..CROWD);
        }
        self.0.push((t, transition));
        let n = self.0.len();
        // A cheap test first: nothing accumulates while the last transitions are far apart.
        if n < 3 || t - self.0[n - 3].0 > 1e-6 * scale(t) {
            return None;
        }
        let steep = || {
            // Two rounds at once are always steeper: only the shortest cycle counts.
            let cycle = (1..=LONGEST_CYCLE).find(|&cycle| self.repeats(cycle, STEEP_ROUNDS))?;
            self.series(t, cycle, STEEP_ROUNDS).filter(|found| found.ratio < STEEP)
        };
        let cycles = (1..=LONGEST_CYCLE).filter(|&cycle| self.repeats(cycle, ROUNDS));
        let steady = cycles.map(|cycle| self.series(t, cycle, ROUNDS)).find(Option::is_some).flatten();
        steady.or_else(steep).or_else(|| self.crowded(t))
    }

    /// Whether the last rounds are of the same transitions, so many each.
    fn repeats(&self, cycle: usize, rounds: usize) -> bool {
        let n = self.0.len();
        n > (rounds + 1) * cycle
            && (0..rounds * cycle).all(|k| self.0[n - 1 - k].1 == self.0[n - 1 - k - cycle].1)
    }

    /// The series that the last rounds of a cycle follow.
    fn series(&self, t: f64, cycle: usize, rounds: usize) -> Option<Accumulation> {
        let n = self.0.len();
        let back = |round: usize| self.0[n - 1 - round * cycle];
        let length = |round: usize| back(round).0 - back(round + 1).0;
        let ratios = (0..rounds - 1).map(|round| length(round) / length(round + 1));
        let (least, most) =
            ratios.fold((f64::INFINITY, 0.0f64), |(a, b), r| (if r < a { r } else { a }, b.max(r)));
        // The oldest ratio is the one least spoilt by rounding.
        let ratio = length(rounds - 2) / length(rounds - 1);
        let steady = least > 0.0 && most < 1.0 && most - least < 0.05;
        let remaining = length(0) * ratio / (1.0 - ratio);
        let shortest = (1..cycle).find(|&shorter| self.repeats(shorter, rounds)).unwrap_or(cycle);
        (steady && remaining < RESOLUTION * scale(t)).then(|| Accumulation {
            limit: t + remaining,
            last: t,
            ratio,
            cycle: self.0[n - shortest..].iter().map(|entry| entry.1).collect(),
        })
    }

    fn crowded(&self, t: f64) -> Option<Accumulation> {
        let n = self.0.len();
        if n < CROWD || t - self.0[n - CROWD].0 > RESOLUTION * scale(t) {
            return None;
        }
        // A long cascade at one instant is not Zeno: it ends, or it is a livelock.
        let instants = self.0[n - CROWD..].windows(2).filter(|pair| pair[0].0 < pair[1].0).count();
        if instants < CROWD / 8 {
            return None;
        }
        let cycle = self.0[n - LONGEST_CYCLE..].iter().map(|entry| entry.1).collect();
        Some(Accumulation { limit: t, last: t, ratio: f64::NAN, cycle })
    }
}

fn scale(t: f64) -> f64 {
    if t.abs() > 1.0 { t.abs() } else { 1.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Restitution r: bounces at t_k = t* − a·rᵏ.
    fn bounces(r: f64, limit: f64) -> Option<(i32, Accumulation)> {
        let mut zeno = Zeno::new(1);
        (0..3000).find_map(|k| {
            let t = limit - 4.0 * sophy_powi(r, k);
            zeno.taken(AutomatonIndex(0), t, TransitionIndex(0)).map(|found| (k, found))
        })
    }

    #[test]
    fn a_bouncing_ball_accumulates() {
        for (r, limit) in [(0.99, 4.5), (0.8, 4.5), (0.5, 300.0), (0.2, 4.5), (0.05, 4.5), (0.02, 0.1)] {
            let (k, found) = bounces(r, limit).expect("recognised");
            assert!(sophy_powi(r, k) < 1e-9, "only near the limit: {k} of {r}");
            assert!((found.limit - limit).abs() < 1e-11 * limit.max(1.0), "{r}: {found:?}");
            assert_eq!(found.cycle, [TransitionIndex(0)]);
        }
    }

    #[test]
    fn a_clock_does_not_accumulate() {
        let mut zeno = Zeno::new(1);
        let mut taken = |k: u32| zeno.taken(AutomatonIndex(0), f64::from(k) * 1e-7, TransitionIndex(k % 2));
        assert!((0..10_000).all(|k| taken(k).is_none()));
    }

    /// Two that take turns: one accumulates, the other has a pause between each two of its transitions.
    #[test]
    fn only_what_follows_closely_is_kept() {
        let mut zeno = Zeno::new(3);
        let found = (0..40).find_map(|k| {
            let t = 1.0 - 0.5 * sophy_powi(0.4, k);
            let other = zeno.taken(AutomatonIndex(2), f64::from(k) * 1e-3, TransitionIndex(1));
            assert!(other.is_none());
            zeno.taken(AutomatonIndex(1), t, TransitionIndex(0))
        });
        assert!((found.expect("recognised").limit - 1.0).abs() < 1e-11);
        assert_eq!(zeno.histories.len(), 1);
        zeno.taken(AutomatonIndex(1), 2.0, TransitionIndex(0));
        assert_eq!(zeno.free, [0], "after a pause it is nobody's");
    }

    fn sophy_powi(base: f64, n: i32) -> f64 {
        (0..n).fold(1.0, |p, _| p * base)
    }
}
