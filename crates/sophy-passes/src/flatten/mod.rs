//! Instances side by side become one system: variables get indices, inputs become what feeds them, values are
//! written out where they are read, event sections become small automata of their own.
//!
//! Nothing here recurses over a model, and the work is that of what comes out: facts about a class are found
//! once, copies replay them.

mod automata;
mod awaits;
mod conditions;
mod copy;
mod error;
mod events;
mod facts;
mod initial;
mod parameters;
mod ranges;
mod smooth;
mod tables;
mod tree;
mod values;
mod variables;

pub use error::{FlattenError, LoopEquation};

use awaits::Part;
use copy::Scratch;
use facts::Facts;
use sophy_field::{AutomatonIndex, StateIndex};
use sophy_ir::{
    AutomatonKind, Class, ClassIndex, Declared, Model, NodeId, Origin, Quantity, Shared, System, VariableId,
};
use std::collections::HashMap;
use tables::Columns;
use tree::Tree;

/// The flat system of a model; kinks are still as written.
///
/// # Errors
/// [`FlattenError`] if something depends on itself.
pub fn flatten(model: &Model) -> Result<System, FlattenError> {
    let facts: Vec<Facts> = model.classes.iter().map(Facts::new).collect();
    let tree = Tree::new(model, &facts);
    let mut flattener = Flattener::new(&tree);
    flattener.parameters()?;
    flattener.variables();
    flattener.events();
    flattener.outputs()?;
    flattener.ranges()?;
    flattener.states()?;
    flattener.automata();
    flattener.initial()?;
    flattener.awaited_parts();
    let mut system = flattener.system;
    smooth::confine_smooth(model, &mut system);
    Ok(system)
}

struct Flattener<'a> {
    tree: &'a Tree<'a>,
    system: System,
    /// Per variable of a place: the leaf of a parameter.
    parameters: Vec<Option<NodeId>>,
    /// Per slot: what it has become.
    nodes: Vec<Option<NodeId>>,
    /// Per slot: whether it is being resolved.
    open: Vec<bool>,
    /// Per slot: the wire that feeds it, in the composite it belongs to.
    wires: Vec<Option<u32>>,
    /// Per instance: its automaton; composites have none.
    automaton_of: Vec<Option<AutomatonIndex>>,
    /// Per instance that has input events: the first of them.
    first_event: Vec<u32>,
    /// Per class, per variable: what was declared.
    declared: Vec<Vec<Shared<Declared>>>,
    /// What stands for `location_index` where others see it.
    location_index: Shared<Declared>,
    /// What the automata of a class have in common: that of its locations, then those of its event sections.
    kinds: HashMap<(ClassIndex, usize), Shared<AutomatonKind>>,
    /// Per class: where its spans begin, once they are known.
    first_span: Vec<Option<u32>>,
    /// Per class: what was copied last.
    scratch: Vec<Scratch>,
    pending: Vec<NodeId>,
    /// `location_index` as others see it, by instance.
    location_numbers: HashMap<u32, NodeId>,
    /// The flag that assigns a mode without value at the start; `None` if several do.
    flag_of: HashMap<StateIndex, Option<NodeId>>,
    /// Per table of the model: its columns, once it is read.
    tables: Vec<Option<Columns>>,
    /// What cannot be run yet and is read as a value or condition, by place.
    awaited: HashMap<(u32, Part), NodeId>,
}

impl<'a> Flattener<'a> {
    /// What was declared of a variable.
    fn declared(&self, class: ClassIndex, id: VariableId) -> Shared<Declared> {
        self.declared[class.0 as usize][id.0 as usize].clone()
    }

    fn new(tree: &'a Tree<'a>) -> Self {
        let model = tree.model;
        Flattener {
            system: System {
                name: model.name().to_owned(),
                components: tree.components.clone(),
                texts: model.texts.clone(),
                ..System::default()
            },
            declared: (0..)
                .map(ClassIndex)
                .zip(&model.classes)
                .map(|(index, class)| declared(index, class))
                .collect(),
            location_index: Shared::new(Declared {
                name: "location_index".to_owned(),
                unit: None,
                quantity: Quantity::Integer,
                choices: Vec::new(),
                origin: Origin { class: model.root, variable: VariableId(u32::MAX) },
                span: None,
            }),
            kinds: HashMap::new(),
            first_span: vec![None; model.classes.len()],
            parameters: vec![None; tree.place_variables as usize],
            nodes: vec![None; tree.slots as usize],
            open: vec![false; tree.slots as usize],
            wires: vec![None; tree.slots as usize],
            automaton_of: vec![None; tree.instances.len()],
            first_event: vec![0; tree.instances.len()],
            scratch: model.classes.iter().map(|_| Scratch::default()).collect(),
            pending: Vec::new(),
            location_numbers: HashMap::new(),
            flag_of: HashMap::new(),
            tables: model.tables.iter().map(|_| None).collect(),
            awaited: HashMap::new(),
            tree,
        }
    }
}

/// What was declared of the variables of a class.
fn declared(index: ClassIndex, class: &Class) -> Vec<Shared<Declared>> {
    let variables = (0..).map(VariableId).zip(&class.variables);
    let declared = variables.map(|(id, variable)| {
        Shared::new(Declared {
            name: variable.name.clone(),
            unit: variable.unit.clone(),
            quantity: variable.quantity,
            choices: variable.choices.clone(),
            origin: Origin { class: index, variable: id },
            span: variable.span,
        })
    });
    declared.collect()
}
