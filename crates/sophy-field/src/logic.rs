use crate::{Affine, AutomatonIndex, Formula, LocationIndex, Site, Table, TransitionIndex, WatchIndex};
use sophy_segment::Sign;

/// The compiled transitions of a system.
#[derive(Clone, Debug, Default)]
pub struct Logic {
    /// What transitions are.
    pub transition_codes: Vec<TransitionCode>,
    /// Per transition, in written order: its code.
    pub transitions: Vec<Site>,
    /// What automata are.
    pub automaton_codes: Vec<AutomatonLogic>,
    /// Per automaton: its code, and its first transition.
    pub automata: Vec<(u32, TransitionIndex)>,
    /// Per event: the automaton that receives it.
    pub receivers: Vec<AutomatonIndex>,
    /// Per watch: the automata whose guards read it.
    pub automata_of_watch: Table<AutomatonIndex>,
}

/// What the logic knows of an automaton; up to the copy.
#[derive(Clone, Debug)]
pub struct AutomatonLogic {
    /// Per location: its outgoing transitions by priority, then in written order, counted from the first one.
    pub outgoing: Vec<Box<[u32]>>,
    /// Whether its two locations are the sides of a flag, which it follows.
    pub follows_flag: bool,
}

impl Logic {
    /// The code of a transition, and which copy of it.
    #[inline]
    pub fn transition(&self, transition: TransitionIndex) -> (&TransitionCode, u32) {
        let Site { pattern, copy } = self.transitions[transition.position()];
        (&self.transition_codes[pattern as usize], copy)
    }

    /// The transitions out of a location, by priority, then in written order.
    #[inline]
    pub fn outgoing(
        &self,
        automaton: AutomatonIndex,
        location: LocationIndex,
    ) -> impl Iterator<Item = TransitionIndex> + use<'_> {
        let (code, first) = self.automata[automaton.position()];
        let outgoing = &self.automaton_codes[code as usize].outgoing[location.position()];
        outgoing.iter().map(move |transition| TransitionIndex(first.0 + transition))
    }

    /// Whether the two locations of an automaton are the sides of a flag, which it follows.
    #[inline]
    pub fn follows_flag(&self, automaton: AutomatonIndex) -> bool {
        self.automaton_codes[self.automata[automaton.position()].0 as usize].follows_flag
    }
}

/// A transition τ = (q₁, q₂, j, r, e_in, e_out), thesis definition 8.5; up to the copy.
#[derive(Clone, Debug)]
pub struct TransitionCode {
    /// Whose: an [`AutomatonIndex`].
    pub automaton: Affine,
    /// q₁.
    pub source: LocationIndex,
    /// q₂.
    pub destination: LocationIndex,
    /// j and e_in.
    pub trigger: TriggerCode,
    /// r: new values of states, read before the micro-step; each a [`StateIndex`](crate::StateIndex).
    pub resets: Vec<(Affine, Formula)>,
    /// e_out: what is emitted, in the order of emission.
    pub emits: Vec<EmissionCode>,
    /// Smaller goes first.
    pub priority: i32,
    /// Whether it only keeps the side of a flag: no event, no micro-step.
    pub silent: bool,
}

/// What is emitted.
#[derive(Clone, Debug)]
pub struct EmissionCode {
    /// The input events that receive it: each an [`EventIndex`](crate::EventIndex).
    pub receivers: Vec<Affine>,
    /// Only if this is not 0 before the micro-step.
    pub when: Option<Formula>,
}

/// When a transition is taken.
#[derive(Clone, Debug)]
pub enum TriggerCode {
    /// While the guard holds.
    When(Guard),
    /// On one of the events, each an [`EventIndex`](crate::EventIndex), if the guard holds.
    On(Vec<Affine>, Guard),
}

/// A boolean combination of watch signs, in postfix form.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Guard {
    /// Evaluated in order on a stack of booleans; exactly one remains.
    pub steps: Vec<GuardStep>,
}

/// One step of a guard.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GuardStep {
    /// Pushes a constant.
    Constant(bool),
    /// Pushes whether the sign of a watch, a [`WatchIndex`], is among `signs` (bit 0 −, bit 1 zero, bit 2 +).
    Sign(Affine, u8),
    /// Replaces the top by its negation.
    Not,
    /// Replaces the two on top by their conjunction.
    And,
    /// Replaces the two on top by their disjunction.
    Or,
}

impl Guard {
    /// Whether the guard of a copy holds, given the signs of watches.
    pub fn holds(&self, copy: u32, sign: impl Fn(WatchIndex) -> Sign) -> bool {
        // Bit stack: guards deeper than 64 are refused when they are compiled.
        let (mut stack, mut depth) = (0u64, 0u32);
        for step in &self.steps {
            match *step {
                GuardStep::Constant(value) => {
                    stack |= u64::from(value) << depth;
                    depth += 1;
                }
                GuardStep::Sign(watch, signs) => {
                    let holds = signs & sign_bit(sign(WatchIndex(watch.of(copy)))) != 0;
                    stack |= u64::from(holds) << depth;
                    depth += 1;
                }
                GuardStep::Not => stack ^= 1 << (depth - 1),
                GuardStep::And | GuardStep::Or => {
                    let (a, b) = (stack >> (depth - 2) & 1, stack >> (depth - 1) & 1);
                    let both = if *step == GuardStep::And { a & b } else { a | b };
                    depth -= 1;
                    stack &= !(3 << (depth - 1));
                    stack |= both << (depth - 1);
                }
            }
        }
        stack & 1 == 1
    }

    /// The deepest the stack becomes.
    pub fn depth(&self) -> usize {
        let (mut depth, mut deepest) = (0usize, 0);
        for step in &self.steps {
            match step {
                GuardStep::Constant(_) | GuardStep::Sign(..) => depth += 1,
                GuardStep::And | GuardStep::Or => depth -= 1,
                GuardStep::Not => {}
            }
            deepest = deepest.max(depth);
        }
        deepest
    }
}

/// The bit of a sign in a set of signs.
#[inline]
pub fn sign_bit(sign: Sign) -> u8 {
    match sign {
        Sign::Negative => 1,
        Sign::Zero => 2,
        Sign::Positive => 4,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_guard_combines_signs() {
        let (a, b) = (Affine::fixed(0), Affine { first: 0, stride: 1 });
        // not a < 0 and (b > 0 or false)
        let guard = Guard {
            steps: vec![
                GuardStep::Sign(a, 1),
                GuardStep::Not,
                GuardStep::Sign(b, 4),
                GuardStep::Constant(false),
                GuardStep::Or,
                GuardStep::And,
            ],
        };
        let signs = |x: Sign, y: Sign| move |w: WatchIndex| if w.0 == 0 { x } else { y };
        assert!(guard.holds(1, signs(Sign::Zero, Sign::Positive)));
        assert!(!guard.holds(1, signs(Sign::Negative, Sign::Positive)));
        assert!(!guard.holds(1, signs(Sign::Positive, Sign::Zero)));
        assert_eq!(guard.depth(), 3);
    }
}
