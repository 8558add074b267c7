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

/// Bytes per state of a ring of cells, held when nothing is to be recorded, and at the peak.
fn bytes(method: Method) -> [isize; 2] {
    const CELLS: usize = 20_000;
    let world = MemoryWorld::default().with("ring.hsml", ring_text(CELLS));
    let quanta = vec![QuantumRule { pattern: "*".to_owned(), quantum: Quantum::absolute(1e-3) }];
    let experiment = Experiment { method, quanta, ..Experiment::default() };
    let before = LIVE.get();
    MOST.set(before);
    let model = load(&world, Path::new("ring.hsml")).model.unwrap();
    let system = Arc::new(sophy_passes::lower(&model).unwrap());
    let mut run = sophy_run::Run::new(system, &experiment).unwrap();
    run.journal.stop();
    let states = run.system().states.len() as isize;
    assert_eq!(states, 3 * CELLS as isize);
    [LIVE.get(), MOST.get()].map(|bytes| (bytes - before) / states)
}

/// With the model, the system and the run; a copy stores nothing that its class knows.
#[test]
fn a_state_of_a_copy_costs_few_bytes() {
    for (method, limits) in [(Method::Qss2, [190, 700]), (Method::Liqss2, [255, 700])] {
        let found = bytes(method);
        assert!(
            found[0] <= limits[0] && found[1] <= limits[1],
            "{method:?}: {found:?} B per state, {limits:?} allowed"
        );
        // A limit that has become generous holds nothing.
        assert!(2 * found[0] > limits[0], "{method:?}: {found:?} B per state, {limits:?} allowed");
    }
}
