use super::library::{Entry, Library};
use crate::checks::{
    hs0107_declared_twice, hs0108_defined_twice, hs0126_out_of_range, hs0138_unknown_component,
    hs0139_unknown_parameter, hs0140_array_of_components,
};
use crate::component::{Builder, Given};
use crate::declarations::{ComponentKind, ExpressionText, MemberDeclaration, MemberItem, Spanned};
use crate::lower::{Expected, Place, Symbol, SymbolKind, SymbolValue};
use crate::units::Measured;
use sophy_diagnostics::Span;
use sophy_ir::{Member, NodeId, Quantity, VariableId, VariableKind};
use std::collections::{BTreeSet, HashMap};
use std::rc::Rc;

/// Members of a composite.
#[derive(Default)]
pub(crate) struct Members {
    pub(crate) list: Vec<Member>,
    /// Per member: what it is a copy of.
    pub(crate) entries: Vec<Rc<Entry>>,
    /// Per member: the kind of its component.
    pub(crate) kinds: Vec<ComponentKind>,
    by_name: HashMap<String, Named>,
}

/// What a member name stands for.
#[derive(Debug)]
pub(crate) enum Named {
    /// One member, or an array of equal ones.
    One(usize),
    /// Elements that were declared one by one, by their indices.
    Elements(HashMap<Vec<u32>, usize>, Span),
    /// Its declaration has mistakes.
    Broken,
}

impl Members {
    pub(crate) fn named(&self, name: &str) -> Option<&Named> {
        self.by_name.get(name)
    }

    pub(crate) fn names(&self) -> BTreeSet<&str> {
        self.by_name.keys().map(String::as_str).collect()
    }

    /// `cell[17]`.
    pub(crate) fn full_name(&self, position: usize, copy: u32) -> String {
        let member = &self.list[position];
        let indices = if member.extents.is_empty() {
            member.element.clone()
        } else {
            let mut rest = copy;
            let mut indices: Vec<u32> = Vec::new();
            for &extent in member.extents.iter().rev() {
                indices.push(rest % extent.max(1) + 1);
                rest /= extent.max(1);
            }
            indices.reverse();
            indices
        };
        if indices.is_empty() {
            return member.name.clone();
        }
        let indices: Vec<String> = indices.iter().map(u32::to_string).collect();
        format!("{}[{}]", member.name, indices.join(","))
    }
}

/// The most copies an array of components may have.
pub(crate) const MOST_COPIES: u64 = 100_000_000;

/// Makes the members of a composite, loops run.
pub(crate) fn expand_members<'a>(builder: &mut Builder<'_, 'a>, library: &mut Library<'a>) -> Members {
    let mut members = Members::default();
    let declaration = builder.declaration;
    expand(builder, library, &declaration.members, &mut members);
    members
}

fn expand<'a>(
    builder: &mut Builder<'_, 'a>,
    library: &mut Library<'a>,
    items: &'a [MemberItem],
    members: &mut Members,
) {
    for item in items {
        match item {
            MemberItem::Member(member) => {
                if add(builder, library, member, members).is_none() && !member.name.value.is_empty() {
                    members.by_name.entry(member.name.value.clone()).or_insert(Named::Broken);
                }
            }
            MemberItem::For(turns) => {
                builder.each_turn(turns, |builder| expand(builder, library, &turns.items, members));
            }
        }
    }
}

fn add<'a>(
    builder: &mut Builder<'_, 'a>,
    library: &mut Library<'a>,
    written: &'a MemberDeclaration,
    members: &mut Members,
) -> Option<()> {
    let name = &written.name;
    if name.value.is_empty() || written.component.value.is_empty() {
        return None;
    }
    let Some(component) = library.named(&written.component.value) else {
        builder.report(hs0138_unknown_component::diagnostic(&written.component, &library.components));
        return None;
    };
    let element = whole_numbers(builder, &written.indices, "an index")?;
    let extents = whole_numbers(builder, &written.extents, "the number of copies")?;
    let copies: u64 = extents.iter().map(|&n| u64::from(n)).product();
    if copies > MOST_COPIES || extents.contains(&0) {
        let span = written.extents.first().map_or(name.span, |extent| extent.span);
        builder.report(hs0140_array_of_components::extent(&name.value, &extents, span));
        return None;
    }
    if !element.is_empty() && !extents.is_empty() {
        builder.report(hs0140_array_of_components::both(&name.value, name.span));
        return None;
    }
    let default = library.entry(builder.shared, component, &Given::new());
    let (parameters, given) = parameters(builder, library, written, &default);
    default.class?;
    let entry = library.entry(builder.shared, component, &given);
    let class = entry.class?;
    // Numbers of variables may differ between forms of a class; names do not.
    let parameters = parameters
        .into_iter()
        .filter_map(|(parameter, node)| {
            Some((library.classes[class.0 as usize].variable_named(&parameter)?, node))
        })
        .collect();
    enter(builder, name, &element, members)?;
    members.list.push(Member {
        name: name.value.clone(),
        class,
        extents,
        element,
        parameters,
        documentation: written.documentation.clone(),
        span: Some(name.span),
    });
    members.entries.push(entry);
    members.kinds.push(library.components[component].kind);
    Some(())
}

/// Enters a member under its name; says so if the name is taken.
fn enter<'a>(
    builder: &mut Builder<'_, 'a>,
    name: &'a Spanned<String>,
    element: &[u32],
    members: &mut Members,
) -> Option<()> {
    let position = members.list.len();
    let known = members.by_name.get_mut(&name.value);
    match (known, element.is_empty()) {
        (Some(Named::Elements(elements, first)), false) => {
            if elements.insert(element.to_vec(), position).is_some() {
                let first = *first;
                let indices: Vec<String> = element.iter().map(u32::to_string).collect();
                let what = format!("`{}[{}]`", name.value, indices.join(","));
                builder.report(hs0108_defined_twice::diagnostic(&what, first, name.span));
                return None;
            }
            return Some(());
        }
        (Some(Named::One(first)), _) => {
            let first = members.list[*first].span.unwrap_or(name.span);
            let kinds = ((SymbolKind::Member, first), (SymbolKind::Member, name.span));
            builder.report(hs0107_declared_twice::diagnostic(&name.value, kinds.0, kinds.1));
            return None;
        }
        (Some(Named::Elements(_, first)), true) => {
            let first = *first;
            let kinds = ((SymbolKind::Member, first), (SymbolKind::Member, name.span));
            builder.report(hs0107_declared_twice::diagnostic(&name.value, kinds.0, kinds.1));
            return None;
        }
        (Some(Named::Broken), _) => return None,
        (None, _) => {}
    }
    let symbol = Symbol { kind: SymbolKind::Member, span: name.span, value: SymbolValue::None };
    if !builder.declare(name, symbol) {
        return None;
    }
    let named = if element.is_empty() {
        Named::One(position)
    } else {
        Named::Elements(HashMap::from([(element.to_vec(), position)]), name.span)
    };
    members.by_name.insert(name.value.clone(), named);
    Some(())
}

fn whole_numbers<'a>(
    builder: &mut Builder<'_, 'a>,
    texts: &'a [ExpressionText],
    what: &str,
) -> Option<Vec<u32>> {
    let mut numbers = Vec::with_capacity(texts.len());
    for text in texts {
        let number = builder.at(Place::PARAMETER).constant_integer(text, what)?;
        match u32::try_from(number) {
            Ok(number) if number > 0 => numbers.push(number),
            _ => {
                builder.report(hs0140_array_of_components::not_positive(what, number, text.span));
                return None;
            }
        }
    }
    Some(numbers)
}

/// Values that a member gives to parameters, element by element and by name, and those that decide its structure.
fn parameters<'a>(
    builder: &mut Builder<'_, 'a>,
    library: &Library<'a>,
    written: &'a MemberDeclaration,
    entry: &Rc<Entry>,
) -> (Vec<(String, NodeId)>, Given) {
    let mut parameters = Vec::new();
    let mut given = Given::new();
    let mut first: HashMap<&str, Span> = HashMap::new();
    for (name, text) in &written.parameters {
        let Some(class) = entry.class else {
            builder.at(Place::PARAMETER).value(text);
            continue;
        };
        let class = &library.classes[class.0 as usize];
        if let Some(&first) = first.get(name.value.as_str()) {
            let what = format!("the value of `{}`", name.value);
            builder.report(hs0108_defined_twice::diagnostic(&what, first, name.span));
        }
        first.insert(&name.value, name.span);
        let Some((ids, expected)) = parameter_of(class, name) else {
            builder.report(hs0139_unknown_parameter::diagnostic(name, &written.component, class));
            builder.at(Place::PARAMETER).value(text);
            continue;
        };
        let Some(value) = builder.at(Place::PARAMETER).value_for(text, &expected) else { continue };
        let nodes = builder.at(Place::PARAMETER).stored(&value);
        if entry.structural.contains(&name.value) {
            match builder.at(Place::PARAMETER).known(&value) {
                Some(values) => {
                    given.insert(name.value.clone(), values);
                }
                None => {
                    builder.report(hs0139_unknown_parameter::not_known(name, &written.component, text.span));
                }
            }
        }
        for (&id, &node) in ids.iter().zip(&nodes) {
            let variable = class.variable(id);
            let bounds = variable
                .range
                .and_then(|[low, high]| Some((class.graph.as_number(low)?, class.graph.as_number(high)?)));
            if let (Some((low, high)), Some(value)) = (bounds, builder.known_value(node))
                && !(low..=high).contains(&value)
            {
                let declared = variable.span.unwrap_or(name.span);
                let found =
                    hs0126_out_of_range::diagnostic(&name.value, value, low, high, text.span, declared);
                builder.report(found);
            }
        }
        for (id, node) in ids.into_iter().zip(nodes) {
            parameters.push((class.variable(id).name.clone(), node));
        }
    }
    (parameters, given)
}

/// The elements of a parameter of a class, and what its value must be.
fn parameter_of(class: &sophy_ir::Class, name: &Spanned<String>) -> Option<(Vec<VariableId>, Expected)> {
    let prefix = format!("{}[", name.value);
    let is_parameter = |kind| matches!(kind, VariableKind::Parameter { .. });
    let ids: Vec<VariableId> = class
        .variables_of(is_parameter)
        .filter(|&id| {
            let own = &class.variable(id).name;
            *own == name.value || own.starts_with(&prefix)
        })
        .collect();
    let &first = ids.first()?;
    let shape = shape_of(&class.variable(*ids.last()?).name, ids.len());
    let variable = class.variable(first);
    let measured = match variable.unit.as_deref().map(crate::units::parse) {
        Some(Ok(parsed)) => Measured::Known(parsed.unit),
        _ => Measured::Unchecked,
    };
    let expected = Expected {
        shape,
        quantity: if variable.quantity == Quantity::Integer { Quantity::Real } else { variable.quantity },
        measured,
        choices: variable.choices.clone(),
        what: format!("parameter `{}`", name.value),
        span: variable.span,
    };
    Some((ids, expected))
}

/// The shape of a variable whose last element has this name.
fn shape_of(last: &str, count: usize) -> crate::lower::Shape {
    use crate::lower::Shape;
    let indices = last.split_once('[').map(|(_, rest)| rest.trim_end_matches(']'));
    match indices.map(|indices| indices.split(',').filter_map(|i| i.parse().ok()).collect::<Vec<usize>>()) {
        Some(extents) => Shape::of(&extents).unwrap_or(Shape::Vector(count)),
        None => Shape::Scalar,
    }
}
