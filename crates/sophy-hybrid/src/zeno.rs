use sophy_field::TransitionIndex;

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

/// Watches the transitions of one automaton for rounds that become shorter and shorter.
///
/// A Zeno run takes infinitely many transitions before a finite time. It is recognised when the last
/// [`ROUNDS`] rounds of one cycle shrink by a steady factor and what remains of their geometric series is
/// within the resolution of time; the limit is then known to rounding. Accumulation without a steady factor
/// is recognised when [`CROWD`] transitions fall within that resolution.
#[derive(Clone, Debug, Default)]
pub struct Zeno {
    /// The last transitions, oldest first.
    history: Vec<(f64, TransitionIndex)>,
}

/// Rounds that must follow the series.
const ROUNDS: usize = 6;
/// The longest cycle looked for.
const LONGEST_CYCLE: usize = 8;
/// Remaining time, relative to |t|, that counts as none.
const RESOLUTION: f64 = 1e-12;
/// Transitions within the resolution that count as accumulating.
const CROWD: usize = 2000;

impl Zeno {
    /// A transition is taken at `t` (s).
    pub fn taken(&mut self, t: f64, transition: TransitionIndex) -> Option<Accumulation> {
        // What came before a pause is no crowd; rounds may be as long as they like, but are few.
        let pause = self.history.last().is_some_and(|last| t - last.0 > RESOLUTION * scale(t));
        let kept = if pause { (ROUNDS + 1) * LONGEST_CYCLE } else { 2 * CROWD };
        if self.history.len() > kept {
            self.history.drain(..self.history.len() - kept.min(CROWD));
        }
        self.history.push((t, transition));
        let n = self.history.len();
        // A cheap test first: nothing accumulates while the last transitions are far apart.
        if n < 3 || t - self.history[n - 3].0 > 1e-6 * scale(t) {
            return None;
        }
        self.geometric(t).or_else(|| self.crowded(t))
    }

    fn geometric(&self, t: f64) -> Option<Accumulation> {
        let n = self.history.len();
        (1..=LONGEST_CYCLE).filter(|cycle| n > (ROUNDS + 1) * cycle).find_map(|cycle| {
            let back = |rounds: usize| self.history[n - 1 - rounds * cycle];
            let same =
                (0..ROUNDS * cycle).all(|k| self.history[n - 1 - k].1 == self.history[n - 1 - k - cycle].1);
            if !same {
                return None;
            }
            let length = |round: usize| back(round).0 - back(round + 1).0;
            let ratios = (0..ROUNDS - 1).map(|round| length(round) / length(round + 1));
            let (least, most) =
                ratios.fold((f64::INFINITY, 0.0f64), |(a, b), r| (if r < a { r } else { a }, b.max(r)));
            // The oldest ratio is the one least spoilt by rounding.
            let ratio = length(ROUNDS - 2) / length(ROUNDS - 1);
            let steady = least > 0.0 && most < 1.0 && most - least < 0.05;
            let remaining = length(0) * ratio / (1.0 - ratio);
            (steady && remaining < RESOLUTION * scale(t)).then(|| Accumulation {
                limit: t + remaining,
                last: t,
                ratio,
                cycle: self.history[n - cycle..].iter().map(|entry| entry.1).collect(),
            })
        })
    }

    fn crowded(&self, t: f64) -> Option<Accumulation> {
        let n = self.history.len();
        if n < CROWD || t - self.history[n - CROWD].0 > RESOLUTION * scale(t) {
            return None;
        }
        // A long cascade at one instant is not Zeno: it ends, or it is a livelock.
        let instants = self.history[n - CROWD..].windows(2).filter(|pair| pair[0].0 < pair[1].0).count();
        if instants < CROWD / 8 {
            return None;
        }
        let cycle = self.history[n - LONGEST_CYCLE..].iter().map(|entry| entry.1).collect();
        Some(Accumulation { limit: t, last: t, ratio: f64::NAN, cycle })
    }
}

fn scale(t: f64) -> f64 {
    if t.abs() > 1.0 { t.abs() } else { 1.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A ball with restitution 0.8: bounces at t_k = t* − a·0.8ᵏ.
    #[test]
    fn a_bouncing_ball_accumulates() {
        let mut zeno = Zeno::default();
        let (limit, first) = (4.5, 4.0);
        let found = (0..400)
            .find_map(|k| zeno.taken(limit - first * sophy_powi(0.8, k), TransitionIndex(0)).map(|a| (k, a)));
        let (k, accumulation) = found.expect("recognised");
        assert!(k > 50, "only near the limit");
        assert!((accumulation.limit - limit).abs() < 1e-11);
        assert_eq!(accumulation.cycle, [TransitionIndex(0)]);
    }

    #[test]
    fn a_clock_does_not_accumulate() {
        let mut zeno = Zeno::default();
        assert!((0..10_000).all(|k| zeno.taken(f64::from(k) * 1e-7, TransitionIndex(k % 2)).is_none()));
    }

    fn sophy_powi(base: f64, n: i32) -> f64 {
        (0..n).fold(1.0, |p, _| p * base)
    }
}
