//! Where everything that outlives a program stands.

use sophy_field::{ColumnIndex, Layout, RecordLayout, SourceIndex};
use sophy_ir::{Leaf, Node, NodeId, System};

/// Where something stands that needs no arithmetic.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Place {
    /// A jet.
    Jet(u32),
    /// A scalar.
    Scalar(u32),
    /// A trajectory, to be followed to the present time, and how many coefficients it has.
    Trajectory(u32, u32),
}

/// Where something stands that was computed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Operand {
    /// A jet at this offset.
    Jet(u32),
    /// A scalar at this offset.
    Scalar(u32),
}

impl Place {
    /// Where it begins.
    pub(crate) fn offset(self) -> u32 {
        match self {
            Place::Jet(at) | Place::Scalar(at) | Place::Trajectory(at, _) => at,
        }
    }
}

/// Which trajectories a program reads: q for rates, x for guards, resets and outputs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Side {
    Quantised,
    Series,
}

/// The memory of a system; temporaries of programs stand behind it.
pub(crate) struct Memory {
    pub(crate) layout: Layout,
    /// First jet of the algebraic variables, per side.
    algebraics: [u32; 2],
    /// First parameter.
    pub(crate) parameters: u32,
    /// Where each column stands: its length, then its numbers.
    pub(crate) columns: Vec<u32>,
    /// First of the pool of numbers and parametric expressions.
    pub(crate) pool: u32,
    /// Parametric expressions and numbers in the pool, in order.
    pub(crate) pooled: Vec<NodeId>,
    /// Per node: its place in the pool, or `ABSENT`.
    known: Vec<u32>,
    /// Per node: whether it is over parameters only.
    parametric: Vec<bool>,
}

const ABSENT: u32 = u32::MAX;

impl Memory {
    pub(crate) fn new(system: &System, order: u32) -> Self {
        let (width, record) = (order + 1, RecordLayout::of_order(order));
        let count = |n: usize| u32::try_from(n).unwrap_or(u32::MAX / 8);
        let (states, inputs) = (count(system.states.len()), count(system.inputs.len()));
        // The head is as long as a record.
        let rest = (1 + states + inputs + 1) * record.stride;
        let algebraics = count(system.algebraics.len()) * width;
        let truths = rest + 2 * algebraics;
        let stairs = truths + count(system.truths.len());
        let parameters = stairs + count(system.stairs.len());
        let mut end = parameters + count(system.parameters.len());
        let mut columns = Vec::new();
        for column in system.graph.columns() {
            columns.push(end);
            end += 1 + count(column.numbers.len());
        }
        Memory {
            layout: Layout { width, states, inputs, record, rest, truths, stairs, length: 0 },
            algebraics: [rest, rest + algebraics],
            parameters,
            columns,
            pool: end,
            pooled: Vec::new(),
            known: vec![ABSENT; system.graph.len()],
            parametric: parametric(system),
        }
    }

    /// Where a column stands.
    pub(crate) fn column(&self, column: ColumnIndex) -> u32 {
        self.columns.get(column.position()).copied().unwrap_or(self.parameters)
    }

    /// Whether an expression depends on parameters and numbers only.
    pub(crate) fn is_parametric(&self, node: NodeId) -> bool {
        self.parametric[node.position()]
    }

    /// The jet of an algebraic variable.
    pub(crate) fn algebraic(&self, side: Side, index: usize) -> u32 {
        self.algebraics[side as usize] + index as u32 * self.layout.width
    }

    /// Where a node stands: a leaf, or what depends on parameters only, which is evaluated once, before the run.
    pub(crate) fn place(&mut self, system: &System, side: Side, node: NodeId) -> Option<Place> {
        let layout = self.layout;
        let source = |index: u32| {
            let (record, source) = (layout.record, SourceIndex(index));
            match side {
                Side::Quantised => Place::Trajectory(layout.quantised_of(source) as u32, record.quantised),
                Side::Series => Place::Trajectory(layout.record_of(source) as u32, record.integrated),
            }
        };
        Some(match system.graph.node(node) {
            Node::Leaf(leaf) => match leaf {
                Leaf::State(i) => source(i.0),
                Leaf::Input(i) => source(layout.states + i.0),
                Leaf::Time => source(layout.states + layout.inputs),
                Leaf::Parameter(i) => Place::Scalar(self.parameters + i.0),
                Leaf::Truth(i) => Place::Scalar(layout.truths + i.0),
                Leaf::Stair(i) => Place::Scalar(layout.stairs + i.0),
                Leaf::Algebraic(i) => Place::Jet(self.algebraic(side, i.position())),
                // Only models refer to variables; the verifier has seen to it.
                Leaf::Variable(_) | Leaf::Special(_) => Place::Scalar(self.parameters),
            },
            _ if self.is_parametric(node) => Place::Scalar(self.pooled(node)),
            _ => return None,
        })
    }

    /// The scalar that holds a parametric expression.
    fn pooled(&mut self, node: NodeId) -> u32 {
        let known = &mut self.known[node.position()];
        if *known == ABSENT {
            *known = self.pool + self.pooled.len() as u32;
            self.pooled.push(node);
        }
        *known
    }

    /// Where temporaries begin, once the pool is complete.
    pub(crate) fn end(&self) -> u32 {
        self.pool + self.pooled.len() as u32
    }
}

fn parametric(system: &System) -> Vec<bool> {
    let graph = &system.graph;
    let mut known: Vec<bool> = Vec::with_capacity(graph.len());
    // Operands stand before users.
    for id in graph.ids() {
        let parametric = match graph.node(id) {
            Node::Leaf(leaf) => matches!(leaf, Leaf::Parameter(_)),
            _ => {
                let mut all = true;
                graph.operands(id, |operand| all &= known[operand.position()]);
                all
            }
        };
        known.push(parametric);
    }
    known
}

/// The sources among leaves: states, inputs and time.
pub(crate) fn source_of(leaf: Leaf, layout: Layout) -> Option<SourceIndex> {
    match leaf {
        Leaf::State(i) => Some(SourceIndex(i.0)),
        Leaf::Input(i) => Some(SourceIndex(layout.states + i.0)),
        Leaf::Time => Some(layout.time()),
        _ => None,
    }
}
