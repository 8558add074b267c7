//! From models to flat systems: what each pass leaves behind.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)] // a test may panic

use sophy_ir::{Comparison, Unary};
use sophy_passes::{FlattenError, PassError, lower};
use sophy_testkit::Build;
use sophy_testkit::problems::Hopper;

#[test]
fn the_text_form_of_the_hopper() {
    let system = lower(&Hopper::TAU40.model()).unwrap();
    let expected = "\
system 
  parameter g = 9.82
  parameter l = 0.5
  parameter tp = 0.1
  parameter tau = 40.0
  parameter gamma = 0.2
  parameter eta = 8.0
  state x0 y := 1.9
    der(y) = ydot
  state x1 ydot := 0.1
    Flight: der(ydot) = -g
    Compression: der(ydot) = eta / y - gamma * ydot - g
    Thrust: der(ydot) = tau - gamma * ydot - g
    Decompression: der(ydot) = eta2 / y - gamma * ydot - g
  state x2 timer := 0.0
    Flight: der(timer) = 0.0
    Compression: der(timer) = 0.0
    Thrust: der(timer) = 1.0
    Decompression: der(timer) = 0.0
  state x3 eta2 := 0.0
    der(eta2) = 0.0
  watch w0 y - l (affine)
  watch w1 ydot (affine)
  watch w2 timer - tp (affine)
  automaton a0 
    location Flight (initial)
      touchdown when (y < l) -> Compression
    location Compression
      bottom when (ydot > 0.0) -> Thrust
        timer := 0.0
    location Thrust
      timer when (timer > tp) -> Decompression
        eta2 := y * tau
      extended when (y > l) -> Decompression
        eta2 := y * tau
    location Decompression
      liftoff when (y > l) -> Flight
";
    assert_eq!(system.to_string(), expected);
}

/// `x < L`, `L > x` and `x − L < 0` are one surface and share one watch; so do `abs(x)` and `sign(x)`.
#[test]
fn equal_surfaces_share_a_watch() {
    let mut b = Build::default();
    b.component("");
    let x = b.state("x", 1.0);
    let read = b.read(x);
    let here = b.location("here");
    let limit = b.parameter("L", 0.5);
    let zero = b.number(0.0);
    let difference = b.sub(read, limit);
    let guards = [
        b.less(read, limit),
        b.greater(limit, read),
        b.less(difference, zero),
        b.compare(Comparison::GreaterEqual, read, limit),
    ];
    for (guard, name) in guards.into_iter().zip(["a", "b", "c", "d"]) {
        b.when(here, name, guard, here, &[]);
    }
    let (size, side) = (b.unary(Unary::Abs, read), b.unary(Unary::Sign, read));
    let rate = b.mul(size, side);
    b.rate(here, x, rate);
    let system = lower(&b.model()).unwrap();
    assert_eq!(system.watches.len(), 2, "{system}");
    assert!(system.watches.iter().all(|w| w.affine));
}

#[test]
fn what_is_lifted_passes_the_verifier_and_what_is_not_does_not() {
    let mut b = Build::default();
    b.component("");
    let x = b.state("x", 1.0);
    let read = b.read(x);
    let here = b.location("here");
    let rounded = b.unary(Unary::Floor, read);
    b.rate(here, x, rounded);
    let flat = sophy_passes::flatten(&b.model()).unwrap();
    assert!(flat.verify().is_err(), "floor is not smooth");
    let system = lower(&b.model()).unwrap();
    assert_eq!((system.stairs.len(), system.watches.len()), (1, 2));
}

/// Two components that feed each other's output straight through.
#[test]
fn an_algebraic_loop_between_components_is_named() {
    let mut b = Build::default();
    let mut ports = Vec::new();
    for name in ["left", "right"] {
        b.component(name);
        let (u, y) = (b.input("u"), b.output("y"));
        let read = b.read(u);
        let here = b.location("here");
        b.value(here, y, read);
        ports.push((u, y));
    }
    b.connect(ports[0].1, ports[1].0);
    b.connect(ports[1].1, ports[0].0);
    let Err(PassError::Flatten(error @ FlattenError::AlgebraicLoop(_))) = lower(&b.model()) else {
        panic!("a loop")
    };
    let names = error.names();
    assert!(names.contains(&"left.y") && names.contains(&"right.y"), "{names:?}");
    assert_eq!(names.first(), names.last());
}

/// A chain of parameters written in the wrong order, on a small stack; and a circle.
#[test]
fn parameters_are_sorted_without_recursion() {
    let chain = |last: Option<f64>| {
        let mut b = Build::default();
        b.component("");
        let count = 20_000;
        let parameters: Vec<_> = (0..count).map(|k| b.parameter(&format!("c{k}"), 0.0)).collect();
        let one = b.number(1.0);
        for (k, &parameter) in parameters.iter().enumerate() {
            let next = match (parameters.get(k + 1), last) {
                (Some(&next), _) => next,
                (None, Some(value)) => b.number(value),
                (None, None) => parameters[0],
            };
            let value = b.add(next, one);
            b.define_parameter(parameter, value);
        }
        b.location("here");
        std::thread::Builder::new()
            .stack_size(256 * 1024)
            .spawn(move || lower(&b.model()))
            .unwrap()
            .join()
            .unwrap()
    };
    let system = chain(Some(1.0)).unwrap();
    assert_eq!(system.parameters.len(), 20_000);
    assert_eq!(system.parameters[0].name, "c19999");
    assert!(matches!(chain(None), Err(PassError::Flatten(FlattenError::ParameterLoop(_)))));
}
