//! Parameters in an order in which each comes after those it reads. There is one per member, not per copy.

use super::copy::Context;
use super::facts::Becomes;
use super::tree::prefixed;
use super::{FlattenError, Flattener};
use sophy_field::ParameterIndex;
use sophy_ir::{Body, Leaf, Node, NodeId, Origin, Parameter, Ranged, VariableId, VariableKind};

impl Flattener<'_> {
    pub(super) fn parameters(&mut self) -> Result<(), FlattenError> {
        // Written order; a composite comes before its members, which may read its parameters.
        let mut pending: Vec<u32> = if self.tree.places.is_empty() { Vec::new() } else { vec![0] };
        while let Some(place) = pending.pop() {
            self.parameters_of(place)?;
            pending.extend(self.tree.members_of(place).rev());
        }
        Ok(())
    }

    fn parameters_of(&mut self, place: u32) -> Result<(), FlattenError> {
        let at = self.tree.places[place as usize];
        let class = self.tree.model.class(at.class);
        let facts = self.tree.class_facts(at.class);
        let mut values: Vec<Option<(Context, NodeId)>> = facts
            .becomes
            .iter()
            .map(|becomes| match becomes {
                Becomes::Parameter(value) => {
                    Some((Context { class: at.class, place, instance: None, location: None }, *value))
                }
                _ => None,
            })
            .collect();
        if let Some(parent) = at.parent {
            let composite = self.tree.places[parent as usize].class;
            let context = Context { class: composite, place: parent, instance: None, location: None };
            if let Body::Composite(holder) = &self.tree.model.class(composite).body {
                for &(id, value) in &holder.members[at.member as usize].parameters {
                    values[id.0 as usize] = Some((context, value));
                }
            }
        }
        let name = self.tree.place_name(place);
        let mut open = vec![false; values.len()];
        for root in 0..values.len() as u32 {
            let mut pending = vec![VariableId(root)];
            while let Some(&id) = pending.last() {
                let done = self.parameters[(at.base + id.0) as usize].is_some();
                let Some((context, value)) = values[id.0 as usize].filter(|_| !done) else {
                    pending.pop();
                    continue;
                };
                let missing = if context.place == place { self.missing(place, value) } else { Vec::new() };
                if missing.is_empty() {
                    pending.pop();
                    let value = self.number(context, value);
                    let variable = class.variable(id);
                    let index = ParameterIndex::new(self.system.parameters.len());
                    self.system.parameters.push(Parameter {
                        name: prefixed(&name, &variable.name),
                        value,
                        unit: variable.unit.clone(),
                        knob: matches!(variable.kind, VariableKind::Parameter { knob: true, .. }),
                        structural: variable.structural,
                        origin: Origin { class: at.class, variable: id },
                        span: variable.span,
                    });
                    let leaf = self.system.graph.leaf(Leaf::Parameter(index));
                    self.parameters[(at.base + id.0) as usize] = Some(leaf);
                } else if std::mem::replace(&mut open[id.0 as usize], true) {
                    let full = |id: &VariableId| prefixed(&name, &class.variable(*id).name);
                    let start = pending.iter().position(|other| *other == id).unwrap_or(0);
                    let circle = pending[start..].iter().filter(|id| open[id.0 as usize]);
                    return Err(FlattenError::ParameterLoop(circle.map(full).collect()));
                } else {
                    pending.extend(missing);
                }
            }
        }
        for (position, variable) in class.variables.iter().enumerate() {
            if let Some(leaf) = self.parameters[at.base as usize + position]
                && let Node::Leaf(Leaf::Parameter(parameter)) = self.system.graph.node(leaf)
            {
                self.range(at.class, place, variable, Ranged::Parameter(parameter));
            }
        }
        Ok(())
    }

    /// Parameters that a value reads and that have no index yet.
    fn missing(&self, place: u32, value: NodeId) -> Vec<VariableId> {
        let at = self.tree.places[place as usize];
        let leaves = self.tree.model.class(at.class).graph.dependencies([value]);
        let unknown = |id: &VariableId| {
            let is_parameter = matches!(self.tree.class_facts(at.class).of(*id), Becomes::Parameter(_));
            is_parameter && self.parameters[(at.base + id.0) as usize].is_none()
        };
        let variables = leaves.into_iter().filter_map(|leaf| match leaf {
            Leaf::Variable(id) => Some(id),
            _ => None,
        });
        variables.filter(unknown).collect()
    }
}
