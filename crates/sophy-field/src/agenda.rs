//! When what happens next.

/// A tournament of times: slots play in fours, the earliest of each four plays on; ties go to the smaller slot.
///
/// Slots are numbered by the engine: states first, then watches, then timers. A new time is compared upwards only as
/// far as it changes who wins, with the four players of a match in one cache line and no branch that depends on who
/// wins.
#[derive(Clone, Debug, Default)]
pub struct Agenda {
    /// The keys of the times of slots, four by four.
    slots: Vec<Four>,
    /// All further matches, round by round.
    matches: Vec<Match>,
    /// Where each round begins.
    rounds: Vec<usize>,
    /// Who has won: the key of its time and the slot.
    first: (i64, u32),
}

#[derive(Clone, Copy, Debug)]
#[repr(align(32))]
struct Four([i64; PLAYERS]);

/// Four winners: keys of their times, and which slots they are.
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
        let fours = slots.div_ceil(PLAYERS).max(1);
        let mut players = fours;
        while players > 1 {
            rounds.push(count);
            players = players.div_ceil(PLAYERS);
            count += players;
        }
        let slots = vec![Four([NEVER; PLAYERS]); fours];
        Agenda { slots, matches: vec![NOBODY; count], rounds, first: (NEVER, 0) }
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
        match self.slots[slot / PLAYERS].0[slot % PLAYERS] {
            NEVER => f64::INFINITY,
            key => time_of(key),
        }
    }

    /// Gives a slot a time; an infinite one takes it off the agenda. `time` must not be NaN.
    #[inline]
    pub fn set(&mut self, slot: u32, time: f64) {
        let key = if time < f64::INFINITY { key_of(time) } else { NEVER };
        let mut player = slot as usize / PLAYERS;
        let Four(keys) = &mut self.slots[player];
        keys[slot as usize % PLAYERS] = key;
        let first = slot - slot % PLAYERS as u32;
        let mut winner = earliest(*keys, [0, 1, 2, 3].map(|seat| first + seat));
        for &round in &self.rounds {
            let players = &mut self.matches[round + player / PLAYERS];
            let seat = player % PLAYERS;
            if (players.keys[seat], players.slots[seat]) == winner {
                return;
            }
            (players.keys[seat], players.slots[seat]) = winner;
            winner = earliest(players.keys, players.slots);
            player /= PLAYERS;
        }
        self.first = winner;
    }
}

/// Of equal ones the first: it has the smaller slot.
#[inline]
fn earliest([a, b, c, d]: [i64; PLAYERS], [i, j, k, l]: [u32; PLAYERS]) -> (i64, u32) {
    let left = if b < a { (b, j) } else { (a, i) };
    let right = if d < c { (d, l) } else { (c, k) };
    if right.0 < left.0 { right } else { left }
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
