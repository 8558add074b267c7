//! Every operation on intervals contains the operation on points inside them.
//!
//! Rounding is monotone, so where an operation rounds correctly the rounded value of a point lies in the
//! interval if the true one does; library functions are within an ulp of the true value, for which the
//! enclosure has room. Containment of true values is tested exactly on dyadic rationals, where it can be
//! computed, and against 30 digits in `elementary_reference.rs`.

use proptest::prelude::*;
use sophy_segment::Interval;

/// A name, the operation on intervals and the one on points.
type Unary = (&'static str, fn(Interval) -> Interval, fn(f64) -> f64);
type Binary = (&'static str, fn(Interval, Interval) -> Interval, fn(f64, f64) -> f64);

const UNARY: &[Unary] = &[
    ("neg", |x| -x, |x| -x),
    ("square", Interval::square, |x| x * x),
    ("sqrt", Interval::sqrt, f64::sqrt),
    ("abs", Interval::abs, f64::abs),
    ("floor", Interval::floor, f64::floor),
    ("sign", Interval::sign, |x| if x == 0.0 { 0.0 } else { x.signum() }),
    ("exp", Interval::exp, libm::exp),
    ("ln", Interval::ln, libm::log),
    ("log10", Interval::log10, libm::log10),
    ("sin", Interval::sin, libm::sin),
    ("cos", Interval::cos, libm::cos),
    ("tan", Interval::tan, libm::tan),
    ("asin", Interval::asin, libm::asin),
    ("acos", Interval::acos, libm::acos),
    ("atan", Interval::atan, libm::atan),
    ("sinh", Interval::sinh, libm::sinh),
    ("cosh", Interval::cosh, libm::cosh),
    ("tanh", Interval::tanh, libm::tanh),
    ("asinh", Interval::asinh, libm::asinh),
    // libm returns numbers for some arguments below 1
    ("acosh", Interval::acosh, |x| if x < 1.0 { f64::NAN } else { libm::acosh(x) }),
    ("atanh", Interval::atanh, libm::atanh),
];

const BINARY: &[Binary] = &[
    ("add", |a, b| a + b, |a, b| a + b),
    ("sub", |a, b| a - b, |a, b| a - b),
    ("mul", |a, b| a * b, |a, b| a * b),
    ("div", |a, b| a / b, |a, b| a / b),
    ("min", Interval::min, f64::min),
    ("max", Interval::max, f64::max),
    ("pow", Interval::pow, libm::pow),
    ("atan2", Interval::atan2, libm::atan2),
    ("hull", Interval::hull, |a, _| a),
];

/// Doubles of all sizes, with the places where functions turn.
fn number() -> impl Strategy<Value = f64> {
    prop_oneof![
        6 => -4.0..4.0,
        2 => -50.0..50.0,
        1 => prop::sample::select(vec![0.0, -0.0, 1.0, -1.0, 2.0, 0.5, std::f64::consts::FRAC_PI_2, std::f64::consts::PI]),
        1 => (-300.0..300.0, prop::bool::ANY).prop_map(|(e, negative)| {
            let x = libm::pow(10.0, e);
            if negative { -x } else { x }
        }),
        1 => prop::num::f64::NORMAL,
    ]
}

/// An interval and a point inside it, often an end.
fn interval_and_point() -> impl Strategy<Value = (Interval, f64)> {
    (number(), number(), 0.0..=1.0, 0..6).prop_map(|(a, b, part, kind): (f64, f64, f64, i32)| match kind {
        0 => (Interval::point(a), a),
        1 => (Interval::new(a, b), b),
        2 => (Interval::new(a, a + part * 1e-3), a),
        _ => {
            let x = Interval::new(a, b);
            let inside = (x.lo * (1.0 - part) + x.hi * part).clamp(x.lo, x.hi);
            (x, inside)
        }
    })
}

/// Failures are not written into the source tree; a case worth keeping becomes a test of its own.
fn cases(cases: u32) -> ProptestConfig {
    ProptestConfig { cases, failure_persistence: None, ..ProptestConfig::default() }
}

proptest! {
    #![proptest_config(cases(20_000))]

    #[test]
    fn functions_of_one_argument((x, p) in interval_and_point()) {
        for (name, on_interval, on_point) in UNARY {
            let (image, value) = (on_interval(x), on_point(p));
            prop_assert!(!image.lo.is_nan() && !image.hi.is_nan() && image.lo <= image.hi, "{name} {x:?} {image:?}");
            prop_assert!(value.is_nan() || image.contains(value), "{name} {x:?} {p} {image:?} {value}");
        }
    }

    #[test]
    fn functions_of_two_arguments((x, p) in interval_and_point(), (y, q) in interval_and_point()) {
        for (name, on_interval, on_point) in BINARY {
            // a power with an integer exponent is a product, whose float chain differs from `pow`
            if *name == "pow" && (q.fract() == 0.0 || y.contains(q.floor())) {
                continue;
            }
            let (image, value) = (on_interval(x, y), on_point(p, q));
            prop_assert!(!image.lo.is_nan() && !image.hi.is_nan() && image.lo <= image.hi, "{name} {x:?} {y:?} {image:?}");
            prop_assert!(value.is_nan() || image.contains(value), "{name} {x:?} {y:?} {p} {q} {image:?} {value}");
        }
    }

    /// A chain of operations applied to an interval contains the same chain applied to a point.
    #[test]
    fn compositions(
        start in interval_and_point(),
        chain in prop::collection::vec((0..UNARY.len(), 0..BINARY.len(), interval_and_point()), 1..8),
    ) {
        let (mut x, mut p) = start;
        for (unary, binary, (y, q)) in chain {
            let (name, on_interval, on_point) = BINARY[binary];
            if name != "pow" {
                (x, p) = (on_interval(x, y), on_point(p, q));
            }
            let (_, on_interval, on_point) = UNARY[unary];
            (x, p) = (on_interval(x), on_point(p));
            if !p.is_finite() {
                return Ok(());
            }
            prop_assert!(x.contains(p), "{x:?} {p}");
        }
    }

    /// On numbers n/2^10 with |n| < 2^20 sums, products and powers are exact in integers.
    #[test]
    fn exact_arithmetic(a in -(1_i64 << 20)..(1_i64 << 20), b in -(1_i64 << 20)..(1_i64 << 20), n in 0_i32..6) {
        let unit = 1024.0;
        let (x, y) = (Interval::point(a as f64 / unit), Interval::point(b as f64 / unit));
        prop_assert_eq!(x + y, Interval::point((a + b) as f64 / unit));
        prop_assert_eq!(x * y, Interval::point((a * b) as f64 / (unit * unit)));
        // |a|^n < 2^100: compare with the integer ends of the enclosure, scaled back
        let scale = (0..n).fold(1.0, |s, _| s * unit);
        let power = x.powi(n);
        let exact = i128::from(a).pow(n as u32);
        prop_assert!((power.lo * scale) as i128 <= exact && exact <= (power.hi * scale) as i128);
        // q.lo·b ≤ a ≤ q.hi·b for b > 0, products of 53 and 20 bits
        if b > 0 {
            let q = x / y;
            let fixed = |v: f64| (v * (1_i64 << 50) as f64) as i128;
            let inexact = a % b != 0;
            prop_assert!(!inexact || (fixed(q.lo) - 1) * i128::from(b) <= i128::from(a) << 50);
            prop_assert!((fixed(q.hi) + 1) * i128::from(b) >= i128::from(a) << 50);
            prop_assert!(q.lo == q.hi || q.lo.next_up() == q.hi);
        }
    }

    /// A quotient is within the neighbouring doubles and exact exactly when the division is.
    #[test]
    fn enclosures_of_points_are_tight(a in 1_i64..(1 << 53), b in 1_i64..(1 << 53)) {
        let (x, y) = (Interval::point(a as f64), Interval::point(b as f64));
        for image in [x + y, x - y, x * y, x / y, x.sqrt()] {
            prop_assert!(image.lo == image.hi || image.lo.next_up() == image.hi);
        }
        let product = i128::from(a) * i128::from(b);
        let (lo, hi) = ((x * y).lo as i128, (x * y).hi as i128);
        prop_assert!(lo <= product && product <= hi && (lo == hi) == (lo == product && hi == product));
    }
}

#[test]
fn waves_over_random_widths_contain_dense_samples() {
    for k in 0..400 {
        let lo = -20.0 + f64::from(k) * 0.1;
        for width in [0.01, 0.5, 1.5, 3.0, 4.0, 6.0] {
            let x = Interval::new(lo, lo + width);
            let (sin, cos) = (x.sin(), x.cos());
            let (mut least, mut greatest) = (1.0_f64, -1.0_f64);
            for i in 0..=200 {
                let t = lo + width * f64::from(i) / 200.0;
                assert!(sin.contains(libm::sin(t)) && cos.contains(libm::cos(t)), "{x:?} {t}");
                (least, greatest) = (least.min(libm::sin(t)), greatest.max(libm::sin(t)));
            }
            // and hardly more than that
            assert!(sin.lo > least - 1e-3 && sin.hi < greatest + 1e-3, "{x:?}");
        }
    }
}
