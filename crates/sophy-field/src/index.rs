//! Typed indices: after the passes no name is looked up, and no bare `usize` crosses a module border.

use std::fmt;

macro_rules! index {
    ($($(#[$doc:meta])* $name:ident, $prefix:literal;)*) => {$(
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub struct $name(pub u32);

        impl $name {
            /// From a position in a table. Tables are limited to 2³² entries; the passes check it.
            #[inline]
            pub fn new(position: usize) -> Self {
                $name(position as u32)
            }

            /// The position in its table.
            #[inline]
            pub fn position(self) -> usize {
                self.0 as usize
            }
        }

        impl fmt::Display for $name {
            fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                write!(f, concat!($prefix, "{}"), self.0)
            }
        }
    )*};
}

index! {
    /// A continuous state of the flat system.
    StateIndex, "x";
    /// A continuous input of the flat system.
    InputIndex, "u";
    /// A parameter (constant or knob).
    ParameterIndex, "p";
    /// An output.
    OutputIndex, "y";
    /// An algebraic variable: an output of one automaton that another reads.
    AlgebraicIndex, "z";
    /// A watch: a scalar whose first sign change an engine locates.
    WatchIndex, "w";
    /// A decided comparison (`a < b`): what a watch's sign means to a guard or a switch.
    TruthIndex, "b";
    /// A staircase: the integer that `floor` of a continuous quantity is at present.
    StairIndex, "s";
    /// A column of numbers: the knots of a table, or a coefficient of its pieces.
    ColumnIndex, "n";
    /// A hybrid automaton; its locations are numbered from 0 in written order.
    AutomatonIndex, "a";
    /// A location of one automaton.
    LocationIndex, "q";
    /// A transition of the flat system, in written order.
    TransitionIndex, "t";
    /// An event label of the flat system.
    EventIndex, "e";
}
