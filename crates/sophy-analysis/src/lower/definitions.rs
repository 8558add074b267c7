use super::expression::{Context, Scope};
use super::functions::Functions;
use super::names_in;
use crate::checks::{hs0301_circular_constants, hs0302_recursive_function};
use crate::declarations::{Declarations, ExpressionText, Spanned};
use crate::dependency_order::dependency_order;
use crate::findings::Findings;
use crate::names::{Kind, Names};
use sophy_ir::{Graph, Leaf, NodeId, Value, VariableId, evaluate};
use std::collections::HashMap;

/// Constants and functions, which hold everywhere and may use one another.
pub(crate) struct Definitions<'a> {
    pub(crate) functions: Functions<'a>,
    /// Values of constants; those with mistakes are left out.
    pub(crate) constants: HashMap<VariableId, NodeId>,
    /// The same, computed.
    pub(crate) values: HashMap<VariableId, f64>,
}

/// A constant or function.
pub(crate) struct Definition<'a> {
    pub(crate) name: &'a Spanned<String>,
    pub(crate) text: &'a ExpressionText,
    is_function: bool,
}

/// Lowers all constants and functions, each after those it uses.
pub(crate) fn lower_definitions<'a>(
    declarations: &'a Declarations,
    names: &Names<'a>,
    graph: &mut Graph,
    findings: &mut Findings,
) -> Definitions<'a> {
    let constants = &declarations.constants;
    let of_constants =
        constants.iter().map(|c| Definition { name: &c.name, text: &c.value, is_function: false });
    let of_functions =
        declarations.functions.iter().map(|f| Definition { name: &f.name, text: &f.body, is_function: true });
    let all: Vec<Definition<'_>> = of_constants.chain(of_functions).collect();
    let index_of = |name: &str| {
        let symbol = names.symbol(name)?;
        match symbol.kind {
            Kind::Constant => Some(symbol.position),
            Kind::Function => Some(constants.len() + symbol.position),
            _ => None,
        }
    };
    let needs: Vec<Vec<usize>> = all
        .iter()
        .enumerate()
        .map(|(index, definition)| {
            let function = index.checked_sub(constants.len()).map(|f| &declarations.functions[f]);
            let is_parameter = |name: &String| {
                function.is_some_and(|f| f.parameters.iter().any(|parameter| parameter.value == *name))
            };
            let used = names_in(definition.text).into_iter().filter(|name| !is_parameter(name));
            used.filter_map(|name| index_of(&name)).collect()
        })
        .collect();
    let sorted = dependency_order(&needs);
    for cycle in &sorted.cycles {
        let members: Vec<&Definition<'_>> = cycle.iter().map(|&index| &all[index]).collect();
        findings.report(if members.iter().all(|member| member.is_function) {
            hs0302_recursive_function::diagnostic(&members)
        } else {
            hs0301_circular_constants::diagnostic(&members)
        });
    }
    let mut result = Definitions {
        functions: Functions::declare(declarations, names),
        constants: HashMap::new(),
        values: HashMap::new(),
    };
    for index in sorted.order {
        if let Some(function) = index.checked_sub(constants.len()) {
            let function = &declarations.functions[function];
            result.functions.define(function, names, &result.values, findings);
        } else {
            let first_of_its_name = index_of(&all[index].name.value) == Some(index);
            result.constant(&all[index], first_of_its_name, names, graph, findings);
        }
    }
    result
}

impl<'a> Definitions<'a> {
    fn constant(
        &mut self,
        constant: &Definition<'a>,
        first_of_its_name: bool,
        names: &Names<'a>,
        graph: &mut Graph,
        findings: &mut Findings,
    ) {
        let mut context = Context { names, functions: &self.functions, constants: &self.values, findings };
        let value = context.number(graph, Scope::Constants { what: "a constant" }, constant.text);
        if let (Some(value), Some(id), true) =
            (value, names.variable(&constant.name.value), first_of_its_name)
        {
            let computed = evaluate(graph, value.node, &mut |leaf| match leaf {
                Leaf::Variable(other) => Value::Real(self.values.get(&other).copied().unwrap_or(f64::NAN)),
                _ => Value::Real(f64::NAN),
            });
            self.constants.insert(id, value.node);
            self.values.insert(id, computed.real());
        }
    }
}
