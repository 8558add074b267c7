//! Nothing is allocated on the way of an event, once every buffer has its size.

use crate::support::{METHODS, by, is_first_order, to};
use allocation_counter::measure;
use sophy_ir::Model;
use sophy_run::{Backend, Experiment, Pause, Run};
use sophy_testkit::problems::{Hopper, oscillator, two_timers};
use sophy_testkit::stiff::{AdvectionReaction, LcLine, Smooth, stiff_pair};
use std::sync::Arc;

#[test]
fn no_event_allocates() {
    let systems: [(&str, Model, f64, f64); 6] = [
        ("hopper", Hopper::TAU40.model(), 100.0, 1e-3),
        ("events", two_timers(), 120.0, 1e-3),
        ("oscillator", oscillator(), 100.0, 1e-4),
        ("stiff pair", stiff_pair(), 500.0, 1e-3),
        ("LC line", LcLine(20).model(), 20.0, 1e-3),
        ("front", AdvectionReaction(200).model(), 0.1, 1e-3),
    ];
    for (name, model, stop, quantum) in systems {
        let system = Arc::new(sophy_passes::lower(&model).unwrap());
        for method in METHODS {
            // An explicit method of first order would take too long on what is stiff.
            let quantum = if is_first_order(method) { 10.0 * quantum } else { quantum };
            for backend in [Backend::Interpreter, Backend::Native] {
                let experiment = Experiment { backend, ..by(method, to(stop, quantum)) };
                let mut run = Run::new(Arc::clone(&system), &experiment).unwrap();
                run.journal.stop();
                let mut advance = |until: f64| {
                    // Whoever records takes them at each pause.
                    run.taken.clear();
                    assert_eq!(run.advance(until, u64::MAX).unwrap(), Pause::Reached);
                    run.statistics().engine.rates
                };
                let before = advance(0.6 * stop);
                let mut after = before;
                let info = measure(|| after = advance(stop));
                assert!(after > before, "{name} by {method:?}");
                assert_eq!(info.count_total, 0, "{name} by {method:?}, {backend:?}: {info:?}");
            }
        }
    }
}
