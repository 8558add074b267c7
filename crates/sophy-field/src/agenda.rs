//! When what happens next.

/// A tournament of times: slots play in fours, the earliest of each four plays on; ties go to the smaller slot.
///
/// Slots are numbered by the engine: states first, then watches, then timers. A new time is compared upwards only as
/// far as it changes who wins, with the four players of a match in one cache line and no branch that depends on who
/// wins.
#[derive(Clone, Debug, Default)]
pub struct Agenda {
    /// All matches, round by round, the slots' own first.
    matches: Vec<Match>,
    /// Where each round begins.
    rounds: Vec<usize>,
    /// Who has won: the key of its time and the slot.
    first: (i64, u32),
}

/// Four players: keys of their times, and which slots they are.
#[derive(Clone, Copy, Debug)]
#[repr(align(64))]
struct Match {
    keys: [i64; PLAYERS],
    slots: [u32; PLAYERS],
}

const PLAYERS: usize = 4;
/// The key of no time; that of infinity is smaller, and never stored.
const NEVER: i64 = i64::MAX;
const NOBODY: Match = Match { keys: [NEVER; PLAYERS], slots: [u32::MAX; PLAYERS] };

impl Agenda {
    /// An agenda of `slots` slots, all without a time.
    pub fn new(slots: usize) -> Self {
        let (mut rounds, mut count) = (Vec::new(), 0);
        let mut players = slots;
        while rounds.is_empty() || players > 1 {
            rounds.push(count);
            players = players.div_ceil(PLAYERS).max(1);
            count += players;
        }
        Agenda { matches: vec![NOBODY; count], rounds, first: (NEVER, 0) }
    }

    /// The earliest time and its slot.
    #[inline]
    pub fn first(&self) -> Option<(f64, u32)> {
        let (key, slot) = self.first;
        (key != NEVER).then(|| (time_of(key), slot))
    }

    /// The time of a slot; infinite if it has none.
    #[inline]
    pub fn time(&self, slot: u32) -> f64 {
        let slot = slot as usize;
        match self.matches[slot / PLAYERS].keys[slot % PLAYERS] {
            NEVER => f64::INFINITY,
            key => time_of(key),
        }
    }

    /// Gives a slot a time; an infinite one takes it off the agenda. `time` must not be NaN.
    #[inline]
    pub fn set(&mut self, slot: u32, time: f64) {
        let (mut key, mut winner) = (if time < f64::INFINITY { key_of(time) } else { NEVER }, slot);
        let mut player = slot as usize;
        for &round in &self.rounds {
            let players = &mut self.matches[round + player / PLAYERS];
            let seat = player % PLAYERS;
            if players.keys[seat] == key && players.slots[seat] == winner {
                return;
            }
            players.keys[seat] = key;
            players.slots[seat] = winner;
            (key, winner) = players.earliest();
            player /= PLAYERS;
        }
        self.first = (key, winner);
    }
}

impl Match {
    /// Of equal ones the first: it has the smaller slot.
    #[inline]
    fn earliest(&self) -> (i64, u32) {
        let Match { keys: [a, b, c, d], slots: [i, j, k, l] } = *self;
        let left = if b < a { (b, j) } else { (a, i) };
        let right = if d < c { (d, l) } else { (c, k) };
        if right.0 < left.0 { right } else { left }
    }
}

/// A whole number of the order of times; −0 and 0 are one time.
#[inline]
fn key_of(time: f64) -> i64 {
    ordered((time + 0.0).to_bits() as i64)
}

#[inline]
fn time_of(key: i64) -> f64 {
    f64::from_bits(ordered(key) as u64)
}

/// Bits of a float as an integer of the same order, and back.
#[inline]
fn ordered(bits: i64) -> i64 {
    bits ^ (((bits >> 63) as u64) >> 1) as i64
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn the_first_is_the_least_of_all(
            slots in 1u32..70,
            changes in prop::collection::vec((0u32..70, prop_oneof![4 => 0u8..20, 1 => Just(255u8)]), 1..200)
        ) {
            let mut agenda = Agenda::new(slots as usize);
            let mut plain = vec![f64::INFINITY; slots as usize];
            for (slot, time) in changes {
                let time = if time == 255 { f64::INFINITY } else { f64::from(time) - 5.0 };
                let slot = slot % slots;
                agenda.set(slot, time);
                plain[slot as usize] = time;
                let least = (0..slots).filter(|&s| plain[s as usize] < f64::INFINITY)
                    .min_by(|&a, &b| plain[a as usize].total_cmp(&plain[b as usize]).then(a.cmp(&b)));
                prop_assert_eq!(agenda.first(), least.map(|s| (plain[s as usize], s)));
                for s in 0..slots {
                    prop_assert_eq!(agenda.time(s), plain[s as usize]);
                }
            }
        }
    }
}
