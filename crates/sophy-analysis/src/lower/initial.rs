use super::expression::{Context, Scope};
use crate::checks::{hs0105_unknown_initial_value, hs0108_defined_twice};
use crate::declarations::Declarations;
use crate::names::Kind;
use sophy_diagnostics::Span;
use sophy_ir::{Graph, NodeId, VariableId};
use std::collections::{BTreeMap, HashMap};

/// Lowers the initial values of states.
pub(crate) fn lower_initial_values(
    declarations: &Declarations,
    graph: &mut Graph,
    context: &mut Context<'_, '_>,
) -> HashMap<VariableId, NodeId> {
    let mut values = HashMap::new();
    let mut first: BTreeMap<&str, Span> = BTreeMap::new();
    for initial in &declarations.initial {
        let name = initial.target.value.as_str();
        let scope = Scope::Constants { what: "an initial value" };
        let value = context.number(graph, scope, &initial.right);
        if name.is_empty() {
            continue;
        }
        let names = context.names;
        if names.symbol(name).is_none_or(|symbol| symbol.kind != Kind::State) {
            context.findings.report(hs0105_unknown_initial_value::diagnostic(&initial.target, names));
            continue;
        }
        if let Some(&first) = first.get(name) {
            let what = format!("the initial value of `{name}`");
            context.findings.report(hs0108_defined_twice::diagnostic(&what, first, initial.target.span));
            continue;
        }
        first.insert(name, initial.target.span);
        if let (Some(id), Some(value)) = (names.variable(name), value) {
            values.insert(id, value.node);
        }
    }
    values
}
