//! The first instant at which a guard holds, against known roots and against a slow exhaustive search on the
//! run's own segments.

use crate::support::{METHODS, by, run, to};
use proptest::prelude::*;
use sophy_ir::{Binary, Comparison, Graph, Leaf, Model, NodeId, Unary, Value, VariableId, evaluate};
use sophy_record::{Side, Trajectory};
use sophy_run::{AtEnd, Experiment, Interpolation, Method, Signal};
use sophy_testkit::Build;

const COMPARISONS: [Comparison; 4] =
    [Comparison::Less, Comparison::LessEqual, Comparison::Greater, Comparison::GreaterEqual];

fn methods() -> impl Strategy<Value = Method> {
    prop::sample::select(METHODS.to_vec())
}

/// Roots of a polynomial, with multiplicity: dyadic, some at the start, in close pairs, double or triple.
fn roots() -> impl Strategy<Value = Vec<f64>> {
    let place = prop_oneof![
        1 => Just(0.0),
        4 => (1u32..63).prop_map(|k| f64::from(k) / 16.0),
        2 => 0.01f64..3.9,
        1 => -2.0f64..-0.1,
        1 => 4.5f64..6.0,
    ];
    let group = (place, prop_oneof![3 => Just(1usize), 2 => Just(2), 1 => Just(3)], 0u32..4).prop_map(
        |(root, count, apart)| match (count, apart) {
            // Two that are close: 2⁻¹⁰ … 2⁻²⁴ apart.
            (2, k @ 1..) => vec![root, root + 1.0 / f64::from(1u32 << (3 + 7 * k))],
            _ => vec![root; count],
        },
    );
    prop::collection::vec(group, 1..4).prop_map(|groups| {
        let mut roots = groups.concat();
        roots.sort_by(f64::total_cmp);
        // At the start itself value, slope and curvature decide: at most a double root there.
        while roots.iter().filter(|&&root| root == 0.0).count() > 2 {
            roots.remove(roots.iter().position(|&root| root == 0.0).unwrap());
        }
        roots.truncate(5);
        roots
    })
}

/// When `factor·Π(t − root)` first has the wanted sign just right of a t ≥ 0; `None` if not before 4.
fn first_time(roots: &[f64], factor: f64, positive: bool) -> Option<f64> {
    let ahead = roots.iter().filter(|&&root| root > 0.0).count();
    let mut sign = if ahead % 2 == 0 { factor } else { -factor };
    if (sign > 0.0) == positive {
        return Some(0.0);
    }
    let mut k = 0;
    let future: Vec<f64> = roots.iter().copied().filter(|&root| root > 0.0).collect();
    while k < future.len() {
        let multiplicity = future[k..].iter().take_while(|&&root| root == future[k]).count();
        if multiplicity % 2 == 1 {
            sign = -sign;
        }
        if (sign > 0.0) == positive {
            return Some(future[k]).filter(|&t| t < 4.0);
        }
        k += multiplicity;
    }
    None
}

/// Two locations with the same motion; leaves the first when the guard holds.
fn watched(b: &mut Build, rates: &[(VariableId, NodeId)], guard: NodeId) {
    let (before, after) = (b.location("before"), b.location("after"));
    for place in [before, after] {
        for &(state, rate) in rates {
            b.rate(place, state, rate);
        }
    }
    b.when(before, "go", guard, after, &[]);
}

fn polynomial(roots: &[f64], factor: f64, comparison: Comparison, of_time: bool, mirrored: bool) -> Model {
    let mut b = Build::default();
    b.component("");
    let x = b.state("x", 0.0);
    let t = if of_time { b.time() } else { b.read(x) };
    let mut product = b.number(factor);
    for &root in roots {
        let root = b.number(root);
        let difference = b.sub(t, root);
        product = b.mul(product, difference);
    }
    let (zero, one) = (b.number(0.0), b.number(1.0));
    let guard = if mirrored {
        b.compare(comparison.mirrored(), zero, product)
    } else {
        b.compare(comparison, product, zero)
    };
    watched(&mut b, &[(x, one)], guard);
    b.model()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]

    /// x = t exactly, so that the roots are known: simple, double, triple, close together, at the start.
    #[test]
    fn polynomials_are_crossed_at_their_roots(
        roots in roots(),
        factor in prop_oneof![-3.0f64..-0.2, 0.2f64..3.0],
        comparison in prop::sample::select(COMPARISONS.to_vec()),
        method in methods(),
        of_time in prop::bool::ANY,
        mirrored in prop::bool::ANY,
    ) {
        let positive = matches!(comparison, Comparison::Greater | Comparison::GreaterEqual);
        let expected = first_time(&roots, factor, positive);
        let model = polynomial(&roots, factor, comparison, of_time, mirrored);
        let result = run(&model, &by(method, to(4.0, 1e-2)));
        let found: Vec<f64> = result.events.iter().map(|e| e.time).collect();
        match expected {
            None => prop_assert!(found.is_empty(), "{found:?}"),
            Some(t) => {
                prop_assert_eq!(found.len(), 1, "expected {}", t);
                prop_assert!((found[0] - t).abs() <= 1e-9 * (1.0 + t), "{} for {t}", found[0]);
            }
        }
    }

    /// The same in powers of t, as far as rounding of the coefficients leaves the roots where they are.
    #[test]
    fn polynomials_in_powers_are_crossed_at_their_roots(
        picked in prop::collection::btree_set(1u32..31, 1..5),
        comparison in prop::sample::select(COMPARISONS.to_vec()),
        method in methods(),
    ) {
        // Multiples of 1/8: all coefficients are exact.
        let roots: Vec<f64> = picked.into_iter().map(|k| f64::from(k) / 8.0).collect();
        let mut coefficients = vec![1.0];
        for root in &roots {
            coefficients.push(0.0);
            for k in (1..coefficients.len()).rev() {
                coefficients[k] -= root * coefficients[k - 1];
            }
        }
        let mut b = Build::default();
        b.component("");
        let x = b.state("x", 0.0);
        let t = b.read(x);
        let degree = roots.len() as i32;
        let mut sum = b.number(0.0);
        for (k, &c) in coefficients.iter().enumerate() {
            let c = b.number(c);
            let power = if k as i32 == degree { b.number(1.0) } else { b.graph().integer_power(t, degree - k as i32) };
            let term = b.mul(c, power);
            sum = b.add(sum, term);
        }
        let (zero, one) = (b.number(0.0), b.number(1.0));
        let guard = b.compare(comparison, sum, zero);
        watched(&mut b, &[(x, one)], guard);
        let positive = matches!(comparison, Comparison::Greater | Comparison::GreaterEqual);
        let expected = first_time(&roots, 1.0, positive);
        let found: Vec<f64> = run(&b.model(), &by(method, to(4.0, 1e-2))).events.iter().map(|e| e.time).collect();
        match expected {
            None => prop_assert!(found.is_empty(), "{found:?}"),
            Some(t) => {
                prop_assert_eq!(found.len(), 1, "expected {}", t);
                prop_assert!((found[0] - t).abs() <= 1e-9 * (1.0 + t), "{} for {t}", found[0]);
            }
        }
    }
}

/// A comparison of a function with a level: which function, which comparison, level.
type Atom = (u8, u8, f64);

/// A rotation x₁ = cos 2t, x₂ = sin 2t and an input, watched by a boolean combination of atoms.
struct Watched {
    model: Model,
    graph: Graph,
    leaves: [Leaf; 3],
    guard: NodeId,
}

fn rotation(atoms: &[Atom], joins: &[u8], guarded: bool) -> Watched {
    let mut b = Build::default();
    b.component("");
    let (x1, x2, u) = (b.state("x1", 1.0), b.state("x2", 0.0), b.input("u"));
    let [r1, r2, ru] = [x1, x2, u].map(|id| b.read(id));
    let comparisons: Vec<NodeId> = atoms.iter().map(|atom| comparison(&mut b, *atom, [r1, r2, ru])).collect();
    let mut guard = comparisons[0];
    for (&next, &join) in comparisons[1..].iter().zip(joins) {
        let graph = b.graph();
        guard = match join % 5 {
            0 | 1 => graph.and(guard, next),
            2 => graph.or(guard, next),
            3 => {
                let not = graph.not(next);
                graph.and(guard, not)
            }
            _ => {
                let not = graph.not(guard);
                graph.or(not, next)
            }
        };
    }
    let two = b.number(2.0);
    let (up, down) = (b.mul(two, r1), b.mul(two, r2));
    let down = b.unary(Unary::Negate, down);
    let never = b.graph().boolean(false);
    watched(&mut b, &[(x1, down), (x2, up)], if guarded { guard } else { never });
    Watched { model: b.model(), graph: b.graph().clone(), leaves: [x1, x2, u].map(Leaf::Variable), guard }
}

fn comparison(b: &mut Build, (function, comparison, level): Atom, [x1, x2, u]: [NodeId; 3]) -> NodeId {
    let t = b.time();
    let [half, three] = [0.5, 3.0].map(|n| b.number(n));
    let value = match function % 16 {
        0 => x1,
        1 => {
            let a = b.mul(half, x1);
            b.sub(a, x2)
        }
        2 => b.mul(x1, x2),
        3 => {
            let square = b.graph().integer_power(x1, 2);
            b.add(square, x2)
        }
        4 => {
            let inner = b.mul(three, x1);
            let sine = b.unary(Unary::Sin, inner);
            b.mul(sine, x2)
        }
        5 => {
            let growth = b.unary(Unary::Exp, x2);
            b.mul(growth, x1)
        }
        6 => {
            let shifted = b.add(x1, three);
            let root = b.unary(Unary::Sqrt, shifted);
            let root = b.sub(root, x2);
            b.sub(root, half)
        }
        7 => {
            let size = b.unary(Unary::Abs, x1);
            b.sub(size, x2)
        }
        8 => {
            let steps = b.mul(three, x2);
            let steps = b.unary(Unary::Floor, steps);
            let part = b.mul(half, steps);
            b.add(part, x1)
        }
        9 => b.binary(Binary::Min, x1, x2),
        10 => {
            let high = b.greater(x1, x2);
            let product = b.mul(x1, x2);
            b.graph().select(high, product, x2)
        }
        11 => {
            let drift = b.mul(half, t);
            let drift = b.sub(drift, half);
            b.mul(drift, x1)
        }
        12 => b.sub(x1, u),
        13 => {
            let product = b.mul(u, x2);
            b.add(product, x1)
        }
        14 => {
            let fast = b.mul(three, t);
            let sine = b.unary(Unary::Sin, fast);
            b.mul(sine, half)
        }
        _ => {
            let one = b.number(1.0);
            let below = b.add(three, x2);
            let quotient = b.div(x1, below);
            let quotient = b.mul(three, quotient);
            let largest = b.binary(Binary::Max, quotient, u);
            b.sub(one, largest)
        }
    };
    let level = b.number(level);
    b.compare(COMPARISONS[usize::from(comparison % 4)], value, level)
}

fn signal(values: &[f64], interpolation: Interpolation) -> Signal {
    Signal {
        times: (0..values.len()).map(|k| 0.375 * k as f64).collect(),
        values: values.to_vec(),
        interpolation,
        at_end: AtEnd::Hold,
        origin: "a test".to_owned(),
    }
}

/// The value of the signal just right of `t`.
fn sample(signal: &Signal, t: f64) -> f64 {
    let next = signal.times.partition_point(|&time| time <= t);
    let last = next - 1;
    match signal.interpolation {
        Interpolation::Linear if next < signal.times.len() => {
            let slope =
                (signal.values[next] - signal.values[last]) / (signal.times[next] - signal.times[last]);
            signal.values[last] + slope * (t - signal.times[last])
        }
        _ => signal.values[last],
    }
}

const STOP: f64 = 3.5;

impl Watched {
    fn holds(&self, trajectory: &Trajectory, signal: &Signal, t: f64) -> bool {
        let mut leaf = |leaf: Leaf| {
            Value::Real(match self.leaves.iter().position(|&l| l == leaf) {
                Some(2) => sample(signal, t),
                Some(state) => trajectory.value(state, t, Side::Right),
                None => t,
            })
        };
        evaluate(&self.graph, self.guard, &mut leaf).boolean()
    }

    /// The first time at which the guard holds, by sampling each segment densely and bisecting.
    fn search(&self, trajectory: &Trajectory, signal: &Signal) -> Option<f64> {
        let mut joints: Vec<f64> = (0..2).flat_map(|state| trajectory.starts(state)).collect();
        joints.extend(&signal.times);
        joints.push(STOP);
        joints.retain(|&t| t <= STOP);
        joints.sort_by(f64::total_cmp);
        joints.dedup();
        let mut low = 0.0;
        for pair in joints.windows(2) {
            for k in 0..=16 {
                // A little inside of the ends.
                let part = (f64::from(k) / 16.0).clamp(1e-7, 1.0 - 1e-7);
                let mut high = pair[0] + part * (pair[1] - pair[0]);
                if !self.holds(trajectory, signal, high) {
                    low = high;
                    continue;
                }
                while high - low > 1e-13 * (1.0 + high) {
                    let middle = low + 0.5 * (high - low);
                    if middle <= low || middle >= high {
                        break;
                    }
                    if self.holds(trajectory, signal, middle) {
                        high = middle;
                    } else {
                        low = middle;
                    }
                }
                return Some(high);
            }
        }
        None
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    /// The engine neither misses what the search finds nor finds what is not there.
    #[test]
    fn combinations_hold_first_where_an_exhaustive_search_says(
        atoms in prop::collection::vec((any::<u8>(), any::<u8>(), -1.2f64..1.2), 1..4),
        joins in prop::collection::vec(any::<u8>(), 3),
        method in methods(),
        quantum in 5e-3f64..4e-2,
        values in prop::collection::vec(-1.0f64..1.0, 9),
        linear in prop::bool::ANY,
    ) {
        let interpolation = if linear { Interpolation::Linear } else { Interpolation::Hold };
        let signal = signal(&values, interpolation);
        let experiment =
            Experiment { inputs: vec![("u".to_owned(), signal.clone())], ..by(method, to(STOP, quantum)) };
        let free = run(&rotation(&atoms, &joins, false).model, &experiment);
        let watched = rotation(&atoms, &joins, true);
        let result = run(&watched.model, &experiment);
        let found = result.events.first().map(|e| e.time);
        prop_assert!(result.events.len() <= 1);
        let expected = watched.search(&free.trajectory, &signal);
        let close = |a: f64, b: f64| (a - b).abs() <= 2e-9 * (1.0 + b);
        match (found, expected) {
            (None, None) => {}
            (Some(t), Some(s)) if close(t, s) => {}
            (Some(t), s) if s.is_none_or(|s| t < s) => {
                // Thinner than the samples: the guard must hold just after.
                let after = (1..2000).map(|k| t + 1e-12 * libm::pow(1.01, f64::from(k)));
                let real = after.into_iter().any(|t| watched.holds(&free.trajectory, &signal, t));
                prop_assert!(real, "found {t}, which is not there; the search says {s:?}");
            }
            (t, s) => {
                // Missed, unless it is a touch within rounding.
                let s = s.unwrap();
                let lasts = (1..100).all(|k| {
                    watched.holds(&free.trajectory, &signal, s + 1e-8 * f64::from(k) / 100.0)
                });
                prop_assert!(!lasts, "found {t:?}, the search says {s}");
            }
        }
    }
}

/// Both crossings of one quantity inside one segment, where the end shows nothing (thesis figure 8.2), at
/// random depths and places; a touch is none.
#[test]
fn double_crossings_inside_a_segment_are_found_and_touches_are_not() {
    for method in METHODS {
        for depth in [0.0, 1e-3, 1e-6, 1e-9, 1e-12] {
            for (k, middle) in [0.25, 1.0, 1.1, 2.0, 3.0625].into_iter().enumerate() {
                // (t − middle)² − depth < 0, not affine in t.
                let mut b = Build::default();
                b.component("");
                let x = b.state("x", 0.0);
                let t = b.read(x);
                let [middle_node, depth_node, one] = [middle, depth, 1.0].map(|n| b.number(n));
                let difference = b.sub(t, middle_node);
                let square = if k % 2 == 0 {
                    b.mul(difference, difference)
                } else {
                    b.graph().integer_power(difference, 2)
                };
                let guard = b.less(square, depth_node);
                watched(&mut b, &[(x, one)], guard);
                let events = run(&b.model(), &by(method, to(4.0, 1e-2))).events;
                if depth == 0.0 {
                    assert!(events.is_empty(), "{method:?} {middle}: {events:?}");
                } else {
                    assert_eq!(events.len(), 1, "{method:?} {middle} {depth:e}");
                    let exact = middle - depth.sqrt();
                    assert!((events[0].time - exact).abs() < 1e-9, "{}", events[0].time - exact);
                }
            }
        }
    }
}
