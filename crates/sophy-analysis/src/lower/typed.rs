use crate::units::Measured;
use sophy_ir::{NodeId, Quantity};
use std::fmt;
use std::rc::Rc;

/// A lowered expression: what it is and the nodes of its elements.
///
/// Elements of truth are boolean nodes, all others numbers; a text is its number in
/// [`sophy_ir::Model::texts`].
#[derive(Clone, Debug)]
pub(crate) struct Typed {
    /// Row by row.
    pub(crate) elements: Elements,
    pub(crate) shape: Shape,
    pub(crate) quantity: Quantity,
    /// What is known of its unit.
    pub(crate) measured: Measured,
    pub(crate) varies: Varies,
}

impl Typed {
    /// A single value.
    pub(crate) fn scalar(node: NodeId, quantity: Quantity, measured: Measured, varies: Varies) -> Self {
        Typed { elements: Elements::One(node), shape: Shape::Scalar, quantity, measured, varies }
    }

    /// A truth value.
    pub(crate) fn truth(node: NodeId, varies: Varies) -> Self {
        Typed::scalar(node, Quantity::Boolean, Measured::Unchecked, varies)
    }

    /// The same kind of value with other elements.
    pub(crate) fn with(&self, shape: Shape, elements: impl Into<Elements>) -> Self {
        Typed { elements: elements.into(), shape, ..self.clone() }
    }

    /// The node of a scalar.
    pub(crate) fn node(&self) -> Option<NodeId> {
        match self.elements.as_slice() {
            &[node] if self.shape == Shape::Scalar => Some(node),
            _ => None,
        }
    }

    pub(crate) fn is_boolean(&self) -> bool {
        self.quantity == Quantity::Boolean
    }
}

/// Nodes of a value. One is the rule, and is stored without a list.
#[derive(Clone, Debug)]
pub(crate) enum Elements {
    One(NodeId),
    Many(Rc<[NodeId]>),
}

impl Elements {
    pub(crate) fn as_slice(&self) -> &[NodeId] {
        match self {
            Elements::One(node) => std::slice::from_ref(node),
            Elements::Many(nodes) => nodes,
        }
    }
}

impl From<Vec<NodeId>> for Elements {
    fn from(nodes: Vec<NodeId>) -> Self {
        match nodes.as_slice() {
            &[node] => Elements::One(node),
            _ => Elements::Many(Rc::from(nodes)),
        }
    }
}

impl From<NodeId> for Elements {
    fn from(node: NodeId) -> Self {
        Elements::One(node)
    }
}

/// Extents of a value.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum Shape {
    #[default]
    Scalar,
    Vector(usize),
    /// Rows and columns.
    Matrix(usize, usize),
}

impl Shape {
    /// The shape of the given extents; there are at most two.
    pub(crate) fn of(extents: &[usize]) -> Option<Self> {
        match *extents {
            [] => Some(Shape::Scalar),
            [n] => Some(Shape::Vector(n)),
            [rows, columns] => Some(Shape::Matrix(rows, columns)),
            _ => None,
        }
    }

    pub(crate) fn extents(self) -> Vec<usize> {
        match self {
            Shape::Scalar => Vec::new(),
            Shape::Vector(n) => vec![n],
            Shape::Matrix(rows, columns) => vec![rows, columns],
        }
    }

    /// Number of elements.
    pub(crate) fn len(self) -> usize {
        match self {
            Shape::Scalar => 1,
            Shape::Vector(n) => n,
            Shape::Matrix(rows, columns) => rows.saturating_mul(columns),
        }
    }

    /// What is appended to the name of element `position`, counted from 0 row by row: `[2]`, `[1,3]`, nothing.
    pub(crate) fn suffix(self, position: usize) -> String {
        match self {
            Shape::Scalar => String::new(),
            Shape::Vector(_) => format!("[{}]", position + 1),
            Shape::Matrix(_, columns) => {
                let columns = columns.max(1);
                format!("[{},{}]", position / columns + 1, position % columns + 1)
            }
        }
    }
}

impl fmt::Display for Shape {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Shape::Scalar => f.write_str("a single value"),
            Shape::Vector(n) => write!(f, "a vector of {n}"),
            Shape::Matrix(rows, columns) => write!(f, "a {rows}×{columns} matrix"),
        }
    }
}

/// When a value can change, from never to always.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Varies {
    /// It is written in the model.
    Never,
    /// It depends on parameters, which are fixed before a run.
    Parameters,
    /// At instants: modes, held inputs, states of discrete-time components.
    Instants,
    /// While time passes.
    Continuously,
}
