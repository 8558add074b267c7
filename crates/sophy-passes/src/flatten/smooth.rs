//! `smooth(…)` means something in rates only. A guard is located by enclosures, which need its switches to be
//! events; outputs and resets, read at instants, keep switches as written in any case.

use sophy_ir::{FlatTrigger, Graph, Model, Node, NodeId, Special, System, Unary};
use std::collections::HashMap;

/// Takes `smooth` off everything but the rates.
pub(super) fn confine_smooth(model: &Model, system: &mut System) {
    let smooth = |special: &Special| matches!(special, Special::Smooth(_));
    if !model.classes.iter().any(|class| class.specials.iter().any(smooth)) {
        return;
    }
    let mut bare = Bare { graph: &mut system.graph, known: HashMap::new() };
    for z in system.algebraics.iter() {
        for row in [z.value, z.plain] {
            system.rows[row.range()].iter_mut().for_each(|node| bare.strip(node));
        }
    }
    for transition in system.transitions.unfinished() {
        match &mut transition.trigger {
            FlatTrigger::When(guard) => bare.strip(guard),
            FlatTrigger::On { guard, .. } => guard.iter_mut().for_each(|guard| bare.strip(guard)),
        }
    }
}

struct Bare<'a> {
    graph: &'a mut Graph,
    known: HashMap<NodeId, NodeId>,
}

impl Bare<'_> {
    fn strip(&mut self, root: &mut NodeId) {
        for id in self.graph.reachable([*root]) {
            if self.known.contains_key(&id) {
                continue;
            }
            let of = |operand: NodeId| self.known.get(&operand).copied().unwrap_or(operand);
            let bare = match self.graph.node(id) {
                Node::Unary(Unary::Smooth, inner) => of(inner),
                other => {
                    let mapped = other.map(of);
                    self.graph.rebuild(mapped)
                }
            };
            self.known.insert(id, bare);
        }
        *root = self.known.get(root).copied().unwrap_or(*root);
    }
}
