//! Size is no reason to fall over.

use crate::support::{to, try_run};
use sophy_ir::{Binary, NodeId, Unary};
use sophy_testkit::Build;

/// Sums and conditions of many thousand parts on a thread with a small stack.
#[test]
fn long_chains_need_no_stack() {
    let body = || {
        let mut b = Build::default();
        b.component("");
        let x = b.state("x", 0.0);
        let read = b.read(x);
        let (here, there) = (b.location("here"), b.location("there"));
        let zero = b.number(0.0);
        let t = b.time();
        let mut sum = b.number(0.0);
        let mut guard = b.graph().boolean(true);
        for k in 1..=20_000 {
            let k = b.number(f64::from(k) / 200_010_000.0);
            let term = b.mul(k, t);
            sum = b.add(sum, term);
            if let Some(index) = b.graph().as_number(k)
                && index < 1e-6
            {
                let part = b.greater(read, k);
                guard = b.graph().and(guard, part);
            }
        }
        b.rate(here, x, sum);
        b.rate(there, x, zero);
        b.when(here, "over", guard, there, &[]);
        let result = try_run(&b.model(), &to(1.0, 1e-2)).expect("runs");
        // The terms add up to t, and x = t²/2 is past 1e-6 at once.
        assert_eq!(result.events.len(), 1);
        assert!(result.events[0].time < 2e-3);
    };
    let thread = std::thread::Builder::new().stack_size(512 * 1024).spawn(body).expect("spawns");
    thread.join().expect("does not overflow");
}

/// |…||x| − 1| − 1 …| shares what its branches have in common; min(min(min(…))) does not and is refused.
#[test]
fn switches_that_nest_too_deep_are_refused() {
    let nested = |levels: u32, fold: fn(&mut Build, NodeId, NodeId) -> NodeId| {
        let mut b = Build::default();
        b.component("");
        let x = b.state("x", 1.0);
        let read = b.read(x);
        let here = b.location("here");
        let mut rate = read;
        for k in 0..levels {
            let k = b.number(f64::from(k % 3) - 1.0);
            rate = fold(&mut b, rate, k);
        }
        b.rate(here, x, rate);
        try_run(&b.model(), &to(0.1, 1e-2))
    };
    let abs = |b: &mut Build, rate, k| {
        let size = b.unary(Unary::Abs, rate);
        b.sub(size, k)
    };
    let min = |b: &mut Build, rate, k| {
        let sum = b.add(rate, k);
        b.binary(Binary::Min, sum, k)
    };
    assert!(nested(30, abs).is_ok());
    assert!(nested(30, min).is_ok());
    let Err(error) = nested(300, min) else { panic!("it should be refused") };
    assert!(error.to_string().contains("nest deeper than 256"), "{error}");
}
