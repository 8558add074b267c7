//! The numbers of what copies repeat: indices, positions of nodes, copies of members.

use crate::class::{EventEnd, EventWire, Port, Sources, Wire};
use crate::graph::{Leaf, Node, NodeId};
use crate::names::ComponentIndex;
use crate::packed::Repeat;
use crate::system::{
    Algebraic, Automaton, Event, FlatEmission, FlatReset, FlatTransition, FlatTrigger, Output, Receiver, Row,
    State, Truth, Watch,
};
use rustc_hash::FxHasher;
use sophy_field::{
    AlgebraicIndex, AutomatonIndex, EventIndex, InputIndex, ParameterIndex, StairIndex, StateIndex,
    TransitionIndex, TruthIndex, WatchIndex,
};
use std::hash::Hash;

impl NodeId {
    #[inline]
    fn renumbered(self, mut number: impl FnMut(u32) -> u32) -> Self {
        NodeId::new(number(self.position() as u32) as usize)
    }
}

impl Row {
    fn renumbered(self, mut number: impl FnMut(u32) -> u32) -> Self {
        Row {
            owner: AutomatonIndex(number(self.owner.0)),
            first: number(self.first),
            locations: self.locations,
            spans: number(self.spans),
        }
    }
}

impl Leaf {
    #[inline]
    fn renumbered(self, mut number: impl FnMut(u32) -> u32) -> Self {
        match self {
            Leaf::Parameter(ParameterIndex(i)) => Leaf::Parameter(ParameterIndex(number(i))),
            Leaf::State(StateIndex(i)) => Leaf::State(StateIndex(number(i))),
            Leaf::Input(InputIndex(i)) => Leaf::Input(InputIndex(number(i))),
            Leaf::Algebraic(AlgebraicIndex(i)) => Leaf::Algebraic(AlgebraicIndex(number(i))),
            Leaf::Truth(TruthIndex(i)) => Leaf::Truth(TruthIndex(number(i))),
            Leaf::Stair(StairIndex(i)) => Leaf::Stair(StairIndex(number(i))),
            Leaf::Variable(_) | Leaf::Special(_) | Leaf::Time => self,
        }
    }
}

impl Repeat for Node {
    #[inline]
    fn renumbered(&self, mut number: impl FnMut(u32) -> u32) -> Self {
        let mut of = |id: NodeId| id.renumbered(&mut number);
        match *self {
            node @ (Node::Number(_) | Node::Boolean(_)) => node,
            Node::Leaf(leaf) => Node::Leaf(leaf.renumbered(number)),
            Node::Unary(function, a) => Node::Unary(function, of(a)),
            Node::IntegerPower(a, n) => Node::IntegerPower(of(a), n),
            Node::Not(a) => Node::Not(of(a)),
            Node::Locate(column, a) => Node::Locate(column, of(a)),
            Node::Lookup(column, a) => Node::Lookup(column, of(a)),
            Node::Binary(function, a, b) => Node::Binary(function, of(a), of(b)),
            Node::Compare(comparison, a, b) => Node::Compare(comparison, of(a), of(b)),
            Node::And(a, b) => Node::And(of(a), of(b)),
            Node::Or(a, b) => Node::Or(of(a), of(b)),
            Node::Select(a, b, c) => Node::Select(of(a), of(b), of(c)),
        }
    }

    fn look(&self, hasher: &mut FxHasher) {
        self.renumbered(|_| 0).hash(hasher);
    }
}

impl Repeat for Wire {
    fn renumbered(&self, mut number: impl FnMut(u32) -> u32) -> Self {
        let mut of = |port: Port| Port { copy: number(port.copy), ..port };
        Wire {
            to: of(self.to),
            from: match &self.from {
                Sources::One(port) => Sources::One(of(*port)),
                sum @ Sources::Sum(_) => sum.clone(),
            },
            span: self.span,
        }
    }

    fn look(&self, hasher: &mut FxHasher) {
        (self.to.member, self.to.variable).hash(hasher);
        if let Sources::One(port) = &self.from {
            (port.member, port.variable).hash(hasher);
        }
    }
}

impl Repeat for EventWire {
    fn renumbered(&self, mut number: impl FnMut(u32) -> u32) -> Self {
        let mut of = |end: &EventEnd| EventEnd { copy: number(end.copy), ..end.clone() };
        EventWire { from: of(&self.from), to: of(&self.to), ..self.clone() }
    }

    fn look(&self, hasher: &mut FxHasher) {
        (self.from.member, self.to.member, &self.from.label).hash(hasher);
    }
}

impl Repeat for State {
    fn renumbered(&self, mut number: impl FnMut(u32) -> u32) -> Self {
        State {
            component: ComponentIndex(number(self.component.0)),
            declared: self.declared.clone(),
            discrete: self.discrete,
            initial: self.initial.map(|node| node.renumbered(&mut number)),
            sign_of: self.sign_of.map(|node| node.renumbered(&mut number)),
            rate: self.rate.renumbered(number),
        }
    }

    fn look(&self, hasher: &mut FxHasher) {
        self.declared.address().hash(hasher);
    }
}

impl Repeat for Algebraic {
    fn renumbered(&self, mut number: impl FnMut(u32) -> u32) -> Self {
        Algebraic {
            component: ComponentIndex(number(self.component.0)),
            declared: self.declared.clone(),
            value: self.value.renumbered(&mut number),
            plain: self.plain.renumbered(number),
        }
    }

    fn look(&self, hasher: &mut FxHasher) {
        self.declared.address().hash(hasher);
    }
}

impl Repeat for Output {
    fn renumbered(&self, mut number: impl FnMut(u32) -> u32) -> Self {
        Output {
            component: ComponentIndex(number(self.component.0)),
            declared: self.declared.clone(),
            view: self.view,
            value: self.value.renumbered(number),
        }
    }

    fn look(&self, hasher: &mut FxHasher) {
        self.declared.address().hash(hasher);
    }
}

impl Repeat for Automaton {
    fn renumbered(&self, mut number: impl FnMut(u32) -> u32) -> Self {
        Automaton {
            component: ComponentIndex(number(self.component.0)),
            kind: self.kind.clone(),
            first: TransitionIndex(number(self.first.0)),
        }
    }

    fn look(&self, hasher: &mut FxHasher) {
        self.kind.address().hash(hasher);
    }
}

impl Repeat for FlatTransition {
    fn renumbered(&self, mut number: impl FnMut(u32) -> u32) -> Self {
        FlatTransition {
            name: self.name.clone(),
            automaton: AutomatonIndex(number(self.automaton.0)),
            source: self.source,
            destination: self.destination,
            trigger: match &self.trigger {
                FlatTrigger::When(guard) => FlatTrigger::When(guard.renumbered(&mut number)),
                FlatTrigger::On { events, guard } => FlatTrigger::On {
                    events: events.iter().map(|event| EventIndex(number(event.0))).collect(),
                    guard: guard.map(|guard| guard.renumbered(&mut number)),
                },
            },
            resets: self.resets.iter().map(|reset| reset.renumbered(&mut number)).collect(),
            emits: self.emits.iter().map(|emission| emission.renumbered(&mut number)).collect(),
            priority: self.priority,
            silent: self.silent,
            span: self.span,
        }
    }

    fn look(&self, hasher: &mut FxHasher) {
        (&self.name, self.source.0, self.destination.0, self.resets.len(), self.emits.len()).hash(hasher);
    }
}

impl FlatReset {
    fn renumbered(&self, mut number: impl FnMut(u32) -> u32) -> Self {
        let state = StateIndex(number(self.state.0));
        FlatReset { state, value: self.value.renumbered(number), span: self.span }
    }
}

impl FlatEmission {
    fn renumbered(&self, mut number: impl FnMut(u32) -> u32) -> Self {
        FlatEmission {
            label: self.label.clone(),
            receivers: self.receivers.iter().map(|event| EventIndex(number(event.0))).collect(),
            when: self.when.map(|when| when.renumbered(number)),
        }
    }
}

impl Repeat for Event {
    fn renumbered(&self, mut number: impl FnMut(u32) -> u32) -> Self {
        Event {
            component: ComponentIndex(number(self.component.0)),
            label: self.label.clone(),
            receiver: Receiver { automaton: AutomatonIndex(number(self.receiver.automaton.0)) },
        }
    }

    fn look(&self, hasher: &mut FxHasher) {
        self.label.hash(hasher);
    }
}

impl Repeat for Watch {
    fn renumbered(&self, mut number: impl FnMut(u32) -> u32) -> Self {
        Watch {
            left: self.left.renumbered(&mut number),
            right: self.right.renumbered(&mut number),
            difference: self.difference.renumbered(number),
            affine: self.affine,
        }
    }

    fn look(&self, hasher: &mut FxHasher) {
        self.affine.hash(hasher);
    }
}

impl Repeat for Truth {
    fn renumbered(&self, mut number: impl FnMut(u32) -> u32) -> Self {
        Truth { watch: WatchIndex(number(self.watch.0)), comparison: self.comparison }
    }

    fn look(&self, hasher: &mut FxHasher) {
        self.comparison.hash(hasher);
    }
}
