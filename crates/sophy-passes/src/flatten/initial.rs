//! The `initial` sections of all components as one list, each assignment after those that it reads; and modes
//! that nothing initialises.

use super::{FlattenError, Flattener};
use sophy_field::StateIndex;
use sophy_ir::{Actions, Body, FlatReset, Leaf, NodeId};
use std::collections::{BTreeSet, HashMap};

impl Flattener<'_> {
    /// The modes that a section assigns and that have no value at the start take that of its flag's sign,
    /// unless several flags assign them.
    pub(super) fn modes_of(&mut self, instance: u32, actions: Option<&Actions>, flag: NodeId) {
        for assignment in actions.into_iter().flat_map(|actions| &actions.assignments) {
            let Some(index) = self.state_of(instance, assignment.variable) else { continue };
            let state = &mut self.system.states.unfinished()[index.position()];
            if state.discrete && state.initial.is_none() {
                let only = self.flag_of.entry(index).or_insert(Some(flag));
                *only = only.filter(|&other| other == flag);
                state.sign_of = *only;
            }
        }
    }

    pub(super) fn initial(&mut self) -> Result<(), FlattenError> {
        let mut written = Vec::new();
        for &instance in &self.tree.order {
            let assignments = match &self.tree.class(instance).body {
                Body::Automaton(automaton) => &automaton.initial,
                Body::Discrete(discrete) => &discrete.initial,
                Body::Composite(_) => continue,
            };
            let context = self.context(instance, None);
            for assignment in assignments {
                let value = self.number(context, assignment.right);
                if let Some(state) = self.state_of(instance, assignment.variable) {
                    written.push(FlatReset { state, value, span: assignment.span });
                }
            }
        }
        self.system.initial = self.sorted(written)?;
        Ok(())
    }

    /// Each after those that assign what it reads; otherwise as written.
    fn sorted(&self, written: Vec<FlatReset>) -> Result<Vec<FlatReset>, FlattenError> {
        let mut assigns: HashMap<StateIndex, Vec<usize>> = HashMap::new();
        for (position, assignment) in written.iter().enumerate() {
            assigns.entry(assignment.state).or_default().push(position);
        }
        let mut done = vec![false; written.len()];
        let mut open = vec![false; written.len()];
        let mut order = Vec::with_capacity(written.len());
        for root in 0..written.len() {
            let mut pending = vec![root];
            while let Some(&next) = pending.last() {
                if done[next] {
                    pending.pop();
                    continue;
                }
                let states = self.states_below(written[next].value);
                let before = states.iter().filter(|&&state| state != written[next].state);
                let missing: Vec<usize> = before
                    .filter_map(|state| assigns.get(state))
                    .flatten()
                    .copied()
                    .filter(|&p| !done[p])
                    .collect();
                if missing.is_empty() {
                    done[next] = true;
                    order.push(next);
                    pending.pop();
                } else if std::mem::replace(&mut open[next], true) {
                    let start = pending.iter().position(|&other| other == next).unwrap_or(0);
                    let circle = pending[start..].iter().filter(|&&p| open[p]);
                    let name =
                        |&p: &usize| self.system.states.at(written[p].state.position()).name(&self.system);
                    return Err(FlattenError::InitialLoop(circle.map(name).collect()));
                } else {
                    pending.extend(missing);
                }
            }
        }
        Ok(order.into_iter().map(|position| written[position].clone()).collect())
    }

    /// The states that an expression reads, also through algebraic variables.
    fn states_below(&self, node: NodeId) -> BTreeSet<StateIndex> {
        let (mut found, mut seen) = (BTreeSet::new(), BTreeSet::new());
        let mut pending: Vec<Leaf> = self.system.graph.dependencies([node]).into_iter().collect();
        while let Some(leaf) = pending.pop() {
            match leaf {
                Leaf::State(state) => {
                    found.insert(state);
                }
                Leaf::Algebraic(z) if seen.insert(z) => {
                    let row = self.system.algebraics.at(z.position()).plain;
                    pending.extend(self.system.graph.dependencies(self.system.nodes(row).iter().copied()));
                }
                _ => {}
            }
        }
        found
    }
}
