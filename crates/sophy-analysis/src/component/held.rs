//! `real` outputs of continuous-time components: they change at instants only.

use super::builder::Builder;
use super::equations::Defined;
use crate::checks::hs0125_type_does_not_suit;
use crate::declarations::{ComponentKind, Dialect, Direction};
use crate::lower::SymbolValue;
use sophy_diagnostics::Span;
use sophy_ir::{Leaf, Node, NodeId, Unary, VariableId, VariableKind};
use std::collections::{BTreeMap, HashSet};

impl Builder<'_, '_> {
    /// Finds the `real` outputs that vary continuously in a location, by name, with the type and the equation.
    pub(crate) fn find_unheld(&self, defined: &Defined, found: &mut BTreeMap<String, (Span, Option<Span>)>) {
        let (Dialect::Hsml, ComponentKind::Ctc) = (self.declaration.dialect, self.declaration.kind) else {
            return;
        };
        for port in self.declaration.ports.iter().filter(|port| port.direction == Direction::Output) {
            let Some(kind) = port.kind.as_ref().filter(|kind| kind.name.value == "real") else { continue };
            let Some(SymbolValue::Variable(symbol)) =
                self.symbols.declared(&port.name.value).map(|symbol| &symbol.value)
            else {
                continue;
            };
            for id in Builder::elements(symbol.first, symbol.shape.len()) {
                let definition = defined.values.get(&id);
                let varies = match definition {
                    Some(definition) => definition.right.is_some_and(|right| self.varies(right, defined)),
                    None => defined.rates.contains_key(&id),
                };
                if varies {
                    let equation = definition.map(|definition| definition.span);
                    found.entry(port.name.value.clone()).or_insert((kind.name.span, equation));
                }
            }
        }
    }

    pub(crate) fn report_unheld(&mut self, found: BTreeMap<String, (Span, Option<Span>)>) {
        for (name, (kind, equation)) in found {
            self.report(hs0125_type_does_not_suit::continuous(&name, kind, equation));
        }
    }

    /// Whether a value varies between events: what only conditions read does not count.
    fn varies(&self, root: NodeId, defined: &Defined) -> bool {
        let mut pending = vec![root];
        let (mut nodes, mut variables): (HashSet<NodeId>, HashSet<VariableId>) = Default::default();
        while let Some(id) = pending.pop() {
            if !nodes.insert(id) {
                continue;
            }
            match self.graph.node(id) {
                Node::Leaf(Leaf::Time) => return true,
                Node::Leaf(Leaf::Variable(variable)) => match self.variables[variable.0 as usize].kind {
                    VariableKind::State(_) => return true,
                    VariableKind::Input { continuous: true } => return true,
                    VariableKind::Local | VariableKind::Flag | VariableKind::Output
                        if variables.insert(variable) =>
                    {
                        pending.extend(defined.values.get(&variable).and_then(|d| d.right));
                    }
                    _ => {}
                },
                Node::Leaf(_) | Node::Compare(..) | Node::Not(_) | Node::And(..) | Node::Or(..) => {}
                Node::Unary(Unary::Sign | Unary::Floor, _) | Node::Locate(..) => {}
                Node::Select(_, a, b) => pending.extend([a, b]),
                _ => self.graph.operands(id, |operand| pending.push(operand)),
            }
        }
        false
    }
}
