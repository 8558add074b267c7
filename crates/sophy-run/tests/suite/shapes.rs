//! Many equal equations: one program for all of them, the same bits, and work that grows with the states.

use crate::support::to;
use sophy_codegen::{Compiled, Parameters, Sharing, compile, compile_sharing};
use sophy_field::{Changes, Engine, Journal, SourceIndex, Start, StateIndex, Statistics, Stop};
use sophy_hybrid::{Control, Taken};
use sophy_ir::{System, Value, evaluate};
use sophy_passes::lift_kinks;
use sophy_run::{Pause, Run};
use sophy_solvers::{Qss2, Quantum, Settings};
use sophy_testkit::Build;
use sophy_testkit::cells::{distinct, ring};
use std::sync::Arc;

fn lifted(mut system: System) -> System {
    lift_kinks(&mut system);
    system.verify().expect("sound");
    system
}

fn compiled(system: &System, sharing: Sharing) -> Compiled {
    compile_sharing(system, &Parameters::new(), 2, sharing).expect("compiles")
}

/// The bits of all states at the end, the transitions taken, and the work.
type Trace = (Vec<u64>, Vec<Taken>, Statistics);

fn play(system: &System, sharing: Sharing, until: f64) -> Trace {
    let Compiled { equations, logic, .. } = compiled(system, sharing);
    let settings = Settings::for_span(vec![Quantum::absolute(1e-2); system.states.len()], until);
    let mut engine: Box<dyn Engine> = Box::new(Qss2::new(&equations, settings));
    let mut control = Control::new(&logic);
    let (mut journal, mut taken) = (Journal::default(), Vec::new());
    let initial = |s: sophy_ir::State| {
        evaluate(&system.graph, s.initial.expect("given"), &mut |_| Value::Real(f64::NAN)).real()
    };
    let states: Vec<f64> = system.states.iter().map(initial).collect();
    let locations: Vec<_> = system.automata.iter().map(|a| a.kind.initial).collect();
    let start = Start { time: 0.0, states: &states, inputs: &[], locations: &locations };
    engine.start(&equations, &start, &mut journal).expect("starts");
    let mut time = 0.0;
    loop {
        let nothing = Changes::default();
        control
            .react(engine.as_mut(), &equations, &logic, time, &nothing, &mut journal, &mut taken)
            .expect("reacts");
        match engine.advance(&equations, until, u64::MAX, &mut journal).expect("goes on") {
            Stop::Crossed(at) => time = at,
            _ => break,
        }
    }
    let bits = (0..system.states.len()).map(|s| engine.value(SourceIndex(s as u32), until).to_bits());
    (bits.collect(), taken, engine.statistics())
}

#[test]
fn programs_do_not_multiply_with_copies() {
    for events in [false, true] {
        let programs = |count| {
            let equations = compiled(&lifted(ring(count, events)), Sharing::Usual).equations;
            let absolute =
                equations.blocks.iter().filter(|b| b.call.program > 0 && b.call.operands.is_empty());
            (equations.programs.len(), absolute.count())
        };
        let few = programs(20);
        assert_eq!(programs(6667), few, "20 001 states need the programs of 60");
        assert!(few.0 <= 16, "{few:?}");
        assert_eq!(few.1, 0, "all copies are equal");
    }
}

#[test]
fn sharing_does_not_change_a_bit() {
    let system = lifted(ring(6667, true));
    let own = play(&system, Sharing::Never, 0.6);
    assert!(own.1.len() > 100, "{} transitions", own.1.len());
    assert!(own.2.steps > 20_000);
    let shared = play(&system, Sharing::Usual, 0.6);
    assert!(own == shared);

    let mut run = Run::new(Arc::new(system), &to(0.6, 1e-2)).expect("starts");
    while run.advance(0.6, u64::MAX).expect("goes on") == Pause::Budget {}
    let states = (0..run.system().states.len()).map(StateIndex::new);
    let bits: Vec<u64> = states.map(|s| run.state(s).to_bits()).collect();
    assert!(bits == own.0);
    assert!(run.taken == own.1);

    let small = lifted(ring(5, true));
    let own = play(&small, Sharing::Never, 30.0);
    assert!(own == play(&small, Sharing::Usual, 30.0));
    assert!(own == play(&small, Sharing::Always, 30.0));
}

#[test]
fn different_equations_keep_programs_of_their_own() {
    let system = distinct(300);
    let equations = compiled(&system, Sharing::Usual).equations;
    assert!(equations.programs.len() >= 300, "{}", equations.programs.len());
    assert!(play(&system, Sharing::Never, 1.0) == play(&system, Sharing::Always, 1.0));
}

/// What parts of a guard share is written several times: a guard that would double 40 times is refused.
#[test]
fn a_guard_that_would_grow_without_end_is_refused() {
    let mut b = Build::default();
    b.component("");
    let x = b.state("x", 0.0);
    let (read, here) = (b.read(x), b.location("all"));
    let one = b.number(1.0);
    b.rate(here, x, one);
    let mut guard = b.greater(read, one);
    for k in 2..42 {
        let limit = b.number(f64::from(k));
        let above = b.greater(read, limit);
        let graph = b.graph();
        let not = graph.not(guard);
        guard = graph.select(above, not, guard);
    }
    b.when(here, "parity", guard, here, &[]);
    let system = sophy_passes::lower(&b.model()).expect("lowers");
    let error = compile(&system, &Parameters::new(), 2).expect_err("is refused");
    assert!(error.to_string().contains("`parity` has more than 65536 conditions"), "{error}");
}

/// One component with many states: no program is as long as the model.
#[test]
fn programs_stay_short_in_a_large_component() {
    let compiled = compile(&distinct(5000), &Parameters::new(), 2).expect("compiles");
    let longest = compiled.equations.programs.iter().map(|p| p.instructions.len()).max();
    assert!(longest < Some(100), "{longest:?}");
}
