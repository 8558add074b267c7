//! Tests of the whole analysis; those of single checks stand with the checks.

mod listings;
mod meaning;
mod robustness;
