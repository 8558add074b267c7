//! What ranges were declared for, wherever it has ended up.

use super::copy::Context;
use super::facts::Becomes;
use super::{FlattenError, Flattener};
use sophy_ir::{Allowed, ClassIndex, ComponentIndex, Leaf, Node, Range, Ranged, Variable, VariableId};

impl Flattener<'_> {
    /// The ranges of everything but parameters. Outputs are resolved by now.
    pub(super) fn ranges(&mut self) -> Result<(), FlattenError> {
        for &instance in &self.tree.order {
            let (at, class) = (self.tree.instance(instance), self.tree.class(instance));
            for (position, variable) in class.variables.iter().enumerate() {
                if variable.range.is_none() {
                    continue;
                }
                let id = VariableId(position as u32);
                let of = match self.tree.facts(instance).of(id) {
                    Becomes::Parameter(_) | Becomes::Nothing => None,
                    Becomes::State(_) => {
                        let node = self.nodes[at.base as usize + position];
                        match node.map(|node| self.system.graph.node(node)) {
                            Some(Node::Leaf(Leaf::State(state))) => Some(Ranged::State(state)),
                            _ => None,
                        }
                    }
                    Becomes::Input | Becomes::Port | Becomes::Value(_) => {
                        self.output_row(instance, id)?.map(|value| Ranged::Value {
                            component: ComponentIndex(instance),
                            declared: self.declared(at.class, id),
                            value,
                        })
                    }
                };
                if let Some(of) = of {
                    self.range(at.class, at.place, variable, of);
                }
            }
        }
        Ok(())
    }

    /// Keeps what `variable` may be, if that was declared.
    pub(super) fn range(&mut self, class: ClassIndex, place: u32, variable: &Variable, of: Ranged) {
        let Some(allowed) = &variable.range else { return };
        let context = Context { class, place, instance: None, location: None };
        let allowed = match allowed {
            Allowed::Between(bounds) => Allowed::Between(bounds.map(|bound| self.number(context, bound))),
            Allowed::OneOf(numbers) => Allowed::OneOf(numbers.clone()),
        };
        self.system.ranges.push(Range { of, allowed, stairs: Vec::new(), span: variable.span });
    }
}
