//! The first crossing of general functions equals known roots or a slow exhaustive search.

mod jet;

use std::f64::consts::{FRAC_PI_2, PI};

use jet::Jet;
use proptest::prelude::*;
use sophy_segment::{Interval, Search, Sign, Start, first_crossing};

type Value = dyn Fn(f64) -> f64;
type Function = dyn Fn(Jet) -> Jet;

const BUDGET: u32 = 20_000;

/// The search over a function written on jets.
fn search(g: impl Fn(Jet) -> Jet, from: f64, to: f64, start: Start) -> Search {
    first_crossing(&mut |t| g(Jet::variable(t)).0, from, to, start, BUDGET)
}

fn decided(sign: Sign) -> Start {
    Start { sign, on_surface: false }
}

fn on_surface(sign: Sign) -> Start {
    Start { sign, on_surface: true }
}

/// a Π (t − root), multiplied out; exact for the small rationals used here.
fn expanded(a: f64, roots: &[f64]) -> Vec<f64> {
    roots.iter().fold(vec![a], |c, r| {
        let mut product = vec![0.0; c.len() + 1];
        for (k, c) in c.iter().enumerate() {
            product[k + 1] += c;
            product[k] -= r * c;
        }
        product
    })
}

fn horner(coefficients: &[f64]) -> impl Fn(Jet) -> Jet {
    move |t| coefficients.iter().rev().fold(Jet::constant(0.0), |sum, &c| sum * t + Jet::constant(c))
}

fn factored(a: f64, roots: &[f64]) -> impl Fn(Jet) -> Jet {
    move |t| roots.iter().fold(Jet::constant(a), |product, &r| product * (t - Jet::constant(r)))
}

/// The sign of a Π (t − root) just right of `from`, and its first root of odd multiplicity in (from, to].
fn first_change(a: f64, roots: &[f64], from: f64, to: f64) -> (Sign, Option<f64>) {
    let right = roots.iter().filter(|&&r| r > from).count();
    let sign = if right.is_multiple_of(2) { Sign::of(a) } else { Sign::of(-a) };
    let odd = |r: f64| !roots.iter().filter(|&&q| q == r).count().is_multiple_of(2);
    let first = roots.iter().copied().filter(|&r| r > from && r < to && odd(r)).min_by(f64::total_cmp);
    (sign, first)
}

/// How far rounding of the expanded polynomial moves a root of multiplicity m: (noise / |g⁽ᵐ⁾/m!|)^(1/m).
fn blur(coefficients: &[f64], a: f64, roots: &[f64], root: f64) -> f64 {
    let size = coefficients.iter().rev().fold(0.0, |sum, c| sum * root.abs() + c.abs());
    let steepness: f64 = roots.iter().filter(|&&r| r != root).map(|r| (root - r).abs()).product();
    let multiplicity = roots.iter().filter(|&&r| r == root).count() as f64;
    libm::pow(64.0 * f64::EPSILON * size / (a.abs() * steepness), 1.0 / multiplicity) + 4.0 * f64::EPSILON
}

fn assert_near(found: Search, expected: Option<f64>, tolerance: f64) -> Result<(), TestCaseError> {
    match (found, expected) {
        (Search::None, None) => Ok(()),
        (Search::Crossing(t), Some(r)) if (t - r).abs() <= tolerance => Ok(()),
        _ => Err(TestCaseError::fail(format!("found {found:?}, expected {expected:?} ± {tolerance:e}"))),
    }
}

/// What a search over the expanded polynomial finds: multiplied out, a root of high multiplicity is a stretch of
/// rounding, and the first one in [from, …) may be told as that.
fn assert_near_expanded(
    found: Search,
    expected: Option<f64>,
    from: f64,
    a: f64,
    roots: &[f64],
) -> Result<(), TestCaseError> {
    let c = expanded(a, roots);
    let blurred = |since: f64, until: f64| {
        let high =
            |r: f64| roots.iter().filter(|&&q| q == r).count() > 4 && expected.is_none_or(|first| r <= first);
        let near = |r: f64| [since, until].iter().all(|t| (t - r).abs() <= blur(&c, a, roots, r));
        roots.iter().any(|&r| r >= from && high(r) && near(r))
    };
    match found {
        Search::Blurred(since, until) if blurred(since, until) => Ok(()),
        found => assert_near(found, expected, expected.map_or(0.0, |r| blur(&c, a, roots, r))),
    }
}

/// Roots in 16ths, often equal.
fn roots() -> impl Strategy<Value = Vec<f64>> {
    prop::collection::vec((-24_i32..24).prop_map(|n| f64::from(n) / 16.0), 1..7).prop_flat_map(|roots| {
        let repeats = prop::collection::vec(0..roots.len(), roots.len());
        (Just(roots), repeats, prop::bool::weighted(0.5)).prop_map(|(roots, repeats, repeat)| {
            if repeat { repeats.iter().map(|&i| roots[i]).collect() } else { roots }
        })
    })
}

fn factor() -> impl Strategy<Value = f64> {
    prop::sample::select(vec![-3.0, -1.0, -0.125, 0.125, 1.0, 3.0])
}

/// Failures are not written into the source tree; a case worth keeping becomes a test of its own.
fn cases(cases: u32) -> ProptestConfig {
    ProptestConfig { cases, failure_persistence: None, ..ProptestConfig::default() }
}

proptest! {
    #![proptest_config(cases(3000))]

    #[test]
    fn polynomials_with_known_roots(a in factor(), roots in roots(), from in -24_i32..24, length in 1_i32..48) {
        // windows that begin and end between possible roots
        let from = f64::from(from) / 16.0 + 1.0 / 32.0;
        let to = from + f64::from(length) / 16.0;
        let (sign, expected) = first_change(a, &roots, from, to);
        let c = expanded(a, &roots);
        assert_near_expanded(search(horner(&c), from, to, decided(sign)), expected, from, a, &roots)?;
        prop_assert_eq!(search(horner(&c), from, to, decided(sign.opposite())), Search::Crossing(from));
        // without cancellation the root is found to an ulp, whatever its multiplicity
        assert_near(search(factored(a, &roots), from, to, decided(sign)), expected, 4.0 * f64::EPSILON)?;
    }

    #[test]
    fn starting_on_a_root(a in factor(), roots in roots(), length in 1_i32..48) {
        let from = roots[0];
        let to = from + f64::from(length) / 16.0 + 1.0 / 32.0;
        let (sign, expected) = first_change(a, &roots, from, to);
        let c = expanded(a, &roots);
        assert_near_expanded(search(horner(&c), from, to, on_surface(sign)), expected, from, a, &roots)?;
        assert_near(search(factored(a, &roots), from, to, on_surface(sign)), expected, 4.0 * f64::EPSILON)?;
    }

    /// What rounding left of a located root, on either side, is not found again.
    #[test]
    fn starting_next_to_a_root(a in factor(), roots in roots(), multiplicity in prop::sample::select(vec![1_usize, 1, 3]), ulps in -3_i32..4, length in 1_i32..48) {
        let root = roots[0];
        // An even root located beside itself begins with the sign of its slope there, and so does a triple one
        // whose slope is lost in rounding.
        let others = roots.into_iter().filter(|&r| r != root);
        let roots: Vec<f64> = vec![root; multiplicity].into_iter().chain(others).collect();
        let step = root.abs().max(0.0625) * f64::EPSILON;
        let from = root + f64::from(ulps) * step;
        let to = root + f64::from(length) / 16.0 + 1.0 / 32.0;
        let (sign, expected) = first_change(a, &roots, root, to);
        if multiplicity == 1 {
            let c = expanded(a, &roots);
            assert_near_expanded(search(horner(&c), from, to, on_surface(sign)), expected, from, a, &roots)?;
        }
        assert_near(search(factored(a, &roots), from, to, on_surface(sign)), expected, 4.0 * f64::EPSILON)?;
    }

    /// Two roots 1e-6 apart and nearer, beside others.
    #[test]
    fn close_pairs(a in factor(), n in -20_i32..20, gap in 15_i32..24, others in prop::collection::vec(-8_i32..8, 0..3)) {
        let root = f64::from(n) / 16.0 + 1.0 / 32.0;
        let mut roots: Vec<f64> = others.into_iter().map(|n| f64::from(n) / 4.0).collect();
        roots.extend([root, root + libm::scalbn(1.0, -gap)]);
        let (from, to) = (-2.03, 2.04);
        let (sign, expected) = first_change(a, &roots, from, to);
        assert_near(search(factored(a, &roots), from, to, decided(sign)), expected, 4.0 * f64::EPSILON)?;
        // a pair in the middle of a window of its own
        let (from, to) = (root - 0.01, root + 0.013);
        let (sign, expected) = first_change(a, &roots, from, to);
        prop_assert_eq!(expected, Some(root));
        assert_near(search(factored(a, &roots), from, to, decided(sign)), expected, 4.0 * f64::EPSILON)?;
    }

    /// sin t dips above 1 − depth on a short interval around π/2 only.
    #[test]
    fn thin_double_crossings(exponent in -13.0..-2.0, from in -1.0..1.0, to in 2.0..7.0) {
        let level = 1.0 - libm::pow(10.0, exponent);
        let depth = 1.0 - level;
        let half_width = 2.0 * libm::asin((depth / 2.0).sqrt());
        let expected = FRAC_PI_2 - half_width;
        let found = search(|t| t.sin() - Jet::constant(level), from, to, decided(Sign::Negative));
        assert_near(found, Some(expected), 8.0 * f64::EPSILON / half_width)?;
        // and back
        let Search::Crossing(t) = found else { return Ok(()) };
        let back = search(|t| t.sin() - Jet::constant(level), t, to, on_surface(Sign::Positive));
        assert_near(back, (to > FRAC_PI_2 + half_width).then_some(FRAC_PI_2 + half_width), 8.0 * f64::EPSILON / half_width)?;
    }

    /// Double roots that are not at convenient numbers.
    #[test]
    fn touching_is_not_crossing(r in -1.0..1.0, scale in 0.01..10.0, from in -3.0..-1.0, to in 1.0..3.0, end in 1.0..9.0_f64) {
        let c = expanded(1.0, &[r, r]);
        // multiplied out the double root is off by rounding: either answer must be at the root
        match search(horner(&c), from, to, decided(Sign::Positive)) {
            Search::None => {}
            Search::Crossing(t) => prop_assert!((t - r).abs() < 1e-7),
            found => prop_assert!(false, "{:?}", found),
        }
        prop_assert_eq!(search(factored(scale, &[r, r]), from, to, decided(Sign::Positive)), Search::None);
        prop_assert_eq!(search(factored(scale, &[r, r, r, r]), from, to, decided(Sign::Positive)), Search::None);
        let touching = |t: Jet| (t.sin() - Jet::constant(1.0)) * Jet::constant(scale);
        prop_assert_eq!(search(touching, -end, end, decided(Sign::Negative)), Search::None);
        prop_assert_eq!(search(|t| (t - Jet::constant(r)).sin().square(), r - 1.0, r + end, decided(Sign::Positive)), Search::None);
    }

    #[test]
    fn random_functions(kind in 0..4, a in 0.2..9.0, b in -1.3..1.3, w in 0.5..20.0, from in -2.0..2.0, length in 0.1..6.0) {
        let (value, jet): (Box<Value>, Box<Function>) = match kind {
            0 => (
                Box::new(move |t| libm::sin(a * t) + b),
                Box::new(move |t| (Jet::constant(a) * t).sin() + Jet::constant(b)),
            ),
            1 => (
                Box::new(move |t| libm::exp(-t) * libm::cos(w * t) - b),
                Box::new(move |t| (-t).exp() * (Jet::constant(w) * t).cos() - Jet::constant(b)),
            ),
            2 => (
                Box::new(move |t| libm::sin(a * t) * libm::sin(w * t) - b),
                Box::new(move |t| (Jet::constant(a) * t).sin() * (Jet::constant(w) * t).sin() - Jet::constant(b)),
            ),
            _ => (
                Box::new(move |t| t * t * libm::exp(-a * t * t) - 0.1 * (1.0 + b)),
                Box::new(move |t| t.square() * (-(Jet::constant(a) * t.square())).exp() - Jet::constant(0.1 * (1.0 + b))),
            ),
        };
        let to = from + length;
        prop_assume!(value(from).abs() > 1e-6 && value(to).abs() > 1e-6);
        let sign = Sign::of(value(from));
        let Some(expected) = exhaustive(&value, from, to, 20_000) else { return Ok(()) };
        let slope = expected.map_or(1.0, |t| (value(t + 1e-7) - value(t - 1e-7)).abs() / 2e-7);
        let size = 1.0 + libm::exp(-from);
        assert_near(search(jet, from, to, decided(sign)), expected, 1e-15 + 32.0 * f64::EPSILON * size * w / slope.min(1.0))?;
    }
}

/// The first sign change of `f`, sampled densely; `None` if samples cannot tell because f comes close to 0
/// without changing sign.
fn exhaustive(f: &dyn Fn(f64) -> f64, from: f64, to: f64, samples: u32) -> Option<Option<f64>> {
    let h = (to - from) / f64::from(samples);
    let positive = f(from) > 0.0;
    // |f″| < 2000 for the functions above: between samples f moves by less than f″ h²/8 off its chord
    let sag = 2000.0 * h * h / 8.0;
    let mut nearest = f64::INFINITY;
    for i in 1..=samples {
        let t = from + h * f64::from(i);
        let y = f(t);
        if (y > 0.0) != positive {
            if nearest < sag {
                return None;
            }
            let (mut lo, mut hi) = (t - h, t);
            for _ in 0..80 {
                let middle = lo.midpoint(hi);
                if (f(middle) > 0.0) == positive { lo = middle } else { hi = middle }
            }
            return Some(Some(hi));
        }
        // samples on the way down to a crossing are near zero as well; only those that turn away count
        let next = f(t + h);
        if y.abs() < sag && next.abs() > y.abs() && (next > 0.0) == positive {
            nearest = nearest.min(y.abs());
        }
    }
    (nearest >= sag).then_some(None)
}

#[test]
fn conventions() {
    let square = |t: Jet| t.square();
    let zero = |_: Jet| Jet::constant(0.0);
    let falling = |t: Jet| -t;
    let table: [(&Function, f64, f64, Start, Search); 12] = [
        (&zero, 0.0, 1.0, decided(Sign::Zero), Search::None),
        (&zero, 0.0, 1.0, decided(Sign::Positive), Search::Crossing(0.0)),
        (&square, 0.0, 1.0, decided(Sign::Zero), Search::Crossing(0.0)),
        (&square, 1.0, 2.0, decided(Sign::Zero), Search::Crossing(1.0)),
        (&square, 0.0, 1.0, decided(Sign::Positive), Search::None),
        (&square, 0.0, 1.0, decided(Sign::Negative), Search::Crossing(0.0)),
        (&square, -1.0, 1.0, decided(Sign::Positive), Search::None),
        (&falling, 0.0, 1.0, on_surface(Sign::Positive), Search::Crossing(0.0)),
        (&falling, 0.0, 1.0, on_surface(Sign::Negative), Search::None),
        (&falling, -1.0, 1.0, decided(Sign::Positive), Search::Crossing(0.0)),
        (&falling, -1.0, 0.0, decided(Sign::Positive), Search::None),
        (&falling, -1.0, f64::INFINITY, decided(Sign::Positive), Search::Undecided(-1.0)),
    ];
    for (i, (g, from, to, start, expected)) in table.into_iter().enumerate() {
        assert_eq!(search(g, from, to, start), expected, "row {i}");
    }
}

/// A zero at the end of a window is found at the start of the next one, where the sign is remembered.
#[test]
fn a_zero_at_the_joint_of_two_windows() {
    let g = |t: Jet| t.sin();
    for joint in [PI.next_down(), PI, PI.next_up()] {
        let first = search(g, 1.0, joint, decided(Sign::Positive));
        let second = search(g, joint, 4.0, decided(Sign::Positive));
        let found = if first == Search::None { second } else { first };
        assert!(matches!(found, Search::Crossing(t) if (t - PI).abs() < 1e-15), "{first:?} {second:?}");
    }
}

#[test]
fn what_cannot_be_decided_is_said() {
    // zero to rounding, everywhere
    let cancelled = |t: Jet| (t + Jet::constant(0.1)).sin() - (t + Jet::constant(0.1)).sin();
    for sign in [Sign::Positive, Sign::Zero] {
        let found = search(cancelled, 0.0, 1.0, decided(sign));
        assert!(matches!(found, Search::Blurred(since, until) if since < 1e-9 && until > 1e-3), "{found:?}");
    }
    // not defined
    let undefined = |_: Jet| Jet([Interval::ENTIRE; 3]);
    assert_eq!(search(undefined, 0.0, 1.0, decided(Sign::Positive)), Search::Undecided(0.0));
    // no budget
    let wild = |t: Jet| {
        let wave = (Jet::constant(1e3) * t).sin();
        wave * wave + Jet::constant(0.1)
    };
    let found = first_crossing(&mut |t| wild(Jet::variable(t)).0, 0.0, 9.0, decided(Sign::Positive), 10);
    assert!(matches!(found, Search::Undecided(t) if t < 1.0), "{found:?}");
    assert_eq!(search(wild, 0.0, 0.5, decided(Sign::Positive)), Search::None);
}

/// On the surface to rounding, with a slope that is zero to rounding, the second derivative proves nothing:
/// here f = sin x − x falls no more where x = 2e-8, and is of third order at x = 0.
#[test]
fn a_slope_lost_in_rounding_is_not_a_slope_of_zero() {
    let x = |t: Jet| Jet::constant(0.9) * t * t - Jet::constant(1.8) * t + Jet::constant(2.1e-8);
    let g = |t: Jet| x(t).sin() - x(t);
    assert_eq!(search(g, 0.0, 1e-5, on_surface(Sign::Positive)), Search::None);
    assert!(matches!(search(g, 0.0, 1e-5, on_surface(Sign::Negative)), Search::Crossing(t) if t < 1e-7));
}

/// Ordinary windows take few boxes.
#[test]
fn few_boxes() {
    let mut calls = 0;
    let mut sine = |t| {
        calls += 1;
        (Jet::variable(t).sin() - Jet::constant(0.5)).0
    };
    let found = first_crossing(&mut sine, 0.0, 1.0, decided(Sign::Negative), 10);
    assert!(matches!(found, Search::Crossing(t) if (t - PI / 6.0).abs() < 1e-15));
    assert!(calls < 30, "{calls}");
}
