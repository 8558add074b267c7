//! What a tolerance is worth: the global error of the examples, against solutions that no engine of ours computed, is at
//! most ten times the tolerance.
//!
//! `SOPHY_ACCURACY= cargo test -p sophy-sim --test accuracy tables -- --nocapture` prints the tables of
//! `docs/book/accuracy.md`, in some minutes; `SOPHY_ACCURACY=hopper` the rows of the hopper.

#![allow(clippy::expect_used, clippy::panic, reason = "a test stops at the first surprise")]

mod accuracy {
    pub(crate) mod cases;
    pub(crate) mod ladder;
    pub(crate) mod measure;
    pub(crate) mod models;
    pub(crate) mod table;
}

use accuracy::cases::{Case, cases};
use accuracy::ladder::{climb, ladders};
use accuracy::measure::measure;
use sophy::Method;

/// Runs a case, and says what is wrong if its error is more than ten times the tolerance.
fn check(case: &Case, method: Method, tolerance: f64) -> Option<String> {
    let found = measure(case, method, tolerance);
    let wrong = found.error().is_nan() || found.error() > 10.0 * tolerance;
    wrong.then(|| format!("{} by {} at {tolerance:e}: {found:?}", case.name, method.name()))
}

/// All cases but the one whose errors grow a hundredfold: every encounter of two craft multiplies them.
fn well_behaved() -> Vec<Case> {
    let mut cases = cases();
    cases.retain(|case| case.name != "hovercraft, 20 s");
    assert!(cases.len() >= 14);
    cases
}

#[test]
fn errors_of_the_default_engine_are_of_the_size_of_the_tolerance() {
    let tolerances = |case: &Case| if case.heavy { &[1e-2, 1e-3][..] } else { &[1e-2, 1e-3, 1e-4, 1e-5] };
    let cases = well_behaved();
    let runs = cases.iter().flat_map(|case| tolerances(case).iter().map(move |&tolerance| (case, tolerance)));
    let wrong: Vec<String> =
        runs.filter_map(|(case, tolerance)| check(case, Method::Auto, tolerance)).collect();
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn errors_of_the_other_engines_are_of_the_size_of_the_tolerance() {
    let mut wrong = Vec::new();
    for case in well_behaved() {
        let tolerances = if case.heavy { &[1e-2][..] } else { &[1e-2, 1e-3, 1e-4] };
        for method in [Method::Qss3, Method::Liqss2, Method::Liqss3] {
            wrong.extend(tolerances.iter().filter_map(|&tolerance| check(&case, method, tolerance)));
        }
        // The last bounces are smaller than what a first order makes of the first ones.
        if !case.heavy && case.name != "bouncing ball" {
            wrong.extend(
                [Method::Qss1, Method::Liqss1].into_iter().filter_map(|method| check(&case, method, 1e-2)),
            );
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn the_tables_of_the_book() {
    if let Ok(part) = std::env::var("SOPHY_ACCURACY") {
        eprintln!("{}", accuracy::table::tables(&part));
    }
}

/// Ten times smaller quanta never cost more than twenty times the steps, and lose no transition: no states chase each
/// other. Engines go on to 1e-9, or until they have taken enough steps for a test.
#[test]
fn no_quantum_makes_states_chase_each_other() {
    const ENOUGH: u64 = 60_000;
    let engines = [Method::Qss1, Method::Qss2, Method::Qss3, Method::Liqss1, Method::Liqss2, Method::Liqss3];
    for ladder in ladders() {
        let explicit = |method: &Method| method.name().starts_with("qss");
        for method in engines.into_iter().filter(|method| !(ladder.stiff && explicit(method))) {
            let mut line = format!("{} by {}:", ladder.name, method.name());
            let mut before = u64::MAX / 20;
            for place in 1..=9 {
                let quantum = libm::pow(10.0, -f64::from(place));
                let (steps, events) = climb(&ladder, method, quantum);
                line += &format!(" {steps}");
                assert!(steps <= 20 * before, "{line} at {quantum:e}");
                assert!(events == ladder.events || place == 1, "{line}, {events} transitions at {quantum:e}");
                if steps > ENOUGH {
                    break;
                }
                before = steps;
            }
            eprintln!("{line}");
        }
    }
}
