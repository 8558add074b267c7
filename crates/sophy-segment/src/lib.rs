//! Superdense instants, polynomial segments, intervals, first crossings.
