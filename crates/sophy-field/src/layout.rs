use crate::SourceIndex;

/// Where the present time stands in memory, s.
pub const NOW: usize = 0;

/// Where things stand in memory; all offsets count numbers.
///
/// Memory begins with a head, whose first number is the present time ([`NOW`]). A *record* for each source follows, as
/// long as the head: see [`RecordLayout`]. Then the *rest*: jets of algebraic variables, truths, stairs, parameters, columns,
/// numbers and temporaries. A *column* is its length and then its numbers: the knots of a table, or a coefficient of its
/// pieces.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Layout {
    /// Coefficients per jet: one more than the order of the engine.
    pub width: u32,
    /// Number of states.
    pub states: u32,
    /// Number of inputs.
    pub inputs: u32,
    /// Of every record.
    pub record: RecordLayout,
    /// First number behind the records.
    pub rest: u32,
    /// First truth (scalar 1 or 0), then the stairs.
    pub truths: u32,
    /// First stair.
    pub stairs: u32,
    /// Length of memory.
    pub length: u32,
}

/// What memory holds of a source (state, input or time): two trajectories, each its Taylor coefficients and then the
/// time, s, from which they count. The *integrated* one, x, is read by guards, resets and outputs, the *quantised*
/// one, q, by rates. Behind them there is room for what an engine keeps.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct RecordLayout {
    /// Numbers per record: a cache line, or two.
    pub stride: u32,
    /// Coefficients of x, which stand first.
    pub integrated: u32,
    /// Coefficients of q.
    pub quantised: u32,
}

impl RecordLayout {
    /// The records of an engine of this order.
    pub const fn of_order(order: u32) -> Self {
        // One line up to order 2; inputs have slopes at any order.
        let (stride, integrated) = if order < 3 { (8, 3) } else { (16, 4) };
        RecordLayout { stride, integrated, quantised: integrated - 1 }
    }

    /// Where the coefficients of q stand.
    pub const fn quantised_at(self) -> u32 {
        self.integrated + 1
    }

    /// Where the engine's own numbers stand.
    pub const fn own_at(self) -> u32 {
        self.quantised_at() + self.quantised + 1
    }
}

impl Layout {
    /// Number of sources.
    pub fn sources(self) -> usize {
        (self.states + self.inputs + 1) as usize
    }

    /// Offset of a source's record, which begins with x.
    #[inline]
    pub fn record_of(self, source: SourceIndex) -> usize {
        ((source.0 + 1) * self.record.stride) as usize
    }

    /// Offset of a source's q.
    #[inline]
    pub fn quantised_of(self, source: SourceIndex) -> usize {
        self.record_of(source) + self.record.quantised_at() as usize
    }

    /// Writes x of a source: Taylor coefficients from `time` (s) on, the last ones 0 if they are not given.
    pub fn set_integrated(self, memory: &mut [f64], source: SourceIndex, jet: &[f64], time: f64) {
        write(&mut memory[self.record_of(source)..][..self.record.integrated as usize + 1], jet, time);
    }

    /// The same of q.
    pub fn set_quantised(self, memory: &mut [f64], source: SourceIndex, jet: &[f64], time: f64) {
        write(&mut memory[self.quantised_of(source)..][..self.record.quantised as usize + 1], jet, time);
    }

    /// The source that is time.
    pub fn time(self) -> SourceIndex {
        SourceIndex(self.states + self.inputs)
    }
}

/// A trajectory: as many coefficients as there is room for, then its start.
fn write(trajectory: &mut [f64], jet: &[f64], time: f64) {
    let Some((start, coefficients)) = trajectory.split_last_mut() else { return };
    coefficients.fill(0.0);
    for (c, value) in coefficients.iter_mut().zip(jet) {
        *c = *value;
    }
    *start = time;
}
