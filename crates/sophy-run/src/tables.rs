//! What to say of tables that are read outside of their range.

use sophy_ir::arithmetic::locate;
use sophy_ir::{Column, Graph, Leaf, Node, NodeId, Value, evaluate};

/// The range of knots: `0 … 10`.
pub(crate) fn range_text(column: &Column) -> String {
    let ends = column.numbers.first().zip(column.numbers.iter().rfind(|knot| knot.is_finite()));
    match ends {
        Some((first, _)) if column.numbers.last() == Some(&f64::INFINITY) => format!("from {first} on"),
        Some((first, last)) => format!("{first} … {last}"),
        None => "empty".to_owned(),
    }
}

/// A sentence for every table below an expression whose argument is outside of its range.
pub(crate) fn outside(graph: &Graph, root: NodeId, leaf: &mut impl FnMut(Leaf) -> Value) -> Vec<String> {
    let mut sentences = Vec::new();
    if graph.columns().is_empty() {
        return sentences;
    }
    for id in graph.reachable([root]) {
        let Node::Locate(column, at) = graph.node(id) else { continue };
        let x = evaluate(graph, at, leaf).real();
        let Some(knots) = graph.columns().get(column.position()) else { continue };
        if x.is_finite() && locate(&knots.numbers, x).is_nan() {
            let (name, range) = (&knots.name, range_text(knots));
            sentences.push(format!("`{name}` is read at {x}, outside of its range, {range}"));
        }
    }
    sentences
}
