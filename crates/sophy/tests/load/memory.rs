//! What a state costs in memory, from HSML to a run that is ready.

use sophy::{Experiment, MemoryWorld, Method, Quantum, QuantumRule, load};
use sophy_testkit::cells::ring_text;
use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;
use std::path::Path;
use std::sync::Arc;

struct Counting;

#[global_allocator]
static COUNTING: Counting = Counting;

thread_local! {
    /// Bytes that this thread has allocated at present, and the most so far: other tests run beside.
    static LIVE: Cell<isize> = const { Cell::new(0) };
    static MOST: Cell<isize> = const { Cell::new(0) };
}

fn count(more: isize) {
    // A thread that ends is not counted.
    let live = LIVE.try_with(|live| {
        live.set(live.get() + more);
        live.get()
    });
    let _ = MOST.try_with(|most| most.set(most.get().max(live.unwrap_or(0))));
}

#[allow(unsafe_code)]
// SAFETY: everything is passed on to the system's allocator; beside it only numbers are counted.
unsafe impl GlobalAlloc for Counting {
    // SAFETY: the caller's promises are those that the system's allocator asks for.
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        count(layout.size().cast_signed());
        // SAFETY: as above.
        unsafe { System.alloc(layout) }
    }

    // SAFETY: the caller's promises are those that the system's allocator asks for.
    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        count(-layout.size().cast_signed());
        // SAFETY: as above.
        unsafe { System.dealloc(pointer, layout) }
    }

    // SAFETY: the caller's promises are those that the system's allocator asks for.
    unsafe fn realloc(&self, pointer: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        // Both stand side by side while one is copied, where it cannot grow in place.
        count(size.cast_signed() - layout.size().cast_signed());
        // SAFETY: as above.
        unsafe { System.realloc(pointer, layout, size) }
    }
}

/// Copies in an array of components.
const COPIES: usize = 20_000;

/// Bytes per state, held by a run that records nothing and has gone on for a while, and at the peak before.
fn bytes(text: &str, method: Method) -> [isize; 2] {
    let world = MemoryWorld::default().with("model.hsml", text);
    let quanta = vec![QuantumRule { pattern: "*".to_owned(), quantum: Quantum::absolute(1e-3) }];
    let experiment = Experiment { method, quanta, ..Experiment::default() };
    let before = LIVE.get();
    MOST.set(before);
    let model = load(&world, Path::new("model.hsml")).model.unwrap();
    let system = Arc::new(sophy_passes::lower(&model).unwrap());
    let mut run = sophy_run::Run::new(system, &experiment).unwrap();
    run.journal.stop();
    assert!(matches!(run.advance(0.02, u64::MAX), Ok(sophy_run::Pause::Reached)));
    let states = run.system().states.len();
    assert!(states >= COPIES, "{states}");
    [LIVE.get(), MOST.get()].map(|bytes| (bytes - before) / states as isize)
}

/// A model of the benchmarks, with so many copies in its array as here.
fn large(name: &str) -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../benches/models").join(name);
    let text = std::fs::read_to_string(path).unwrap();
    text.replace("500", &COPIES.to_string()).replace("1..499", &format!("1..{}", COPIES - 1))
}

/// With the model, the system and the run; a copy stores nothing that its class knows.
#[test]
fn a_state_of_a_copy_costs_few_bytes() {
    let (ring, line) = (ring_text(COPIES), large("line.hsml"));
    let (reaction, neurons) = (large("reaction.hsml"), large("neurons.hsml"));
    let limits = [
        ("ring", &ring, [125, 190]),
        ("line", &line, [140, 210]),
        ("reaction", &reaction, [190, 250]),
        ("neurons", &neurons, [200, 280]),
    ];
    for (name, text, limits) in limits {
        for (method, limit) in [Method::Qss2, Method::Liqss2].into_iter().zip(limits) {
            let [found, peak] = bytes(text, method);
            println!("{name} {method:?}: {found} B per state, {peak} at the peak");
            assert!(found <= limit, "{name} {method:?}: {found} B per state, {limit} allowed");
            assert!(peak <= 1100, "{name} {method:?}: {peak} B per state at the peak");
            // A limit that has become generous holds nothing.
            assert!(5 * found > 4 * limit, "{name} {method:?}: {found} B per state, {limit} allowed");
        }
    }
}
