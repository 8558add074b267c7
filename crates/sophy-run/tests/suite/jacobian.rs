//! The Jacobian of a run against symbolic derivatives and difference quotients, on random smooth systems.

use crate::support::{by, to};
use proptest::prelude::*;
use sophy_field::SourceIndex;
use sophy_ir::{Binary, Leaf, NodeId, Unary, Value, evaluate};
use sophy_run::{Experiment, Method, Run, Signal};
use sophy_testkit::Build;
use std::sync::Arc;

/// A smooth and bounded expression of some leaves.
fn smooth(b: &mut Build, leaves: &[NodeId], steps: &[(u8, u8, u8)]) -> NodeId {
    let mut nodes = leaves.to_vec();
    let one = b.number(1.5);
    for &(operation, i, j) in steps {
        let (x, y) = (nodes[usize::from(i) % nodes.len()], nodes[usize::from(j) % nodes.len()]);
        let node = match operation % 9 {
            0 => b.add(x, y),
            1 => b.sub(x, y),
            2 | 3 => {
                let product = b.mul(x, y);
                b.unary(Unary::Tanh, product)
            }
            4 => b.unary(Unary::Sin, x),
            5 => b.unary(Unary::Atan, x),
            6 => {
                let square = b.graph().integer_power(y, 2);
                let below = b.add(square, one);
                b.div(x, below)
            }
            7 => {
                let square = b.graph().integer_power(x, 2);
                let inside = b.add(square, one);
                b.unary(Unary::Sqrt, inside)
            }
            _ => {
                let sine = b.unary(Unary::Cos, y);
                let base = b.add(sine, one);
                let exponent = b.unary(Unary::Tanh, x);
                b.binary(Binary::Power, base, exponent)
            }
        };
        nodes.push(node);
    }
    nodes[nodes.len() - 1]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(150))]

    #[test]
    fn the_jacobian_is_that_of_the_expressions(
        rates in prop::collection::vec(prop::collection::vec(any::<(u8, u8, u8)>(), 1..10), 2),
        initial in [-2.0f64..2.0, -2.0f64..2.0],
        input in -2.0f64..2.0,
        first_order in prop::bool::ANY,
        until in 0.0f64..0.5,
    ) {
        let mut b = Build::default();
        b.component("");
        let (x1, x2) = (b.state("x1", initial[0]), b.state("x2", initial[1]));
        let (u, p) = (b.input("u"), b.parameter("p", 0.7));
        let names = [x1, x2, u].map(Leaf::Variable);
        let here = b.location("all");
        let leaves = [b.read(x1), b.read(x2), b.read(u), b.time(), p];
        let right: Vec<NodeId> = rates.iter().map(|steps| smooth(&mut b, &leaves, steps)).collect();
        b.rate(here, x1, right[0]);
        b.rate(here, x2, right[1]);
        let method = if first_order { Method::Qss1 } else { Method::Qss2 };
        let experiment = Experiment {
            inputs: vec![("u".to_owned(), Signal::constant(input))],
            ..by(method, to(1.0, 1e-2))
        };
        let system = Arc::new(sophy_passes::lower(&b.model()).expect("lowers"));
        let mut run = Run::new(system, &experiment).expect("starts");
        run.advance(until, u64::MAX).expect("goes on");
        let values = [run.state(sophy_field::StateIndex(0)), run.state(sophy_field::StateIndex(1)), input, until];
        let leaf = |values: [f64; 4]| move |leaf: Leaf| Value::Real(match leaf {
            Leaf::Time => values[3],
            other => names.iter().position(|&name| name == other).map_or(0.7, |k| values[k]),
        });
        let jacobian = run.jacobian();
        let mut graph = b.graph().clone();
        for (row, &node) in right.iter().enumerate() {
            for column in 0..4 {
                let name = names.get(column).copied().unwrap_or(Leaf::Time);
                let symbolic = graph.derivative(node, name);
                let symbolic = symbolic.map(|d| evaluate(&graph, d, &mut leaf(values)).real());
                let found = jacobian
                    .iter()
                    .find(|e| e.0.0 as usize == row && e.1 == SourceIndex(column as u32))
                    .map(|e| e.2);
                let (exact, found) = (symbolic.unwrap_or(0.0), found.unwrap_or(0.0));
                prop_assert!((exact - found).abs() < 1e-11 * (1.0 + exact.abs()), "{row} {column}: {found} for {exact}");
                let at = |h: f64| {
                    let mut values = values;
                    values[column] += h;
                    evaluate(&graph, node, &mut leaf(values)).real()
                };
                let h = 1e-4;
                let quotient = (at(-2.0 * h) - 8.0 * at(-h) + 8.0 * at(h) - at(2.0 * h)) / (12.0 * h);
                prop_assert!((quotient - found).abs() < 1e-6 * (1.0 + found.abs()), "{row} {column}: {found} for {quotient}");
            }
        }
    }
}
